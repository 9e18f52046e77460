//! Message <-> bytes of one frame: bincode through serde, bounded and checked to the last byte.

use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

use super::MOST_FROM_SERVER;
use super::inputs::{self, Inputs};
use super::message::ServerMessage;
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

/// The bytes of what a server says.
pub fn encode_from_server(message: &ServerMessage) -> Vec<u8> {
    match message {
        ServerMessage::Inputs(inputs) => inputs.to_bytes(),
        other => encode(other),
    }
}

/// What a server says.
///
/// # Errors
/// If the bytes are not exactly one message, or its words cannot be shown.
pub fn decode_from_server(bytes: &[u8]) -> Result<ServerMessage, FrameError> {
    match bytes.first() {
        Some(&first) if first & inputs::MARK != 0 => Ok(ServerMessage::Inputs(Inputs::from_bytes(bytes)?)),
        _ => checked(decode(bytes)?, bytes.len()),
    }
}

/// The first thing that a server says.
///
/// # Errors
/// If its protocol is not ours, the bytes are not exactly one message, or its words cannot be shown.
pub fn decode_welcome(bytes: &[u8]) -> Result<ServerMessage, FrameError> {
    checked(decode_greeting(bytes)?, bytes.len())
}

fn checked(message: ServerMessage, length: usize) -> Result<ServerMessage, FrameError> {
    message.check().map_err(|problem| FrameError::Malformed { length, problem })?;
    Ok(message)
}

/// The bytes of a value.
///
/// # Panics
/// If its `Serialize` reports an error, which no derived implementation does.
pub fn encode<T: Serialize>(message: &T) -> Vec<u8> {
    bincode::serde::encode_to_vec(message, config()).expect("derived Serialize does not fail")
}

/// The value in the bytes.
///
/// # Errors
/// If they are not exactly one.
pub fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, FrameError> {
    let length = bytes.len();
    let (value, used) = decode_prefix(bytes)?;
    if used < length {
        return Err(FrameError::Trailing { length, left: length - used });
    }
    Ok(value)
}

/// The value at the front of the bytes, and how many it has.
pub(super) fn decode_prefix<T: DeserializeOwned>(bytes: &[u8]) -> Result<(T, usize), FrameError> {
    bincode::serde::decode_from_slice(bytes, config())
        .map_err(|error| FrameError::Malformed { length: bytes.len(), problem: error.to_string() })
}

/// The same with numbers of fixed length: a state in this form is what digests are made of, and what patches apply to.
pub(super) fn encode_fixed<T: Serialize>(value: &T) -> Vec<u8> {
    let config = bincode::config::standard().with_fixed_int_encoding();
    bincode::serde::encode_to_vec(value, config).expect("derived Serialize does not fail")
}

/// The value of such bytes.
pub(super) fn decode_fixed<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, FrameError> {
    let config = bincode::config::standard().with_fixed_int_encoding().with_limit::<MOST_FROM_SERVER>();
    let length = bytes.len();
    let (value, used) = bincode::serde::decode_from_slice(bytes, config)
        .map_err(|error: bincode::error::DecodeError| FrameError::Malformed { length, problem: error.to_string() })?;
    if used < length {
        return Err(FrameError::Trailing { length, left: length - used });
    }
    Ok(value)
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
