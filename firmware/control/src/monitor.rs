//! Compares the amplifier's monitor with the driven voltage.
//!
//! A board latches the code of a tick at the end of that tick's period, and reads the monitor at the beginning of a
//! period. The reading in a tick thus shows the codes up to the tick before the last one, each held for a whole tick.
//!
//! | state of the amplifier | correct reading |
//! |---|---|
//! | enabled | a voltage near the expected one |
//! | enabled for less than its turn-on time | up to the ceiling: the larger of its initial and the driven voltage |
//! | disabled for less than its turn-off time | up to the ceiling, and not above an earlier reading |
//! | disabled | a voltage near zero |
//!
//! A wrong voltage after the enable has fallen is an immediate fault, and so is one that is not near zero at the end of
//! the turn-off time. Otherwise, wrong ticks are counted, so that a single disturbed reading does not stop the output.
//!
//! The tolerance of a single tick includes an offset, which hides any gain error at a low voltage. [`Gain`] sums
//! correct ticks over whole periods of the carrier, where the offset cancels.

mod gain;

use crate::{Board, ReadyWhileDisabled};
use gain::Gain;

/// Tolerance of the monitor voltage, as a fraction of full scale, in addition to [`GAIN_TOLERANCE`]. It covers offsets
/// of amplifier, level shifter and ADC (assumed, not measured).
const FLOOR: f32 = 0.04;
/// Tolerance as a fraction of a constant voltage. It covers gain errors of the same parts (the amplifier's is specified
/// as 5 %), a deviation of the amplifier's speed from its specification, and the 2 us for which the newest code is out
/// when the monitor is read.
const GAIN_TOLERANCE: f32 = 0.25;
/// The monitor faults once wrong ticks exceed a third of the correct ones by the ticks in this time, in s. It is long
/// compared with a disturbed reading. If the monitor is wrong in every tick, the output is off within 0.5 ms at
/// 40 kHz, including the ticks to detect a wrong voltage and to output zero.
const WRONG_S: f32 = 0.4e-3;
/// Correct ticks that compensate one wrong tick. A DAC that holds its last code is correct in every other half period
/// of a square carrier: it is found after three times that time, or in the first half period longer than that. A
/// healthy amplifier has no wrong ticks.
const RIGHT_PER_WRONG: u32 = 3;
/// Two wrong samples of the ready line within this time, in s, are a fault. A single one may be a disturbance of an
/// opto-isolator or a level shifter at an edge of hundreds of volts (assumed). A line that stays wrong is detected in
/// the next tick.
const READY_S: f32 = 1e-3;
/// Ticks between an edge of the enable and the first reading that shows it for a whole tick, plus one for an edge
/// anywhere within its tick.
const EDGE_TICKS: u32 = 2;

/// The expected monitor voltage, and the count of ticks at which the monitor read something else.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MonitorCheck {
    /// Expected reading of the monitor in the next tick.
    expected_v: f32,
    volts_per_code: f32,
    step: f32,
    /// Half of [`GAIN_TOLERANCE`], for the sum of the expected and the newest voltage. Stored here because the compiler
    /// would hold a constant in a register over the whole tick.
    half_gain_tolerance: f32,
    floor_v: f32,
    /// Equal to `floor_v`; minus infinity while every tick has to be [counted](Self::count).
    uncounted_below_v: f32,
    /// The last reading.
    monitor_v: f32,
    is_enabled: bool,
    /// Ticks for which the amplifier may still be switching on or off.
    switching_ticks: u32,
    /// Largest magnitude of a reading while the amplifier switches; zero when it has switched.
    ceiling_v: f32,
    /// [`RIGHT_PER_WRONG`] for each wrong tick, minus one for each correct one.
    wrong_count: u32,
    wrong_count_max: u32,
    turn_on_ticks: u32,
    turn_off_ticks: u32,
    ready_while_disabled: ReadyWhileDisabled,
    ready_ticks: u32,
    /// Ticks in which another wrong sample of the ready line is a fault.
    ready_left_ticks: u32,
    gain: Gain,
}

