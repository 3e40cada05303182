//! What a simulated finger felt, tick by tick, against what it should have.

use frixel_hil_sim::{TickRecord, contact_of};
use frixel_model::{LoadedContact, ParameterError};
use frixel_wire::fault::Flags;
use frixel_wire::hello::BoardLimits;
use frixel_wire::scene::Carrier;

use super::streamed::Streamed;
use crate::output::FeltRow;
use frixel_scene::metrics::{Metrics, TickSample};
use frixel_scene::wanted::{Along, Moment, Wanted};
use frixel_scene::{Program, carrier};

/// Gathers the errors of every tick of a program that plays, and a row every so many ticks.
pub struct Recorder {
    wanted: Along,
    tick_period_s: f64,
    inversion: Inversion,
    metrics: Metrics,
    row_maker: RowMaker,
    rows: Vec<FeltRow>,
    ticks_left: u64,
    streamed: Streamed,
}

impl Recorder {
    /// A recorder for `program` on a board of these limits, that takes `ticks` ticks and makes a row every
    /// `ticks_per_row` of them.
    pub fn new(
        program: &Program,
        limits: &BoardLimits,
        tick_hz: u32,
        ticks: u64,
        ticks_per_row: u32,
    ) -> Result<Self, ParameterError> {
        Ok(Self {
            wanted: Wanted::new(program).along(),
            tick_period_s: 1.0 / f64::from(tick_hz),
            inversion: Inversion::new(program, limits, tick_hz)?,
            metrics: Metrics::new(program.half_period_ticks),
            row_maker: RowMaker::new(tick_hz, ticks_per_row),
            rows: Vec::new(),
            ticks_left: ticks,
            streamed: Streamed::new(tick_hz),
        })
    }

    /// The errors so far.
    pub fn metrics(&self) -> &Metrics {
        &self.metrics
    }

    /// The rows so far, those that were taken left out.
    pub fn rows(&self) -> &[FeltRow] {
        &self.rows
    }

    /// Hands over the rows since the last time.
    pub(crate) fn take_rows(&mut self) -> Vec<FeltRow> {
        std::mem::take(&mut self.rows)
    }

    /// Hears what the host sends to the board: samples of a stream are part of what is wanted.
    pub(super) fn hear(&mut self, frame: &[u8]) {
        self.streamed.hear(frame);
    }

    /// Takes no more ticks.
    pub(crate) fn end(&mut self) {
        self.ticks_left = 0;
    }

    /// Takes one tick, unless there were enough.
    pub(super) fn take(&mut self, record: &TickRecord) {
        if self.ticks_left == 0 {
            return;
        }
        self.ticks_left -= 1;
        let natural_n = self.wanted.natural_friction_n();
        let wanted_n = self.wanted_electric_n(record).map(|electric_n| natural_n + electric_n);
        let telemetry = &record.status.telemetry;
        self.metrics.add(&TickSample {
            wanted_n: wanted_n.unwrap_or_default(),
            asked_n: natural_n + f64::from(telemetry.asked_electric_friction_n),
            felt_n: record.felt.friction_n,
            inversion_n: natural_n + self.inversion.electric_friction_n(telemetry.voltage_v_rms, telemetry.dac_code),
            saturated: telemetry.flags.contains(Flags::SATURATED),
            finger_down: wanted_n.is_some(),
            wanted_in_reach: wanted_n.is_some_and(|wanted_n| self.inversion.reaches(wanted_n - natural_n)),
        });
        self.rows.extend(self.row_maker.take(record, wanted_n));
    }

    /// Electric friction wanted where the finger is, when it is on the screen.
    fn wanted_electric_n(&mut self, record: &TickRecord) -> Option<f64> {
        let (stream, stream_weight) = self.streamed.next(record.status.telemetry.flags);
        let Some(finger) = record.felt.finger else {
            self.wanted.lift();
            return None;
        };
        Some(self.wanted.electric_friction_n(&Moment {
            x_m: finger.x_m,
            y_m: finger.y_m,
            t_s: record.tick as f64 * self.tick_period_s,
            speed_m_per_s: finger.speed_m_per_s,
            stream,
            stream_weight,
        }))
    }
}

/// The full model behind an ideal amplifier and the DAC's steps.
struct Inversion {
    contact: LoadedContact<f64>,
    shape: Carrier,
    codes_per_v_rms: f64,
    electric_friction_max_n: f64,
}

