//! Frames: payload and CRC-32, COBS-encoded, with a zero byte at the end.
//!
//! ```
//! use frixel_wire::frame::{Decoder, FRAME_MAX_LEN, encode};
//!
//! let mut frame = [0; FRAME_MAX_LEN];
//! let sent = encode(b"hello", &mut frame)?;
//!
//! let mut decoder = Decoder::new();
//! let mut input = sent;
//! assert_eq!(decoder.next_frame(&mut input), Some(&b"hello"[..]));
//! # Ok::<(), frixel_wire::frame::PayloadLengthError>(())
//! ```

use core::fmt;

use cobs::{CobsEncoder, DecodeResult, DecoderState};
use crc::{CRC_32_ISO_HDLC, Crc, Digest, NoTable};

use crate::payload::PAYLOAD_MAX_LEN;

/// Largest frame in bytes, including the zero byte.
pub const FRAME_MAX_LEN: usize = 192;

/// Bytes of the CRC-32.
const CRC_LEN: usize = 4;
/// Largest frame after COBS decoding, in bytes: payload and CRC.
const DECODED_MAX_LEN: usize = PAYLOAD_MAX_LEN + CRC_LEN;

const _: () = assert!(cobs::max_encoding_length(DECODED_MAX_LEN) + 1 == FRAME_MAX_LEN);

/// Computed bit by bit, without a table of 1 KiB: about 40 instructions per byte, or 5 % of a board's processor time at
/// 2 Mbaud.
static CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// CRC-32/ISO-HDLC: the CRC of Ethernet, zlib and PNG.
pub fn crc32(bytes: &[u8]) -> u32 {
    CRC.checksum(bytes)
}

/// [`crc32`] of bytes that arrive in pieces.
///
/// ```
/// use frixel_wire::frame::{Crc32, crc32};
/// assert_eq!(Crc32::new().update(b"1234").update(b"56789").finish(), crc32(b"123456789"));
/// ```
#[derive(Clone)]
pub struct Crc32(Digest<'static, u32, NoTable>);

impl Crc32 {
    /// Creates the CRC-32 of an empty byte string.
    #[must_use]
    pub const fn new() -> Self {
        Self(CRC.digest())
    }

    /// Appends bytes.
    pub fn update(&mut self, bytes: &[u8]) -> &mut Self {
        self.0.update(bytes);
        self
    }

    /// The CRC-32 of all bytes appended so far.
    pub fn finish(&self) -> u32 {
        self.0.clone().finalize()
    }
}

impl Default for Crc32 {
    fn default() -> Self {
        Self::new()
    }
}

impl fmt::Debug for Crc32 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Crc32({:#010x})", self.finish())
    }
}

/// The payload is empty, or longer than [`PAYLOAD_MAX_LEN`] bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PayloadLengthError {
    /// Bytes of the payload.
    pub len: usize,
}

impl fmt::Display for PayloadLengthError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the payload has {} bytes, but a frame holds 1 to {PAYLOAD_MAX_LEN}: split a longer one", self.len)
    }
}

impl core::error::Error for PayloadLengthError {}

/// Encodes a payload as a frame and returns the frame's bytes, including the zero byte.
pub fn encode<'f>(payload: &[u8], frame: &'f mut [u8; FRAME_MAX_LEN]) -> Result<&'f [u8], PayloadLengthError> {
    let wrong_length = PayloadLengthError { len: payload.len() };
    if !(1..=PAYLOAD_MAX_LEN).contains(&payload.len()) {
        return Err(wrong_length);
    }
    let mut encoder = CobsEncoder::new(frame.as_mut_slice());
    encoder.push(payload).map_err(|_| wrong_length)?;
    encoder.push(&crc32(payload).to_le_bytes()).map_err(|_| wrong_length)?;
    let len = encoder.finalize();
    *frame.get_mut(len).ok_or(wrong_length)? = 0;
    frame.get(..=len).ok_or(wrong_length)
}

/// Finds valid frames in a stream of bytes.
///
/// A frame extends from one zero byte to the next. The decoder drops and counts a frame that is not valid COBS, has a
/// wrong CRC, or is too short or too long; the next frame starts after the next zero byte. Consecutive zero bytes are
/// not an error.
#[derive(Debug)]
pub struct Decoder {
    decoded: [u8; DECODED_MAX_LEN],
    len: usize,
    cobs: DecoderState,
    overlong: bool,
    frames: u32,
    rejected: u32,
}

impl Decoder {
    /// Creates a decoder that treats the first byte as the start of a frame.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            decoded: [0; DECODED_MAX_LEN],
            len: 0,
            cobs: DecoderState::Idle,
            overlong: false,
            frames: 0,
            rejected: 0,
        }
    }

    /// Number of valid frames so far, modulo 2^32.
    pub const fn frames(&self) -> u32 {
        self.frames
    }

    /// Number of dropped frames so far, modulo 2^32.
    pub const fn rejected(&self) -> u32 {
        self.rejected
    }

    /// Decodes one byte; returns the payload if the byte ends a valid frame.
    pub fn push(&mut self, byte: u8) -> Option<&[u8]> {
        if self.take(byte) { self.decoded.get(..self.len) } else { None }
    }

    /// Consumes bytes from the front of `input` up to the end of the next valid frame and returns its payload; returns
    /// `None` when `input` is empty.
    pub fn next_frame(&mut self, input: &mut &[u8]) -> Option<&[u8]> {
        while let Some((&byte, rest)) = input.split_first() {
            *input = rest;
            if self.take(byte) {
                return self.decoded.get(..self.len);
            }
        }
        None
    }

    /// Decodes one byte; returns whether it ends a valid frame. The frame's payload is the first `len` bytes of
    /// `decoded`.
    fn take(&mut self, byte: u8) -> bool {
        if byte != 0 {
            self.take_inside(byte);
            return false;
        }
        if matches!(self.cobs, DecoderState::Idle) {
            return false;
        }
        let cobs_complete = matches!(self.cobs.feed(0), Ok(DecodeResult::DataComplete));
        let good = cobs_complete && !self.overlong && self.strip_crc();
        if good {
            self.frames = self.frames.wrapping_add(1);
        } else {
            self.rejected = self.rejected.wrapping_add(1);
        }
        good
    }

    fn take_inside(&mut self, byte: u8) {
        if matches!(self.cobs, DecoderState::Idle) {
            self.len = 0;
            self.overlong = false;
        }
        if let Ok(DecodeResult::DataContinue(data)) = self.cobs.feed(byte) {
            match self.decoded.get_mut(self.len) {
                Some(place) => {
                    *place = data;
                    self.len += 1;
                }
                None => self.overlong = true,
            }
        }
    }

    /// Removes the CRC after the payload; returns whether the CRC is correct. An empty payload is refused: its CRC is
    /// zero, so a single flipped bit would turn any five zeros in a row into its frame.
    fn strip_crc(&mut self) -> bool {
        let decoded = self.decoded.get(..self.len).unwrap_or_default();
        let Some((payload, crc)) = decoded.split_last_chunk::<CRC_LEN>() else { return false };
        self.len = payload.len();
        !payload.is_empty() && crc32(payload) == u32::from_le_bytes(*crc)
    }
}

impl Default for Decoder {
    fn default() -> Self {
        Self::new()
    }
}
