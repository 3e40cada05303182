//! Checks the amplifier's gain over several milliseconds of readings.
//!
//! A healthy reading is the expected voltage `e`, plus an offset of at most [`FLOOR`](super::FLOOR), plus an error
//! proportional to `e`, of at most [`GAIN_TOLERANCE`](super::GAIN_TOLERANCE). The magnitude of the sum of the
//! deviations, weighted with `e`, is thus at most
//!
//! ```text
//! GAIN_TOLERANCE * sum(e^2) + FLOOR * |sum(e)|
//! ```
//!
//! The tolerance of a single tick is this bound for one tick. Over whole periods of the carrier, `sum(e)` is zero, and
//! only the gain remains. The number of periods need not be exact: while `sum(e)` is large, the bound is wide.

use super::{Comparison, GAIN_TOLERANCE};
use crate::Board;

/// Time between two checks, in s: an eighth of the period of the slowest carrier, so that a check is near each zero of
/// its integral.
const CHECK_PERIOD_S: f32 = 1e-3;
/// Number of checks after which the sums restart. A gain that is off by 40 % is then found within 20 ms: earlier
/// correct ticks hide it for at most five eighths of the 10 ms, and the slowest carrier is balanced twice in the next
/// 10 ms.
const CHECKS: u32 = 10;
/// The sums are checked once the sum of the squared drive reaches that of a constant drive at the offset's tolerance
/// for this time. Below, noise and ADC steps are not small compared with a quarter of the drive. It is a quarter of the
/// 10 ms, so that the mean drive must be half of the offset's tolerance: 4 V rms of 200 V.
const CHECKED_FROM_S: f32 = 2.5e-3;
/// Codes are divided by two to this power, so that the squares of 10 ms fit into 32 bits up to a tick rate of 100 kHz.
const SHIFT: u32 = 4;

/// Sums over correct ticks since the last restart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gain {
    /// Sum of the expected voltages times the deviations, V^2.
    deviation_v2: f32,
    /// Sum of the codes, in units of 2^[`SHIFT`]. An integer, because a Cortex-M0+ does not add floating-point numbers
    /// in hardware.
    drive: i32,
    /// Sum of the squared codes, in the same units.
    square: u32,
    left_ticks: u32,
    left_checks: u32,
    check_period_ticks: u32,
    /// [`CHECKED_FROM_S`] as a sum of squares.
    checked_from: u32,
    /// Tolerance of an offset, as a code in the same units.
    offset: i32,
    /// Squared codes in the same units per squared volt.
    squares_per_v2: f32,
}

impl Gain {
    pub(super) fn new(board: &Board, floor_v: f32) -> Self {
        let codes_per_v = f32::from(i16::MAX >> SHIFT) / board.limits.full_scale_v_peak;
        let offset = floor_v * codes_per_v;
        let check_period_ticks = board.ticks(CHECK_PERIOD_S).max(1);
        Self {
            deviation_v2: 0.0,
            drive: 0,
            square: 0,
            left_ticks: check_period_ticks,
            left_checks: CHECKS,
            check_period_ticks,
            checked_from: (offset * offset) as u32 * board.ticks(CHECKED_FROM_S).max(1),
            // Rounded up, so that it is not tighter than a single tick's tolerance.
            offset: offset as i32 + 1,
            squares_per_v2: codes_per_v * codes_per_v,
        }
    }

    /// Sums up a tick, and returns whether the sums show a faulty gain.
    #[inline]
    pub(super) fn take(&mut self, comparison: Comparison) -> bool {
        let Comparison { expected_v, driven_code, deviation_v, .. } = comparison;
        let drive = i32::from(driven_code >> SHIFT);
        self.deviation_v2 += expected_v * deviation_v;
        self.drive = self.drive.wrapping_add(drive);
        self.square = self.square.wrapping_add((drive * drive).cast_unsigned());
        self.left_ticks -= 1;
        self.left_ticks == 0 && self.check()
    }

    /// Returns whether the gain is faulty, and schedules the next check.
    #[cold]
    #[inline(never)]
    fn check(&mut self) -> bool {
        // The conversion saturates.
        let deviation = (self.deviation_v2.abs() * self.squares_per_v2) as u32;
        let offset = self.drive.wrapping_mul(self.offset).unsigned_abs();
        // `GAIN_TOLERANCE`, a quarter.
        let tolerance = (self.square >> 2).saturating_add(offset);
        let is_wrong = self.square >= self.checked_from && deviation > tolerance;
        self.left_ticks = self.check_period_ticks;
        self.left_checks -= 1;
        if is_wrong || self.left_checks == 0 {
            self.left_checks = CHECKS;
            (self.deviation_v2, self.drive, self.square) = (0.0, 0, 0);
        }
        is_wrong
    }
}

const _: () = assert!(GAIN_TOLERANCE == 0.25);
