//! Thresholds of touch, with their sources. "Quoted from memory" marks a value to check before use;
//! `docs/inside/evidence.md` lists all of them.

use frixel_hil_sim::{FingertipConfig, RELAXATION_LENGTH_M};
use serde::{Deserialize, Serialize};

/// Weber fraction of friction: the smallest perceptible change of the total friction, for a transient decrease
/// (Gueorguiev 2017, doi:10.1098/rsif.2017.0641). It is assumed to hold for increases and for changes over place. It
/// does not apply to fine textures.
pub const WEBER_FRACTION: f64 = 0.11;

/// Weber fraction that rubber needed under active touch, rounded up to the 0.27 of force discrimination below 0.5 N
/// (Fehlberg 2022, doi:10.1007/978-3-031-06249-0_3: 0.2; doi:10.1038/s41598-022-12010-0: 0.15 to 0.27). A step above it
/// is perceptible according to all three studies.
pub(super) const WEBER_FRACTION_SAFE: f64 = 0.27;

/// Difference threshold of electrovibration voltage, dB (doi:10.1038/s41598-018-22865-x).
pub(crate) const VOLTAGE_DIFFERENCE_DB: f64 = 1.21;

/// Root mean square of a finger's own friction noise from 10 to 1,000 Hz, N. Its spectral density falls as 1/f, so
/// each octave has the same share. Computed from one trial of one bare finger at 0.53 N and 40 mm/s
/// (romangrigorii/data-driven-playback).
pub const NATURAL_NOISE_RMS_N: f64 = FingertipConfig::REALISTIC.noise_rms_n;
/// Band of [`NATURAL_NOISE_RMS_N`], Hz.
const NOISE_BAND_HZ: (f64, f64) = (10.0, 1000.0);

/// Distance from a border within which a fingertip cannot tell the side of a change, m: its spatial resolution is 1 to
/// 2 mm (Basdogan's review).
pub(super) const FINGERTIP_M: f64 = 0.002;
/// The longest way over which a change counts as one, m: a second of sliding at a usual speed. Assumed.
pub(super) const WAY_MAX_M: f64 = 0.05;
/// Duration of a touch of an element, s: strokes may miss a less frequent burst. Assumed.
pub(super) const TOUCH_S: f64 = 1.0;
/// Shortest perceptible burst, s: the period of 500 Hz, the highest frequency with a threshold. Assumed.
pub(super) const BURST_MIN_S: f64 = 2e-3;

/// Frequency below which a change of friction counts as a step, and above which it counts as a texture, Hz. Assumed; it
/// is the lowest frequency with a threshold.
pub(super) const TEXTURE_MIN_HZ: f64 = 10.0;

/// The highest frequency with a threshold, Hz.
pub(super) const TEXTURE_MAX_HZ: f32 = 500.0;

/// Smallest perceptible vibration: frequency in Hz and displacement amplitude in micrometres, from the four-channel
/// model of Bolanowski et al. 1988 (doi:10.1121/1.397184). Quoted from memory.
const DISPLACEMENT_THRESHOLD_UM: [(f64, f64); 8] =
    [(10.0, 16.0), (20.0, 10.0), (40.0, 4.0), (80.0, 1.0), (160.0, 0.2), (250.0, 0.1), (400.0, 0.16), (500.0, 0.25)];

/// Stiffness of a fingertip against tangential motion, N/m (Wiertlewski and Hayward 2012,
/// doi:10.1016/j.jbiomech.2012.05.045). Quoted from memory.
const TANGENTIAL_STIFFNESS_N_PER_M: f64 = 1.0e3;
/// Damping of a fingertip against tangential motion, N s/m. Same source, also quoted from memory.
const TANGENTIAL_DAMPING_N_S_PER_M: f64 = 1.5;

/// Factor by which the threshold may be wrong in either direction: people differ by a factor of 2, and the thresholds
/// were measured with a vibrating probe, not with friction. Assumed.
pub(crate) const THRESHOLD_UNCERTAINTY: f64 = 3.0;

/// Meaning of *maybe* for users. It is a range of contrast: from the smallest to the largest Weber fraction of the
/// studies, or a factor of 3 on both sides of a texture's threshold. No study gives the distribution of thresholds
/// among people.
pub(crate) const MAYBE: &str = "maybe: near the threshold, where some people or some strokes will not notice it";

/// Whether a person perceives something, ordered by certainty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Too small for anyone in the studies.
    NotFelt,
    /// No study covers it.
    Unknown,
    /// Near the threshold, where some people or some strokes will not notice it.
    Maybe,
    /// Felt by everyone in the studies.
    Felt,
}

