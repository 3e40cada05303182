//! Sharing the DAC's bus between the tick, which sends a frame every period, and the main loop, which configures and reads
//! back.

use core::sync::atomic::{AtomicBool, Ordering};

/// Whose turn it is on the bus. One of the two sides is an interrupt that the other cannot delay.
///
/// The main loop uses the bus in [`while_frames_rest`](Self::while_frames_rest). The tick asks
/// [`tick_sends`](Self::tick_sends) before it sends its frame.
#[derive(Debug, Default)]
pub struct BusHandover {
    requested: AtomicBool,
    granted: AtomicBool,
}

impl BusHandover {
    /// The tick has the bus.
    pub const fn new() -> Self {
        Self { requested: AtomicBool::new(false), granted: AtomicBool::new(false) }
    }

    /// In the tick, once: returns whether the tick sends its frame. It does not while the main loop has the bus, which it
    /// only gets while the output is zero (`output_is_zero`) and no order waits that could change that.
    #[inline]
    pub fn tick_sends(&self, output_is_zero: bool) -> bool {
        let granted = output_is_zero && self.requested.load(Ordering::Acquire);
        self.granted.store(granted, Ordering::Release);
        !granted
    }

    /// In the main loop: does `work` on the bus, and returns when the tick sends frames again. `wait_until` waits for a
    /// condition that changes in a tick.
    pub fn while_frames_rest<R>(&self, wait_until: impl Fn(&dyn Fn() -> bool), work: impl FnOnce() -> R) -> R {
        self.requested.store(true, Ordering::Release);
        wait_until(&|| self.is_granted());
        let result = work();
        self.requested.store(false, Ordering::Release);
        wait_until(&|| !self.is_granted());
        result
    }

    fn is_granted(&self) -> bool {
        self.granted.load(Ordering::Acquire)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ticks with zero output until a condition holds, ten times at most.
    fn tick_until(bus: &BusHandover, condition: &dyn Fn() -> bool) {
        assert!((0..10).any(|_| {
            bus.tick_sends(true);
            condition()
        }));
    }

    #[test]
    fn the_tick_rests_during_the_work_only() {
        let bus = BusHandover::new();
        assert!(bus.tick_sends(true));
        let rested = bus.while_frames_rest(|condition| tick_until(&bus, condition), || !bus.tick_sends(true));
        assert!(rested, "the tick sent a frame during the work");
        assert!(bus.tick_sends(true));
    }

    #[test]
    fn an_output_that_is_not_zero_keeps_the_bus() {
        let bus = BusHandover::new();
        let wait = |condition: &dyn Fn() -> bool| {
            assert!(bus.tick_sends(false));
            assert!(!bus.is_granted());
            tick_until(&bus, condition);
        };
        bus.while_frames_rest(wait, || assert!(!bus.tick_sends(true)));
    }
}
