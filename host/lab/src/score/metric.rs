//! The numbers of a score, with perception thresholds and goals.

use std::f64::consts::FRAC_1_SQRT_2;

use frixel_felt::fidelity::{Fidelity, Goal};
use frixel_felt::judge::{NATURAL_NOISE_RMS_N, weber_steps_safe};
use serde::Serialize;

use crate::bootstrap::{Draws, Z_95};

/// Draws of the bootstrap of an interval.
const DRAWS: usize = 2000;
/// Seed of the draws: the same score has the same intervals.
const SEED: u64 = 1;

/// A number of [`Fidelity`].
pub(super) struct Metric {
    /// Name in JSON and CSV.
    pub(super) key: &'static str,
    title: &'static str,
    unit: &'static str,
    /// Factor from SI units to `unit`.
    factor: f64,
    value: fn(&Fidelity) -> Option<f64>,
    human: fn() -> Option<Human>,
    goal: Option<GoalBound>,
}

/// A perception threshold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Human {
    /// The threshold from which a person notices it, in the metric's unit.
    pub value: f64,
    /// Definition, with its source.
    pub meaning: &'static str,
}

/// Goal for a display: a number of [`Goal::SLOW`].
///
/// It is for features that are as large as its touch source needs, and for strokes with a median speed of at most 100
/// mm/s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum GoalBound {
    /// The number must not be larger.
    AtMost(f64),
    /// The number must not be smaller.
    AtLeast(f64),
}

impl GoalBound {
    /// Whether a value is within the limit.
    pub fn is_met_by(self, value: f64) -> bool {
        match self {
            Self::AtMost(limit) => value <= limit,
            Self::AtLeast(limit) => value >= limit,
        }
    }
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
    /// 95 % interval of the mean over people, or strokes, like these, by bootstrap: it contains no value that none of
    /// them had. Absent with a single one.
    pub interval: Option<[f64; 2]>,
    /// Perception threshold; absent where it is unknown.
    pub human: Option<Human>,
    /// Goal for a display, if there is one.
    pub goal: Option<GoalBound>,
}

impl Metric {
    /// A metric without a unit, of which nothing is known that a person notices, and without a goal.
    const fn new(key: &'static str, title: &'static str, value: fn(&Fidelity) -> Option<f64>) -> Self {
        Self { key, title, unit: "", factor: 1.0, value, human: || None, goal: None }
    }

    /// The number of a play, in the metric's unit; `None` where it does not exist.
    pub(super) fn of(&self, fidelity: &Fidelity) -> Option<f64> {
        (self.value)(fidelity).map(|value| self.factor * value)
    }

    /// The number over groups of plays, each independent of the others; `None` without a play in which it exists.
    pub(super) fn score(&self, groups: &[Vec<Fidelity>]) -> Option<MetricScore> {
        let values: Vec<f64> =
            groups.iter().filter_map(|group| mean(group.iter().filter_map(|play| self.of(play)))).collect();
        Some(MetricScore {
            key: self.key,
            title: self.title,
            unit: self.unit,
            mean: mean(values.iter().copied())?,
            interval: interval(&values),
            human: (self.human)(),
            goal: self.goal,
        })
    }
}

/// Mean; `None` without values.
fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mean = crate::statistics::mean(values);
    mean.is_finite().then_some(mean)
}

/// 95 % interval of the mean of independent values; `None` of a single one.
pub(crate) fn interval(values: &[f64]) -> Option<[f64; 2]> {
    if values.len() < 2 {
        return None;
    }
    let mut draws = Draws::new(&vec![(); values.len()], SEED);
    let drawn =
        (0..DRAWS).filter_map(|_| mean(draws.draw().into_iter().filter_map(|index| values.get(index).copied())));
    let mut means: Vec<f64> = drawn.collect();
    let (low, high) = draws.interval(&mut means, Z_95);
    Some([low, high])
}

/// The keys of all numbers.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn metric_keys() -> impl Iterator<Item = &'static str> {
    METRICS.iter().map(|metric| metric.key)
}

