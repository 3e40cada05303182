//! The drive of a calibration over time.

use std::fmt::Write;

use frixel_hil_sim::{Point, Stroke, StrokeError};
use frixel_model::{Contact, Finger, ParameterError};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// The voltages of the protocol as parts of the highest: 75, 106 and 150 V, a factor of two in the square each.
const PARTS: [f64; 3] = [0.5, core::f64::consts::FRAC_1_SQRT_2, 1.0];
/// Half-periods of the envelope, in seconds: near 20 Hz natural friction is quiet, and a random length meets neither
/// tremor nor mains.
const HALF_PERIOD_S: (f64, f64) = (0.02, 0.03);
/// The start marker: Barker's code of 13, whose correlation with itself has one peak.
const MARKER: [bool; 13] = [true, true, true, true, true, false, false, true, true, false, true, false, true];
/// Duration of an element of the marker, in seconds.
const MARKER_ELEMENT_S: f64 = 0.04;
/// When the marker begins in the first stroke, in seconds: the finger slides by then.
const MARKER_START_S: f64 = 0.3;
/// Samples of the drive per second.
const SAMPLE_HZ: u32 = 4_000;
/// Places of the simulated finger a second.
const PLACE_HZ: f64 = 250.0;
/// Finger for which the board computes voltages. Any finger will do, because only the voltages count.
const BOARD_FINGER: Finger<f64> = Finger::<f64>::EXAMPLE;
/// So large that electric friction is a square of the voltage, whose mean is the same under every carrier.
const BOARD_GAP_M: f64 = 100e-6;
const BOARD_LOAD_N: f64 = 0.5;
/// Highest voltage in a calibration or an experiment with a person, V rms.
pub const VOLTAGE_MAX_V_RMS: f64 = 150.0;
/// Fraction of the highest voltage's friction that calibrations and experiments request, so that rounding stays within
/// reach.
pub const REACH: f64 = 0.999;

/// A calibration: strokes back and forth, each at one voltage that is switched on and off.
#[derive(Clone, Debug, PartialEq)]
pub struct Protocol {
    /// Number of strokes.
    pub strokes: usize,
    /// Duration of a stroke, in seconds.
    pub stroke_s: f64,
    /// Rest between two strokes, in seconds.
    pub pause_s: f64,
    /// Length of a stroke, in millimetres.
    pub length_mm: f64,
    /// Voltages in volts rms, one stroke each, in turn.
    pub voltages_v_rms: Vec<f64>,
    /// Seed of the half-periods.
    pub seed: u64,
}

impl Protocol {
    /// A minute of strokes of 70 mm at 44 mm/s on average, up to this voltage and 150 V rms.
    pub fn new(voltage_max_v_rms: f64, seed: u64) -> Self {
        let highest = VOLTAGE_MAX_V_RMS.min(voltage_max_v_rms);
        let voltages_v_rms = PARTS.iter().map(|part| part * highest).collect();
        Self { strokes: 36, stroke_s: 1.6, pause_s: 0.2, length_mm: 70.0, voltages_v_rms, seed }
    }

    /// Highest voltage, in volts rms.
    pub fn voltage_max_v_rms(&self) -> f64 {
        self.voltages_v_rms.iter().copied().fold(0.0, f64::max)
    }

    /// Duration of all strokes, in seconds.
    pub fn duration_s(&self) -> f64 {
        self.strokes as f64 * (self.stroke_s + self.pause_s)
    }

    /// Samples of the drive per second.
    pub fn sample_hz(&self) -> u32 {
        SAMPLE_HZ
    }

