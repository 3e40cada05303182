//! The logic lines of the high-voltage amplifier: enable out, ready in.

use embedded_hal::digital::{InputPin, OutputPin};

/// The amplifier's enable input and ready output.
#[derive(Debug)]
pub struct Amplifier<E, W> {
    enable: E,
    ready: W,
}

impl<E: OutputPin, W: InputPin> Amplifier<E, W> {
    /// The driver of an amplifier that is enabled while `enable` is high, and holds `ready` high while it can drive: a
    /// disconnected wire reads as a fault.
    ///
    /// `enable` may be a one-shot that goes low by itself unless [`Self::set_enabled`] is called again.
    pub const fn new(enable: E, ready: W) -> Self {
        Self { enable, ready }
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
        !matches!(self.ready.is_high(), Ok(true))
    }

    /// The enable pin.
    pub fn enable_mut(&mut self) -> &mut E {
        &mut self.enable
    }
}
