//! A virtual board behind a pseudo-terminal, paced by the wall clock.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::time::{Duration, Instant};

use frixel_hil_sim::Rig;
use rustix::fs::OFlags;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
use thiserror::Error;

use super::server_log::ServerLog;
use crate::output::OutputError;

/// How long the server sleeps between two looks at the clock.
const NAP: Duration = Duration::from_millis(1);
/// Most virtual time between two looks at the terminal, so that what a client sends meanwhile is not late.
const BATCH_MAX_S: f64 = 5e-3;
/// When the wall clock is this far ahead, the machine was busy elsewhere: virtual time lets it go.
const LAG_MAX_S: f64 = 50e-3;
/// A client that was silent for this long is gone, or idle; pings come several times as often.
const CLIENT_GONE_AFTER: Duration = Duration::from_millis(500);

/// Why a virtual board ended.
#[derive(Debug, Error)]
pub enum ServerError {
    /// No pseudo-terminal could be made.
    #[error("no pseudo-terminal for the virtual board: {0}; this needs a Unix system with /dev/pts")]
    Terminal(#[from] io::Error),
    /// The pseudo-terminal broke.
    #[error("the virtual board's pseudo-terminal {path} broke: {source}")]
    Line {
        /// Path of the terminal.
        path: String,
        /// What the system says.
        source: io::Error,
    },
    /// A file could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// A virtual board on a pseudo-terminal.
pub struct Server {
    /// Never blocks: a client that does not read must not stop the board.
    board_end: File,
    /// Held open, so that clients may come and go.
    client_end: File,
    path: String,
    heard_at: Instant,
    log: ServerLog,
}

impl Server {
    /// Creates `felt.csv`, with a row every `ticks_per_row` ticks, and `events.csv` in `folder`; then makes the
    /// pseudo-terminal.
    pub fn open(folder: &Path, tick_hz: u32, ticks_per_row: u32) -> Result<Self, ServerError> {
        let log = ServerLog::create(folder, tick_hz, ticks_per_row)?;
        let (board_end, path) = open_board_end()?;
        let client_end = open_client_end(&path).map_err(|source| ServerError::Line { path: path.clone(), source })?;
        Ok(Self { board_end, client_end, path, heard_at: Instant::now(), log })
    }

    /// What a client opens.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Runs `rig` at the pace of the wall clock until `interrupted`, with the finger on its stroke from the start, and
    /// writes down what happens.
    pub fn run(mut self, rig: &mut Rig, interrupted: &dyn Fn() -> bool) -> Result<(), ServerError> {
        let tick_period_s = 1.0 / f64::from(rig.tick_hz());
        rig.world_mut().start_stroke();
        let mut epoch = Instant::now();
        let mut bytes = Vec::new();
        while !interrupted() {
            self.receive(rig)?;
            let mut behind_s = epoch.elapsed().as_secs_f64() - rig.tick() as f64 * tick_period_s;
            if behind_s > LAG_MAX_S {
                epoch += Duration::from_secs_f64(behind_s - BATCH_MAX_S);
                behind_s = BATCH_MAX_S;
            }
            for _ in 0..(behind_s.min(BATCH_MAX_S) / tick_period_s) as u32 {
                let record = rig.step();
                self.log.take(&record, rig)?;
            }
            rig.receive(&mut bytes);
            self.transmit(&mut bytes)?;
            self.let_the_next_client_in();
            std::thread::sleep(NAP);
        }
        Ok(self.log.flush()?)
    }

    fn receive(&mut self, rig: &mut Rig) -> Result<(), ServerError> {
        let mut bytes = [0; 4096];
        match self.board_end.read(&mut bytes) {
            Ok(count) => {
                rig.send(&bytes[..count]);
                self.heard_at = Instant::now();
                Ok(())
            }
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => Ok(()),
            Err(error) => Err(self.broken(error)),
        }
    }

    /// Bytes that nobody reads are lost, as on a real line; they must not stop the board. What fits is written, and the
    /// rest dropped.
    fn transmit(&mut self, bytes: &mut Vec<u8>) -> Result<(), ServerError> {
        if bytes.is_empty() {
            return Ok(());
        }
        match self.board_end.write(bytes) {
            Ok(_) => {}
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
            Err(error) => return Err(self.broken(error)),
        }
        bytes.clear();
        Ok(())
    }

    /// A client that was killed leaves the terminal in exclusive mode, which lasts for as long as anybody holds it open.
    fn let_the_next_client_in(&mut self) {
        if self.heard_at.elapsed() > CLIENT_GONE_AFTER {
            self.heard_at = Instant::now();
            // Should it fail, the next client is told that the port is busy.
            let _ = rustix::termios::ioctl_tiocnxcl(&self.client_end);
        }
    }

    fn broken(&self, source: io::Error) -> ServerError {
        ServerError::Line { path: self.path.clone(), source }
    }
}

/// The end of a new pseudo-terminal that the board has, and the path of the other.
fn open_board_end() -> io::Result<(File, String)> {
    let board_end = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY)?;
    grantpt(&board_end)?;
    unlockpt(&board_end)?;
    let flags = rustix::fs::fcntl_getfl(&board_end)?;
    rustix::fs::fcntl_setfl(&board_end, flags | OFlags::NONBLOCK)?;
    let path = ptsname(&board_end, Vec::new())?;
    Ok((File::from(board_end), path.to_string_lossy().into_owned()))
}

/// Opens the other end and makes it raw: bytes go through as they are.
fn open_client_end(path: &str) -> io::Result<File> {
    let client_end = OpenOptions::new().read(true).write(true).custom_flags(OFlags::NOCTTY.bits() as i32).open(path)?;
    let mut settings = tcgetattr(&client_end)?;
    settings.make_raw();
    tcsetattr(&client_end, OptionalActions::Now, &settings)?;
    Ok(client_end)
}

#[cfg(test)]
mod tests;
