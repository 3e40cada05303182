//! The tick, which its interrupt owns.

use frixel_board::hardware::Hardware;
use frixel_board::tick::Tick;

use crate::Owned;

/// The tick of a program, in a static beside the handler that runs it.
pub struct TickOwner<H: Hardware>(Owned<Tick<H>>);

impl<H: Hardware> TickOwner<H>
where
    Tick<H>: Send,
{
    /// No tick yet.
    #[allow(clippy::new_without_default, reason = "it belongs in a static")]
    pub const fn new() -> Self {
        Self(Owned::new())
    }

    /// Gives the tick to its interrupt. `None` if the interrupt has one already, which it keeps.
    #[inline]
    #[must_use = "an interrupt that has a tick keeps it"]
    pub fn give(&self, tick: Tick<H>) -> Option<()> {
        self.0.give(tick)
    }

    /// Runs the tick, if there is one.
    ///
    /// # Safety
    /// Only the handler of the tick's interrupt calls this, once in each run.
    #[inline]
    pub unsafe fn run(&self) {
        // SAFETY: the handler owns the value, says the caller.
        if let Some(tick) = unsafe { self.0.get() } {
            tick.run();
        }
    }
}
