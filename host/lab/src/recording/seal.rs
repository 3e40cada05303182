//! The hash of a recording's file: the SHA-256 of all of its bytes, with zeros in place of its own digits. A growing
//! file has a hash in each footer, over everything before it.

use std::io::{self, Write};

use sha2::{Digest, Sha256};

use crate::hash::hex;

/// Key of the hash in the metadata, where it stands last.
pub(super) const KEY: &str = "frixel.sha256";
/// The digits before the hash is known.
pub(super) const UNKNOWN: &str = "0000000000000000000000000000000000000000000000000000000000000000";
/// Thrift's bytes between the key and the digits: a field of 64 bytes.
const BETWEEN: [u8; 2] = [0x18, 64];

/// A writer that hashes what goes through it.
pub(super) struct Hashed<W> {
    pub(super) to: W,
    hash: Sha256,
}

impl<W> Hashed<W> {
    pub(super) fn new(to: W) -> Self {
        Self { to, hash: Sha256::new() }
    }

    /// Writes the hash into the footer that follows the bytes so far.
    pub(super) fn seal(&self, footer: &mut [u8]) {
        let digits = hex(&self.hash.clone().chain_update(&*footer).finalize());
        if let Some(place) = place(footer).and_then(|at| footer.get_mut(at..at + UNKNOWN.len())) {
            place.copy_from_slice(digits.as_bytes());
        }
    }
}

impl<W: Write> Write for Hashed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let len = self.to.write(bytes)?;
        self.hash.update(bytes.get(..len).unwrap_or(bytes));
        Ok(len)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

/// Whether a file whose footer begins here has the hash of its bytes.
pub(super) fn is_whole(bytes: &[u8], footer: usize) -> bool {
    let Some(at) = bytes.get(footer..).and_then(place).map(|at| footer + at) else { return false };
    let end = at + UNKNOWN.len();
    let (Some(before), Some(digits), Some(after)) = (bytes.get(..at), bytes.get(at..end), bytes.get(end..)) else {
        return false;
    };
    let hash = Sha256::new().chain_update(before).chain_update(UNKNOWN).chain_update(after);
    hex(&hash.finalize()).as_bytes() == digits
}

/// Where the digits begin in a footer.
fn place(footer: &[u8]) -> Option<usize> {
    let head = [KEY.as_bytes(), &BETWEEN].concat();
    footer.windows(head.len()).rposition(|part| part == head).map(|at| at + head.len())
}

/// The bytes of a changed file, whose footer begins here, with the hash that they have now.
#[cfg(test)]
pub(super) fn sealed(mut bytes: Vec<u8>, footer: usize) -> Vec<u8> {
    let mut hashed = Hashed::new(io::sink());
    hashed.write_all(&bytes[..footer]).unwrap();
    let footer = &mut bytes[footer..];
    let at = place(footer).unwrap();
    footer[at..at + UNKNOWN.len()].copy_from_slice(UNKNOWN.as_bytes());
    hashed.seal(footer);
    bytes
}
