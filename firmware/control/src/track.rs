//! The finger between two touch reports: its position as a parabola in time, and the ramp of the friction at
//! standstill.

/// The estimated path of a finger from one touch report to the next.
///
/// The tracker makes a track from every report with new data; the tick only reads it. The tick computes position and
/// gain from the ticks since [`Self::from_tick`]. No error accumulates, and a late track is as accurate as a timely
/// one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Track {
    /// Number of the contact between finger and screen. If it differs from the previous track's, the finger was lifted
    /// in between.
    pub contact: u32,
    /// Tick at which the track begins: the arrival of its report or, for a scene without prediction, the measurement of
    /// its position.
    pub from_tick: u32,
    /// The track is invalid from this tick on.
    pub until_tick: u32,
    /// Place at `from_tick`, in m from the screen's left and top edge.
    pub place_m: [f32; 2],
    /// Rate of the place at `from_tick`, in m/s. It differs from the finger's velocity by a correction that leads
    /// the place from the previous track to the new estimate, so that the place does not jump at a report.
    pub path_velocity_m_per_s: [f32; 2],
    /// Half the acceleration of the place, in m/s^2.
    pub path_half_acceleration_m_per_s2: [f32; 2],
    /// The finger's velocity at `from_tick`, in m/s.
    pub velocity_m_per_s: [f32; 2],
    /// Half the finger's acceleration, in m/s^2.
    pub half_acceleration_m_per_s2: [f32; 2],
    /// Gain on the friction, ramped down while the finger stands still.
    pub ramp: StandstillRamp,
}

impl Track {
    /// Seconds from `from_tick` to `tick`, given the tick period.
    #[inline]
    pub fn elapsed_s(&self, tick: u32, tick_period_s: f32) -> f32 {
        tick.wrapping_sub(self.from_tick) as i32 as f32 * tick_period_s
    }

    /// Place after a time, in m.
    #[inline]
    pub fn place_m(&self, elapsed_s: f32) -> [f32; 2] {
        let ([x, y], [vx, vy], [ax, ay]) =
            (self.place_m, self.path_velocity_m_per_s, self.path_half_acceleration_m_per_s2);
        [x + elapsed_s * (vx + elapsed_s * ax), y + elapsed_s * (vy + elapsed_s * ay)]
    }

    /// Gain on the friction, from 0 to 1. It falls by `fall_per_tick` per tick to zero at the end, where the touch data
    /// is stale.
    #[inline]
    pub fn gain_before_end(&self, tick: u32, fall_per_tick: f32) -> f32 {
        let gain = fall_per_tick * self.until_tick.wrapping_sub(tick) as f32;
        if gain < 1.0 { gain } else { 1.0 }
    }

    /// Velocity after a time, in m/s.
    #[inline]
    pub fn velocity_m_per_s(&self, elapsed_s: f32) -> [f32; 2] {
        let ([vx, vy], [ax, ay]) = (self.velocity_m_per_s, self.half_acceleration_m_per_s2);
        let twice_s = elapsed_s + elapsed_s;
        [vx + twice_s * ax, vy + twice_s * ay]
    }
}

/// A gain that changes by the same step every tick and is clamped to the range from 0 to 1.
///
/// A ramp may begin in the future: until then, a gain of 1 that will fall, or of 0 that will rise, stays constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandstillRamp {
    /// Tick at which the gain is `gain`.
    pub from_tick: u32,
    /// From 0 to 1.
    pub gain: f32,
    /// Change of the gain in a tick.
    pub slope_per_tick: f32,
}

impl StandstillRamp {
    /// The gain of a finger that moves.
    pub const MOVING: Self = Self { from_tick: 0, gain: 1.0, slope_per_tick: 0.0 };

    /// The gain at a tick, from 0 to 1.
    #[inline]
    pub fn gain_at(&self, tick: u32) -> f32 {
        let ticks = tick.wrapping_sub(self.from_tick) as i32;
        let gain = self.gain + self.slope_per_tick * ticks as f32;
        if gain > 1.0 {
            1.0
        } else if gain > 0.0 {
            gain
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRACK: Track = Track {
        contact: 1,
        from_tick: u32::MAX - 100,
        until_tick: 1_100,
        place_m: [0.01, 0.02],
        path_velocity_m_per_s: [0.1, -0.2],
        path_half_acceleration_m_per_s2: [0.5, 0.8],
        velocity_m_per_s: [0.3, 0.4],
        half_acceleration_m_per_s2: [-0.5, 2.0],
        ramp: StandstillRamp::MOVING,
    };

    fn assert_close(found: f32, expected: f32) {
        assert!((found - expected).abs() < 1e-6, "{found} is not {expected}");
    }

    #[test]
    fn place_and_velocity_follow_a_parabola_while_the_tick_counter_wraps() {
        let elapsed_s = TRACK.elapsed_s(TRACK.from_tick.wrapping_add(400), 25e-6);
        assert_close(elapsed_s, 0.01);
        let [x_m, y_m] = TRACK.place_m(elapsed_s);
        assert_close(x_m, 0.01 + 0.1 * 0.01 + 0.5 * 1e-4);
        assert_close(y_m, 0.02 - 0.2 * 0.01 + 0.8 * 1e-4);
        let [vx, vy] = TRACK.velocity_m_per_s(elapsed_s);
        assert_close(vx, 0.3 - 2.0 * 0.5 * 0.01);
        assert_close(vy, 0.4 + 2.0 * 2.0 * 0.01);
        assert_close(TRACK.elapsed_s(TRACK.from_tick.wrapping_sub(40), 25e-6), -1e-3);
    }

    #[test]
    fn a_ramp_stays_within_0_and_1_on_both_sides_of_its_beginning() {
        let from_tick = u32::MAX - 10;
        let down = StandstillRamp { from_tick, gain: 1.0, slope_per_tick: -0.01 };
        let up = StandstillRamp { from_tick, gain: 0.25, slope_per_tick: 0.01 };
        for (ticks, expected_down, expected_up) in
            [(-5000, 1.0, 0.0), (-1, 1.0, 0.24), (0, 1.0, 0.25), (50, 0.5, 0.75), (99, 0.01, 1.0), (5000, 0.0, 1.0)]
        {
            let tick = from_tick.wrapping_add_signed(ticks);
            assert_close(down.gain_at(tick), expected_down);
            assert_close(up.gain_at(tick), expected_up);
        }
        assert_close(StandstillRamp::MOVING.gain_at(from_tick), 1.0);
    }
}