pub(super) const METRICS: [Metric; 14] = [
    Metric {
        goal: Some(GoalBound::AtMost(Goal::SLOW.error_max)),
        ..Metric::new("error", "error, 0 to 400 Hz", |fidelity| fidelity.error)
    },
    Metric {
        goal: Some(GoalBound::AtLeast(Goal::SLOW.correlation_min)),
        ..Metric::new("correlation", "correlation, 0 to 400 Hz", |fidelity| fidelity.correlation)
    },
    Metric::new("error_below_40_hz", "error below 40 Hz", |fidelity| fidelity.error_below_40_hz),
    Metric::new("correlation_below_40_hz", "correlation below 40 Hz", |fidelity| fidelity.correlation_below_40_hz),
    Metric {
        unit: "Weber fractions",
        human: || Some(Human { value: 1.0, meaning: "smallest step felt (doi:10.1098/rsif.2017.0641)" }),
        ..Metric::new("error_weber", "error", |fidelity| Some(fidelity.error_weber))
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
        human: || Some(Human { value: weber_steps_safe(), meaning: "felt by everyone in the studies" }),
        ..Metric::new("contrast_weber_steps", "contrast felt", |fidelity| Some(fidelity.contrast_weber_steps))
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
            Some(fidelity.spurious_40_to_400_hz_n)
        })
    },
    Metric {
        unit: "dB",
        goal: Some(GoalBound::AtMost(Goal::SLOW.spurious_over_noise_max_db)),
        ..Metric::new("spurious_over_noise_db", "worst third octave of it", |fidelity| fidelity.spurious_over_noise_db)
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    fn plays(errors: &[f64]) -> Vec<Fidelity> {
        let play = |error: &f64| Fidelity { correlation: Some(*error), ..Fidelity::default() };
        errors.iter().map(play).collect()
    }

    fn correlation(groups: &[Vec<Fidelity>]) -> MetricScore {
        METRICS[1].score(groups).unwrap()
    }

    /// Seeds of a stroke that are all alike say as much as one.
    #[test]
    fn the_stroke_is_the_unit_of_an_interval() {
        let once = correlation(&[plays(&[0.1]), plays(&[0.3])]);
        let often = correlation(&[plays(&[0.1; 20]), plays(&[0.3; 20])]);
        assert!((once.mean - 0.2).abs() < 1e-12 && (often.mean - 0.2).abs() < 1e-12);
        let ends = once.interval.unwrap().into_iter().zip(often.interval.unwrap());
        assert!(ends.into_iter().all(|(one, other)| (one - other).abs() < 1e-12));
        assert_eq!(correlation(&[plays(&[0.1; 20])]).interval, None);
    }

    /// Two strokes tell little of others, and yet no correlation is above 1.
    #[test]
    fn an_interval_stays_within_the_values_of_the_strokes() {
        let [low, high] = correlation(&[plays(&[0.4]), plays(&[1.0])]).interval.unwrap();
        assert!((low - 0.4).abs() < 1e-12 && (high - 1.0).abs() < 1e-12, "{low} to {high}");
    }

    #[test]
    fn an_interval_of_many_strokes_is_two_standard_errors_wide_on_either_side() {
        let values: Vec<Vec<Fidelity>> = (0..100).map(|number| plays(&[f64::from(number) / 99.0])).collect();
        let [low, high] = correlation(&values).interval.unwrap();
        let standard_error = (1.0_f64 / 12.0).sqrt() / 10.0;
        assert!(((high - low) / (2.0 * 1.984 * standard_error) - 1.0).abs() < 0.1, "{low} to {high}");
    }

    #[test]
    fn a_play_without_a_number_is_not_in_its_mean() {
        let absent = Fidelity::default();
        assert!((correlation(&[vec![absent], plays(&[0.5])]).mean - 0.5).abs() < 1e-12);
        assert_eq!(METRICS[1].score(&[vec![absent]]), None);
    }
}
