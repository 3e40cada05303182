//! Payloads of frames. The first byte is the kind of the payload and determines the layout of the rest.
//!
//! | first byte | from | rest |
//! |---|---|---|
//! | `0x00` | host | hello request: protocol major, protocol minor; what follows is ignored |
//! | `0x01` | board | [`Hello`] |
//! | `0x02` | host | [`Request`] in postcard |
//! | `0x03` | board | [`FromBoard`] in postcard |
//! | `0x04` | host | stream: index of the first sample, 4 bytes; then 1 to [`SAMPLES_MAX`] samples, 2 bytes each |
//! | `0x80..=0xff` | host | upload: 0x8000 plus the chunk's number, big-endian; then 1 to [`CHUNK_LEN`] bytes |
//!
//! A host sends with [`hello_request_frame`], [`request_frame`], [`chunk_frame`] and [`samples_frame`] and reads with
//! [`Payload::parse_from_board`]. A board sends with [`hello_frame`] and [`from_board_frame`] and reads with
//! [`Payload::parse_from_host`]. Separate functions keep the code for the other direction out of the firmware image.

mod error;

use postcard::experimental::max_size::MaxSize;
use serde::{Deserialize, Serialize};

use crate::frame::{self, FRAME_MAX_LEN};
use crate::hello::{Hello, PROTOCOL_MAJOR, PROTOCOL_MINOR};
use crate::message::{Command, FromBoard, Request};

pub use error::{ParseError, WriteError};

/// Largest payload of a frame in bytes, including the first byte: 192 less zero byte, COBS overhead byte and CRC-32.
pub const PAYLOAD_MAX_LEN: usize = 186;

/// Bytes in a chunk of an upload; only the last chunk may be shorter.
pub const CHUNK_LEN: usize = PAYLOAD_MAX_LEN - 2;

/// Maximum number of stream samples in a frame.
pub const SAMPLES_MAX: usize = (PAYLOAD_MAX_LEN - 5) / 2;

/// Largest chunk number.
pub const CHUNK_NUMBER_MAX: u16 = 0x7fff;

const HELLO_REQUEST: u8 = 0x00;
const HELLO: u8 = 0x01;
const REQUEST: u8 = 0x02;
const FROM_BOARD: u8 = 0x03;
const SAMPLES: u8 = 0x04;
const CHUNK: u8 = 0x80;

const _: () = assert!(Request::POSTCARD_MAX_SIZE < PAYLOAD_MAX_LEN);
const _: () = assert!(FromBoard::POSTCARD_MAX_SIZE < PAYLOAD_MAX_LEN);

/// The payload of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Payload<'a> {
    /// The host requests the board's [`Hello`].
    HelloRequest {
        /// Protocol version of the host: major, minor.
        protocol: (u8, u8),
    },
    /// The board identifies itself.
    Hello(Hello),
    /// The host sends a command.
    Request(Request),
    /// The board answers a command or reports an event.
    FromBoard(FromBoard),
    /// A chunk of the current upload.
    Chunk {
        /// The chunk's number, from zero.
        number: u16,
        /// The chunk's bytes: [`CHUNK_LEN`] of them, or at least one in the last chunk.
        bytes: &'a [u8],
    },
    /// Samples of the current stream.
    Samples {
        /// Index of the first sample, counted from the start of the stream.
        first_index: u32,
        /// The samples, 1 to [`SAMPLES_MAX`], each little-endian; 65,535 represents 1.
        samples: &'a [[u8; 2]],
    },
}

impl<'a> Payload<'a> {
    /// Reads a payload from either side.
    pub fn parse(payload: &'a [u8]) -> Result<Self, ParseError> {
        match payload {
            [HELLO | FROM_BOARD, ..] => Self::parse_from_board(payload),
            _ => Self::parse_from_host(payload),
        }
    }

