//! Comparing tick counts. The counter wraps, so two ticks can be compared only if they are less than 2^31 ticks apart.

/// Whether `tick` is `now_tick` or earlier.
#[inline]
pub fn is_past(tick: u32, now_tick: u32) -> bool {
    tick.wrapping_sub(now_tick) as i32 <= 0
}
