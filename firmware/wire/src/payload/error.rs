//! Errors in reading and writing payloads.

use core::fmt;

use super::{CHUNK_LEN, CHUNK_NUMBER_MAX, PAYLOAD_MAX_LEN, SAMPLES_MAX};
use crate::frame::PayloadLengthError;
use crate::hello::HelloError;

/// Why a payload cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParseError {
    /// The frame's payload is empty.
    Empty,
    /// The first byte is not a payload kind that the other side sends.
    UnknownKind {
        /// The first byte.
        kind: u8,
    },
    /// The command of a request cannot be read; most likely it belongs to a newer protocol. The board answers
    /// [`crate::message::Refusal::UnknownCommand`].
    UnknownCommand {
        /// The request's sequence number.
        sequence: u16,
    },
    /// The bytes after the first do not form a payload of this kind.
    Malformed {
        /// The first byte.
        kind: u8,
    },
    /// The hello cannot be read.
    Hello(HelloError),
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("a frame carries no payload: its sender is not frixel"),
            Self::UnknownKind { kind } => {
                write!(f, "a payload of kind {kind:#04x} is not expected from this side: update the older of the two")
            }
            Self::UnknownCommand { sequence } => {
                write!(f, "the command of request {sequence} cannot be read: update the firmware")
            }
            Self::Malformed { kind } => {
                write!(f, "a payload of kind {kind:#04x} cannot be read: update the older of host and board")
            }
            Self::Hello(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for ParseError {}

/// Why a payload cannot be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WriteError {
    /// The payload would be longer than [`PAYLOAD_MAX_LEN`].
    TooLong,
    /// The chunk number is above [`CHUNK_NUMBER_MAX`].
    ChunkNumber {
        /// The chunk's number.
        number: u16,
    },
    /// The chunk is empty or longer than [`CHUNK_LEN`].
    ChunkLength {
        /// Bytes in the chunk.
        len: usize,
    },
    /// There are no samples, or more than [`SAMPLES_MAX`].
    SampleCount {
        /// Number of samples.
        count: usize,
    },
}

impl fmt::Display for WriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLong => write!(f, "a payload is longer than the {PAYLOAD_MAX_LEN} bytes that a frame holds"),
            Self::ChunkNumber { number } => {
                write!(f, "chunk {number} is beyond {CHUNK_NUMBER_MAX}, the last that an upload can have: upload less")
            }
            Self::ChunkLength { len } => write!(f, "a chunk holds 1 to {CHUNK_LEN} bytes, and this one has {len}"),
            Self::SampleCount { count } => {
                write!(f, "a frame holds 1 to {SAMPLES_MAX} samples, and {count} were given")
            }
        }
    }
}

impl core::error::Error for WriteError {}

impl From<PayloadLengthError> for WriteError {
    fn from(_: PayloadLengthError) -> Self {
        Self::TooLong
    }
}
