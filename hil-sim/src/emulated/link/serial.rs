//! The host's end of the emulator's serial port.

use std::fs::{File, OpenOptions};
use std::io::Write;
use std::os::unix::fs::OpenOptionsExt;

use rustix::fs::OFlags;

use crate::emulated::EmulatorError;

/// The host's end of the pseudo-terminal. It is held open because the emulator checks only once a second whether a
/// client has opened it.
pub(super) struct Serial(File);

impl Serial {
    pub(super) fn open(path: &str) -> Result<Self, EmulatorError> {
        OpenOptions::new()
            .read(true)
            .write(true)
            .custom_flags(OFlags::NOCTTY.bits() as i32)
            .open(path)
            .map(Self)
            .map_err(EmulatorError::system("opening the emulator's serial port"))
    }

    /// Writes a single zero byte, which a board ignores.
    pub(super) fn write_zero(&self) -> Result<(), EmulatorError> {
        (&self.0).write_all(&[0]).map_err(EmulatorError::system("writing to the emulator's serial port"))
    }

    /// Ends exclusive mode, so that the next host can open the port. A host may have opened it exclusively, which
    /// lasts as long as any process has it open.
    pub(super) fn accept_next_host(&self) -> Result<(), EmulatorError> {
        let refused =
            |error: rustix::io::Errno| EmulatorError::system("freeing the emulator's serial port")(error.into());
        rustix::termios::ioctl_tiocnxcl(&self.0).map_err(refused)
    }
}
