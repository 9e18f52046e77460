//! The written form of numbers that are often zero: those that are not, behind a mark of which they are.

use core::fmt;

use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Up to 16 numbers. Each that is +0 bit for bit is a bit of the first two bytes and nothing else. Put those first that are zero
/// now and then, so that the bits of the others, which hardly ever are, do not make the mark longer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Numbers<const N: usize>(pub(super) [f64; N]);

impl<const N: usize> Numbers<N> {
    fn zeros(&self) -> u16 {
        let is_zero = |number: &f64| u16::from(number.to_bits() == 0);
        self.0.iter().rev().fold(0, |bits, number| bits << 1 | is_zero(number))
    }
}

impl<const N: usize> Serialize for Numbers<N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let zeros = self.zeros();
        let mut tuple = serializer.serialize_tuple(1 + N - zeros.count_ones() as usize)?;
        tuple.serialize_element(&zeros)?;
        for number in self.0.iter().filter(|number| number.to_bits() != 0) {
            tuple.serialize_element(number)?;
        }
        tuple.end()
    }
}

impl<'de, const N: usize> Deserialize<'de> for Numbers<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Form<const N: usize>;

        impl<'de, const N: usize> Visitor<'de> for Form<N> {
            type Value = Numbers<N>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{N} numbers, those that are zero as marks")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Numbers<N>, A::Error> {
                let missing = || A::Error::custom("a number is missing");
                let zeros: u16 = seq.next_element()?.ok_or_else(missing)?;
                if N < 16 && zeros >> N != 0 {
                    return Err(A::Error::custom("a mark of a number that there is not"));
                }
                let mut numbers = [0.0; N];
                for (place, number) in numbers.iter_mut().enumerate() {
                    if zeros >> place & 1 == 0 {
                        *number = seq.next_element()?.ok_or_else(missing)?;
                    }
                }
                Ok(Numbers(numbers))
            }
        }

        const { assert!(N <= 16) };
        // How many follow is known once the mark is read.
        deserializer.deserialize_tuple(1 + N, Form::<N>)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::{decode, encode};

    #[test]
    fn numbers_are_read_back_bit_for_bit_and_zeros_take_no_bytes() {
        for (numbers, bytes) in [
            ([0.0; 4], 1),
            ([0.0, 1.5, 0.0, -2.0], 1 + 16),
            ([-0.0, f64::MIN_POSITIVE / 4.0, f64::INFINITY, 0.1 + 0.2], 1 + 32),
        ] {
            let written = encode(&Numbers(numbers));
            assert_eq!(written.len(), bytes);
            let read: Numbers<4> = decode(&written).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(read.0.map(f64::to_bits), numbers.map(f64::to_bits));
        }
        assert!(decode::<Numbers<4>>(&[0b1_0000]).is_err(), "there is no fifth");
        assert!(decode::<Numbers<4>>(&[0b0111, 0]).is_err(), "a number is cut off");
    }
}
