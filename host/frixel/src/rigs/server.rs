//! A virtual board behind a pseudo-terminal, paced by the wall clock.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use frixel_hil_sim::{PseudoTerminal, Rig};
use thiserror::Error;

use super::server_log::ServerLog;
use crate::output_file::{Inputs, OutputFileError};

/// Time that the server sleeps between two readings of the clock.
const NAP: Duration = Duration::from_millis(1);
/// Most virtual time between two reads of the terminal, and so the largest delay of a client's bytes.
const BATCH_MAX_S: f64 = 5e-3;
/// Most reads of 4 KiB between two batches of ticks. This is more than a terminal buffers, and bounds the loop when a
/// client writes as fast as the server reads.
const READS_MAX: usize = 16;
/// Largest lag of virtual time behind the wall clock, for example on a busy machine. The server does not catch up on a
/// lag beyond that.
const LAG_MAX_S: f64 = 50e-3;

/// Why a virtual board stopped.
#[derive(Debug, Error)]
pub enum ServerError {
    /// The pseudo-terminal could not be created.
    #[error("no pseudo-terminal for the virtual board: {0}; this needs a Unix system with /dev/pts")]
    Terminal(#[from] io::Error),
    /// Reading or writing the pseudo-terminal failed.
    #[error("the virtual board's pseudo-terminal {path} broke: {source}")]
    Line {
        /// Path of the terminal.
        path: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A file could not be written.
    #[error(transparent)]
    Output(#[from] OutputFileError),
}

/// A virtual board on a pseudo-terminal.
pub struct Server {
    terminal: PseudoTerminal,
    /// Bytes that the terminal had no room for because the client does not read.
    unwritten: Vec<u8>,
    log: ServerLog,
}

impl Server {
    /// Creates `felt.csv`, with a row every `ticks_per_row` ticks, `forces.csv` and `events.csv` in `folder`, where they
    /// overwrite none of the inputs; then creates the pseudo-terminal.
    pub fn open(folder: &Path, inputs: &Inputs, tick_hz: u32, ticks_per_row: u32) -> Result<Self, ServerError> {
        let log = ServerLog::create(folder, inputs, tick_hz, ticks_per_row)?;
        Ok(Self { terminal: PseudoTerminal::open()?, unwritten: Vec::new(), log })
    }

    /// Path of the terminal that a client opens.
    pub fn path(&self) -> &str {
        self.terminal.path()
    }

    /// Runs `rig` at the pace of the wall clock until `interrupted` returns true. The finger starts its stroke at once.
    /// Ticks and events are written to the files.
    pub fn run(mut self, rig: &mut Rig, interrupted: &dyn Fn() -> bool) -> Result<(), ServerError> {
        let tick_period_s = 1.0 / f64::from(rig.tick_hz());
        rig.world_mut().start_stroke();
        let mut epoch = Instant::now();
        while !interrupted() {
            self.exchange(rig).map_err(|source| ServerError::Line { path: self.path().to_owned(), source })?;
            let mut behind_s = epoch.elapsed().as_secs_f64() - rig.tick() as f64 * tick_period_s;
            if behind_s > LAG_MAX_S {
                epoch += Duration::from_secs_f64(behind_s - BATCH_MAX_S);
                behind_s = BATCH_MAX_S;
            }
            for _ in 0..(behind_s.min(BATCH_MAX_S) / tick_period_s) as u32 {
                let record = rig.step();
                self.log.take(&record, rig)?;
            }
            std::thread::sleep(NAP);
        }
        Ok(self.log.flush()?)
    }

    /// Transfers bytes between client and board.
    ///
    /// Reads all that the client has written, and lets the rig drop bytes beyond its credit: bytes left in the terminal
    /// would reach the board after the client has gone. A client that does not read blocks the board's line, but not
    /// the board.
    fn exchange(&mut self, rig: &mut Rig) -> io::Result<()> {
        if self.terminal.client_has_gone()? {
            self.unwritten.clear();
        }
        let mut bytes = [0; 4096];
        for _ in 0..READS_MAX {
            let count = self.terminal.read(&mut bytes)?;
            if count == 0 {
                break;
            }
            rig.send(bytes.get(..count).unwrap_or_default());
        }
        rig.receive(&mut self.unwritten);
        let written = self.terminal.write(&self.unwritten)?;
        self.unwritten.drain(..written);
        rig.set_host_away(!self.unwritten.is_empty());
        Ok(())
    }
}
