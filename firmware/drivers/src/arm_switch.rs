//! The switch that a person holds to allow output.

use embedded_hal::digital::InputPin;

/// Time in us for which the contact must be closed before the switch counts as held: longer than a contact bounces (a
/// few milliseconds).
const HELD_AFTER_US: u32 = 20_000;
/// Time in us for which the contact must be open before the switch counts as released. It bridges contact breaks from a
/// moving hand, and leaves 0.3 ms of the 1.1 ms within which the output is off: 0.11 ms for the filter of the wire
/// (`docs/board/hardware.md`, "Arm switch"), a tick until the pin is read, and a tick until the DAC has the zero.
const RELEASED_AFTER_US: u32 = 800;

/// A normally open contact, closed while the pin is high.
///
/// The switch never counts as held before its contact has been open once, so that a welded or taped switch does not arm
/// the board.
#[derive(Debug)]
pub struct ArmSwitch<P> {
    contact: P,
    state: State,
    /// Number of consecutive ticks in which the contact has contradicted the state.
    contrary_ticks: u32,
    held_after_ticks: u32,
    released_after_ticks: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// The contact has not been open since the start.
    NeverReleased,
    Released,
    Held,
}

impl<P: InputPin> ArmSwitch<P> {
    /// A switch whose contact has not been read yet, and will be read `tick_hz` times a second.
    pub const fn new(contact: P, tick_hz: u32) -> Self {
        Self {
            contact,
            state: State::NeverReleased,
            contrary_ticks: 0,
            held_after_ticks: ticks(HELD_AFTER_US, tick_hz),
            released_after_ticks: ticks(RELEASED_AFTER_US, tick_hz),
        }
    }

    /// Reads the contact, once per tick, and returns whether the switch is held. A pin that cannot be read counts as
    /// open.
    #[inline]
    pub fn is_held(&mut self) -> bool {
        let closed = matches!(self.contact.is_high(), Ok(true));
        let (next, after_ticks) = match self.state {
            State::Released => (State::Held, self.held_after_ticks),
            State::NeverReleased | State::Held => (State::Released, self.released_after_ticks),
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
}

/// Number of whole ticks in a time.
const fn ticks(time_us: u32, tick_hz: u32) -> u32 {
    (time_us as u64 * tick_hz as u64 / 1_000_000) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pin::{DirectPin, ReadLevel};

    struct Contact(bool);

    impl ReadLevel for Contact {
        fn is_high(&self) -> bool {
            self.0
        }
    }

    /// Runs for some ticks and returns whether the switch is held at the last.
    fn run(switch: &mut ArmSwitch<DirectPin<Contact>>, closed: bool, ticks: u32) -> bool {
        switch.contact = DirectPin(Contact(closed));
        (0..ticks).map(|_| switch.is_held()).last().unwrap()
    }

    const TICK_HZ: u32 = 40_000;

    fn released(tick_hz: u32) -> ArmSwitch<DirectPin<Contact>> {
        let mut switch = ArmSwitch::new(DirectPin(Contact(false)), tick_hz);
        run(&mut switch, false, tick_hz / 100);
        switch
    }

    #[test]
    fn it_is_held_after_20_ms_and_released_after_800_us_at_any_tick_rate() {
        for (tick_hz, held_after, released_after) in [(10_000, 200, 8), (40_000, 800, 32), (100_000, 2_000, 80)] {
            let mut switch = released(tick_hz);
            assert!(!run(&mut switch, true, held_after - 1));
            assert!(run(&mut switch, true, 1));
            assert!(run(&mut switch, false, released_after - 1));
            assert!(!run(&mut switch, false, 1));
        }
    }

    #[test]
    fn a_bouncing_contact_changes_nothing() {
        let mut switch = released(TICK_HZ);
        for _ in 0..100 {
            assert!(!run(&mut switch, true, 700));
            assert!(!run(&mut switch, false, 1));
        }
        run(&mut switch, true, 800);
        for _ in 0..100 {
            assert!(run(&mut switch, false, 31));
            assert!(run(&mut switch, true, 1));
        }
    }

    #[test]
    fn a_contact_that_was_never_open_is_not_held() {
        let mut switch = ArmSwitch::new(DirectPin(Contact(true)), TICK_HZ);
        assert!(!run(&mut switch, true, 40_000));
        assert!(!run(&mut switch, false, 31) && !run(&mut switch, true, 40_000), "too short to be a release");
        assert!(!run(&mut switch, false, 32) && !run(&mut switch, true, 799));
        assert!(run(&mut switch, true, 1));
    }

    /// Longest time, in seconds, from the opening of the contact until the DAC has the zero, with the wire's filter of
    /// `docs/board/hardware.md`: the voltage at the pin falls from that of the divider to the level that is low for
    /// certain, 0.3 of the supply (DS12288, "I/O static characteristics", not read).
    fn off_after_s(series_ohm: f64, down_ohm: f64, capacitance_f: f64) -> f64 {
        let high = down_ohm / (down_ohm + series_ohm);
        let discharge_s = down_ohm * capacitance_f * (high / 0.3).ln();
        let period_s = 1.0 / f64::from(TICK_HZ);
        // The contact opens just after a tick has read it; the tick that finds the release sends the zero, which the
        // DAC puts out at the end of that period.
        let first_low_tick = (discharge_s / period_s).floor() + 1.0;
        let mut switch = released(TICK_HZ);
        run(&mut switch, true, TICK_HZ);
        let ticks = (1..100).find(|_| !run(&mut switch, false, 1)).unwrap();
        (first_low_tick + f64::from(ticks - 1) + 1.0) * period_s
    }

    #[test]
    fn the_output_is_off_within_1100_us_after_the_contact_opens() {
        // 8.2 kOhm and 10 nF that are 1 % and 20 % too large, and no pull-down inside.
        let off_s = off_after_s(1_000.0, 8_282.0, 12e-9);
        assert!(off_s < 1.1e-3, "{off_s}");
        // Without the resistor, 100 nF discharge through the pull-down inside, 25 to 55 kOhm.
        assert!(off_after_s(1_000.0, 25_000.0, 100e-9) > 1.1e-3);
    }
}
