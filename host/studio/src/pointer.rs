//! The finger between the samples of a pointer.
//!
//! A pointer reports its place some hundred times a second, or not at all while it rests. The finger of the simulated
//! world needs a place at every tick. It is interpolated between samples and never extrapolated, so a sample has to be
//! here before its tick: the caller adds a delay to the time of each sample, and says so.

use std::collections::VecDeque;

/// A sample that is late is moved so many ticks into the future, so that the finger does not jump.
const LATE_TICKS: f64 = 200.0;
/// Samples that are stored at most; a caller that sends more has stopped the clock.
const SAMPLES_MAX: usize = 4_096;

/// A sample of a pointer, at the tick at which the finger is to be there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PointerSample {
    /// Tick, with its fraction.
    pub(crate) tick: f64,
    /// Place from the screen's top left corner, m.
    pub(crate) place_m: [f64; 2],
    /// Whether the finger is on the screen.
    pub(crate) is_down: bool,
    /// Normal load, N; `None` for that of the finger's profile.
    pub(crate) normal_load_n: Option<f64>,
}

/// The finger at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Finger {
    /// Place from the screen's top left corner, m.
    pub(crate) place_m: [f64; 2],
    /// Speed, m a tick.
    pub(crate) speed_m_per_tick: f64,
    /// Normal load, N; `None` for that of the finger's profile.
    pub(crate) normal_load_n: Option<f64>,
}

/// Interpolates a pointer's samples.
///
/// Between two samples the finger follows a cubic whose velocities at both ends are the mean slopes of the samples
/// around them (a Catmull-Rom spline), so that its velocity does not jump either. When the last sample has passed, the
/// finger rests there.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pointer {
    /// Where the current segment began, and its velocity there, m a tick; `None` while the finger is up.
    start: Option<(PointerSample, [f64; 2])>,
    ahead: VecDeque<PointerSample>,
}

impl Pointer {
    /// Adds a sample. `now_tick` is the current tick.
    pub(crate) fn add(&mut self, sample: PointerSample, now_tick: f64) {
        let after = self.ahead.back().map_or(now_tick, |last| last.tick);
        let earliest = if self.ahead.is_empty() { now_tick + LATE_TICKS } else { after + 1.0 };
        if self.ahead.is_empty() {
            // The finger has rested up to now: the new segment begins here.
            if let Some((start, velocity)) = &mut self.start {
                (start.tick, *velocity) = (now_tick, [0.0; 2]);
            }
        }
        if self.ahead.len() < SAMPLES_MAX {
            self.ahead.push_back(PointerSample { tick: sample.tick.max(earliest), ..sample });
        }
    }

    /// Lifts the finger, and forgets the samples ahead.
    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }

    /// The finger at a tick, which is not before that of the last call; `None` while it is up.
    pub(crate) fn at(&mut self, tick: f64) -> Option<Finger> {
        while let Some(passed) = self.ahead.pop_front_if(|sample| sample.tick <= tick) {
            self.pass(passed);
        }
        let (start, velocity) = self.start?;
        let Some(end) = self.ahead.front().filter(|end| end.is_down) else {
            return Some(Finger { place_m: start.place_m, speed_m_per_tick: 0.0, normal_load_n: start.normal_load_n });
        };
        let end_velocity = self.end_velocity(&start, end);
        let span = end.tick - start.tick;
        let t = ((tick - start.tick) / span).clamp(0.0, 1.0);
        let along = |axis: usize| {
            let points = (start.place_m[axis], end.place_m[axis]);
            hermite(points, (velocity[axis] * span, end_velocity[axis] * span), t)
        };
        let [(x_m, x_slope), (y_m, y_slope)] = [along(0), along(1)];
        let load = |from: f64, to: f64| from + t * (to - from);
        Some(Finger {
            place_m: [x_m, y_m],
            speed_m_per_tick: (x_slope * x_slope + y_slope * y_slope).sqrt() / span,
            normal_load_n: start.normal_load_n.zip(end.normal_load_n).map(|(from, to)| load(from, to)),
        })
    }

    /// Takes a sample that has been passed as the start of the next segment.
    fn pass(&mut self, sample: PointerSample) {
        let velocity = match (&self.start, self.ahead.front().filter(|next| next.is_down)) {
            (Some((start, _)), _) => self.end_velocity(start, &sample),
            (None, Some(next)) => slope(&sample, next),
            (None, None) => [0.0; 2],
        };
        self.start = sample.is_down.then_some((sample, velocity));
    }

    /// Velocity at `end`, m a tick: the mean slope from `start` to the sample behind `end`, or zero where the finger
    /// rests or lifts.
    fn end_velocity(&self, start: &PointerSample, end: &PointerSample) -> [f64; 2] {
        let next = self.ahead.iter().find(|sample| sample.tick > end.tick && sample.is_down);
        let Some(next) = next.filter(|_| end.is_down) else { return slope(start, end) };
        let (before, behind) = (slope(start, end), slope(end, next));
        let share = (end.tick - start.tick) / (next.tick - start.tick);
        // The slope over the shorter span counts more.
        [0, 1].map(|axis| (1.0 - share) * before[axis] + share * behind[axis])
    }
}

fn slope(from: &PointerSample, to: &PointerSample) -> [f64; 2] {
    [0, 1].map(|axis| (to.place_m[axis] - from.place_m[axis]) / (to.tick - from.tick))
}