impl Verdict {
    /// Judges a change of friction from its size in Weber steps.
    pub fn of_step(weber_steps: f64) -> Self {
        match weber_steps.abs() {
            steps if steps < 1.0 => Self::NotFelt,
            steps if steps < weber_steps_safe() => Self::Maybe,
            steps if steps.is_finite() => Self::Felt,
            _ => Self::Unknown,
        }
    }

    /// Judges a texture of an amplitude in newtons at a frequency.
    pub(super) fn of_texture(amplitude_n: f64, frequency_hz: f64) -> Self {
        let Some(threshold_n) = texture_threshold_n(frequency_hz) else { return Self::Unknown };
        if amplitude_n < threshold_n / THRESHOLD_UNCERTAINTY {
            Self::NotFelt
        } else if amplitude_n < threshold_n * THRESHOLD_UNCERTAINTY {
            Self::Maybe
        } else if amplitude_n < natural_noise_amplitude_n(frequency_hz) {
            // The thresholds were measured on a finger that did not slide.
            Self::Unknown
        } else {
            Self::Felt
        }
    }

    /// Name of the verdict in columns and JSON.
    pub fn key(self) -> &'static str {
        match self {
            Self::NotFelt => "not_felt",
            Self::Maybe => "maybe",
            Self::Felt => "felt",
            Self::Unknown => "unknown",
        }
    }

    /// The verdict in a word or two.
    pub fn words(self) -> &'static str {
        match self {
            Self::NotFelt => "not felt",
            Self::Maybe => "maybe",
            Self::Felt => "felt",
            Self::Unknown => "unknown",
        }
    }
}

/// The change from one total friction to another, in Weber steps: `ln(to / from) / ln 1.11`. Negative if friction
/// falls.
///
/// ```
/// use frixel_felt::judge::weber_steps;
///
/// assert!((weber_steps(0.25, 0.2775) - 1.0).abs() < 1e-12);
/// ```
pub fn weber_steps(from_n: f64, to_n: f64) -> f64 {
    libm::log(to_n / from_n) / libm::log1p(WEBER_FRACTION)
}

/// Formats Weber steps with one decimal place, or with as many more as its verdict needs: 2.3 is felt, and 2.28 is near
/// the threshold.
pub fn weber_steps_text(weber_steps: f64) -> String {
    let rounded = |digits: i32| (weber_steps * 10f64.powi(digits)).round() / 10f64.powi(digits);
    let is_faithful = |digits: &i32| Verdict::of_step(rounded(*digits)) == Verdict::of_step(weber_steps);
    let digits = (1..=3).find(is_faithful).unwrap_or(3);
    // Adding zero avoids a negative zero.
    format!("{:.*}", digits as usize, 0.0 + rounded(digits))
}

/// Number of Weber steps felt by everyone in the studies, about 2.3.
pub fn weber_steps_safe() -> f64 {
    weber_steps(1.0, 1.0 + WEBER_FRACTION_SAFE)
}

/// The smallest perceptible amplitude of a sinusoidal tangential force, N; `None` without a measurement.
///
/// It is the displacement threshold times the magnitude of the fingertip's tangential impedance, `|k + 2 pi i f c|`,
/// interpolated in the logarithms of frequency and displacement. It holds within a factor of 3.
pub(super) fn texture_threshold_n(frequency_hz: f64) -> Option<f64> {
    let mut pairs = DISPLACEMENT_THRESHOLD_UM.array_windows();
    let [(from_hz, from_um), (to_hz, to_um)] = pairs.find(|[from, to]| (from.0..=to.0).contains(&frequency_hz))?;
    let part = libm::log(frequency_hz / from_hz) / libm::log(to_hz / from_hz);
    let displacement_m = 1e-6 * from_um * libm::pow(to_um / from_um, part);
    let damping_n_per_m = std::f64::consts::TAU * frequency_hz * TANGENTIAL_DAMPING_N_S_PER_M;
    Some(displacement_m * libm::hypot(TANGENTIAL_STIFFNESS_N_PER_M, damping_n_per_m))
}

/// Amplitude of a sine with the power of a finger's own friction noise in the third of an octave around a frequency, N.
pub(crate) fn natural_noise_amplitude_n(frequency_hz: f64) -> f64 {
    let (from_hz, to_hz) = NOISE_BAND_HZ;
    if !(from_hz..=to_hz).contains(&frequency_hz) {
        return 0.0;
    }
    let thirds_of_octave = 3.0 * libm::log2(to_hz / from_hz);
    NATURAL_NOISE_RMS_N * (2.0 / thirds_of_octave).sqrt()
}

