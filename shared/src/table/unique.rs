//! Maps that refuse a key that is written twice.
//!
//! serde's own maps silently keep the last one, and whoever copied a material and forgot to rename it would wonder.

use core::fmt;
use core::marker::PhantomData;
use std::collections::BTreeMap;

use serde::Deserializer;
use serde::de::{Deserialize, Error, MapAccess, Visitor};

/// Reads a map with names as keys: `#[serde(deserialize_with = "unique::map")]`.
///
/// # Errors
/// If a key is there twice.
pub(super) fn map<'de, D, V>(deserializer: D) -> Result<BTreeMap<String, V>, D::Error>
where
    D: Deserializer<'de>,
    V: Deserialize<'de>,
{
    struct Map<V>(PhantomData<V>);

    impl<'de, V: Deserialize<'de>> Visitor<'de> for Map<V> {
        type Value = BTreeMap<String, V>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "a map of names, each there once")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Self::Value, A::Error> {
            let mut map = BTreeMap::new();
            while let Some(key) = entries.next_key::<String>()? {
                if map.contains_key(&key) {
                    return Err(A::Error::custom(format!("{key:?} is there twice; names must differ")));
                }
                map.insert(key, entries.next_value()?);
            }
            Ok(map)
        }
    }

    deserializer.deserialize_map(Map(PhantomData))
}