/// The cubic between two values with two slopes, at `t` from 0 to 1, and its slope there.
fn hermite((from, to): (f64, f64), (slope_from, slope_to): (f64, f64), t: f64) -> (f64, f64) {
    let rise = to - from;
    // Horner's form of the cubic with the given values and slopes at 0 and 1.
    let (c3, c2) = (slope_from + slope_to - 2.0 * rise, 3.0 * rise - 2.0 * slope_from - slope_to);
    (from + t * (slope_from + t * (c2 + t * c3)), slope_from + t * (2.0 * c2 + t * 3.0 * c3))
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "a place that is passed on unchanged is equal")]
mod tests {
    use super::*;

    fn sample(tick: f64, x_m: f64) -> PointerSample {
        PointerSample { tick, place_m: [x_m, 0.03], is_down: true, normal_load_n: None }
    }

    /// Samples every 16 ms of a slide of 100 mm/s: 64 mm in 25,600 ticks of 25 us.
    fn slide() -> Pointer {
        let mut pointer = Pointer::default();
        for number in 0..40 {
            let tick = 1_000.0 + 640.0 * f64::from(number);
            pointer.add(sample(tick, 0.01 + 1.6e-3 * f64::from(number)), 0.0);
        }
        pointer
    }

    #[test]
    fn an_even_slide_has_its_speed_at_every_tick() {
        let mut pointer = slide();
        assert_eq!(pointer.at(999.0), None);
        for tick in (1_000..1_000 + 38 * 640).step_by(7) {
            let finger = pointer.at(f64::from(tick)).unwrap();
            let x_m = 0.01 + 2.5e-6 * f64::from(tick - 1_000);
            assert!((finger.place_m[0] - x_m).abs() < 1e-12, "{tick}: {finger:?}");
            assert!((finger.speed_m_per_tick - 2.5e-6).abs() < 1e-12, "{tick}: {finger:?}");
        }
    }

    #[test]
    fn the_finger_passes_every_sample_and_never_jumps() {
        let mut pointer = Pointer::default();
        for (number, x_mm) in [10.0, 11.0, 14.0, 14.5, 12.0, 12.0, 30.0].into_iter().enumerate() {
            pointer.add(sample(1_000.0 + 500.0 * number as f64, 1e-3 * x_mm), 0.0);
        }
        let mut last = pointer.at(1_000.0).unwrap();
        assert!((last.place_m[0] - 0.01).abs() < 1e-15);
        for tick in 1_001..=4_000 {
            let finger = pointer.at(f64::from(tick)).unwrap();
            let step_m = (finger.place_m[0] - last.place_m[0]).abs();
            let speeds = finger.speed_m_per_tick.max(last.speed_m_per_tick);
            assert!(step_m <= 1.01 * speeds + 1e-12, "{tick}: {step_m} m in a tick at {speeds}");
            if tick == 2_500 {
                assert!((finger.place_m[0] - 0.0145).abs() < 1e-12, "{finger:?}");
            }
            last = finger;
        }
    }

    #[test]
    fn a_pointer_that_rests_is_held_where_it_is() {
        let mut pointer = slide();
        let end = pointer.at(1e6).unwrap();
        assert_eq!((end.place_m[0], end.speed_m_per_tick), (0.01 + 1.6e-3 * 39.0, 0.0));
        // It goes on from there when it moves again, and not from when it was last seen.
        pointer.add(sample(1e6 + 400.0, 0.08), 1e6 + 10.0);
        let just_after = pointer.at(1e6 + 11.0).unwrap();
        assert!((just_after.place_m[0] - end.place_m[0]).abs() < 1e-4, "{just_after:?}");
        assert!((pointer.at(1e6 + 400.0).unwrap().place_m[0] - 0.08).abs() < 1e-12);
    }

    #[test]
    fn a_late_sample_moves_the_finger_over_time() {
        let mut pointer = slide();
        let before = pointer.at(1e6).unwrap();
        pointer.add(sample(500_000.0, 0.01), 1e6);
        let after = pointer.at(1e6 + 1.0).unwrap();
        assert!((after.place_m[0] - before.place_m[0]).abs() < 1e-3);
        assert_eq!(pointer.at(1e6 + LATE_TICKS).unwrap().place_m[0], 0.01);
    }

    #[test]
    fn a_lift_takes_the_finger_away_where_it_was() {
        let mut pointer = slide();
        pointer.add(PointerSample { is_down: false, ..sample(30_000.0, 0.074) }, 0.0);
        assert!(pointer.at(29_999.0).is_some());
        assert_eq!(pointer.at(30_000.0), None);
        pointer.add(sample(40_000.0, 0.05), 39_000.0);
        assert_eq!(pointer.at(39_999.0), None, "nothing leads from a lift to a touch");
        assert_eq!(pointer.at(40_000.0).unwrap().place_m[0], 0.05);
    }

    #[test]
    fn a_load_is_interpolated_where_both_samples_state_one() {
        let mut pointer = Pointer::default();
        let load = |tick: f64, load_n: f64| PointerSample { normal_load_n: Some(load_n), ..sample(tick, 0.01) };
        pointer.add(load(1_000.0, 0.4), 0.0);
        pointer.add(load(1_500.0, 0.8), 0.0);
        assert!((pointer.at(1_250.0).unwrap().normal_load_n.unwrap() - 0.6).abs() < 1e-12);
    }
}
