//! What a trial plays: two strokes, of which one has the stimulus.

use frixel_model::ParameterError;

use crate::calibration::Protocol;

/// Duration of each of the two strokes, in seconds.
pub const STROKE_S: f64 = 1.6;
/// The stimulus: friction that swings at this frequency, in Hz, near which fingers feel best (Vardar 2016; Wijekoon
/// 2012: 160 Hz of force).
pub const STIMULUS_HZ: f64 = 160.0;
/// Fade of the stimulus at either end of a stroke, in seconds, so that no click gives it away.
pub const FADE_S: f64 = 0.2;

/// The samples of a trial, for the stream of [`Protocol::scene`]: the stimulus, with an amplitude of `level_db`
/// relative to the largest, in the first stroke or in the second.
pub fn samples(protocol: &Protocol, level_db: f64, is_second: bool) -> Vec<u16> {
    let sample_hz = f64::from(protocol.sample_hz());
    let amplitude = amplitude(level_db);
    (0..(2.0 * STROKE_S * sample_hz) as u32)
        .map(|sample| {
            let time_s = f64::from(sample) / sample_hz;
            let in_stroke_s = time_s % STROKE_S;
            if (time_s >= STROKE_S) != is_second {
                return 0;
            }
            let fade = (in_stroke_s.min(STROKE_S - in_stroke_s) / FADE_S).min(1.0);
            let wave = 0.5 - 0.5 * libm::cos(core::f64::consts::TAU * STIMULUS_HZ * in_stroke_s);
            (fade * amplitude * wave * f64::from(u16::MAX)).round() as u16
        })
        .collect()
}

/// The voltage at the peaks of a stimulus of this level, in volts rms.
pub fn level_v_rms(level_db: f64, protocol: &Protocol) -> Result<f64, ParameterError> {
    protocol.voltage_of_share_v_rms(amplitude(level_db))
}

/// The amplitude of a level, as a part of the largest.
fn amplitude(level_db: f64) -> f64 {
    libm::pow(10.0, level_db / 20.0)
}
