//! The first byte of a frame's payload says what the rest is.
//!
//! | first byte | from | rest |
//! |---|---|---|
//! | `0x00` | host | hello request: protocol major, protocol minor |
//! | `0x01` | board | [`crate::hello::Hello`] |
//! | `0x02` | host | [`crate::message::Request`] in postcard |
//! | `0x03` | board | [`crate::message::FromBoard`] in postcard |
//! | `0x80..=0xff` | host | upload chunk: the chunk's number in 15 bits, big-endian, whose top bit is this byte's; then at most [`CHUNK_LEN`] bytes |

/// Largest payload of a frame in bytes, first byte included: 192 less zero byte, COBS overhead byte and CRC-32.
pub const PAYLOAD_MAX_LEN: usize = 186;

/// Bytes that every chunk of an upload carries, but for the last, which may be shorter.
pub const CHUNK_LEN: usize = PAYLOAD_MAX_LEN - 2;
