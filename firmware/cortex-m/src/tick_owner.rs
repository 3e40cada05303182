//! The tick, owned by its interrupt.

use frixel_board::hardware::Hardware;
use frixel_board::tick::Tick;

use crate::{Boot, Owned};

/// The tick of a program, in a static next to the handler that runs it.
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

    /// Gives the tick to its interrupt. There is only one [`Boot`], so a program has one tick, which is never replaced.
    #[inline]
    pub fn give(&self, boot: Boot, tick: Tick<H>) {
        // SAFETY: the place is private, and nothing else here gives.
        unsafe { self.0.give_once(boot, tick) };
    }

    /// Runs the tick, if there is one.
    ///
    /// # Safety
    /// Only the handler of the tick's interrupt calls this or [`Self::with`], once in each run.
    #[inline]
    pub unsafe fn run(&self) {
        // SAFETY: the handler owns the value, as the caller guarantees.
        if let Some(tick) = unsafe { self.0.get() } {
            tick.run();
        }
    }

    /// Passes the tick to `work`, if there is one.
    ///
    /// # Safety
    /// That of [`Self::run`].
    #[inline]
    pub unsafe fn with(&self, work: impl FnOnce(&mut Tick<H>)) {
        // SAFETY: the handler owns the value, as the caller guarantees.
        if let Some(tick) = unsafe { self.0.get() } {
            work(tick);
        }
    }
}

/// Declares `TICK`, the tick of a program whose parts are those of `$hardware`, and the handler of the interrupt that
/// runs it. `interrupt` of the processor's peripheral access crate must be in scope.
#[macro_export]
macro_rules! tick_interrupt {
    ($hardware:ty, $interrupt:ident) => {
        static TICK: $crate::TickOwner<$hardware> = $crate::TickOwner::new();

        #[interrupt]
        fn $interrupt() {
            // SAFETY: this is the handler.
            unsafe { TICK.run() }
        }
    };
}
