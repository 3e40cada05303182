//! The filters that are compared, each from reports to the path of the finger until the next one.

use frixel_hil_sim::TouchReport;

/// The path of a finger from a time on: a parabola, and what leads on from the path before.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Path {
    from_s: f64,
    place_m: [f64; 2],
    velocity_m_per_s: [f64; 2],
    half_acceleration_m_per_s2: [f64; 2],
}

impl Path {
    pub(super) fn place_m(&self, time_s: f64) -> [f64; 2] {
        let t = time_s - self.from_s;
        let motion = self.velocity_m_per_s.iter().zip(self.half_acceleration_m_per_s2);
        let mut places = self.place_m;
        for (place, (velocity, half_acceleration)) in places.iter_mut().zip(motion) {
            *place += t * (velocity + t * half_acceleration);
        }
        places
    }

    /// The same path, but from where `before` is at a time; the difference is gone after 1.5 intervals.
    fn led_from(mut self, before: Option<Path>, now_s: f64, interval_s: f64) -> Self {
        let Some(before) = before else { return self };
        let here = Self { from_s: now_s, place_m: self.place_m(now_s), ..self };
        let t = now_s - self.from_s;
        self = here;
        let blend_s = 1.5 * interval_s;
        for (axis, from_m) in before.place_m(now_s).into_iter().enumerate() {
            let (Some(place), Some(velocity), Some(half_acceleration)) = (
                self.place_m.get_mut(axis),
                self.velocity_m_per_s.get_mut(axis),
                self.half_acceleration_m_per_s2.get_mut(axis),
            ) else {
                continue;
            };
            let difference_m = from_m - *place;
            *place = from_m;
            *velocity += 2.0 * t * *half_acceleration - 2.0 * difference_m / blend_s;
            *half_acceleration += difference_m / (blend_s * blend_s);
        }
        self
    }
}

/// Follows a finger.
pub(in super::super) trait Filter {
    /// Takes a report that has arrived; `None` if it says nothing new.
    fn take(&mut self, report: &TouchReport) -> Option<Path>;
}

/// A filter with its name, made for a report rate in Hz.
pub(in super::super) struct Method {
    pub(in super::super) name: &'static str,
    pub(in super::super) make: fn(f64) -> Box<dyn Filter>,
}

/// The filters of the chart, that of the board last.
pub(in super::super) fn methods() -> [Method; 6] {
    [
        Method { name: "g-h-k filter (the board's before)", make: |hz| Box::new(Fading::new(2, 0.65, hz)) },
        Method { name: "alpha-beta filter", make: |hz| Box::new(Fading::new(1, 0.5, hz)) },
        // White acceleration: one that is forgotten within a millisecond.
        Method { name: "Kalman, random velocity", make: |_| Box::new(Kalman::fixed(1e-3, 10.0)) },
        Method { name: "Kalman, random acceleration", make: |_| Box::new(Kalman::fixed(0.04, 1.0)) },
        Method { name: "interacting models", make: |_| Box::new(Interacting::new()) },
        Method { name: "Kalman, by speed, no jumps (the board's)", make: |hz| Box::new(Kalman::of_board(hz)) },
    ]
}

/// Filters with fixed tunings, of which the best is chosen with hindsight.
pub(in super::super) fn best_of_grid() -> impl Iterator<Item = impl Fn() -> Box<dyn Filter>> {
    [0.1, 0.3, 1.0, 3.0, 10.0].into_iter().flat_map(|deviation| {
        [0.02, 0.05, 0.1].map(|time_s| move || -> Box<dyn Filter> { Box::new(Kalman::fixed(time_s, deviation)) })
    })
}

/// A fading-memory polynomial filter of degree 1 (alpha-beta) or 2 (g-h-k), with gains of its own for every sample.
struct Fading {
    degree: u32,
    fading: f64,
    step_min_s: f64,
    samples: u32,
    sampled_s: f64,
    axes: [[f64; 3]; 2],
}

