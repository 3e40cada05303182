//! What keeps a finger from feeling a change of friction that would be strong enough.

use frixel_hil_sim::TouchConfig;
use frixel_layers::Burst;
use serde::Serialize;

use super::thresholds::TEXTURE_MIN_HZ;
use super::{Step, USUAL_M_PER_S, Verdict};

/// The smallest distance that a fingertip resolves, mm: 1 to 2 mm (Basdogan's review, second hand).
const FINGERTIP_MM: f64 = 2.0;
/// Reports that a touch source has to make while a finger of [`CROSSING_MM_PER_S`] crosses an element. Computed with the
/// simulated sources, and assumed of others: more than four fifths of the Weber steps of a bar of that width come
/// through (`docs/touch.md`).
const REPORTS_MIN: f64 = 5.0;
/// The speed of that finger, mm/s.
const CROSSING_MM_PER_S: f64 = 100.0;
/// How long a finger is on an element, s: a slower change, and a burst that comes less often, is missed by some strokes.
/// Assumed.
const TOUCH_S: f64 = 1.0;
/// A shorter pulse is not felt, s: the period of 500 Hz, the highest frequency with a threshold. Assumed.
const PULSE_MIN_S: f64 = 2e-3;

/// What keeps a finger from feeling a change of friction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "reason")]
pub enum Obstacle {
    /// The element is too small.
    TooSmall {
        /// The smallest size that is large enough, mm: its width where its friction is halfway.
        least_mm: f64,
        /// What takes part of the change.
        limit: SizeLimit,
        /// What comes through, in Weber steps; absent for a texture.
        #[serde(skip_serializing_if = "Option::is_none")]
        weber_steps: Option<f64>,
    },
    /// The friction changes too slowly.
    TooSlow {
        /// The longest way that counts as one change, mm.
        way_mm: f64,
        /// The largest change over that way, in Weber steps.
        weber_steps: f64,
    },
    /// A change in time is faster than what counts as a step.
    TooFast {
        /// Its frequency, Hz.
        frequency_hz: f64,
        /// The frequency from which a change counts as a texture, Hz.
        most_hz: f64,
    },
    /// A burst or a click is too short.
    TooShort {
        /// Its duration, ms.
        duration_ms: f64,
        /// The shortest one that is felt, ms.
        least_ms: f64,
    },
    /// A touch may fall between two bursts.
    TooRare {
        /// The pause between two bursts, ms.
        pause_ms: f64,
        /// How long a touch lasts, ms.
        touch_ms: f64,
    },
}

/// What keeps a finger from feeling something, and how sure a verdict can be in spite of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hindrance {
    pub(super) most: Verdict,
    pub(super) obstacle: Obstacle,
}

impl Hindrance {
    /// What is left of a verdict, and the obstacle if that is less.
    pub(super) fn apply(self, verdict: Verdict) -> Option<(Verdict, Option<Obstacle>)> {
        (self.most.sureness() < verdict.sureness()).then_some((self.most, Some(self.obstacle)))
    }
}

/// What sets the smallest size of an element.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SizeLimit {
    /// A fingertip.
    Fingertip,
    /// A touch source with so many reports a second.
    TouchSource {
        /// Reports a second.
        reports_hz: f64,
    },
}

/// The smallest size that a touch source plays in place and a fingertip resolves.
#[derive(Clone, Copy, Debug)]
pub(super) struct SmallestSize {
    size_m: f64,
    limit: SizeLimit,
}

impl SmallestSize {
    pub(super) fn of(touch: &TouchConfig) -> Self {
        let source_mm = REPORTS_MIN * CROSSING_MM_PER_S / touch.rate_hz;
        let (size_mm, limit) = if source_mm > FINGERTIP_MM {
            (source_mm, SizeLimit::TouchSource { reports_hz: touch.rate_hz })
        } else {
            (FINGERTIP_MM, SizeLimit::Fingertip)
        };
        Self { size_m: 1e-3 * size_mm, limit }
    }

    /// In metres.
    pub(super) fn size_m(&self) -> f64 {
        self.size_m
    }

    /// What keeps a finger from feeling a step, of which only `met` comes through.
    pub(super) fn of_step(&self, met: &Step) -> Hindrance {
        let weber_steps = met.weber_steps.abs();
        Hindrance { most: Verdict::of_step(weber_steps), obstacle: self.obstacle(Some(weber_steps)) }
    }

