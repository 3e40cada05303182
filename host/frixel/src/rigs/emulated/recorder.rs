//! What a finger felt on an emulated board, from what the world saw at every tick and what the board told now and then.

use std::collections::VecDeque;

use frixel_hil_sim::emulated::LinkRecord;
use frixel_wire::message::Telemetry;

use crate::output::FeltRow;
use frixel_scene::Program;
use frixel_scene::metrics::{Metrics, MetricsSummary, TickSample};
use frixel_scene::wanted::Wanted;

/// Gathers the errors of every tick and makes a row every so many, from a tick of the board on.
///
/// The emulated serial port is too slow for telemetry at every row: what only the board knows (what it asked for, its rms
/// voltage, its flags) stands in the rows that a telemetry message falls in. Saturated ticks and the error of
/// the inversion would take it at every tick, and stay unknown.
pub struct EmulatedRecorder {
    wanted: Wanted,
    metrics: Metrics,
    tick_period_s: f64,
    ticks_per_row: u32,
    first_tick: u32,
    ticks: u32,
    ticks_max: u64,
    sums: Sums,
    told: VecDeque<Telemetry>,
}

/// Of the ticks of a row so far.
#[derive(Default)]
struct Sums {
    wanted_n: f64,
    felt_n: f64,
    finger_ticks: u32,
}

impl EmulatedRecorder {
    /// Takes at most `ticks` ticks from `first_tick` on, of a board that ticks `tick_hz` times a second.
    pub fn new(program: &Program, tick_hz: u32, first_tick: u32, ticks: u64, ticks_per_row: u32) -> Self {
        Self {
            wanted: Wanted::new(program),
            metrics: Metrics::new(program.half_period_ticks),
            tick_period_s: 1.0 / f64::from(tick_hz),
            ticks_per_row: ticks_per_row.max(1),
            first_tick,
            ticks: 0,
            ticks_max: ticks,
            sums: Sums::default(),
            told: VecDeque::new(),
        }
    }

    /// Whether there were enough ticks.
    pub fn is_done(&self) -> bool {
        u64::from(self.ticks) >= self.ticks_max
    }

    /// The part of the ticks that was taken, from 0 to 1.
    pub fn part(&self) -> f64 {
        f64::from(self.ticks) / self.ticks_max.max(1) as f64
    }

    /// Ticks so far.
    pub fn ticks(&self) -> u32 {
        self.ticks
    }

    /// Takes what the board tells. To be called before [`Self::take`] comes to that tick.
    pub fn tell(&mut self, telemetry: &Telemetry) {
        self.told.push_back(*telemetry);
    }

    /// Takes the next tick, and gives a row when one is complete.
    pub fn take(&mut self, record: &LinkRecord) -> Option<FeltRow> {
        if self.is_done() || (record.tick.wrapping_sub(self.first_tick) as i32) < 0 {
            return None;
        }
        self.ticks += 1;
        self.add(record);
        if !self.ticks.is_multiple_of(self.ticks_per_row) {
            return None;
        }
        Some(self.row(record))
    }

    /// What was gathered so far.
    pub fn metrics(&self) -> MetricsSummary {
        MetricsSummary { saturated_ticks: None, inversion_error: None, ..self.metrics.summary() }
    }

    fn add(&mut self, record: &LinkRecord) {
        let finger = record.felt.finger;
        let wanted_n = finger.map_or(0.0, |finger| {
            self.wanted.natural_friction_n() + self.wanted.electric_friction_n(finger.x_m, finger.y_m)
        });
        self.metrics.add(&TickSample {
            wanted_n,
            felt_n: record.felt.friction_n,
            finger_down: finger.is_some(),
            asked_n: 0.0,
            inversion_n: 0.0,
            saturated: false,
            // No inversion error is made of what is not known.
            wanted_in_reach: false,
        });
        if finger.is_some() {
            self.sums.wanted_n += wanted_n;
            self.sums.felt_n += record.felt.friction_n;
            self.sums.finger_ticks += 1;
        }
    }