/// Fraction of a texture's amplitude that remains after the lag of friction, from 0 to 1.
pub(super) fn lag_gain(wavelength_mm: f64) -> f64 {
    1.0 / libm::hypot(1.0, std::f64::consts::TAU * 1e3 * RELAXATION_LENGTH_M / wavelength_mm)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::element::PAUSE_MAX_S;
    use crate::judge::spectrum::POWER_PART_MIN;
    use crate::judge::texture::SUMMED_S;

    /// `docs/design/scenes.md` has these numbers in these sentences.
    #[test]
    #[allow(clippy::disallowed_methods, reason = "the test reads the documentation")]
    fn the_guide_states_the_constants() {
        let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/design/scenes.md");
        let page = std::fs::read_to_string(page).unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
        let percent = 100.0 * POWER_PART_MIN;
        for said in [
            format!("`ln(F2 / F1) / ln {:.2}` of the total friction: below 1 it", 1.0 + WEBER_FRACTION),
            format!("A Weber step is a factor of {:.2} in friction", 1.0 + WEBER_FRACTION),
            format!("from {:.1} on it is felt", weber_steps_safe()),
            format!("Weber fraction that was measured, {WEBER_FRACTION}, to the largest, {WEBER_FRACTION_SAFE}"),
            format!("repeats faster than {TEXTURE_MIN_HZ} Hz under the finger"),
            format!("less than {percent} % of the power"),
            format!("a fingertip, which resolves {} mm", 1e3 * FINGERTIP_M),
            format!("change within {} mm", 1e3 * WAY_MAX_M),
            format!("a burst below {} ms", 1e3 * BURST_MIN_S),
            format!("sums the power of about {SUMMED_S:.1} s"),
            format!("the longest are cut to {PAUSE_MAX_S} s"),
        ] {
            assert!(page.contains(&said), "docs/design/scenes.md does not say: {said}");
        }
        assert!(page.contains("pauses of more than a second") && TOUCH_S.to_bits() == 1.0_f64.to_bits());
    }

    #[test]
    fn verdicts_of_steps_change_at_one_and_at_the_safe_number() {
        let steps = [0.99, 1.01, 2.28, 2.30, -3.0, f64::NAN];
        let verdicts = steps.map(Verdict::of_step);
        assert_eq!(
            verdicts,
            [Verdict::NotFelt, Verdict::Maybe, Verdict::Maybe, Verdict::Felt, Verdict::Felt, Verdict::Unknown]
        );
    }

    #[test]
    fn a_number_of_steps_is_written_as_it_is_judged() {
        for (steps, text) in [
            (2.326, "2.3"),
            (2.275, "2.28"),
            (0.96, "0.96"),
            (1.04, "1.0"),
            (-0.01, "0.0"),
            (-0.98, "-0.98"),
            (-3.04, "-3.0"),
        ] {
            assert_eq!(weber_steps_text(steps), text);
        }
    }

    #[test]
    fn the_threshold_is_a_u_with_its_bottom_in_the_pacinian_range() {
        let threshold_n = |frequency_hz| texture_threshold_n(frequency_hz).unwrap();
        let lowest_hz = (10..=500).map(f64::from).min_by(|a, b| threshold_n(*a).total_cmp(&threshold_n(*b))).unwrap();
        assert!((200.0..=300.0).contains(&lowest_hz), "{lowest_hz} Hz");
        assert!(threshold_n(10.0) > 30.0 * threshold_n(250.0));
        assert!(threshold_n(500.0) > 2.0 * threshold_n(250.0));
        assert_eq!((texture_threshold_n(9.0), texture_threshold_n(501.0)), (None, None));
    }

    #[test]
    fn the_noise_of_all_thirds_of_an_octave_is_the_measured_noise() {
        let bands = (3.0 * libm::log2(100.0)).round();
        let sum = bands * natural_noise_amplitude_n(100.0).powi(2) / 2.0;
        assert!((sum.sqrt() / NATURAL_NOISE_RMS_N - 1.0).abs() < 0.02, "{sum}");
    }

    #[test]
    fn a_texture_is_judged_by_threshold_and_noise() {
        let threshold_n = texture_threshold_n(40.0).unwrap();
        assert_eq!(Verdict::of_texture(0.3 * threshold_n, 40.0), Verdict::NotFelt);
        assert_eq!(Verdict::of_texture(2.0 * threshold_n, 40.0), Verdict::Maybe);
        assert_eq!(Verdict::of_texture(4.0 * threshold_n, 40.0), Verdict::Felt);
        // At 250 Hz the threshold is far below the finger's own noise.
        assert_eq!(Verdict::of_texture(4.0 * texture_threshold_n(250.0).unwrap(), 250.0), Verdict::Unknown);
        assert_eq!(Verdict::of_texture(1.0, 900.0), Verdict::Unknown);
    }

    #[test]
    fn the_lag_halves_the_power_at_its_cutoff_at_every_speed() {
        // 50 mm/s: cutoff 690 Hz, wavelength 50/690 mm.
        assert!((lag_gain(50.0 / 690.0) - 0.5_f64.sqrt()).abs() < 1e-12);
    }
}