    /// What keeps a finger from feeling what happens within an element that is nowhere larger than `extent_m`: less
    /// than half of the smallest size is too small for it, and less than the whole is near the threshold at best.
    pub(super) fn of_extent(&self, extent_m: f64) -> Option<Hindrance> {
        let most = match extent_m / self.size_m {
            part if part < 0.5 => Verdict::NotFelt,
            part if part < 1.0 => Verdict::NearThreshold,
            _ => return None,
        };
        Some(Hindrance { most, obstacle: self.obstacle(None) })
    }

    fn obstacle(&self, weber_steps: Option<f64>) -> Obstacle {
        Obstacle::TooSmall { least_mm: 1e3 * self.size_m, limit: self.limit, weber_steps }
    }

    /// What keeps a finger from feeling the contrast of the friction along a slide at the usual speed, averaged over the
    /// smallest size.
    pub(super) fn of_slide(&self, friction_n: &[f64], sample_hz: f64) -> Hindrance {
        let box_samples = (self.size_m / USUAL_M_PER_S * sample_hz).round() as usize;
        self.of_step(&largest_change(&averaged(friction_n, box_samples), sample_hz))
    }
}

/// What keeps a finger from feeling the contrast of the friction along a slide at the usual speed as one change.
pub(super) fn of_slope(friction_n: &[f64], sample_hz: f64) -> Hindrance {
    let Step { weber_steps, verdict, .. } = largest_change(friction_n, sample_hz);
    Hindrance { most: verdict, obstacle: Obstacle::TooSlow { way_mm: 1e3 * USUAL_M_PER_S * TOUCH_S, weber_steps } }
}

/// What keeps a finger from feeling a vibration as steps.
pub(super) fn of_frequency(frequency_hz: f64) -> Option<Hindrance> {
    let obstacle = Obstacle::TooFast { frequency_hz, most_hz: TEXTURE_MIN_HZ };
    (frequency_hz >= TEXTURE_MIN_HZ).then_some(Hindrance { most: Verdict::NotFelt, obstacle })
}

/// What keeps a finger from feeling a pulse, such as a click.
pub(super) fn of_pulse(duration_s: f64) -> Option<Hindrance> {
    let obstacle = Obstacle::TooShort { duration_ms: 1e3 * duration_s, least_ms: 1e3 * PULSE_MIN_S };
    (duration_s < PULSE_MIN_S).then_some(Hindrance { most: Verdict::NotFelt, obstacle })
}

/// What keeps a finger from feeling bursts. A program starts those that are `triggered`, when it wants them felt.
pub(super) fn of_bursts(burst: &Burst, triggered: bool) -> Option<Hindrance> {
    let [on_s, period_s] = [burst.on_s, burst.period_s].map(f64::from);
    if period_s <= 0.0 {
        return None;
    }
    let pause_s = period_s - on_s;
    let obstacle = Obstacle::TooRare { pause_ms: 1e3 * pause_s, touch_ms: 1e3 * TOUCH_S };
    let rare = (pause_s > TOUCH_S && !triggered).then_some(Hindrance { most: Verdict::NearThreshold, obstacle });
    of_pulse(on_s).or(rare)
}

/// The largest change over a way that counts as one, of the friction along a slide at the usual speed.
fn largest_change(friction_n: &[f64], sample_hz: f64) -> Step {
    // Samples of a stretch of which least and largest friction are taken: 0.5 mm, or one.
    let stretch = ((0.5e-3 / USUAL_M_PER_S * sample_hz) as usize).max(1);
    let stretches_of_way = (TOUCH_S * sample_hz) as usize / stretch;
    let stretches: Vec<[f64; 2]> = friction_n.chunks(stretch).map(range_n).collect();
    let ways = stretches.windows(stretches_of_way.min(stretches.len()).max(1));
    let changes = ways.map(|way| {
        let [least_n, most_n] = range_n(way.as_flattened());
        Step::new(least_n, most_n)
    });
    changes.max_by(|one, other| one.weber_steps.total_cmp(&other.weber_steps)).unwrap_or(Step::new(1.0, 1.0))
}