    /// The row that ends with this tick. Frictions are means over it.
    fn row(&mut self, record: &LinkRecord) -> FeltRow {
        let sums = std::mem::take(&mut self.sums);
        let mean = |sum: f64| (sums.finger_ticks > 0).then(|| sum / f64::from(sums.finger_ticks));
        let told = self.told_until(record.tick);
        let finger = record.felt.finger;
        let natural_n = self.wanted.natural_friction_n();
        FeltRow {
            t_s: f64::from(self.ticks) * self.tick_period_s,
            x_mm: finger.map(|finger| 1e3 * finger.x_m),
            y_mm: finger.map(|finger| 1e3 * finger.y_m),
            speed_mm_s: finger.map(|finger| 1e3 * finger.speed_m_per_s),
            wanted_n: mean(sums.wanted_n),
            felt_n: mean(sums.felt_n),
            dac_code: Some(record.drive.dac_code),
            asked_n: told
                .filter(|_| finger.is_some())
                .map(|told| natural_n + f64::from(told.asked_electric_friction_n)),
            voltage_v_rms: told.map(|told| f64::from(told.voltage_v_rms)),
            flags: told.map(|told| told.flags),
        }
    }

    /// The last that was told of a tick of the row that ends with `tick`.
    fn told_until(&mut self, tick: u32) -> Option<Telemetry> {
        let mut last = None;
        while let Some(told) = self.told.pop_front_if(|told| tick.wrapping_sub(told.tick) as i32 >= 0) {
            last = (tick.wrapping_sub(told.tick) < self.ticks_per_row).then_some(told);
        }
        last
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use frixel_hil_sim::emulated::BOARD;
    use frixel_hil_sim::{Felt, FingerState};
    use frixel_render::Drive;
    use frixel_wire::fault::{Flags, State};

    use super::*;
    use crate::scene_file;
    use frixel_scene::compile;

    fn record(tick: u32, friction_n: f64) -> LinkRecord {
        let finger = Some(FingerState { x_m: 0.05, y_m: 0.05, speed_m_per_s: 0.1 });
        let felt = Felt { finger, friction_n, electric_friction_n: 0.0, electrode_v: 0.0, mean_square_v2: 0.0 };
        LinkRecord { tick, drive: Drive { dac_code: tick as i16, amplifier_enable: true }, felt }
    }

    fn telemetry(tick: u32) -> Telemetry {
        Telemetry {
            tick,
            state: State::Active,
            flags: Flags::default(),
            finger_x_m: 0.0,
            finger_y_m: 0.0,
            speed_m_per_s: 0.0,
            asked_electric_friction_n: 0.0,
            voltage_v_rms: tick as f32,
            dac_code: 0,
        }
    }

    #[test]
    fn a_row_has_the_mean_of_its_ticks_and_what_was_told_of_one_of_them() {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/constant.toml");
        let program = compile(&scene_file::load(&scene).unwrap(), &BOARD.limits, BOARD.tick_hz).unwrap();
        let mut recorder = EmulatedRecorder::new(&program, BOARD.tick_hz, 100, 12, 4);
        for tick in [50, 102, 105, 111] {
            recorder.tell(&telemetry(tick));
        }
        let rows: Vec<FeltRow> =
            (90..120).filter_map(|tick| recorder.take(&record(tick, f64::from(tick) / 1e3))).collect();
        let means: Vec<_> = rows.iter().map(|row| row.felt_n.map(|felt_n| (2e3 * felt_n).round() as i32)).collect();
        assert_eq!(means, [Some(203), Some(211), Some(219)]);
        let told: Vec<_> = rows.iter().map(|row| row.voltage_v_rms).collect();
        assert_eq!(told, [Some(102.0), Some(105.0), Some(111.0)]);
        assert_eq!(rows.iter().map(|row| row.dac_code).collect::<Vec<_>>(), [Some(103), Some(107), Some(111)]);
        assert!(recorder.is_done());
        assert_eq!((recorder.ticks(), recorder.metrics().finger_down_ticks), (12, 12));
        assert!(recorder.metrics().friction_error.unwrap().rms_n > 0.1);

        let mut untold = EmulatedRecorder::new(&program, BOARD.tick_hz, 0, 4, 4);
        untold.tell(&telemetry(4));
        let row = (0..4).find_map(|tick| untold.take(&record(tick, 0.0))).unwrap();
        assert_eq!((row.voltage_v_rms, row.flags), (None, None), "that was told of the next row");
    }
}
