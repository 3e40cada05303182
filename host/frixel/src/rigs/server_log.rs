//! The output files of a virtual board: felt friction, forces and events.

use std::path::Path;

use anyhow::Result;
use frixel_felt::recorder::{Observation, Recorder};
use frixel_hil_sim::{Rig, RigTick, Status};
use frixel_lab::calibration::ForceSensor;
use frixel_wire::fault::{Flags, State};

use crate::output::{EventCsv, EventRow, FeltCsv, ForcesCsv};
use frixel_files::{Inputs, OutputFile, OutputFolder};

/// The option that names the folder.
const OPTION: &str = "--out";
/// Virtual time between two flushes, which bounds the loss when the server is killed.
const FLUSH_PERIOD_S: f64 = 0.1;
/// Rows a second of the force sensor under the screen.
const FORCES_HZ: u32 = 1_000;

/// `felt.csv`, `forces.csv` and `events.csv` of a virtual board. The reference is unknown because only the client has
/// the scene file.
pub(super) struct ServerLog {
    _folder: OutputFolder,
    felt_csv: FeltCsv,
    forces_csv: ForcesCsv,
    sensor: ForceSensor,
    events_csv: EventCsv,
    recorder: Recorder,
    last: LastReport,
    tick_period_s: f64,
    ticks_per_flush: u64,
    frames: u32,
    last_frame_at_tick: u64,
}

impl ServerLog {
    /// Creates the three files in `folder`, where they overwrite none of the inputs. Creates the folder if necessary.
    pub(super) fn create(folder: &Path, inputs: &Inputs, tick_hz: u32, ticks_per_row: u32) -> Result<Self> {
        let output = |name: &str| OutputFile::new(&folder.join(name), OPTION, inputs);
        let locked = OutputFolder::open(folder)?;
        let [felt, forces, events] = [output("felt.csv")?, output("forces.csv")?, output("events.csv")?];
        let mut recorder = Recorder::without_reference(tick_hz, ticks_per_row);
        recorder.start(0);
        Ok(Self {
            _folder: locked,
            felt_csv: FeltCsv::new(felt.create_live()?)?,
            forces_csv: ForcesCsv::new(forces.create_live()?)?,
            sensor: ForceSensor::new(FORCES_HZ, tick_hz),
            events_csv: EventCsv::new(events.create_live()?)?,
            recorder,
            last: LastReport { state: State::Disarmed, is_host_silent: false },
            tick_period_s: 1.0 / f64::from(tick_hz),
            ticks_per_flush: (FLUSH_PERIOD_S * f64::from(tick_hz)) as u64,
            frames: 0,
            last_frame_at_tick: 0,
        })
    }

    /// Records one tick of `rig`.
    pub(super) fn take(&mut self, record: &RigTick<Status>, rig: &Rig) -> Result<()> {
        let (frames, _) = rig.frame_counts();
        if frames != self.frames {
            self.frames = frames;
            self.last_frame_at_tick = record.tick;
        }
        self.recorder.record(&Observation::of_tick(record.tick as u32, &record.felt, &record.status.telemetry));
        for row in self.recorder.take_rows() {
            self.felt_csv.write(&row)?;
        }
        self.sensor.measure(record.tick, &record.felt);
        for row in self.sensor.take_rows() {
            self.forces_csv.write(&row)?;
        }
        let status = &record.status;
        let t_s = record.tick as f64 * self.tick_period_s;
        for event in self.last.changes(status.telemetry.state, status.telemetry.flags) {
            self.note(t_s, event, None)?;
        }
        if record.tick.is_multiple_of(self.ticks_per_flush) { self.flush() } else { Ok(()) }
    }

    /// Writes the event that this board dropped time, after `t_s` seconds.
    pub(super) fn note_dropped(&mut self, t_s: f64, dropped_s: f64) -> Result<()> {
        self.note(t_s, "time-dropped", Some(dropped_s))
    }

    fn note(&mut self, t_s: f64, event: &'static str, dropped_s: Option<f64>) -> Result<()> {
        let last_frame_t_s = self.last_frame_at_tick as f64 * self.tick_period_s;
        self.events_csv.write(&EventRow { t_s, event, last_frame_t_s, dropped_s })
    }

    /// Writes the buffered rows to the files.
    pub(super) fn flush(&mut self) -> Result<()> {
        self.felt_csv.flush()?;
        self.forces_csv.flush()?;
        self.events_csv.flush()
    }
}

/// The last report of the board.
struct LastReport {
    state: State,
    is_host_silent: bool,
}

impl LastReport {
    /// The events between the last report and this one: the state that the board entered, and `host-silent` if its host
    /// has sent nothing for the scene's host timeout.
    fn changes(&mut self, state: State, flags: Flags) -> impl Iterator<Item = &'static str> + use<> {
        let is_host_silent = flags.contains(Flags::HOST_SILENT);
        let entered = (state != self.state).then_some(state.word());
        let silent = (is_host_silent && !self.is_host_silent).then_some("host-silent");
        *self = Self { state, is_host_silent };
        entered.into_iter().chain(silent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_change_is_one_event() {
        let mut last = LastReport { state: State::Disarmed, is_host_silent: false };
        let silent = Flags::HOST_SILENT;
        for (state, flags, expected) in [
            (State::Disarmed, Flags::default(), &[][..]),
            (State::Armed, Flags::default(), &["armed"]),
            (State::Active, Flags::STILL, &["active"]),
            (State::Active, Flags::default(), &[]),
            (State::Disarmed, silent, &["disarmed", "host-silent"]),
            (State::Disarmed, silent, &[]),
            (State::Armed, Flags::default(), &["armed"]),
        ] {
            assert_eq!(last.changes(state, flags).collect::<Vec<_>>(), expected);
        }
    }

    #[test]
    fn a_virtual_board_does_not_replace_what_a_finger_did_on_a_board() {
        let folder = tempfile::tempdir().unwrap();
        let felt = folder.path().join("felt.csv");
        let rows = "t_s,x_mm,y_mm,speed_mm_s,participant\n";
        std::fs::write(&felt, rows).unwrap();
        let error = ServerLog::create(folder.path(), &Inputs::default(), 40_000, 40).err().unwrap().to_string();
        assert!(error.contains("felt.csv is a recording of a person") && error.contains("--out"), "{error}");
        assert_eq!(std::fs::read_to_string(felt).unwrap(), rows);
    }
}
