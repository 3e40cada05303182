//! The logic lines of the high-voltage amplifier: enable out, ready in.

use embedded_hal::digital::InputPin;

/// The amplifier's enable with a hardware one-shot: it is low unless it is kicked repeatedly.
///
/// A pin that keeps its level does not qualify: if the firmware hangs, nothing would switch the amplifier off.
/// [`Amplifier`] therefore takes no `OutputPin`, and a board implements this trait only for its one-shot. Its methods
/// cannot fail: an enable on a bus that may report errors does not qualify either.
pub trait KickedEnable {
    /// Enables the amplifier until the one-shot ends, at most 1 ms after the last kick.
    fn kick(&mut self);

    /// Disables the amplifier at once.
    fn disable(&mut self);
}

/// The amplifier's enable input and ready output.
///
/// ```
/// use embedded_hal::digital::InputPin;
/// use frixel_drivers::amplifier::{Amplifier, KickedEnable};
///
/// fn driver<E: KickedEnable, W: InputPin>(enable: E, ready: W) -> Amplifier<E, W> {
///     Amplifier::new(enable, ready)
/// }
/// ```
///
/// An output without a one-shot does not compile:
///
/// ```compile_fail,E0277
/// use embedded_hal::digital::{InputPin, OutputPin};
/// use frixel_drivers::amplifier::{Amplifier, KickedEnable};
///
/// fn driver<E: OutputPin, W: InputPin>(enable: E, ready: W) -> Amplifier<E, W> {
///     Amplifier::new(enable, ready)
/// }
/// ```
#[derive(Debug)]
pub struct Amplifier<E, W> {
    enable: E,
    ready: W,
}

impl<E, W> Amplifier<E, W>
where
    E: KickedEnable,
    W: InputPin,
{
    /// The driver of an amplifier that holds `ready` high while it can drive: a disconnected wire reads as a fault.
    pub const fn new(enable: E, ready: W) -> Self {
        Self { enable, ready }
    }

    /// Enables the output for the duration of the one-shot, or disables it at once.
    #[inline]
    pub fn set_enabled(&mut self, enabled: bool) {
        if enabled { self.enable.kick() } else { self.enable.disable() }
    }

    /// Whether the amplifier reports that it cannot drive. A pin that cannot be read counts as a fault.
    #[inline]
    pub fn has_fault(&mut self) -> bool {
        !matches!(self.ready.is_high(), Ok(true))
    }
}
