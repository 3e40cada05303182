//! Sliding direction of a finger, and its landings and turns.

use frixel_hil_sim::{FingerState, RELAXATION_LENGTH_M, one_minus_exp};

/// Fraction of its full pull against the motion from which on the skin counts as turned.
const TURNED: f64 = 0.95;

/// Direction of the skin's pull. It follows the direction of motion over the relaxation length, so that friction
/// against the motion is smaller, or negative, after a finger lands or turns.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turning {
    /// A unit vector in steady sliding.
    pull: [f64; 2],
    place_m: Option<[f64; 2]>,
    /// Direction of the last step; zeros before the first one.
    direction: [f64; 2],
}

impl Turning {
    /// Moves the finger. Returns whether its skin does not yet pull against its motion.
    pub(super) fn follow(&mut self, finger: Option<FingerState>) -> bool {
        let Some(FingerState { x_m, y_m, .. }) = finger else {
            *self = Self::default();
            return true;
        };
        let Some([from_x_m, from_y_m]) = self.place_m.replace([x_m, y_m]) else { return true };
        let step = [x_m - from_x_m, y_m - from_y_m];
        let step_m = length(step);
        if step_m <= 0.0 {
            return length(self.pull) < TURNED;
        }
        // Same as `direction_of` in `frixel_scene::reference`, with a known length.
        self.direction = step.map(|part_m| part_m / step_m);
        let share = one_minus_exp(step_m / RELAXATION_LENGTH_M);
        for (pull, direction) in self.pull.iter_mut().zip(self.direction) {
            *pull += share * (direction - *pull);
        }
        let along: f64 = self.pull.iter().zip(self.direction).map(|(pull, direction)| pull * direction).sum();
        along < TURNED
    }

    /// Direction of the last motion, a unit vector; zeros for a finger that has not moved since it landed.
    pub(super) fn direction(&self) -> [f64; 2] {
        self.direction
    }
}

/// Length of a vector. Steps of a finger are far above the lengths whose squares vanish.
fn length([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finger_turns_for_some_relaxation_lengths() {
        let mut turning = Turning::default();
        let mut at =
            |x_um: i32| turning.follow(Some(FingerState { x_m: 1e-6 * f64::from(x_um), ..FingerState::default() }));
        // 1 - e^-3 and 1 - 2 e^-3.7 are 0.95; the relaxation length is 11.5 um.
        let there: Vec<bool> = (0..100).map(&mut at).collect();
        assert_eq!(there.iter().filter(|turning| **turning).count(), 35);
        let back: Vec<bool> = (0..99).rev().map(&mut at).collect();
        assert_eq!(back.iter().filter(|turning| **turning).count(), 42);
        assert!(!at(0), "a finger that rests after it has slid has turned");
        assert!(turning.direction()[0] <= -1.0, "and has the direction of its slide");
        assert!(turning.follow(None));
        assert!(turning.direction()[0].abs() <= 0.0, "a lifted finger has none");
    }
}
