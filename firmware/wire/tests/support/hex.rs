//! Bytes as text.

use std::fmt::Write;

/// `01 02 ff`.
pub fn to_hex(bytes: &[u8]) -> String {
    let mut text = String::new();
    for byte in bytes {
        let space = if text.is_empty() { "" } else { " " };
        write!(text, "{space}{byte:02x}").unwrap();
    }
    text
}

/// Bytes written as `01 02 ff`.
pub fn from_hex(text: &str) -> Vec<u8> {
    text.split_whitespace().map(|byte| u8::from_str_radix(byte, 16).expect(byte)).collect()
}
