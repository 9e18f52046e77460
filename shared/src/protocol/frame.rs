//! Message <-> bytes of one frame: bincode through serde, bounded and checked to the last byte.

use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

use super::MOST_FROM_SERVER;
use super::version::{PREAMBLE_LENGTH, Preamble, PreambleError};

/// Why a frame could not be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum FrameError {
    /// The other side speaks something else.
    #[error(transparent)]
    Preamble(#[from] PreambleError),
    /// The bytes are no message.
    #[error("a frame of {length} bytes is no message: {problem}")]
    Malformed {
        /// Of the frame.
        length: usize,
        /// What bincode says.
        problem: String,
    },
    /// The message ends before the frame does.
    #[error("a frame of {length} bytes has {left} bytes behind its message")]
    Trailing {
        /// Of the frame.
        length: usize,
        /// Behind the message.
        left: usize,
    },
}

fn config() -> impl bincode::config::Config {
    // The limit stops a string from allocating what it claims; lists are bounded by their own visitors.
    bincode::config::standard().with_limit::<MOST_FROM_SERVER>()
}

/// The bytes of a message.
///
/// # Panics
/// If its `Serialize` reports an error, which no derived implementation does.
pub fn encode<T: Serialize>(message: &T) -> Vec<u8> {
    bincode::serde::encode_to_vec(message, config()).expect("derived Serialize does not fail")
}

/// The message in the bytes.
///
/// # Errors
/// If they are not exactly one message.
pub fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, FrameError> {
    let length = bytes.len();
    let (message, used) = bincode::serde::decode_from_slice(bytes, config())
        .map_err(|error| FrameError::Malformed { length, problem: error.to_string() })?;
    if used < length {
        return Err(FrameError::Trailing { length, left: length - used });
    }
    Ok(message)
}

/// The bytes of a first message: a preamble, then the message.
pub fn encode_greeting<T: Serialize>(message: &T) -> Vec<u8> {
    let mut bytes = Preamble::ours().to_bytes().to_vec();
    bytes.extend(encode(message));
    bytes
}

/// The message in the first frame of the other side.
///
/// # Errors
/// If the other side's protocol is not ours, or the bytes are not exactly one message.
pub fn decode_greeting<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, FrameError> {
    Preamble::from_bytes(bytes)?.check()?;
    decode(&bytes[PREAMBLE_LENGTH..])
}
