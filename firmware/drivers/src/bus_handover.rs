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
