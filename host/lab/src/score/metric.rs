//! The numbers of a score, and what a person notices of them.

use std::f64::consts::FRAC_1_SQRT_2;

use frixel_felt::fidelity::Fidelity;
use frixel_felt::perception::{NATURAL_NOISE_RMS_N, weber_steps_safe};
use serde::Serialize;

/// Number of standard errors on either side of a mean in its 95 % interval, by the number of independent values less
/// one: Student's t, from 1 to 10.
const STANDARD_ERRORS: [f64; 10] = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228];

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
    /// Mean over the people, or over the strokes of the scene's finger, of the mean over the plays of each.
    pub mean: f64,
    /// 95 % interval of the mean over people, or strokes, like these; absent with a single one.
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

    /// The number over groups of plays, each independent of the others; `None` without a play in which it exists.
    pub(super) fn score(&self, groups: &[Vec<Fidelity>]) -> Option<MetricScore> {
        let mean_of = |group: &Vec<Fidelity>| {
            let values: Vec<f64> = group.iter().map(|play| self.of(play)).filter(|value| value.is_finite()).collect();
            (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
        };
        let values: Vec<f64> = groups.iter().filter_map(mean_of).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let variance = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0);
        let half = standard_errors(values.len()) * (variance / count).sqrt();
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

/// Half of the 95 % interval of a mean of so many values, in standard errors.
fn standard_errors(count: usize) -> f64 {
    let freedom = count.saturating_sub(1);
    // Beyond the table, the first terms of the expansion about the normal distribution, to 0.2 %.
    let expanded = |freedom: usize| 1.96 + 2.372 / freedom as f64 + 2.8 / (freedom * freedom) as f64;
    freedom
        .checked_sub(1)
        .and_then(|index| STANDARD_ERRORS.get(index).copied())
        .unwrap_or_else(|| expanded(freedom.max(1)))
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

#[cfg(test)]
mod tests {
    use super::*;

    fn plays(errors: &[f64]) -> Vec<Fidelity> {
        let play = |error: &f64| Fidelity { error_below_40_hz: *error, ..Fidelity::default() };
        errors.iter().map(play).collect()
    }

    /// Seeds of a stroke that are all alike say as much as one.
    #[test]
    fn the_stroke_is_the_unit_of_an_interval() {
        let score = |groups: &[Vec<Fidelity>]| METRICS[0].score(groups).unwrap();
        let once = score(&[plays(&[0.1]), plays(&[0.3])]);
        let often = score(&[plays(&[0.1; 20]), plays(&[0.3; 20])]);
        assert!((once.mean - 0.2).abs() < 1e-12 && (often.mean - 0.2).abs() < 1e-12);
        // The mean of two has a standard error of 0.1, and t is 12.7.
        let [low, high] = often.interval.unwrap();
        assert!((high - low - 2.0 * 12.706 * 0.1).abs() < 1e-9, "{low} to {high}");
        assert_eq!(score(&[plays(&[0.1; 20])]).interval, None);
    }

    #[test]
    fn students_t_has_no_step_at_the_end_of_its_table() {
        let true_values = [(12, 2.201), (21, 2.086), (31, 2.042), (101, 1.984)];
        for (count, t) in true_values {
            assert!((standard_errors(count) / t - 1.0).abs() < 2e-3, "{count}: {}", standard_errors(count));
        }
    }
}
