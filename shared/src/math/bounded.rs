//! Lists that refuse to grow beyond a bound while they are read.
//!
//! serde's own `Vec` believes the length that it is told and allocates up to 1 MiB ahead of ten hostile bytes.

use core::fmt;
use core::marker::PhantomData;

use serde::Deserializer;
use serde::de::{Deserialize, Error, SeqAccess, Visitor};

/// Reads a list of at most `MOST` items: `#[serde(deserialize_with = "bounded::list::<_, _, 64>")]`.
///
/// # Errors
/// If the list says that it is longer, or turns out to be.
pub fn list<'de, D, T, const MOST: usize>(deserializer: D) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    struct List<T, const MOST: usize>(PhantomData<T>);

    impl<'de, T: Deserialize<'de>, const MOST: usize> Visitor<'de> for List<T, MOST> {
        type Value = Vec<T>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "a list of at most {MOST} items")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Vec<T>, A::Error> {
            let too_long = |length| A::Error::invalid_length(length, &self);
            if let Some(length) = items.size_hint()
                && length > MOST
            {
                return Err(too_long(length));
            }
            let mut list = Vec::new();
            while let Some(item) = items.next_element()? {
                if list.len() == MOST {
                    return Err(too_long(MOST + 1));
                }
                list.push(item);
            }
            Ok(list)
        }
    }

    deserializer.deserialize_seq(List::<T, MOST>(PhantomData))
}
