//! Specification of a board's amplifier.

/// The high-voltage amplifier of a board: its bandwidth, its switching times, and the meaning of its ready line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmplifierSpec {
    /// Time constant of the amplifier's output, before the series resistor, in s. 0 for an amplifier that is much
    /// faster than a tick.
    pub time_constant_s: f32,
    /// Longest time from the rise of the enable until the output follows the DAC.
    pub turn_on: SwitchingTime,
    /// Longest time from the fall of the enable until the output is at 0 V.
    pub turn_off: SwitchingTime,
    /// Level of the ready line while the amplifier is disabled.
    pub ready_while_disabled: ReadyWhileDisabled,
}

/// The level of an amplifier's ready line while the amplifier is disabled. While it is enabled, the line is high.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadyWhileDisabled {
    /// High unless there is a fault: a low line is a fault in every state of the board.
    High,
    /// Low: a low line is a fault only while the amplifier is enabled, and a high line is a fault once it is off.
    Low,
    /// Any level: a low line is a fault only while the amplifier is enabled.
    DontCare,
}

/// Switching time of an amplifier, at most [`SwitchingTime::MAX_S`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwitchingTime(f32);

impl SwitchingTime {
    /// Longest time that a board may state, in s. While an amplifier switches, the supervisor only compares its output
    /// with a ceiling. A startled hand takes 100 ms to let go, so 2 ms add little to a shock. Amplifiers with an enable
    /// input take from 10 us to 1 ms (assumed, from the parts required by `docs/board/hardware.md`).
    pub const MAX_S: f32 = 2e-3;

    /// A time in s.
    ///
    /// # Panics
    ///
    /// If it is below 0, above [`Self::MAX_S`] or not a number. Use it in a constant, where that fails to compile:
    ///
    /// ```
    /// use frixel_control::SwitchingTime;
    ///
    /// const TURN_OFF: SwitchingTime = SwitchingTime::from_s(1e-3);
    /// ```
    ///
    /// ```compile_fail
    /// # use frixel_control::SwitchingTime;
    /// const TURN_OFF: SwitchingTime = SwitchingTime::from_s(3e-3);
    /// ```
    #[must_use]
    pub const fn from_s(time_s: f32) -> Self {
        assert!(time_s >= 0.0 && time_s <= Self::MAX_S, "an amplifier must switch within 2 ms");
        Self(time_s)
    }

    /// This time in ticks, rounded up.
    pub(crate) fn ticks(self, tick_hz: u32) -> u32 {
        let ticks = self.0 * tick_hz as f32;
        let whole = ticks as u32;
        // Do not round up a product that exceeds a whole number only by a rounding error.
        whole + u32::from(ticks - whole as f32 > 1e-3)
    }
}

#[cfg(test)]
mod tests {
    use super::SwitchingTime;

    #[test]
    fn a_switching_time_covers_every_tick_that_it_touches() {
        for (time_s, tick_hz, ticks) in [
            (0.0, 40_000, 0),
            (1e-6, 40_000, 1),
            (25e-6, 40_000, 1),
            (26e-6, 40_000, 2),
            (1e-3, 40_000, 40),
            (2e-3, 10_000, 20),
        ] {
            assert_eq!(SwitchingTime::from_s(time_s).ticks(tick_hz), ticks, "{time_s} s at {tick_hz} Hz");
        }
    }

    #[test]
    #[should_panic(expected = "an amplifier must switch within 2 ms")]
    fn a_switching_time_that_is_not_a_number_is_refused() {
        let _ = SwitchingTime::from_s(f32::NAN);
    }
}
