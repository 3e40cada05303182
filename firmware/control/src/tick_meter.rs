//! Memory for the durations of a board's ticks.

use core::sync::atomic::{AtomicU32, Ordering};

use frixel_wire::message::{TICK_TIME_CLASSES, TickTimes};

/// Durations of the ticks: written by the tick, read by the session.
///
/// Every number is an atomic with one writer, which costs nothing on a Cortex-M and needs no `unsafe`. If the session
/// reads while the tick writes, the numbers are from two successive ticks.
pub struct TickMeter {
    deadline_cycles: u32,
    worst_cycles: AtomicU32,
    histogram: [AtomicU32; TICK_TIME_CLASSES + 1],
}

impl TickMeter {
    /// A meter of ticks whose drive is late after `deadline_cycles`.
    #[allow(clippy::new_without_default, reason = "it belongs in a static, not on the stack")]
    pub const fn new(deadline_cycles: u32) -> Self {
        Self {
            deadline_cycles,
            worst_cycles: AtomicU32::new(0),
            histogram: [const { AtomicU32::new(0) }; TICK_TIME_CLASSES + 1],
        }
    }

    /// Counts a tick that took `cycles` from the start of its period. Call this after the drive was output.
    #[inline]
    pub fn record(&self, cycles: u32) {
        let eighths = cycles.saturating_mul(TICK_TIME_CLASSES as u32).saturating_sub(1);
        let class = eighths.checked_div(self.deadline_cycles).unwrap_or(0).min(TICK_TIME_CLASSES as u32);
        if let Some(count) = self.histogram.get(class as usize) {
            count.store(count.load(Ordering::Relaxed).saturating_add(1), Ordering::Relaxed);
        }
        if cycles > self.worst_cycles.load(Ordering::Relaxed) {
            self.worst_cycles.store(cycles, Ordering::Relaxed);
        }
    }

    /// The durations so far, with this number of missed deadlines.
    pub fn times(&self, missed_deadlines: u32) -> TickTimes {
        let mut histogram = [0; TICK_TIME_CLASSES + 1];
        for (to, from) in histogram.iter_mut().zip(&self.histogram) {
            *to = from.load(Ordering::Relaxed);
        }
        let worst_cycles = self.worst_cycles.load(Ordering::Relaxed);
        TickTimes { deadline_cycles: self.deadline_cycles, worst_cycles, missed_deadlines, histogram }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The class of a tick of this length.
    fn class(meter: &TickMeter, cycles: u32) -> usize {
        let before = meter.times(0).histogram;
        meter.record(cycles);
        let after = meter.times(0).histogram;
        let counted: Vec<usize> = (0..=TICK_TIME_CLASSES).filter(|&class| after[class] != before[class]).collect();
        let &[class] = counted.as_slice() else { panic!("{cycles}: {counted:?}") };
        assert_eq!(after[class], before[class] + 1);
        class
    }

    /// With 3,700 cycles, an eighth is not a whole number.
    #[test]
    fn ticks_are_counted_by_eighths_of_the_deadline_and_late_ones_apart() {
        for deadline_cycles in [3_700, 4_250, 8, 1_000_000] {
            let meter = TickMeter::new(deadline_cycles);
            for eighth in 1..=8 {
                let end = deadline_cycles * eighth / 8;
                assert_eq!(class(&meter, end), eighth as usize - 1, "{deadline_cycles}");
                assert_eq!(class(&meter, end + 1), eighth as usize, "{deadline_cycles}");
            }
            assert_eq!((class(&meter, 0), class(&meter, u32::MAX)), (0, TICK_TIME_CLASSES));
        }
    }

    #[test]
    fn the_worst_tick_stays() {
        let meter = TickMeter::new(3_700);
        for (cycles, worst_cycles) in [(1_000, 1_000), (999, 1_000), (3_900, 3_900), (1_000, 3_900)] {
            meter.record(cycles);
            assert_eq!(meter.times(5).worst_cycles, worst_cycles);
        }
        let times = meter.times(5);
        assert_eq!((times.deadline_cycles, times.missed_deadlines), (3_700, 5));
        assert_eq!(times.histogram, [0, 0, 3, 0, 0, 0, 0, 0, 1]);
    }

    #[test]
    fn a_full_count_stays() {
        let meter = TickMeter::new(3_700);
        meter.histogram[0].store(u32::MAX, Ordering::Relaxed);
        meter.record(1);
        assert_eq!(meter.times(0).histogram[0], u32::MAX);
    }
}
