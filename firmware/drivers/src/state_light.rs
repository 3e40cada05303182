//! A light that shows the board's state.

use embedded_hal::digital::OutputPin;
use frixel_wire::fault::State;

/// Half a period of the blinking: 1/8 s at 40 kHz.
const BLINK_TICKS: u32 = 5_000;

/// A light that is off while the board is disarmed, on while it is armed or plays, and blinks while a fault is latched.
#[derive(Debug)]
pub struct StateLight<P> {
    pin: P,
}

impl<P: OutputPin> StateLight<P> {
    /// A light that is on while `pin` is high.
    pub const fn new(pin: P) -> Self {
        Self { pin }
    }

    /// Shows a state. Ignores a pin that cannot be set: nothing depends on the light.
    pub fn show(&mut self, state: State, now_tick: u32) {
        let on = match state {
            State::Disarmed => false,
            State::Armed | State::Active => true,
            State::Faulted => (now_tick / BLINK_TICKS).is_multiple_of(2),
        };
        let _ = if on { self.pin.set_high() } else { self.pin.set_low() };
    }
}
