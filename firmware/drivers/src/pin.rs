//! Processor pins as `embedded-hal` pins: reading and setting them never fails.

use core::convert::Infallible;

use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

/// A pin whose level can be read.
pub trait ReadLevel {
    /// Whether the pin is high.
    fn is_high(&self) -> bool;
}

/// A pin whose level can be set.
pub trait SetLevel {
    /// Sets the pin high or low.
    fn set(&self, high: bool);
}

/// A pin of the processor.
#[derive(Debug)]
pub struct DirectPin<P>(pub P);

impl<P> ErrorType for DirectPin<P> {
    type Error = Infallible;
}

impl<P: ReadLevel> InputPin for DirectPin<P> {
    #[inline]
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.is_high())
    }

    #[inline]
    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(!self.0.is_high())
    }
}

impl<P: SetLevel> OutputPin for DirectPin<P> {
    #[inline]
    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.set(true);
        Ok(())
    }

    #[inline]
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.set(false);
        Ok(())
    }
}
