//! Access to little-endian fields at given offsets of fixed layouts.
//!
//! With a constant offset, a field outside the layout is a compile error. With a runtime offset, such a field reads as
//! zeros, and writing it has no effect.

/// The `N` bytes at `AT`.
pub fn get<const AT: usize, const N: usize, const LEN: usize>(bytes: &[u8; LEN]) -> [u8; N] {
    const { assert!(AT + N <= LEN, "the field lies outside the layout") };
    bytes.get(AT..).and_then(<[u8]>::first_chunk).copied().unwrap_or([0; N])
}

/// Writes `N` bytes at `AT`.
pub fn put<const AT: usize, const N: usize, const LEN: usize>(bytes: &mut [u8; LEN], field: [u8; N]) {
    const { assert!(AT + N <= LEN, "the field lies outside the layout") };
    if let Some(place) = bytes.get_mut(AT..).and_then(<[u8]>::first_chunk_mut) {
        *place = field;
    }
}

/// The `N` bytes at an offset; zeros if they are not entirely inside the layout.
pub fn get_at<const N: usize, const LEN: usize>(bytes: &[u8; LEN], offset: usize) -> [u8; N] {
    bytes.get(offset..).and_then(<[u8]>::first_chunk).copied().unwrap_or([0; N])
}

/// Writes `N` bytes at an offset; does nothing if they are not entirely inside the layout.
pub fn put_at<const N: usize, const LEN: usize>(bytes: &mut [u8; LEN], offset: usize, field: [u8; N]) {
    if let Some(place) = bytes.get_mut(offset..).and_then(<[u8]>::first_chunk_mut) {
        *place = field;
    }
}

/// Offset of the first byte in which `found` and `canonical` differ.
pub fn first_difference<const LEN: usize>(found: &[u8; LEN], canonical: &[u8; LEN]) -> Option<u8> {
    found.iter().zip(canonical).position(|(a, b)| a != b).map(|offset| offset as u8)
}

/// The little-endian `u32` at `AT`.
pub fn get_u32<const AT: usize, const LEN: usize>(bytes: &[u8; LEN]) -> u32 {
    u32::from_le_bytes(get::<AT, 4, LEN>(bytes))
}

/// Writes a little-endian `u32` at `AT`.
pub fn put_u32<const AT: usize, const LEN: usize>(bytes: &mut [u8; LEN], field: u32) {
    put::<AT, 4, LEN>(bytes, field.to_le_bytes());
}

/// The little-endian `u16` at `AT`.
pub fn get_u16<const AT: usize, const LEN: usize>(bytes: &[u8; LEN]) -> u16 {
    u16::from_le_bytes(get::<AT, 2, LEN>(bytes))
}

/// Writes a little-endian `u16` at `AT`.
pub fn put_u16<const AT: usize, const LEN: usize>(bytes: &mut [u8; LEN], field: u16) {
    put::<AT, 2, LEN>(bytes, field.to_le_bytes());
}

/// The byte at `AT`.
pub fn get_u8<const AT: usize, const LEN: usize>(bytes: &[u8; LEN]) -> u8 {
    let [byte] = get::<AT, 1, LEN>(bytes);
    byte
}

/// Writes a byte at `AT`.
pub fn put_u8<const AT: usize, const LEN: usize>(bytes: &mut [u8; LEN], field: u8) {
    put::<AT, 1, LEN>(bytes, [field]);
}