impl Fading {
    fn new(degree: u32, fading: f64, rate_hz: f64) -> Self {
        let step_min_s = 0.25 / rate_hz;
        Self { degree, fading, step_min_s, samples: 0, sampled_s: 0.0, axes: [[0.0; 3]; 2] }
    }

    /// Parts of the residual that go to place, velocity and half the acceleration, per step.
    fn gains(&self) -> [f64; 3] {
        let (n, rest, fading) = (f64::from(self.samples), 1.0 - self.fading, self.fading);
        let steady = if self.degree == 2 {
            [1.0 - fading.powi(3), 1.5 * rest * rest * (1.0 + fading), 0.5 * rest.powi(3)]
        } else {
            [1.0 - fading * fading, rest * rest, 0.0]
        };
        let d = (n + 1.0) * (n + 2.0);
        let growing = if self.samples < 3 || self.degree == 1 {
            [2.0 * (2.0 * n + 1.0) / d, 6.0 / d, 0.0]
        } else {
            let d = d * (n + 3.0);
            [3.0 * (3.0 * n * n + 3.0 * n + 2.0) / d, 18.0 * (2.0 * n + 1.0) / d, 30.0 / d]
        };
        if growing[0] > steady[0] { growing } else { steady }
    }
}

impl Filter for Fading {
    fn take(&mut self, report: &TouchReport) -> Option<Path> {
        let (mut step_s, mut gains) = (0.0, [1.0, 0.0, 0.0]);
        if self.samples > 0 {
            step_s = report.sampled_s - self.sampled_s;
            if step_s <= 0.0 {
                return None;
            }
            let per_s = 1.0 / step_s.max(self.step_min_s);
            let [place, velocity, half_acceleration] = self.gains();
            gains = [place, velocity * per_s, half_acceleration * per_s * per_s];
        }
        self.samples += 1;
        self.sampled_s = report.sampled_s;
        for ([place, velocity, half_acceleration], measured) in self.axes.iter_mut().zip(report.place_m) {
            *place += step_s * (*velocity + step_s * *half_acceleration);
            *velocity += 2.0 * step_s * *half_acceleration;
            let residual = measured - *place;
            *place += gains[0] * residual;
            *velocity += gains[1] * residual;
            *half_acceleration += gains[2] * residual;
        }
        Some(path(self.sampled_s, self.axes))
    }
}

fn path(from_s: f64, [x, y]: [[f64; 3]; 2]) -> Path {
    Path { from_s, place_m: [x[0], y[0]], velocity_m_per_s: [x[1], y[1]], half_acceleration_m_per_s2: [x[2], y[2]] }
}

/// Standard deviation of a measured place, in m.
const MEASURED_M: f64 = 0.05e-3;

type Vector = [f64; 3];
type Matrix = [Vector; 3];

/// Place, velocity and acceleration along two axes with one covariance, in SI units.
#[derive(Clone, Copy)]
struct Belief {
    axes: [Vector; 2],
    covariance: Matrix,
}

impl Belief {
    fn first(place_m: [f64; 2], deviation: f64) -> Self {
        let mut covariance = [[0.0; 3]; 3];
        covariance[0][0] = MEASURED_M * MEASURED_M;
        covariance[1][1] = 0.3 * 0.3;
        covariance[2][2] = deviation * deviation;
        Self { axes: place_m.map(|place| [place, 0.0, 0.0]), covariance }
    }

