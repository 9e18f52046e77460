//! A digest of state: equal on two machines if and only if (but for chance) all the state's bits are.

use bincode::enc::write::Writer;
use bincode::error::EncodeError;
use serde::Serialize;

const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x0000_0100_0000_01b3;

/// A running 64-bit FNV-1a digest (Fowler, Noll, Vo). It finds differences; it does not resist forgery.
#[derive(Debug, Clone, Copy)]
pub struct Digest(u64);

impl Default for Digest {
    fn default() -> Self {
        Self(FNV_OFFSET)
    }
}

impl Digest {
    /// Takes in bytes.
    pub fn update(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(FNV_PRIME);
        }
    }

    /// The digest of all that was taken in.
    pub fn finish(self) -> u64 {
        self.0
    }
}

impl Writer for Digest {
    fn write(&mut self, bytes: &[u8]) -> Result<(), EncodeError> {
        self.update(bytes);
        Ok(())
    }
}

/// Digest of a value through its serde form: integers as fixed little-endian, f64 as its raw bits, nothing rounded and
/// nothing allocated.
///
/// # Panics
/// If the value's `Serialize` reports an error, which no derived implementation does.
pub fn digest_of<T: Serialize>(value: &T) -> u64 {
    let mut digest = Digest::default();
    let config = bincode::config::standard().with_fixed_int_encoding();
    bincode::serde::encode_into_writer(value, &mut digest, config).expect("derived Serialize does not fail");
    digest.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_value_of_fnv_1a() {
        let mut digest = Digest::default();
        digest.update(b"foobar");
        assert_eq!(digest.finish(), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn one_bit_of_a_float_changes_the_digest() {
        let x = 0.1_f64;
        assert_ne!(digest_of(&x), digest_of(&f64::from_bits(x.to_bits() + 1)));
        assert_ne!(digest_of(&0.0_f64), digest_of(&-0.0_f64));
    }
}
