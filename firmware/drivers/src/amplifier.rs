//! The logic lines of the high-voltage amplifier: enable out, well in.

use embedded_hal::digital::{InputPin, OutputPin};

/// The amplifier's enable input and well output.
#[derive(Debug)]
pub struct Amplifier<E, W> {
    enable: E,
    well: W,
}

impl<E: OutputPin, W: InputPin> Amplifier<E, W> {
    /// An amplifier that is enabled while `enable` is high, and holds `well` high while it can drive: a disconnected
    /// wire reads as a fault.
    ///
    /// `enable` may be a one-shot that goes low by itself unless [`Self::set_enabled`] is called again.
    pub const fn new(enable: E, well: W) -> Self {
        Self { enable, well }
    }

    /// Enables or disables the output. Returns `false` when the pin could not be set.
    #[inline]
    pub fn set_enabled(&mut self, enabled: bool) -> bool {
        let set = if enabled { self.enable.set_high() } else { self.enable.set_low() };
        set.is_ok()
    }

    /// Whether the amplifier reports that it cannot drive. A pin that cannot be read counts as a fault.
    #[inline]
    pub fn has_fault(&mut self) -> bool {
        !matches!(self.well.is_high(), Ok(true))
    }

    /// The enable pin.
    pub fn enable_mut(&mut self) -> &mut E {
        &mut self.enable
    }
}