/// A reading of the monitor and the expected voltage.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Comparison {
    expected_v: f32,
    /// The driven code, for most of the tick, one tick after that of the reading.
    driven_code: i16,
    deviation_v: f32,
    gain_tolerance_v: f32,
}

impl Comparison {
    /// Whether the reading is within tolerance; `false` if it is not a number.
    #[inline]
    fn is_within(self, floor_v: f32) -> bool {
        self.deviation_v.abs() < floor_v + self.gain_tolerance_v
    }
}

impl MonitorCheck {
    pub(crate) fn new(board: &Board) -> Self {
        let floor_v = FLOOR * board.limits.full_scale_v_peak;
        let amplifier = &board.amplifier;
        let mut check = Self {
            expected_v: 0.0,
            volts_per_code: board.limits.full_scale_v_peak / f32::from(i16::MAX),
            step: lag_step(board.tick_period_s() / amplifier.time_constant_s),
            half_gain_tolerance: 0.5 * GAIN_TOLERANCE,
            floor_v,
            uncounted_below_v: floor_v,
            monitor_v: 0.0,
            is_enabled: false,
            switching_ticks: 0,
            ceiling_v: 0.0,
            wrong_count: 0,
            wrong_count_max: RIGHT_PER_WRONG * board.ticks(WRONG_S).max(1),
            turn_on_ticks: amplifier.turn_on.ticks(board.tick_hz) + EDGE_TICKS,
            turn_off_ticks: amplifier.turn_off.ticks(board.tick_hz) + EDGE_TICKS,
            ready_while_disabled: amplifier.ready_while_disabled,
            ready_ticks: board.ticks(READY_S).max(1),
            ready_left_ticks: 0,
            gain: Gain::new(board, floor_v),
        };
        check.choose_ticks_to_count();
        check
    }

    /// Follows the amplifier's enable of this tick. `driven_code` is the code of the last tick.
    #[inline]
    pub(crate) fn set_enabled(&mut self, is_enabled: bool, driven_code: i16) {
        if self.is_enabled != is_enabled {
            if is_enabled { self.turn_on() } else { self.turn_off(driven_code) }
        }
    }

    /// Takes a sample of the ready line, and returns whether it is a fault: the second wrong one within a short time.
    pub(crate) fn is_ready_fault(&mut self, is_ready: bool) -> bool {
        let is_wrong = self.is_ready_wrong(is_ready);
        let is_fault = is_wrong && self.ready_left_ticks > 0;
        self.ready_left_ticks = if is_wrong { self.ready_ticks } else { self.ready_left_ticks.saturating_sub(1) };
        is_fault
    }

    /// Whether the level of the ready line is wrong.
    fn is_ready_wrong(&self, is_ready: bool) -> bool {
        match self.ready_while_disabled {
            ReadyWhileDisabled::High => !is_ready,
            _ if self.switching_ticks > 0 => false,
            ReadyWhileDisabled::Low => is_ready != self.is_enabled,
            ReadyWhileDisabled::DontCare => self.is_enabled && !is_ready,
        }
    }

    /// Compares a reading with the expected voltage, and advances the latter by the code of the last tick. Returns
    /// whether [`Self::count`] has to process the comparison.
    #[inline]
    pub(crate) fn advance(&mut self, driven_code: i16, monitor_v: f32) -> (Comparison, bool) {
        let expected_v = self.expected_v;
        let driven_v = f32::from(driven_code) * self.volts_per_code;
        self.expected_v = expected_v + self.step * (driven_v - expected_v);
        self.monitor_v = monitor_v;
        let comparison = Comparison {
            expected_v,
            driven_code,
            deviation_v: monitor_v - expected_v,
            gain_tolerance_v: self.half_gain_tolerance * (expected_v.abs() + driven_v.abs()),
        };
        (comparison, !comparison.is_within(self.uncounted_below_v))
    }

    /// Sums up a tick that [`Self::count`] does not process, and returns whether the gain is a fault.
    #[inline]
    pub(crate) fn sum(&mut self, comparison: Comparison) -> bool {
        self.gain.take(comparison)
    }

