//! A light that shows the board's state.

use embedded_hal::digital::OutputPin;
use frixel_wire::fault::State;

/// Changes per second while blinking, Hz.
const BLINK_HZ: u32 = 8;

/// A light that is off while the board is disarmed, on while it is armed or active, and blinking while a fault is
/// latched.
#[derive(Debug)]
pub struct StateLight<P> {
    pin: P,
    blink_ticks: u32,
}

impl<P: OutputPin> StateLight<P> {
    /// A light that is on while `pin` is high, on a board with the tick rate `tick_hz`.
    pub const fn new(pin: P, tick_hz: u32) -> Self {
        Self { pin, blink_ticks: tick_hz / BLINK_HZ }
    }

    /// Shows a state. Ignores a pin that cannot be set: nothing depends on the light.
    pub fn show(&mut self, state: State, now_tick: u32) {
        let on = match state {
            State::Disarmed => false,
            State::Armed | State::Active => true,
            State::Faulted => {
                now_tick.checked_div(self.blink_ticks).is_some_and(|half_period| half_period.is_multiple_of(2))
            }
        };
        let _ = if on { self.pin.set_high() } else { self.pin.set_low() };
    }
}
