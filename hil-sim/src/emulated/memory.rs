//! The memory that board and simulator share: a file that the emulator maps, and the simulator reads and writes. On
//! Linux both go through the same pages, so each sees what the other writes.

use std::fs::{File, OpenOptions};
use std::os::unix::fs::FileExt;
use std::path::Path;

use frixel_exchange::layout::SHARED_LEN;

use super::EmulatorError;

/// Words shared with the board.
#[derive(Debug)]
pub(super) struct Memory(File);

impl Memory {
    /// Memory full of zeros, in a new file.
    pub(super) fn new(path: &Path) -> Result<Self, EmulatorError> {
        let making = || EmulatorError::system("making the shared memory");
        let file = OpenOptions::new().read(true).write(true).create_new(true).open(path).map_err(making())?;
        file.set_len(SHARED_LEN as u64).map_err(making())?;
        Ok(Self(file))
    }

    /// The same memory, for another thread.
    pub(super) fn try_clone(&self) -> Result<Self, EmulatorError> {
        self.0.try_clone().map(Self).map_err(EmulatorError::system("sharing the shared memory"))
    }

    /// A word.
    pub(super) fn get(&self, word: usize) -> Result<u32, EmulatorError> {
        let mut bytes = [0; 4];
        self.read(word, &mut bytes)?;
        Ok(u32::from_le_bytes(bytes))
    }

    /// Sets a word.
    pub(super) fn set(&self, word: usize, value: u32) -> Result<(), EmulatorError> {
        self.set_all(word, &[value])
    }

    /// Returns `count` words from `word` on.
    pub(super) fn get_all(&self, word: usize, count: usize) -> Result<Vec<u32>, EmulatorError> {
        let mut bytes = vec![0; 4 * count];
        self.read(word, &mut bytes)?;
        Ok(bytes.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect())
    }

    /// Sets words from `word` on.
    pub(super) fn set_all(&self, word: usize, values: &[u32]) -> Result<(), EmulatorError> {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.0.write_all_at(&bytes, 4 * word as u64).map_err(EmulatorError::system("writing shared memory"))
    }

    fn read(&self, word: usize, bytes: &mut [u8]) -> Result<(), EmulatorError> {
        self.0.read_exact_at(bytes, 4 * word as u64).map_err(EmulatorError::system("reading shared memory"))
    }
}
