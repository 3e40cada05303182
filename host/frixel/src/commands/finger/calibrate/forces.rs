//! The forces of a sensor: from a file, or from standard input while the board plays.

use std::io::{self, BufReader, Read, Write, stdin};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::commands::error::{at, reading};
use crate::input::{self, Bounded};
use anyhow::Result;
use frixel_files::{FileWriter, Inputs, OutputFile};
use frixel_lab::calibration::{ForceRow, read_forces};
use frixel_lab::table::Reading;

use super::CalibrateArgs;
use crate::commands::terminal::note_understood;

/// The copy of the forces that come on standard input: `DATA.csv.forces.partial`.
pub(super) fn copy(args: &CalibrateArgs) -> Result<OutputFile> {
    let mut path = args.output.clone().into_os_string();
    path.push(".forces");
    Ok(OutputFile::recording(path.as_ref(), "-o", &Inputs::new(&args.forces), true)?)
}

/// Standard input, read while the board plays so that its writer does not block.
pub(super) struct StandardInput {
    reader: JoinHandle<io::Result<()>>,
    bytes: Arc<Mutex<Vec<u8>>>,
}

impl StandardInput {
    /// Starts to read, and to write a copy.
    pub(super) fn read(copy: Option<FileWriter>) -> Self {
        Self::read_from(Bounded::new(stdin(), input::CSV_MAX_BYTES), copy)
    }

    fn read_from(mut input: Bounded<impl Read + Send + 'static>, mut copy: Option<FileWriter>) -> Self {
        let bytes = Arc::new(Mutex::new(Vec::new()));
        let shared = Arc::clone(&bytes);
        let reader = thread::spawn(move || {
            let mut chunk = [0; 4096];
            loop {
                let count = match input.read(&mut chunk) {
                    Ok(0) => return Ok(()),
                    Ok(count) => count,
                    Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                    Err(error) => return Err(error),
                };
                let chunk = chunk.get(..count).unwrap_or_default();
                // The copy is needed only if this process is cut off.
                let _ = copy.as_mut().map(|copy| copy.write_all(chunk).and_then(|()| copy.flush()));
                shared.lock().unwrap_or_else(PoisonError::into_inner).extend_from_slice(chunk);
            }
        });
        Self { reader, bytes }
    }

    /// Returns the bytes read until the input ends or `time_max` has passed: a sensor may go on measuring. Input beyond
    /// the size limit is an error, since its end would be missing.
    pub(super) fn after(self, time_max: Duration) -> io::Result<Vec<u8>> {
        let begun = Instant::now();
        while !self.reader.is_finished() && begun.elapsed() < time_max {
            thread::sleep(Duration::from_millis(5));
        }
        if self.reader.is_finished() {
            // A thread that panicked has printed its message.
            self.reader.join().unwrap_or(Ok(()))?;
        }
        Ok(std::mem::take(&mut self.bytes.lock().unwrap_or_else(PoisonError::into_inner)))
    }
}

/// Returns the rows of a reading, and prints a note on how they were interpreted.
pub(super) fn understood(path: &Path, forces: Reading<Vec<ForceRow>>) -> Vec<ForceRow> {
    note_understood(path, forces.understood.as_deref());
    forces.value
}

/// The forces in a file; `-` is standard input.
pub(super) fn read(path: &Path) -> Result<Vec<ForceRow>> {
    let rows = if path == Path::new("-") {
        read_forces(Bounded::new(stdin(), input::CSV_MAX_BYTES))
    } else {
        read_forces(BufReader::new(input::open(path, input::CSV_MAX_BYTES).map_err(reading(path))?))
    };
    let forces = rows.map_err(at(path.display()))?;
    Ok(understood(path, forces))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_beyond_the_limit_are_an_error() {
        let read = |len: usize| {
            let input = Bounded::new(io::repeat(b'7').take(len as u64), 10_000);
            StandardInput::read_from(input, None).after(Duration::from_mins(1))
        };
        assert_eq!(read(10_000).unwrap(), [b'7'; 10_000]);
        assert_eq!(read(10_001).unwrap_err().to_string(), "it is longer than 10000 bytes, the most that are read");
    }
}
