//! The compact form of a stream: what was pressed since the frame before. Sixty a second of them must be small, so their
//! bytes are laid out by hand.
//!
//! | bytes | what |
//! |---|---|
//! | 1 | bit 7 set (no other message begins so), bit 6: a digest follows, bit 5: inputs follow, bits 0 to 4: the span, or 0 |
//! | 1 to 10 | the tick up to which everything is told, as a varint |
//! | 0 to 10 | the span as a varint, if it is none of 1 to 31 ticks |
//! | 0 or 8 | the digest, little-endian |
//! | the rest | for each input the tick after the frame's first one as a varint, whose it is, and the action |

use super::frame::{FrameError, decode_prefix, encode};
use super::framing::{read_varint, write_varint};
use crate::game::{Action, HOUSE, Input};

/// The first bit of these frames.
pub(super) const MARK: u8 = 0x80;
const HAS_DIGEST: u8 = 0x40;
const HAS_INPUTS: u8 = 0x20;
const SPAN: u8 = 0x1f;
/// Of the byte that says whose an input is: the seat, and 7 is the house.
const SEAT: u8 = 0x07;
const BOARD_SHIFT: u32 = 3;

/// The most inputs of one frame. A room in which more happened sends a full snapshot.
pub const MOST_INPUTS: usize = 1024;

/// An input, and on which board it acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoardInput {
    /// The board, from 0.
    pub board: u8,
    /// What was done there.
    pub input: Input,
}

/// Everything that was pressed from one tick up to another.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Inputs {
    /// The first tick that is told; the frame before told everything up to it.
    pub from: u64,
    /// The first tick that is not told: a copy of the game may be stepped until it is at this tick.
    pub to: u64,
    /// What the room's digest must be at `to`: see [`super::digest_of_room`].
    pub digest: Option<u64>,
    /// In the order in which they act.
    pub inputs: Vec<BoardInput>,
}

impl Inputs {
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        let span = self.to - self.from;
        let short = u8::try_from(span).ok().filter(|&span| span <= SPAN).unwrap_or(0);
        let mut bytes = Vec::with_capacity(16);
        let mut first = MARK | short;
        first |= if self.digest.is_some() { HAS_DIGEST } else { 0 };
        first |= if self.inputs.is_empty() { 0 } else { HAS_INPUTS };
        bytes.push(first);
        write_varint(&mut bytes, self.to);
        if short == 0 {
            write_varint(&mut bytes, span);
        }
        if let Some(digest) = self.digest {
            bytes.extend_from_slice(&digest.to_le_bytes());
        }
        for &BoardInput { board, input: Input { tick, seat, action } } in &self.inputs {
            write_varint(&mut bytes, tick - self.from);
            bytes.push(board << BOARD_SHIFT | if seat == HOUSE { SEAT } else { seat });
            bytes.extend(encode(&action));
        }
        bytes
    }

    pub(super) fn from_bytes(frame: &[u8]) -> Result<Self, FrameError> {
        let malformed = |problem: &str| FrameError::Malformed { length: frame.len(), problem: problem.to_owned() };
        let (&first, mut rest) = frame.split_first().ok_or_else(|| malformed("empty"))?;
        let to = read_varint(&mut rest).ok_or_else(|| malformed("no tick"))?;
        let span = match first & SPAN {
            0 => read_varint(&mut rest)
                .filter(|&span| span == 0 || span > u64::from(SPAN))
                .ok_or_else(|| malformed("no span"))?,
            short => u64::from(short),
        };
        let from = to.checked_sub(span).ok_or_else(|| malformed("a span that begins before tick 0"))?;
        let mut digest = None;
        if first & HAS_DIGEST != 0 {
            let (bytes, behind) = rest.split_first_chunk::<8>().ok_or_else(|| malformed("half a digest"))?;
            (digest, rest) = (Some(u64::from_le_bytes(*bytes)), behind);
        }
        if (first & HAS_INPUTS == 0) != rest.is_empty() {
            return Err(malformed("inputs that are not announced, or none that are"));
        }
        let mut inputs = Vec::new();
        let mut before = from;
        while !rest.is_empty() {
            if inputs.len() == MOST_INPUTS {
                return Err(malformed("too many inputs"));
            }
            let after = read_varint(&mut rest).ok_or_else(|| malformed("an input without a tick"))?;
            let tick = from.checked_add(after).filter(|tick| (before..to).contains(tick));
            let tick = tick.ok_or_else(|| malformed("an input out of order, or beyond the frame's span"))?;
            let (&who, behind) = rest.split_first().ok_or_else(|| malformed("an input of nobody"))?;
            let (action, used) = decode_prefix::<Action>(behind)?;
            rest = &behind[used..];
            let seat = if who & SEAT == SEAT { HOUSE } else { who & SEAT };
            inputs.push(BoardInput { board: who >> BOARD_SHIFT, input: Input { tick, seat, action } });
            before = tick;
        }
        Ok(Self { from, to, digest, inputs })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::game::Nudge;

    fn sample() -> Inputs {
        let input = |tick, seat, action| BoardInput { board: seat % 2, input: Input { tick, seat, action } };
        let flip = Action::Flipper { right: true, pressed: true };
        let inputs = vec![
            input(1_000_001, 0, flip),
            input(1_000_001, 3, Action::Pull(u16::MAX)),
            input(1_000_016, HOUSE, Action::Nudge(Nudge::Forward)),
        ];
        Inputs { from: 1_000_000, to: 1_000_017, digest: Some(77), inputs }
    }

    #[test]
    fn survives_the_wire() {
        let full = sample();
        let long = Inputs { from: 0, to: 100, digest: None, inputs: Vec::new() };
        let none = Inputs { from: 5, to: 5, digest: Some(1), inputs: Vec::new() };
        for inputs in [full, long, none] {
            assert_eq!(Inputs::from_bytes(&inputs.to_bytes()), Ok(inputs));
        }
    }

    /// Sixty of these a second, with five digests and some inputs, are to stay below 500 bytes with their lengths.
    #[test]
    fn a_quiet_frame_has_five_bytes_for_the_first_three_days() {
        let to = (1 << 28) - 1;
        let quiet = Inputs { from: to - 17, to, digest: None, inputs: Vec::new() };
        assert_eq!(quiet.to_bytes().len(), 5);
        assert_eq!(sample().to_bytes().len(), 1 + 3 + 8 + (2 + 3) + (2 + 4) + (2 + 2));
    }

    #[test]
    fn hostile_bytes_are_refused() {
        let good = sample().to_bytes();
        for length in 0..good.len() {
            let cut = Inputs::from_bytes(&good[..length]);
            assert!(cut.is_err() || cut.is_ok_and(|cut| cut.inputs.len() < 3), "{length}");
        }
        let mut beyond = good;
        beyond[12] = 40;
        let error = Inputs::from_bytes(&beyond).expect_err("an input after the end").to_string();
        assert!(error.contains("beyond the frame's span"), "{error}");
    }
}