impl Inversion {
    fn new(program: &Program, limits: &BoardLimits, tick_hz: u32) -> Result<Self, ParameterError> {
        let half_period_s = f64::from(program.half_period_ticks) / f64::from(tick_hz);
        let peak_per_rms = f64::from(carrier(program.header.carrier, half_period_s, limits).peak_per_rms());
        let codes_per_v_peak = f64::from(i16::MAX) / f64::from(limits.full_scale_v_peak);
        Ok(Self {
            contact: contact_of(&program.header)?,
            shape: program.header.carrier,
            codes_per_v_rms: peak_per_rms * codes_per_v_peak,
            electric_friction_max_n: program.reach.electric_friction_max_n,
        })
    }

    /// A square wave's code is its amplitude. A sine's is one of many, so its amplitude is rounded as the DAC would.
    fn electric_friction_n(&self, voltage_v_rms: f32, dac_code: i16) -> f64 {
        let amplitude_code = match self.shape {
            Carrier::Square => f64::from(dac_code).abs(),
            Carrier::Sine => (f64::from(voltage_v_rms) * self.codes_per_v_rms).round(),
        };
        self.contact.electric_friction_n(amplitude_code / self.codes_per_v_rms)
    }

    fn reaches(&self, electric_friction_n: f64) -> bool {
        (0.0..=self.electric_friction_max_n).contains(&electric_friction_n)
    }
}

/// Makes a row of every so many ticks: frictions are means over them, flags are gathered, all else is the last tick's.
///
/// At a row a millisecond and a carrier of 1 kHz, felt friction is thus the mean over a carrier period, and does not
/// show which part of a carrier's edge the row happened to fall on.
pub(super) struct RowMaker {
    tick_period_s: f64,
    ticks_per_row: u32,
    ticks: u64,
    wanted: Mean,
    asked: Mean,
    felt: Mean,
    flags: Flags,
}

/// A mean of what was there.
#[derive(Default)]
struct Mean {
    sum: f64,
    count: u32,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    fn take(&mut self) -> Option<f64> {
        let Self { sum, count } = std::mem::take(self);
        (count > 0).then(|| sum / f64::from(count))
    }
}

impl RowMaker {
    pub(super) fn new(tick_hz: u32, ticks_per_row: u32) -> Self {
        Self {
            tick_period_s: 1.0 / f64::from(tick_hz),
            ticks_per_row: ticks_per_row.max(1),
            ticks: 0,
            wanted: Mean::default(),
            asked: Mean::default(),
            felt: Mean::default(),
            flags: Flags::default(),
        }
    }

    /// Takes one tick, with the total friction wanted where that is known, and gives a row when one is complete.
    pub(super) fn take(&mut self, record: &TickRecord, wanted_n: Option<f64>) -> Option<FeltRow> {
        self.ticks += 1;
        let telemetry = &record.status.telemetry;
        let felt = &record.felt;
        if felt.finger.is_some() {
            let natural_n = felt.friction_n - felt.electric_friction_n;
            self.felt.add(felt.friction_n);
            self.asked.add(natural_n + f64::from(telemetry.asked_electric_friction_n));
        }
        if let Some(wanted_n) = wanted_n {
            self.wanted.add(wanted_n);
        }
        self.flags = self.flags.with(telemetry.flags);
        if !self.ticks.is_multiple_of(u64::from(self.ticks_per_row)) {
            return None;
        }
        Some(FeltRow {
            t_s: self.ticks as f64 * self.tick_period_s,
            x_mm: felt.finger.map(|finger| 1e3 * finger.x_m),
            y_mm: felt.finger.map(|finger| 1e3 * finger.y_m),
            speed_mm_s: felt.finger.map(|finger| 1e3 * finger.speed_m_per_s),
            wanted_n: self.wanted.take(),
            asked_n: self.asked.take(),
            felt_n: self.felt.take(),
            voltage_v_rms: Some(f64::from(telemetry.voltage_v_rms)),
            dac_code: Some(telemetry.dac_code),
            flags: Some(std::mem::take(&mut self.flags)),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use frixel_hil_sim::RigConfig;

    use super::*;
    use crate::scene_file;
    use frixel_scene::compile;

    #[test]
    fn a_code_of_zero_is_no_friction_whatever_voltage_was_meant() {
        let board = RigConfig::default().board;
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/constant.toml");
        let program = compile(&scene_file::load(&scene).unwrap(), &board.limits, board.tick_hz).unwrap();
        let inversion = Inversion::new(&program, &board.limits, board.tick_hz).unwrap();
        assert_eq!(inversion.electric_friction_n(100.0, 0).to_bits(), 0);
        let code = (100.0 * inversion.codes_per_v_rms).round() as i16;
        let expected_n = inversion.contact.electric_friction_n(100.0);
        assert!((inversion.electric_friction_n(100.0, -code) / expected_n - 1.0).abs() < 1e-3);
    }
}