    /// Reads a payload that a host sent.
    #[inline(never)]
    pub fn parse_from_host(payload: &'a [u8]) -> Result<Self, ParseError> {
        let (&kind, rest) = payload.split_first().ok_or(ParseError::Empty)?;
        match (kind, rest) {
            (HELLO_REQUEST, &[major, minor, ..]) => Ok(Self::HelloRequest { protocol: (major, minor) }),
            (HELLO_REQUEST, _) => Err(ParseError::Malformed { kind }),
            (REQUEST, rest) => parse_request(rest).map(Self::Request),
            (CHUNK.., [low, bytes @ ..]) if !bytes.is_empty() => {
                Ok(Self::Chunk { number: u16::from_be_bytes([kind & !CHUNK, *low]), bytes })
            }
            (CHUNK.., _) => Err(ParseError::Malformed { kind }),
            (SAMPLES, rest) => parse_samples(rest).ok_or(ParseError::Malformed { kind }),
            (kind, _) => Err(ParseError::UnknownKind { kind }),
        }
    }

    /// Reads a payload that a board sent.
    pub fn parse_from_board(payload: &'a [u8]) -> Result<Self, ParseError> {
        let (&kind, rest) = payload.split_first().ok_or(ParseError::Empty)?;
        match kind {
            HELLO => Hello::parse(rest).map(Self::Hello).map_err(ParseError::Hello),
            FROM_BOARD => whole(rest).map(Self::FromBoard).ok_or(ParseError::Malformed { kind }),
            kind => Err(ParseError::UnknownKind { kind }),
        }
    }

    /// Writes the payload to `buffer` and returns the bytes written.
    pub fn write<'b>(&self, buffer: &'b mut [u8; PAYLOAD_MAX_LEN]) -> Result<&'b [u8], WriteError> {
        match self {
            Self::HelloRequest { protocol: (major, minor) } => join(buffer, &[HELLO_REQUEST], &[*major, *minor]),
            Self::Hello(hello) => join(buffer, &[HELLO], &hello.write()),
            Self::Request(request) => write_postcard(buffer, REQUEST, request),
            Self::FromBoard(message) => write_postcard(buffer, FROM_BOARD, message),
            Self::Chunk { number, bytes } => write_chunk(buffer, *number, bytes),
            Self::Samples { first_index, samples } => write_samples(buffer, *first_index, samples.iter().copied()),
        }
    }

    /// Writes a complete frame and returns the bytes written.
    pub fn write_frame<'f>(&self, frame: &'f mut [u8; FRAME_MAX_LEN]) -> Result<&'f [u8], WriteError> {
        let mut buffer = [0; PAYLOAD_MAX_LEN];
        Ok(frame::encode(self.write(&mut buffer)?, frame)?)
    }
}

/// Writes the frame of a hello request with the protocol version of this crate.
pub fn hello_request_frame(frame: &mut [u8; FRAME_MAX_LEN]) -> Result<&[u8], WriteError> {
    Ok(frame::encode(&[HELLO_REQUEST, PROTOCOL_MAJOR, PROTOCOL_MINOR], frame)?)
}

/// Writes the frame of a hello.
#[inline(never)]
pub fn hello_frame<'f>(hello: &Hello, frame: &'f mut [u8; FRAME_MAX_LEN]) -> Result<&'f [u8], WriteError> {
    let mut buffer = [0; PAYLOAD_MAX_LEN];
    Ok(frame::encode(join(&mut buffer, &[HELLO], &hello.write())?, frame)?)
}

/// Writes the frame of a request.
pub fn request_frame<'f>(request: &Request, frame: &'f mut [u8; FRAME_MAX_LEN]) -> Result<&'f [u8], WriteError> {
    let mut buffer = [0; PAYLOAD_MAX_LEN];
    Ok(frame::encode(write_postcard(&mut buffer, REQUEST, request)?, frame)?)
}

/// Writes the frame of a message from the board.
#[inline(never)]
pub fn from_board_frame<'f>(message: &FromBoard, frame: &'f mut [u8; FRAME_MAX_LEN]) -> Result<&'f [u8], WriteError> {
    let mut buffer = [0; PAYLOAD_MAX_LEN];
    Ok(frame::encode(write_postcard(&mut buffer, FROM_BOARD, message)?, frame)?)
}

