//! Sharing the DAC's bus between the tick, which sends a frame every period, and the main loop, which configures and reads
//! back.

use core::sync::atomic::{AtomicBool, Ordering};

/// Whose turn it is on the bus. One of the two sides is an interrupt that the other cannot delay.
///
/// The main loop [requests](Self::request) the bus and waits until it [has](Self::is_granted) it; [releases](Self::release) it,
/// and waits until it has it no longer: from then on the tick sends frames again.
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

    /// In the main loop: requests the bus from the next tick on.
    pub fn request(&self) {
        self.requested.store(true, Ordering::Release);
    }

    /// In the main loop: whether it has the bus.
    pub fn is_granted(&self) -> bool {
        self.granted.load(Ordering::Acquire)
    }

    /// In the main loop: gives the bus back at the next tick.
    pub fn release(&self) {
        self.requested.store(false, Ordering::Release);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tick_rests_from_the_request_to_the_release() {
        let bus = BusHandover::new();
        assert!(bus.tick_sends(true) && !bus.is_granted());
        bus.request();
        assert!(!bus.is_granted(), "not before the tick has agreed");
        assert!(!bus.tick_sends(true) && bus.is_granted());
        bus.release();
        assert!(bus.is_granted(), "until the tick sends again");
        assert!(bus.tick_sends(true) && !bus.is_granted());
    }

    #[test]
    fn an_output_that_is_not_zero_keeps_the_bus() {
        let bus = BusHandover::new();
        bus.request();
        assert!(bus.tick_sends(false) && !bus.is_granted());
        assert!(!bus.tick_sends(true) && bus.is_granted());
        assert!(bus.tick_sends(false) && !bus.is_granted());
    }
}