    /// The plan as text, one line per item.
    pub fn words(&self) -> String {
        let voltages: Vec<String> = self.voltages_v_rms.iter().map(|volts| format!("{volts:.0}")).collect();
        let mut text = format!(
            "{} strokes of {:.0} mm in {:.1} s each, back and forth, with {:.1} s between: {:.0} s in all\n",
            self.strokes,
            self.length_mm,
            self.stroke_s,
            self.pause_s,
            self.duration_s()
        );
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{} V rms in turn, switched on and off after 20 to 30 ms, seed {}",
            voltages.join(", "),
            self.seed
        );
        let _ = writeln!(text, "a start marker of 13 elements of 40 ms in the first stroke");
        if self.voltage_max_v_rms() < 100.0 {
            let _ = writeln!(text, "below 100 V rms the recording cannot test the model");
        }
        text
    }

    /// The voltage at each sample, in volts rms.
    fn voltages(&self) -> Vec<f64> {
        let mut random = Pcg64::seed_from_u64(self.seed);
        let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        let period_s = self.stroke_s + self.pause_s;
        let count = (self.duration_s() * f64::from(SAMPLE_HZ)) as u32;
        let (mut is_on, mut change_s) = (false, 0.0);
        (0..count)
            .map(|sample| {
                let time_s = f64::from(sample) / f64::from(SAMPLE_HZ);
                if time_s >= change_s {
                    is_on = !is_on;
                    change_s += HALF_PERIOD_S.0 + (HALF_PERIOD_S.1 - HALF_PERIOD_S.0) * uniform();
                }
                let stroke = (time_s / period_s) as usize;
                let element = (time_s - MARKER_START_S) / MARKER_ELEMENT_S;
                let marked = if element >= 0.0 { MARKER.get(element as usize).copied() } else { None };
                match marked {
                    Some(true) => self.voltage_max_v_rms(),
                    None if is_on => {
                        self.voltages_v_rms.get(stroke % self.voltages_v_rms.len()).copied().unwrap_or(0.0)
                    }
                    Some(false) | None => 0.0,
                }
            })
            .collect()
    }

    /// The samples for the stream of [`scene`](Self::scene), with which a board drives these voltages.
    pub fn samples(&self) -> Result<Vec<u16>, ParameterError> {
        let contact = Contact::new(&BOARD_FINGER, BOARD_GAP_M)?.under_load(BOARD_LOAD_N)?;
        let most_n = contact.electric_friction_n(self.voltage_max_v_rms());
        let sample = |volts: f64| (contact.electric_friction_n(volts) / most_n * f64::from(u16::MAX)).round() as u16;
        Ok(self.voltages().into_iter().map(sample).collect())
    }

    /// The scene that plays the samples: a stream over the whole screen.
    pub fn scene(&self) -> Result<String, ParameterError> {
        let contact = Contact::new(&BOARD_FINGER, BOARD_GAP_M)?.under_load(BOARD_LOAD_N)?;
        let highest = self.voltage_max_v_rms();
        let high_n = REACH * contact.electric_friction_n(highest);
        let Finger { radius_m, stiffness_pa_per_m, friction_coefficient } = BOARD_FINGER;
        let (thickness_um, radius_mm) = (1e6 * BOARD_GAP_M, 1e3 * radius_m);
        Ok(format!(
            "version = 1\nscreen = {{ width_mm = 120, height_mm = 80, \
             coating = {{ thickness_um = {thickness_um}, permittivity = 1 }} }}\n\
             finger = {{ radius_mm = {radius_mm}, stiffness_pa_per_m = {stiffness_pa_per_m}, \
             friction_coefficient = {friction_coefficient}, normal_load_n = {BOARD_LOAD_N}, skin_gap_um = 0 }}\n\
             drive = {{ voltage_max_v_rms = {highest} }}\n\
             [[layer]]\nname = \"calibration\"\nkind = \"stream\"\nlow_n = 0.0\nhigh_n = {high_n}\n"
        ))
    }

    /// Path of the simulated finger: strokes of minimum jerk, back and forth.
    pub fn stroke(&self) -> Result<Stroke, StrokeError> {
        let period_s = self.stroke_s + self.pause_s;
        let place = |step: u32| {
            let time_s = f64::from(step) / PLACE_HZ;
            let stroke = (time_s / period_s).floor();
            let part = ((time_s - stroke * period_s) / self.stroke_s).clamp(0.0, 1.0);
            let way = part * part * part * (10.0 - 15.0 * part + 6.0 * part * part);
            let way = if (stroke as u64).is_multiple_of(2) { way } else { 1.0 - way };
            (time_s, Some(Point { x_m: (25.0 + self.length_mm * way) / 1e3, y_m: 40.0 / 1e3 }))
        };
        Stroke::through(&(0..=(self.duration_s() * PLACE_HZ) as u32).map(place).collect::<Vec<_>>())
    }
}

#[cfg(test)]
mod tests {
    use super::{Protocol, SAMPLE_HZ};

    #[test]
    fn half_periods_and_voltages_are_those_of_the_plan() {
        let protocol = Protocol::new(200.0, 1);
        let voltages = protocol.voltages();
        assert_eq!(voltages.len(), (protocol.duration_s() * f64::from(SAMPLE_HZ)) as usize);
        let mut levels: Vec<u32> = voltages.iter().map(|volts| volts.round() as u32).collect();
        levels.sort_unstable();
        levels.dedup();
        assert_eq!(levels, [0, 75, 106, 150]);
        // After the marker, every run of one state lasts for 20 to 30 ms.
        let after = &voltages[SAMPLE_HZ as usize * 2..];
        let mut length = 0_u32;
        let mut lengths = Vec::new();
        for pair in after.windows(2) {
            length += 1;
            if (pair[0] > 0.0) != (pair[1] > 0.0) {
                lengths.push(f64::from(std::mem::take(&mut length)) / f64::from(SAMPLE_HZ));
            }
        }
        assert!(lengths[1..].iter().all(|seconds| (0.0195..0.0305).contains(seconds)), "{lengths:?}");
    }

    #[test]
    fn a_board_that_drives_less_gets_less() {
        let protocol = Protocol::new(50.0, 1);
        assert!((protocol.voltages_v_rms[1] - 35.36).abs() < 0.01);
        assert!(protocol.words().contains("below 100 V rms the recording cannot test the model"));
        assert!(!Protocol::new(150.0, 1).words().contains("cannot test"));
    }
}
