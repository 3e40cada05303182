//! The finger's way between two samples: the estimator's parabola by forward differences, so that a tick needs additions
//! only.

/// Where the finger is taken to be, one tick after another.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Motion {
    /// Way since `start`, in m: small, so that it may be summed up thousands of times.
    offset_m: [f32; 2],
    /// Way until the next tick, in m.
    step_m: [f32; 2],
    /// What is added to the step at every tick, in m.
    step_change_m: [f32; 2],
    /// Place when the last sample was taken in, in m.
    start_m: [f32; 2],
}

impl Motion {
    /// A finger that stays where it is.
    pub(crate) const fn resting_at(start_m: [f32; 2]) -> Self {
        Self { offset_m: [0.0; 2], step_m: [0.0; 2], step_change_m: [0.0; 2], start_m }
    }

    /// A finger that is at a place, and on its way with a velocity and half an acceleration.
    pub(crate) fn new(
        start_m: [f32; 2],
        velocity_m_per_s: [f32; 2],
        half_acceleration_m_per_s2: [f32; 2],
        tick_period_s: f32,
    ) -> Self {
        let square_change_m = half_acceleration_m_per_s2.map(|half| half * tick_period_s * tick_period_s);
        let [x_m, y_m] = velocity_m_per_s.map(|velocity| velocity * tick_period_s);
        let [change_x_m, change_y_m] = square_change_m;
        Self {
            offset_m: [0.0; 2],
            step_m: [x_m + change_x_m, y_m + change_y_m],
            step_change_m: square_change_m.map(|change| 2.0 * change),
            start_m,
        }
    }

    /// Goes on by a tick.
    #[inline]
    pub(crate) fn advance(&mut self) {
        let [x_m, y_m] = self.offset_m;
        let [step_x_m, step_y_m] = self.step_m;
        let [change_x_m, change_y_m] = self.step_change_m;
        self.offset_m = [x_m + step_x_m, y_m + step_y_m];
        self.step_m = [step_x_m + change_x_m, step_y_m + change_y_m];
    }

    /// Where the finger is now, in m.
    #[inline]
    pub(crate) fn place_m(&self) -> [f32; 2] {
        let [x_m, y_m] = self.offset_m;
        let [start_x_m, start_y_m] = self.start_m;
        [start_x_m + x_m, start_y_m + y_m]
    }
}
