//! The token of a start.

use cortex_m::Peripherals;

/// Permission to make the parts of a tick, and to give the tick to its interrupt.
///
/// A program has one, returned by [`Boot::take`]. Constructors of the tick's parts borrow it, and
/// [`TickOwner::give`](crate::TickOwner::give) consumes it. Once the interrupt runs, no code without `unsafe` can
/// replace the tick, or create a second part that drives the same registers.
pub struct Boot(());

impl Boot {
    /// Takes the token and the processor's peripherals. A second call panics.
    pub fn take() -> (Self, Peripherals) {
        match Peripherals::take() {
            Some(peripherals) => (Self(()), peripherals),
            None => unreachable_state(),
        }
    }
}

/// Panics in a state that cannot occur. A panic sets the output to zero and resets.
#[allow(clippy::panic, clippy::missing_panics_doc, reason = "there is no way to continue")]
pub fn unreachable_state() -> ! {
    panic!("a static was taken twice")
}
