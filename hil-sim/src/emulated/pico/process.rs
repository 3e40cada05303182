//! The emulator's process, and the messages to and from it.

use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::os::fd::AsFd;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use tempfile::NamedTempFile;

use super::protocol::Request;
use crate::emulated::image::NODE;
use crate::emulated::{EmulatorError, Image, harness};

/// Wall time allowed for an answer on a busy machine. A run takes milliseconds.
const WALL_TIMEOUT: Duration = Duration::from_mins(2);
/// Largest number of words in a valid message.
const WORDS_MAX: u32 = 1 << 24;
/// Largest number of bytes of the emulator's output in an error, from the end.
const ERRORS_MAX_LEN: u64 = 64 << 10;

/// A running emulator. Dropping this ends it.
#[derive(Debug)]
pub(super) struct Process {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    /// Standard error of the emulator, in a file, so that it never waits for a reader.
    errors: NamedTempFile,
}

impl Process {
    /// Starts the image.
    pub(super) fn start(image: &Image) -> Result<Self, EmulatorError> {
        let main = harness::find()?;
        let making = || EmulatorError::system("making a file for the emulator's output");
        let errors = NamedTempFile::new().map_err(making())?;
        let mut child = Command::new(NODE)
            .arg(main)
            .arg(image.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(errors.as_file().try_clone().map_err(making())?)
            .spawn()
            .map_err(EmulatorError::system("starting the emulator"))?;
        let (Some(to), Some(from)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(EmulatorError::ended("it has no pipes"));
        };
        Ok(Self { child, to, from: BufReader::new(from), errors })
    }

    /// Sends a request, and waits for the answer to it.
    pub(super) fn request(&mut self, request: Request, values: &[u32]) -> Result<Vec<u32>, EmulatorError> {
        let head = [values.len() as u32 + 1, request as u32];
        let bytes: Vec<u8> = head.iter().chain(values).flat_map(|word| word.to_le_bytes()).collect();
        if self.to.write_all(&bytes).is_err() {
            return Err(self.ended());
        }
        let count = self.words(1)?.first().copied().filter(|count| *count <= WORDS_MAX).ok_or_else(|| self.ended())?;
        self.words(count as usize)
    }

    fn words(&mut self, count: usize) -> Result<Vec<u32>, EmulatorError> {
        let mut bytes = vec![0; 4 * count];
        let mut missing = &mut bytes[..];
        while !missing.is_empty() {
            if self.from.buffer().is_empty() {
                self.wait()?;
            }
            match self.from.read(missing) {
                Ok(len) if len > 0 => missing = &mut missing[len..],
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                _ => return Err(self.ended()),
            }
        }
        Ok(bytes.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect())
    }

    /// Waits for bytes of an answer.
    fn wait(&self) -> Result<(), EmulatorError> {
        let timeout = Timespec { tv_sec: WALL_TIMEOUT.as_secs() as i64, tv_nsec: 0 };
        let mut ready = [PollFd::from_borrowed_fd(self.from.get_ref().as_fd(), PollFlags::IN)];
        match poll(&mut ready, Some(&timeout)) {
            Ok(0) => Err(EmulatorError::Silent { what: "the answer to a request", seconds: WALL_TIMEOUT.as_secs() }),
            Ok(_) => Ok(()),
            Err(error) => Err(EmulatorError::system("waiting for the emulator")(error.into())),
        }
    }

    /// The error that ended the emulator.
    fn ended(&mut self) -> EmulatorError {
        // It has reported the reason before closing its output. After an invalid answer it still runs, and would block.
        let _ = self.child.kill();
        let _ = self.child.wait();
        match self.last_errors() {
            Ok(output) => EmulatorError::ended(output),
            Err(error) => EmulatorError::system("reading the emulator's output")(error),
        }
    }

    /// The end of its output on standard error.
    fn last_errors(&self) -> io::Result<String> {
        let mut file = File::open(self.errors.path())?;
        let len = file.metadata()?.len();
        file.seek(SeekFrom::Start(len.saturating_sub(ERRORS_MAX_LEN)))?;
        let mut bytes = Vec::new();
        file.take(ERRORS_MAX_LEN).read_to_end(&mut bytes)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
