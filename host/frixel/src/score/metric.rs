//! The numbers of a score, and what a person notices of them.

use std::f64::consts::FRAC_1_SQRT_2;

use frixel_scene::fidelity::Fidelity;
use frixel_scene::perception::{NATURAL_NOISE_RMS_N, weber_steps_safe};
use serde::Serialize;

/// Number of standard errors on either side of a mean in its interval: 95 % for many plays.
const STANDARD_ERRORS: f64 = 1.96;

/// A number of [`Fidelity`].
pub(super) struct Metric {
    key: &'static str,
    title: &'static str,
    unit: &'static str,
    /// Factor from SI units to `unit`.
    factor: f64,
    value: fn(&Fidelity) -> f64,
    human: fn() -> Option<Human>,
}

/// What a person notices.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Human {
    /// The value from which a person notices it, in the metric's unit.
    pub value: f64,
    /// What it is, with its source.
    pub meaning: &'static str,
}

/// A number of [`Fidelity`] over all plays.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MetricScore {
    /// Name in JSON and CSV.
    pub key: &'static str,
    /// Name for a person.
    pub title: &'static str,
    /// Unit of all values; empty for a ratio.
    pub unit: &'static str,
    /// Mean over the plays.
    pub mean: f64,
    /// 95 % interval of the mean over plays like these; absent with a single play.
    pub interval: Option<[f64; 2]>,
    /// What a person notices; absent where it is not known.
    pub human: Option<Human>,
}

impl Metric {
    /// A metric without a unit, of which nothing is known that a person notices.
    const fn new(key: &'static str, title: &'static str, value: fn(&Fidelity) -> f64) -> Self {
        Self { key, title, unit: "", factor: 1.0, value, human: || None }
    }

    /// Name in JSON and CSV.
    pub(super) fn key(&self) -> &'static str {
        self.key
    }

    /// The number of a play, in the metric's unit.
    pub(super) fn of(&self, fidelity: &Fidelity) -> f64 {
        self.factor * (self.value)(fidelity)
    }

    /// The number over plays; `None` without a play in which it exists.
    pub(super) fn score(&self, plays: &[Fidelity]) -> Option<MetricScore> {
        let values = plays.iter().map(|play| self.of(play));
        let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let variance = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0);
        let half = STANDARD_ERRORS * (variance / count).sqrt();
        (count > 0.0).then(|| MetricScore {
            key: self.key,
            title: self.title,
            unit: self.unit,
            mean,
            interval: (count > 1.0).then_some([mean - half, mean + half]),
            human: (self.human)(),
        })
    }
}

pub(super) const METRICS: [Metric; 11] = [
    Metric::new("error_below_40_hz", "error below 40 Hz", |fidelity| fidelity.error_below_40_hz),
    Metric::new("correlation_below_40_hz", "correlation below 40 Hz", |fidelity| fidelity.correlation_below_40_hz),
    Metric {
        unit: "Weber fractions",
        human: || Some(Human { value: 1.0, meaning: "smallest step felt (doi:10.1098/rsif.2017.0641)" }),
        ..Metric::new("error_weber", "error", |fidelity| fidelity.error_weber)
    },
    Metric {
        unit: "dB",
        ..Metric::new("snr_below_40_hz_db", "signal to noise below 40 Hz", |fidelity| fidelity.snr_below_40_hz_db)
    },
    Metric {
        unit: "dB",
        ..Metric::new("snr_above_40_hz_db", "signal to noise, 40 to 400 Hz", |fidelity| fidelity.snr_above_40_hz_db)
    },
    Metric {
        unit: "Weber steps",
        human: || {
            Some(Human { value: weber_steps_safe(), meaning: "felt by everyone in the studies (ln 1.27 / ln 1.11)" })
        },
        ..Metric::new("contrast_weber_steps", "contrast felt", |fidelity| fidelity.contrast_weber_steps)
    },
    Metric::new("contrast_kept", "contrast kept", |fidelity| fidelity.contrast_kept),
    Metric {
        unit: "ms",
        human: || Some(Human { value: 50.0, meaning: "largest recommended (doi:10.1145/2611387: 5 to 50 ms)" }),
        ..Metric::new("delay_ms", "delay", |fidelity| fidelity.delay_ms)
    },
    Metric {
        unit: "mm",
        human: || {
            Some(Human { value: 1.0, meaning: "spatial resolution of a fingertip, 1 to 2 mm (Basdogan's review)" })
        },
        ..Metric::new("delay_mm", "delay", |fidelity| fidelity.delay_mm)
    },
    Metric::new("peak_rate_kept", "peak dF/dt kept", |fidelity| fidelity.peak_rate_kept),
    Metric {
        unit: "mN rms",
        factor: 1e3,
        human: || {
            let meaning = "a finger's own noise there (one finger, romangrigorii/data-driven-playback)";
            // A decade of noise that falls as 1/f has half of the power of the two decades that were measured.
            Some(Human { value: 1e3 * NATURAL_NOISE_RMS_N * FRAC_1_SQRT_2, meaning })
        },
        ..Metric::new("spurious_40_to_400_hz_mn", "spurious force, 40 to 400 Hz", |fidelity| {
            fidelity.spurious_40_to_400_hz_n
        })
    },
];