    /// Counts a tick, and returns whether the monitor shows a fault.
    pub(crate) fn count(&mut self, comparison: Comparison) -> bool {
        if self.switching_ticks == 0 {
            let is_right = comparison.is_within(self.floor_v);
            let is_gain_wrong = is_right && self.gain.take(comparison);
            return self.count_one(is_right) || is_gain_wrong;
        }
        self.switching_ticks -= 1;
        let is_right =
            if self.is_enabled { self.is_right_while_turning_on() } else { self.is_right_while_turning_off() };
        if self.switching_ticks > 0 && is_right {
            return false;
        }
        if self.switching_ticks == 0 {
            self.ceiling_v = 0.0;
        }
        if !self.is_enabled && !is_right {
            self.wrong_count = self.wrong_count_max;
        }
        self.count_one(is_right)
    }

    /// Counts a correct or a wrong tick, and returns whether there were too many wrong ones. The count is limited, so
    /// that it falls again soon after the monitor was wrong for any time.
    fn count_one(&mut self, is_right: bool) -> bool {
        self.wrong_count = if is_right {
            self.wrong_count.saturating_sub(1)
        } else {
            (self.wrong_count + RIGHT_PER_WRONG).min(self.wrong_count_max)
        };
        self.choose_ticks_to_count();
        !is_right && self.wrong_count == self.wrong_count_max
    }

    fn is_right_while_turning_on(&mut self) -> bool {
        // The next reading may show the voltage driven in this tick.
        let driven_v = self.with_tolerance_v(self.expected_v);
        // Not `max`, which is a call on a Cortex-M4F.
        if driven_v > self.ceiling_v {
            self.ceiling_v = driven_v;
        }
        self.monitor_v.abs() < self.ceiling_v
    }

    fn is_right_while_turning_off(&mut self) -> bool {
        let monitor_v = self.monitor_v.abs();
        let is_right = monitor_v < self.ceiling_v && (self.switching_ticks > 0 || monitor_v < self.floor_v);
        // The first reading may still show the voltage before the enable fell.
        let risen_v = monitor_v + self.floor_v;
        if risen_v < self.ceiling_v && self.switching_ticks + 1 < self.turn_off_ticks {
            self.ceiling_v = risen_v;
        }
        is_right
    }

    /// The enable rises at this tick.
    #[inline]
    fn turn_on(&mut self) {
        self.is_enabled = true;
        self.switching_ticks = self.turn_on_ticks;
        self.uncounted_below_v = f32::NEG_INFINITY;
    }

    /// The enable falls at this tick.
    #[cold]
    #[inline(never)]
    fn turn_off(&mut self, driven_code: i16) {
        self.is_enabled = false;
        self.switching_ticks = self.turn_off_ticks;
        self.uncounted_below_v = f32::NEG_INFINITY;
        self.expected_v = 0.0;
        for last_v in [self.monitor_v, f32::from(driven_code) * self.volts_per_code] {
            let ceiling_v = self.with_tolerance_v(last_v);
            if ceiling_v > self.ceiling_v {
                self.ceiling_v = ceiling_v;
            }
        }
    }

    fn with_tolerance_v(&self, voltage_v: f32) -> f32 {
        self.floor_v + (1.0 + GAIN_TOLERANCE) * voltage_v.abs()
    }

    fn choose_ticks_to_count(&mut self) {
        // A high line does not trigger `count`, so every tick is counted where high is wrong.
        let watches_ready = self.ready_while_disabled == ReadyWhileDisabled::Low && !self.is_enabled;
        let counts_all = self.wrong_count > 0 || self.switching_ticks > 0 || watches_ready || self.ready_left_ticks > 0;
        self.uncounted_below_v = if counts_all { f32::NEG_INFINITY } else { self.floor_v };
    }
}

/// `1 - exp(-x)`, the step response of a first-order lag after `x` time constants, within 1e-5 for `x` up to one and
/// 1e-3 for any above zero: 64 steps of the trapezoidal rule. `libm::expf` would make the image larger.
fn lag_step(x: f32) -> f32 {
    let half_step = (x / 128.0).min(1.0);
    let mut left = (1.0 - half_step) / (1.0 + half_step);
    for _ in 0..6 {
        left *= left;
    }
    1.0 - left
}

#[cfg(test)]
mod tests;