/// Writes the frame of an upload chunk: its number, from zero, and [`CHUNK_LEN`] bytes, or fewer in the last chunk.
pub fn chunk_frame<'f>(number: u16, bytes: &[u8], frame: &'f mut [u8; FRAME_MAX_LEN]) -> Result<&'f [u8], WriteError> {
    let mut buffer = [0; PAYLOAD_MAX_LEN];
    Ok(frame::encode(write_chunk(&mut buffer, number, bytes)?, frame)?)
}

/// Writes the frame of stream samples: the index of the first, and 1 to [`SAMPLES_MAX`] samples; 65,535 represents 1.
pub fn samples_frame<'f>(
    first_index: u32,
    samples: &[u16],
    frame: &'f mut [u8; FRAME_MAX_LEN],
) -> Result<&'f [u8], WriteError> {
    let mut buffer = [0; PAYLOAD_MAX_LEN];
    let bytes = samples.iter().map(|sample| sample.to_le_bytes());
    Ok(frame::encode(write_samples(&mut buffer, first_index, bytes)?, frame)?)
}

fn write_samples(
    buffer: &mut [u8; PAYLOAD_MAX_LEN],
    first_index: u32,
    samples: impl ExactSizeIterator<Item = [u8; 2]>,
) -> Result<&[u8], WriteError> {
    let count = samples.len();
    if count == 0 || count > SAMPLES_MAX {
        return Err(WriteError::SampleCount { count });
    }
    let [kind, rest @ ..] = buffer;
    *kind = SAMPLES;
    let bytes = first_index.to_le_bytes().into_iter().chain(samples.flatten());
    for (to, from) in rest.iter_mut().zip(bytes) {
        *to = from;
    }
    buffer.get(..5 + 2 * count).ok_or(WriteError::TooLong)
}

fn parse_samples(rest: &[u8]) -> Option<Payload<'_>> {
    let (first_index, rest) = rest.split_first_chunk()?;
    match rest.as_chunks() {
        (samples @ [_, ..], []) => Some(Payload::Samples { first_index: u32::from_le_bytes(*first_index), samples }),
        _ => None,
    }
}

fn write_chunk<'b>(buffer: &'b mut [u8; PAYLOAD_MAX_LEN], number: u16, bytes: &[u8]) -> Result<&'b [u8], WriteError> {
    if number > CHUNK_NUMBER_MAX {
        return Err(WriteError::ChunkNumber { number });
    }
    if bytes.is_empty() || bytes.len() > CHUNK_LEN {
        return Err(WriteError::ChunkLength { len: bytes.len() });
    }
    let [high, low] = number.to_be_bytes();
    join(buffer, &[CHUNK | high, low], bytes)
}

fn write_postcard<'b, T: Serialize>(
    buffer: &'b mut [u8; PAYLOAD_MAX_LEN],
    kind: u8,
    message: &T,
) -> Result<&'b [u8], WriteError> {
    let [first, rest @ ..] = buffer;
    *first = kind;
    let len = postcard::to_slice(message, rest).map_err(|_| WriteError::TooLong)?.len();
    buffer.get(..=len).ok_or(WriteError::TooLong)
}

fn join<'b>(buffer: &'b mut [u8; PAYLOAD_MAX_LEN], head: &[u8], tail: &[u8]) -> Result<&'b [u8], WriteError> {
    let joined = buffer.get_mut(..head.len() + tail.len()).ok_or(WriteError::TooLong)?;
    for (to, from) in joined.iter_mut().zip(head.iter().chain(tail)) {
        *to = *from;
    }
    Ok(joined)
}

/// Reads the sequence number first, so that an unreadable command can still be refused by its number.
fn parse_request(bytes: &[u8]) -> Result<Request, ParseError> {
    let (sequence, command) =
        postcard::take_from_bytes::<u16>(bytes).map_err(|_| ParseError::Malformed { kind: REQUEST })?;
    let command = whole::<Command>(command).ok_or(ParseError::UnknownCommand { sequence })?;
    Ok(Request { sequence, command })
}

/// Deserializes a postcard value that must take up all of the bytes.
fn whole<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Option<T> {
    match postcard::take_from_bytes(bytes) {
        Ok((value, [])) => Some(value),
        _ => None,
    }
}