    /// Singer's model: an acceleration with a standard deviation, forgotten with a time constant.
    fn advance(&mut self, t: f64, time_s: f64, deviation: f64) {
        let remainder = (-t / time_s).exp();
        let transition: Matrix = [
            [1.0, t, time_s * (t - time_s * (1.0 - remainder))],
            [0.0, 1.0, time_s * (1.0 - remainder)],
            [0.0, 0.0, remainder],
        ];
        self.axes = self.axes.map(|axis| transition.map(|row| (0..3).map(|i| row[i] * axis[i]).sum()));
        let half = transition.map(|row| [0, 1, 2].map(|j| (0..3).map(|k| row[k] * self.covariance[k][j]).sum::<f64>()));
        let gained = deviation * deviation * (1.0 - remainder * remainder);
        // The gained variance as white noise over the step.
        let white: Matrix = [
            [t.powi(4) / 20.0, t.powi(3) / 8.0, t * t / 6.0],
            [t.powi(3) / 8.0, t * t / 3.0, t / 2.0],
            [t * t / 6.0, t / 2.0, 1.0],
        ];
        for (i, row) in self.covariance.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = (0..3).map(|k| half[i][k] * transition[j][k]).sum::<f64>() + gained * white[i][j];
            }
        }
    }

    /// Takes a measured place. Returns how likely it was.
    fn correct(&mut self, place_m: [f64; 2], measured_m: f64) -> f64 {
        let variance = self.covariance[0][0] + measured_m * measured_m;
        let first_row = self.covariance[0];
        let gains = first_row.map(|entry| entry / variance);
        let mut squares = 0.0;
        for (axis, place) in self.axes.iter_mut().zip(place_m) {
            let residual = place - axis[0];
            squares += residual * residual;
            for (value, gain) in axis.iter_mut().zip(gains) {
                *value += gain * residual;
            }
        }
        for (row, gain) in self.covariance.iter_mut().zip(gains) {
            for (entry, first) in row.iter_mut().zip(first_row) {
                *entry -= gain * first;
            }
        }
        (-0.5 * squares / variance).exp() / variance
    }

    fn path(&self, from_s: f64) -> Path {
        path(from_s, self.axes.map(|[place, velocity, acceleration]| [place, velocity, 0.5 * acceleration]))
    }
}

/// A Kalman filter of random acceleration.
struct Kalman {
    time_s: f64,
    deviation: f64,
    /// What a unit of recent speed adds to the deviation, in 1/s, and to that of the place, in s.
    by_speed: [f64; 2],
    /// Time between reports if paths lead on from each other, and bunched reports count as lost.
    leads_on_s: Option<f64>,
    state: KalmanState,
    /// The state before the last report.
    before: KalmanState,
    last: Option<Path>,
}

#[derive(Clone, Copy)]
struct KalmanState {
    belief: Option<Belief>,
    recent_m_per_s: f64,
    sampled_s: f64,
    samples: u32,
}

impl Kalman {
    fn fixed(time_s: f64, deviation: f64) -> Self {
        let state = KalmanState { belief: None, recent_m_per_s: 0.0, sampled_s: 0.0, samples: 0 };
        Self { time_s, deviation, by_speed: [0.0; 2], leads_on_s: None, state, before: state, last: None }
    }

    /// The constants of `firmware/session/src/motion/estimator.rs` and `tracker.rs`.
    fn of_board(rate_hz: f64) -> Self {
        Self { by_speed: [8.0, 0.04 / rate_hz], leads_on_s: Some(1.0 / rate_hz), ..Self::fixed(0.04, 0.3) }
    }
}

