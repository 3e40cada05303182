//! A virtual board behind a pseudo-terminal, paced by the wall clock.

use frixel_play::GoesOn;
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Result, anyhow};
use frixel_hil_sim::{PseudoTerminal, Rig};

use super::pace::{Dropped, Pace};
use super::server_log::ServerLog;
use frixel_files::Inputs;

/// Time that the server sleeps between two readings of the clock.
const CLOCK_PERIOD: Duration = Duration::from_millis(1);
/// Largest number of reads of 4 KiB between two batches of ticks. It is more than a terminal buffers, and bounds the
/// loop when a client writes as fast as the server reads.
const READS_MAX: usize = 16;

/// A virtual board on a pseudo-terminal.
pub struct Server {
    terminal: PseudoTerminal,
    /// Bytes that the terminal had no room for because the client does not read.
    unwritten: Vec<u8>,
    log: ServerLog,
}

impl Server {
    /// Creates `felt.csv`, with a row every `ticks_per_row` ticks, `forces.csv` and `events.csv` in `folder`, where
    /// they overwrite none of the inputs; then creates the pseudo-terminal.
    pub fn open(folder: &Path, inputs: &Inputs, tick_hz: u32, ticks_per_row: u32) -> Result<Self> {
        let log = ServerLog::create(folder, inputs, tick_hz, ticks_per_row)?;
        let terminal = PseudoTerminal::open().map_err(|error| {
            anyhow!("no pseudo-terminal for the virtual board: {error}; this needs a Unix system with /dev/pts")
        })?;
        Ok(Self { terminal, unwritten: Vec::new(), log })
    }

    /// Path of the terminal that a client opens.
    pub fn path(&self) -> &str {
        self.terminal.path()
    }

    /// Runs `rig` at the pace of the wall clock until `goes_on` breaks. The finger starts its stroke at once.
    /// Ticks and events are written to the files. Returns the time that was dropped, because the server was too far
    /// behind the wall clock to catch up.
    pub fn run(mut self, rig: &mut Rig, goes_on: GoesOn<'_>) -> Result<Dropped> {
        let tick_period_s = 1.0 / f64::from(rig.tick_hz());
        rig.world_mut().start_stroke();
        let (begin, mut pace) = (Instant::now(), Pace::default());
        while goes_on().is_continue() {
            self.exchange(rig)
                .map_err(|error| anyhow!("the virtual board's pseudo-terminal {} broke: {error}", self.path()))?;
            let virtual_s = rig.tick() as f64 * tick_period_s;
            let batch = pace.next(begin.elapsed().as_secs_f64(), virtual_s);
            if batch.dropped_s > 0.0 {
                self.log.note_dropped(virtual_s, batch.dropped_s)?;
            }
            for _ in 0..(batch.virtual_s / tick_period_s) as u32 {
                let record = rig.step();
                self.log.take(&record, rig)?;
            }
            std::thread::sleep(CLOCK_PERIOD);
        }
        self.log.flush()?;
        Ok(pace.dropped())
    }

    /// Transfers bytes between client and board.
    ///
    /// Reads all bytes that the client has written, and lets the rig drop bytes beyond its credit: bytes left in the
    /// terminal would reach the board after the client has gone. A client that does not read blocks the board's line,
    /// but not the board.
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
