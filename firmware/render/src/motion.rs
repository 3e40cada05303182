//! The finger's way between two samples: the estimator's parabola by forward differences, so that a tick needs additions
//! only.

use crate::estimator::Estimate;

/// Where the finger is taken to be along one axis, one tick after another.
///
/// Every addition rounds to 7.5e-9 m at most on screens up to 0.25 m: over three report periods of 10 ms that is less
/// than 10 um, and as little as the place itself is known.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Motion {
    place_m: f32,
    /// Way until the next tick, in m.
    step_m: f32,
    /// What is added to the step at every tick, in m.
    step_change_m: f32,
}

impl Motion {
    /// A finger that stays where it is.
    pub(crate) const fn resting_at(place_m: f32) -> Self {
        Self { place_m, step_m: 0.0, step_change_m: 0.0 }
    }

    /// A finger that goes on as it was estimated.
    pub(crate) fn of(estimate: &Estimate, tick_period_s: f32) -> Self {
        let square_change_m = estimate.half_acceleration_m_per_s2 * tick_period_s * tick_period_s;
        Self {
            place_m: estimate.place_m,
            step_m: estimate.velocity_m_per_s * tick_period_s + square_change_m,
            step_change_m: 2.0 * square_change_m,
        }
    }

    /// Goes on by a tick.
    #[inline]
    pub(crate) fn advance(&mut self) {
        self.place_m += self.step_m;
        self.step_m += self.step_change_m;
    }

    /// Where the finger is now, in m.
    #[inline]
    pub(crate) fn place_m(&self) -> f32 {
        self.place_m
    }
}