/// Means over so many values, or over all if they are fewer.
fn averaged(values: &[f64], count: usize) -> Vec<f64> {
    let count = count.clamp(1, values.len().max(1));
    let mut sums = vec![0.0];
    sums.extend(values.iter().scan(0.0, |sum, value| {
        *sum += value;
        Some(*sum)
    }));
    sums.iter().zip(sums.iter().skip(count)).map(|(from, to)| (to - from) / count as f64).collect()
}

/// The least and the largest of some frictions, N.
fn range_n(friction_n: &[f64]) -> [f64; 2] {
    friction_n
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[least_n, most_n], now_n| [least_n.min(*now_n), most_n.max(*now_n)])
}

#[cfg(test)]
mod tests {
    use super::super::SAMPLE_HZ;
    use super::*;

    const HUNDRED: SmallestSize = SmallestSize { size_m: 5e-3, limit: SizeLimit::TouchSource { reports_hz: 100.0 } };
    const SAMPLES_OF_MM: usize = (1e-3 / USUAL_M_PER_S * SAMPLE_HZ) as usize;

    fn bar(width_mm: usize) -> Vec<f64> {
        let bare = vec![0.25; 20 * SAMPLES_OF_MM];
        [bare.clone(), vec![0.367; width_mm * SAMPLES_OF_MM], bare].concat()
    }

    #[test]
    fn the_smallest_size_is_that_of_the_source_or_of_the_fingertip() {
        let least_um = |rate_hz| {
            let smallest = SmallestSize::of(&TouchConfig { rate_hz, ..TouchConfig::REALISTIC });
            (1e6 * smallest.size_m()).round() as u32
        };
        assert_eq!([100.0, 200.0, 500.0].map(least_um), [5000, 2500, 2000]);
    }

    #[test]
    fn a_bar_is_met_as_far_as_it_is_wide() {
        let contrast = Step::new(0.25, 0.367);
        for (width_mm, verdict) in
            [(1, Verdict::NotFelt), (2, Verdict::NearThreshold), (4, Verdict::Felt), (8, Verdict::Felt)]
        {
            let met = contrast.behind(Some(HUNDRED.of_slide(&bar(width_mm), SAMPLE_HZ)));
            assert_eq!((met.verdict, met.weber_steps), (verdict, contrast.weber_steps), "{width_mm} mm");
            assert_eq!(met.obstacle.is_some(), verdict != Verdict::Felt, "{met:?}");
        }
    }

    #[test]
    fn a_change_counts_as_far_as_it_happens_during_a_touch() {
        let line = |way_mm: usize| -> Vec<f64> {
            let count = way_mm * SAMPLES_OF_MM;
            (0..count).map(|number| 0.25 + 0.1 * number as f64 / count as f64).collect()
        };
        let contrast = Step::new(0.25, 0.35);
        let met = contrast.behind(Some(of_slope(&line(200), SAMPLE_HZ)));
        let Some(Obstacle::TooSlow { weber_steps, .. }) = met.obstacle else { panic!("{met:?}") };
        // The steepest part, in Weber steps, is the first one.
        assert!((weber_steps / Step::new(0.25, 0.275).weber_steps - 1.0).abs() < 0.02, "{weber_steps}");
        assert_eq!(met.verdict, Verdict::NotFelt);
        assert_eq!(contrast.behind(Some(of_slope(&line(45), SAMPLE_HZ))).obstacle, None);
        assert_eq!(of_slope(&[], SAMPLE_HZ).most, Verdict::NotFelt);
    }

    #[test]
    fn short_and_rare_bursts_are_hindered() {
        let verdict = |on_s, period_s, triggered| {
            of_bursts(&Burst { on_s, period_s, ramp_s: 0.0 }, triggered).map(|hindrance| hindrance.most)
        };
        assert_eq!(verdict(1e-3, 60.0, false), Some(Verdict::NotFelt));
        assert_eq!(verdict(0.1, 5.0, false), Some(Verdict::NearThreshold));
        assert_eq!(verdict(0.1, 5.0, true), None);
        assert_eq!(verdict(0.1, 1.0, false), None);
        assert_eq!(verdict(0.0, 0.0, false), None, "a vibration without bursts");
        assert_eq!(of_pulse(1e-4).map(|hindrance| hindrance.most), Some(Verdict::NotFelt));
        assert!(of_pulse(5e-3).is_none());
    }
}