impl Filter for Kalman {
    fn take(&mut self, report: &TouchReport) -> Option<Path> {
        let is_bunched =
            |interval_s| self.state.samples > 0 && report.sampled_s - self.state.sampled_s < 0.25 * interval_s;
        if self.leads_on_s.is_some_and(is_bunched) {
            self.state = self.before;
        }
        self.before = self.state;
        let state = &mut self.state;
        let step_s = report.sampled_s - state.sampled_s;
        let Some(belief) = &mut state.belief else {
            state.belief = Some(Belief::first(report.place_m, self.deviation));
            (state.sampled_s, state.samples) = (report.sampled_s, 1);
            return state.belief.map(|belief| belief.path(report.sampled_s));
        };
        if step_s <= 0.0 {
            return None;
        }
        state.sampled_s = report.sampled_s;
        state.recent_m_per_s *= 0.5 / (0.5 + step_s);
        let [deviation_per_speed, place_per_speed] = self.by_speed;
        belief.advance(step_s, self.time_s, self.deviation + deviation_per_speed * state.recent_m_per_s);
        belief.correct(report.place_m, MEASURED_M.hypot(place_per_speed * state.recent_m_per_s));
        let [[_, x, _], [_, y, _]] = belief.axes;
        state.recent_m_per_s = state.recent_m_per_s.max(x.hypot(y));
        state.samples += 1;
        let mut path = belief.path(report.sampled_s);
        if let Some(interval_s) = self.leads_on_s
            && state.samples > 2
        {
            path = path.led_from(self.last, report.arrived_s, interval_s);
        }
        self.last = Some(path);
        self.last
    }
}

/// Interacting multiple models (Blom and Bar-Shalom, doi:10.1109/9.1299): three Kalman filters of different
/// accelerations, weighted by how well they foresee the reports.
struct Interacting {
    beliefs: Option<[Belief; 3]>,
    weights: Vector,
    sampled_s: f64,
}

const DEVIATIONS: Vector = [0.3, 1.0, 4.0];
/// Probability that a finger keeps its model from one report to the next.
const STAYS: f64 = 0.95;

impl Interacting {
    fn new() -> Self {
        Self { beliefs: None, weights: [1.0 / 3.0; 3], sampled_s: 0.0 }
    }

    /// Mixture of beliefs with weights, and their spread.
    fn mixed(beliefs: &[Belief; 3], weights: Vector) -> Belief {
        let mut mixed = Belief { axes: [[0.0; 3]; 2], covariance: [[0.0; 3]; 3] };
        for (belief, weight) in beliefs.iter().zip(weights) {
            for (sum, axis) in mixed.axes.iter_mut().zip(belief.axes) {
                *sum = [0, 1, 2].map(|i| sum[i] + weight * axis[i]);
            }
        }
        let means = mixed.axes;
        for (belief, weight) in beliefs.iter().zip(weights) {
            let [x, y] = [0, 1].map(|axis| [0, 1, 2].map(|i| belief.axes[axis][i] - means[axis][i]));
            for (i, row) in mixed.covariance.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry += weight * (belief.covariance[i][j] + 0.5 * (x[i] * x[j] + y[i] * y[j]));
                }
            }
        }
        mixed
    }
}

impl Filter for Interacting {
    fn take(&mut self, report: &TouchReport) -> Option<Path> {
        let step_s = report.sampled_s - self.sampled_s;
        let Some(before) = self.beliefs else {
            let beliefs = DEVIATIONS.map(|deviation| Belief::first(report.place_m, deviation));
            self.beliefs = Some(beliefs);
            self.sampled_s = report.sampled_s;
            return Some(beliefs[0].path(report.sampled_s));
        };
        if step_s <= 0.0 {
            return None;
        }
        self.sampled_s = report.sampled_s;
        let changes = |from: usize, to: usize| if from == to { STAYS } else { 0.5 * (1.0 - STAYS) };
        let expected = [0, 1, 2].map(|to| (0..3).map(|from| changes(from, to) * self.weights[from]).sum::<f64>());
        let mut likely = [0.0; 3];
        let beliefs = [0, 1, 2].map(|to| {
            let from = [0, 1, 2].map(|from| changes(from, to) * self.weights[from] / expected[to]);
            let mut belief = Self::mixed(&before, from);
            belief.advance(step_s, 0.05, DEVIATIONS[to]);
            likely[to] = expected[to] * belief.correct(report.place_m, MEASURED_M).max(1e-30);
            belief
        });
        let sum: f64 = likely.iter().sum();
        self.weights = likely.map(|weight| weight / sum);
        self.beliefs = Some(beliefs);
        Some(Self::mixed(&beliefs, self.weights).path(report.sampled_s))
    }
}
