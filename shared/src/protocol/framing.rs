//! Frames on a stream of bytes such as TCP: each has its length in front, as a varint (seven bits a byte, the lowest
//! first). Carriers that keep messages apart by themselves need none of this.

use thiserror::Error;

/// The most bytes of a length: 21 bits, which is more than any frame may have.
const MOST_LENGTH_BYTES: usize = 3;

/// Why a stream of bytes cannot be read any further.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum FramingError {
    /// A frame says that it is longer than allowed. It is refused unread.
    #[error("frame size too big: {length} bytes, at most {most} would be right")]
    TooLong {
        /// What it says.
        length: usize,
        /// What is allowed.
        most: usize,
    },
    /// A length that goes on after its last possible byte, or is written longer than it need be.
    #[error("a frame's length is not written as one")]
    Length,
}

/// The length that stands in front of a frame of so many bytes.
///
/// # Panics
/// If there is no such frame: [`super::MOST_FROM_SERVER`] is the most.
pub fn length_prefix(length: usize) -> Vec<u8> {
    assert!(length < 1 << (7 * MOST_LENGTH_BYTES), "no frame has {length} bytes");
    let mut prefix = Vec::with_capacity(MOST_LENGTH_BYTES);
    write_varint(&mut prefix, length as u64);
    prefix
}

/// A frame as it stands on a stream: its length, then its bytes.
pub fn framed(frame: &[u8]) -> Vec<u8> {
    let mut bytes = length_prefix(frame.len());
    bytes.extend_from_slice(frame);
    bytes
}

/// Takes frames out of a stream of bytes. Holds at most one frame of the largest size and what came with it.
#[derive(Debug)]
pub struct Deframer {
    buffer: Vec<u8>,
    /// Where the next frame's length begins.
    start: usize,
    most: usize,
}

impl Deframer {
    /// For frames of at most `most` bytes.
    pub fn new(most: usize) -> Self {
        Self { buffer: Vec::new(), start: 0, most }
    }

    /// Where bytes that came in are to be appended. To be called when [`Self::next_frame`] has no more.
    pub fn space(&mut self) -> &mut Vec<u8> {
        self.buffer.drain(..self.start);
        self.start = 0;
        &mut self.buffer
    }

    /// The next frame that is there as a whole.
    ///
    /// # Errors
    /// If what comes is no frame or too long a one. Nothing behind it can be read.
    pub fn next_frame(&mut self) -> Result<Option<&[u8]>, FramingError> {
        let rest = &self.buffer[self.start..];
        let mut length = 0;
        for place in 0.. {
            let Some(&byte) = rest.get(place) else { return Ok(None) };
            length |= usize::from(byte & 0x7f) << (7 * place);
            if byte & 0x80 == 0 {
                if byte == 0 && place > 0 {
                    return Err(FramingError::Length);
                }
                if length > self.most {
                    return Err(FramingError::TooLong { length, most: self.most });
                }
                let begin = self.start + place + 1;
                return Ok(match self.buffer.get(begin..begin + length) {
                    Some(frame) => {
                        self.start = begin + length;
                        Some(frame)
                    }
                    None => None,
                });
            }
            if place + 1 == MOST_LENGTH_BYTES {
                break;
            }
        }
        Err(FramingError::Length)
    }
}

/// Appends a number, seven bits a byte, the lowest first.
pub(super) fn write_varint(bytes: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

/// Takes a number off the front of `bytes`; `None` if there is none, or it is written longer than it need be.
pub(super) fn read_varint(bytes: &mut &[u8]) -> Option<u64> {
    let mut number = 0_u64;
    for place in 0..10 {
        let (&byte, rest) = bytes.split_first()?;
        *bytes = rest;
        let bits = u64::from(byte & 0x7f);
        if place == 9 && bits > 1 {
            return None;
        }
        number |= bits << (7 * place);
        if byte & 0x80 == 0 {
            return (byte != 0 || place == 0).then_some(number);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;

    #[test]
    fn frames_come_out_as_they_went_in_however_they_were_cut() {
        let mut rng = Rng::new(3);
        let frames: Vec<Vec<u8>> =
            [0, 1, 127, 128, 300, 16_383, 16_384, 70_000].map(|length| vec![length as u8; length]).to_vec();
        let stream: Vec<u8> = frames.iter().flat_map(|frame| framed(frame)).collect();
        for _ in 0..50 {
            let (mut deframer, mut rest, mut found) = (Deframer::new(70_000), &stream[..], Vec::new());
            while !rest.is_empty() {
                let (now, later) = rest.split_at((rng.bits() % 20_000) as usize % rest.len() + 1);
                deframer.space().extend_from_slice(now);
                rest = later;
                while let Some(frame) = deframer.next_frame().unwrap() {
                    found.push(frame.to_vec());
                }
            }
            assert!(found == frames);
        }
    }

    #[test]
    fn a_frame_that_is_too_long_is_refused_by_its_length_alone() {
        let mut deframer = Deframer::new(100);
        deframer.space().extend_from_slice(&length_prefix(101));
        assert_eq!(deframer.next_frame(), Err(FramingError::TooLong { length: 101, most: 100 }));
        for endless in [&[0x80, 0x80, 0x80, 0x80][..], &[0xff, 0xff, 0xff], &[0x80, 0x00]] {
            let mut deframer = Deframer::new(100);
            deframer.space().extend_from_slice(endless);
            assert_eq!(deframer.next_frame(), Err(FramingError::Length), "{endless:?}");
        }
    }

    #[test]
    fn varints_have_one_form_each() {
        for number in [0, 1, 127, 128, 1 << 21, u64::from(u32::MAX), u64::MAX] {
            let mut bytes = Vec::new();
            write_varint(&mut bytes, number);
            assert_eq!(read_varint(&mut &bytes[..]), Some(number));
        }
        for bad in [&[0x80, 0x00][..], &[0x80], &[], &[0xff; 10], &[0x80; 11]] {
            assert_eq!(read_varint(&mut &bad[..]), None, "{bad:?}");
        }
    }
}
