//! What a start has once.

use cortex_m::Peripherals;

/// The right to hand the tick's parts out, and the tick to its interrupt.
///
/// There is one, which [`Boot::take`] returns. Constructors of parts that the tick uses borrow it, and
/// [`TickOwner::give`](crate::TickOwner::give) takes it: so once the interrupt runs, no code without `unsafe` can replace
/// the tick, or make a second part that drives the same registers.
pub struct Boot(());

impl Boot {
    /// Takes it, and the processor's peripherals. A second call panics.
    pub fn take() -> (Self, Peripherals) {
        match Peripherals::take() {
            Some(peripherals) => (Self(()), peripherals),
            None => never(),
        }
    }
}

/// Panics where a static would be taken twice, which cannot happen. A panic sets the output to zero and resets.
#[allow(clippy::panic, clippy::missing_panics_doc, reason = "there is nothing to go on with")]
pub fn never() -> ! {
    panic!("a static was taken twice")
}
