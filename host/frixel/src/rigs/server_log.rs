//! What a virtual board writes down while it runs: what the finger felt, and what happened.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use frixel_hil_sim::{Rig, TickRecord};
use frixel_wire::fault::{Flags, State};

use super::recorder::RowMaker;
use crate::output::{FeltCsv, OutputError};

/// Virtual time between two flushes, so that a killed server leaves all but the last moment.
const FLUSH_PERIOD_S: f64 = 0.1;

/// `felt.csv` and `events.csv` of a virtual board.
///
/// The second has the columns `t_s,event,last_frame_t_s`: every change of the supervisor's state by its name, and
/// `host-silent`; with the time at which the last whole frame of a host had arrived.
pub(super) struct ServerLog {
    felt: FeltCsv,
    events: BufWriter<File>,
    events_path: PathBuf,
    row_maker: RowMaker,
    tick_period_s: f64,
    ticks_per_flush: u64,
    frames: u32,
    last_frame_at_tick: u64,
    state: State,
    host_silent: bool,
}

impl ServerLog {
    pub(super) fn create(folder: &Path, tick_hz: u32, ticks_per_row: u32) -> Result<Self, OutputError> {
        std::fs::create_dir_all(folder).map_err(failed(folder))?;
        let path = folder.join("events.csv");
        let mut events = BufWriter::new(File::create(&path).map_err(failed(&path))?);
        writeln!(events, "t_s,event,last_frame_t_s").map_err(failed(&path))?;
        Ok(Self {
            felt: FeltCsv::create(&folder.join("felt.csv"))?,
            events,
            events_path: path,
            row_maker: RowMaker::new(tick_hz, ticks_per_row),
            tick_period_s: 1.0 / f64::from(tick_hz),
            ticks_per_flush: (FLUSH_PERIOD_S * f64::from(tick_hz)) as u64,
            frames: 0,
            last_frame_at_tick: 0,
            state: State::Disarmed,
            host_silent: false,
        })
    }

    /// Takes one tick of `rig`. What is wanted is not known here: the scene's file is the client's.
    pub(super) fn take(&mut self, record: &TickRecord, rig: &Rig) -> Result<(), OutputError> {
        let (frames, _) = rig.frame_counts();
        if frames != self.frames {
            self.frames = frames;
            self.last_frame_at_tick = record.tick;
        }
        let telemetry = &record.status.telemetry;
        if telemetry.state != self.state {
            self.state = telemetry.state;
            self.event(record.tick, name_of(telemetry.state))?;
        }
        let host_silent = telemetry.flags.contains(Flags::HOST_SILENT);
        if host_silent && !self.host_silent {
            self.event(record.tick, "host-silent")?;
        }
        self.host_silent = host_silent;
        if let Some(row) = self.row_maker.take(record, None) {
            self.felt.write(&row)?;
        }
        if record.tick.is_multiple_of(self.ticks_per_flush) { self.flush() } else { Ok(()) }
    }

    /// Writes out what is held back so far.
    pub(super) fn flush(&mut self) -> Result<(), OutputError> {
        self.felt.flush()?;
        self.events.flush().map_err(failed(&self.events_path))
    }

    fn event(&mut self, tick: u64, event: &str) -> Result<(), OutputError> {
        let seconds = |tick: u64| tick as f64 * self.tick_period_s;
        let (t_s, last_frame_t_s) = (seconds(tick), seconds(self.last_frame_at_tick));
        writeln!(self.events, "{t_s:.6},{event},{last_frame_t_s:.6}").map_err(failed(&self.events_path))
    }
}

fn failed(path: &Path) -> impl FnOnce(io::Error) -> OutputError {
    let path = path.to_owned();
    move |source| OutputError::File { path, source }
}

/// A word for a column, where a sentence would not do.
fn name_of(state: State) -> &'static str {
    match state {
        State::Disarmed => "disarmed",
        State::Armed => "armed",
        State::Active => "active",
        State::Faulted => "faulted",
    }
}
