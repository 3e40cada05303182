//! The switch that a person holds to allow output.

use embedded_hal::digital::InputPin;

/// Ticks that the contact must be closed before the switch counts as held: 20 ms at 40 kHz, longer than a contact
/// bounces (a few milliseconds).
const HELD_AFTER_TICKS: u32 = 800;
/// Ticks that the contact must be open before the switch counts as released: 1 ms at 40 kHz. This bridges contact
/// breaks from a moving hand, and is short compared with a person's reaction time.
const RELEASED_AFTER_TICKS: u32 = 40;

/// A normally open contact, closed while the pin is high.
///
/// The switch never counts as held before its contact has been open once: a welded or taped switch does not arm the
/// board.
#[derive(Debug)]
pub struct ArmSwitch<P> {
    contact: P,
    state: State,
    /// Number of consecutive ticks in which the contact has contradicted the state.
    contrary_ticks: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// The contact has not been open since the start.
    NeverReleased,
    Released,
    Held,
}

impl<P: InputPin> ArmSwitch<P> {
    /// A switch whose contact has not been read yet.
    pub const fn new(contact: P) -> Self {
        Self { contact, state: State::NeverReleased, contrary_ticks: 0 }
    }

    /// Reads the contact, once a tick, and returns whether the switch is held. A pin that cannot be read counts as
    /// open.
    #[inline]
    pub fn is_held(&mut self) -> bool {
        let closed = matches!(self.contact.is_high(), Ok(true));
        let (next, after_ticks) = match self.state {
            State::Released => (State::Held, HELD_AFTER_TICKS),
            State::NeverReleased | State::Held => (State::Released, RELEASED_AFTER_TICKS),
        };
        if closed == (next == State::Held) {
            self.contrary_ticks += 1;
            if self.contrary_ticks >= after_ticks {
                self.state = next;
                self.contrary_ticks = 0;
            }
        } else {
            self.contrary_ticks = 0;
        }
        self.state == State::Held
    }

    /// The contact's pin.
    pub fn contact_mut(&mut self) -> &mut P {
        &mut self.contact
    }
}

#[cfg(test)]
mod tests {
    use core::convert::Infallible;

    use embedded_hal::digital::ErrorType;

    use super::*;

    struct Contact(bool);

    impl ErrorType for Contact {
        type Error = Infallible;
    }

    impl InputPin for Contact {
        fn is_high(&mut self) -> Result<bool, Infallible> {
            Ok(self.0)
        }

        fn is_low(&mut self) -> Result<bool, Infallible> {
            Ok(!self.0)
        }
    }

    /// Runs for some ticks and returns whether the switch is held at the last.
    fn run(switch: &mut ArmSwitch<Contact>, closed: bool, ticks: u32) -> bool {
        switch.contact_mut().0 = closed;
        (0..ticks).map(|_| switch.is_held()).last().unwrap()
    }

    fn released() -> ArmSwitch<Contact> {
        let mut switch = ArmSwitch::new(Contact(false));
        run(&mut switch, false, RELEASED_AFTER_TICKS);
        switch
    }

    #[test]
    fn it_is_held_after_20_ms_and_released_after_1_ms() {
        let mut switch = released();
        assert!(!run(&mut switch, true, 799));
        assert!(run(&mut switch, true, 1));
        assert!(run(&mut switch, false, 39));
        assert!(!run(&mut switch, false, 1));
    }

    #[test]
    fn a_bouncing_contact_changes_nothing() {
        let mut switch = released();
        for _ in 0..100 {
            assert!(!run(&mut switch, true, 700));
            assert!(!run(&mut switch, false, 1));
        }
        run(&mut switch, true, 800);
        for _ in 0..100 {
            assert!(run(&mut switch, false, 39));
            assert!(run(&mut switch, true, 1));
        }
    }

    #[test]
    fn a_contact_that_was_never_open_is_not_held() {
        let mut switch = ArmSwitch::new(Contact(true));
        assert!(!run(&mut switch, true, 40_000));
        assert!(!run(&mut switch, false, 39) && !run(&mut switch, true, 40_000), "too short to be a release");
        assert!(!run(&mut switch, false, 40) && !run(&mut switch, true, 799));
        assert!(run(&mut switch, true, 1));
    }
}
