//! Shares the DAC's bus between the tick, which sends a frame every period, and the main loop, which configures and
//! reads back.

use core::sync::atomic::{AtomicBool, Ordering};

/// Arbitrates the bus between the tick and the main loop. The tick is an interrupt that the main loop cannot delay.
///
/// The main loop uses the bus in [`while_frames_rest`](Self::while_frames_rest). The tick calls
/// [`tick_sends`](Self::tick_sends) before it sends its frame.
#[derive(Debug, Default)]
pub struct BusHandover {
    requested: AtomicBool,
    granted: AtomicBool,
}

impl BusHandover {
    /// A bus that belongs to the tick.
    pub const fn new() -> Self {
        Self { requested: AtomicBool::new(false), granted: AtomicBool::new(false) }
    }

    /// Called once by each tick: returns whether the tick sends its frame, which it does not while the main loop has
    /// the bus. The main loop gets the bus only while the output is zero and no waiting order could change that
    /// (`output_is_zero`).
    #[inline]
    pub fn tick_sends(&self, output_is_zero: bool) -> bool {
        let granted = output_is_zero && self.requested.load(Ordering::Acquire);
        self.granted.store(granted, Ordering::Release);
        !granted
    }

    /// Called by the main loop: runs `work` while the tick sends no frames, and returns when the tick sends them again.
    /// Calls `poll` while waiting for the tick.
    pub fn while_frames_rest<R>(&self, mut poll: impl FnMut(), work: impl FnOnce() -> R) -> R {
        self.requested.store(true, Ordering::Release);
        while !self.is_granted() {
            poll();
        }
        let result = work();
        self.requested.store(false, Ordering::Release);
        while self.is_granted() {
            poll();
        }
        result
    }

    fn is_granted(&self) -> bool {
        self.granted.load(Ordering::Acquire)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Simulates ticks whose output is zero from tick number `zero_from` on; ten at most.
    fn ticks(bus: &BusHandover, zero_from: u32) -> impl FnMut() {
        let mut tick = 0;
        move || {
            let output_is_zero = tick >= zero_from;
            assert!(
                bus.tick_sends(output_is_zero) || output_is_zero,
                "the main loop got the bus from a tick that drives"
            );
            tick += 1;
            assert!(tick < 10, "the main loop waits in vain");
        }
    }

    #[test]
    fn the_tick_rests_during_the_work_only() {
        let bus = BusHandover::new();
        assert!(bus.tick_sends(true));
        let rested = bus.while_frames_rest(ticks(&bus, 0), || !bus.tick_sends(true));
        assert!(rested, "the tick sent a frame during the work");
        assert!(bus.tick_sends(true));
    }

    #[test]
    fn an_output_that_is_not_zero_keeps_the_bus() {
        let bus = BusHandover::new();
        bus.while_frames_rest(ticks(&bus, 5), || assert!(!bus.tick_sends(true)));
    }
}
