//! Pre-sliding state: friction follows its steady value over a distance, in the direction of motion.

/// Distance in newtons below which a part of the friction is set to its target. Otherwise the decay would reach
/// subnormal numbers, which are slow and never become zero.
const SETTLED_N: f64 = 1e-15;
/// Largest exponent for which `1 - e^-a` is computed by a Padé approximant, with an error of 4e-8 at 1 and 5e-12 at
/// 0.35.
const PADE_UP_TO: f64 = 0.35;

/// Motion of the skin in a tick, for models that follow the same finger, such as a reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipStep {
    /// Fraction of the distance to its steady value that friction covered in the tick, from 0 to 1: `1 - e^(-v T / L)`.
    pub share: f64,
    /// Unit vector of the motion's direction. Always `[1, 0]` without pre-sliding.
    pub direction: [f64; 2],
    /// Ratio of the electric friction at this tick's load to that at the profile's load, at the same voltage.
    pub electric_gain: f64,
}

impl SlipStep {
    /// A finger that does not move, under the load of the profile.
    pub(super) const REST: Self = Self { share: 0.0, direction: [1.0, 0.0], electric_gain: 1.0 };

    /// Advances a friction force in the screen's plane to the end of the tick, by Dahl's law `dF/ds = (F_steady e - F)
    /// / L` along the direction `e` of the motion. Returns its component against the motion.
    ///
    /// In steady sliding this is a first-order lag with the cutoff `v / (2 pi L)`.
    pub fn advance(&self, friction_n: &mut [f64; 2], steady_n: f64) -> f64 {
        let [x_n, y_n] = friction_n;
        let [x, y] = self.direction;
        *x_n = approach(*x_n, x * steady_n, self.share);
        *y_n = approach(*y_n, y * steady_n, self.share);
        x * *x_n + y * *y_n
    }
}

fn approach(now_n: f64, target_n: f64, share: f64) -> f64 {
    let distance_n = target_n - now_n;
    if distance_n.abs() < SETTLED_N { target_n } else { now_n + share * distance_n }
}

/// The motion of a finger over its screen, tick by tick.
#[derive(Clone, Debug)]
pub(super) struct Sliding {
    tick_period_s: f64,
    /// `1 / L`; `None` if friction has its steady value at once.
    per_length: Option<f64>,
    /// Whether the direction of the motion is taken into account.
    is_directed: bool,
    place_m: Option<[f64; 2]>,
    direction: [f64; 2],
    speed_m_per_s: f64,
    share: f64,
}

impl Sliding {
    pub(super) fn new(relaxation_length_m: f64, is_directed: bool, tick_hz: u32) -> Self {
        let per_length = (relaxation_length_m > 0.0).then(|| 1.0 / relaxation_length_m);
        Self {
            tick_period_s: 1.0 / f64::from(tick_hz),
            per_length,
            is_directed,
            place_m: None,
            direction: [1.0, 0.0],
            speed_m_per_s: 0.0,
            share: if per_length.is_some() { 0.0 } else { 1.0 },
        }
    }

    /// Moves the finger to a place, at a speed. Returns the fraction of the distance covered by friction, and the
    /// direction.
    pub(super) fn to(&mut self, place_m: [f64; 2], speed_m_per_s: f64) -> (f64, [f64; 2]) {
        if self.is_directed {
            self.turn_towards(place_m);
        }
        if let Some(per_length) = self.per_length
            && speed_m_per_s.to_bits() != self.speed_m_per_s.to_bits()
        {
            self.speed_m_per_s = speed_m_per_s;
            self.share = one_minus_exp(speed_m_per_s * self.tick_period_s * per_length);
        }
        (self.share, self.direction)
    }

    /// Resets the state when the finger leaves the screen.
    pub(super) fn lift(&mut self) {
        self.place_m = None;
    }

    fn turn_towards(&mut self, place_m: [f64; 2]) {
        let [x_m, y_m] = place_m;
        if let Some([from_x_m, from_y_m]) = self.place_m.replace(place_m) {
            let (x_step_m, y_step_m) = (x_m - from_x_m, y_m - from_y_m);
            let square = x_step_m * x_step_m + y_step_m * y_step_m;
            if square > 0.0 {
                let per_length = 1.0 / square.sqrt();
                self.direction = [x_step_m * per_length, y_step_m * per_length];
            }
        }
    }
}

/// `1 - e^-a` for `a >= 0`: the fraction covered after `a` relaxation lengths. Its error is at most 5e-12.
pub fn one_minus_exp(a: f64) -> f64 {
    if a < PADE_UP_TO {
        // Padé approximant [4/4] of e^-a.
        let square = a * a;
        let odd = a * (840.0 + 20.0 * square);
        let even = 1680.0 + square * (180.0 + square);
        2.0 * odd / (even + odd)
    } else {
        -libm::expm1(-a)
    }
}

#[cfg(test)]
mod tests {
    use super::one_minus_exp;

    #[test]
    fn the_quotient_is_the_exponential() {
        for step in 0..4000 {
            let a = 1e-3 * f64::from(step);
            let expected = -libm::expm1(-a);
            assert!((one_minus_exp(a) - expected).abs() <= 1e-11 * expected, "{a}");
        }
    }
}
