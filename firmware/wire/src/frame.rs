//! Frames: COBS, CRC-32, a zero byte between.

/// Largest frame in bytes, zero byte included.
pub const FRAME_MAX_LEN: usize = 192;
