//! The switch that a person holds while the board may play.

/// Ticks that the contact has to be closed before the switch counts as held: 20 ms at 40 kHz, longer than a contact
/// bounces (a few milliseconds).
const HELD_AFTER_TICKS: u32 = 800;
/// Ticks that it has to be open before the switch counts as let go: 1 ms at 40 kHz. It bridges what a moving hand does to
/// a contact, and is short beside a person's reaction.
const LET_GO_AFTER_TICKS: u32 = 40;

/// State of the switch.
#[derive(Clone, Copy, Debug, Default)]
pub struct ArmSwitch {
    held: bool,
    /// Ticks for which the contact has said otherwise.
    other_ticks: u32,
}

impl ArmSwitch {
    /// A switch that nobody holds.
    pub const fn new() -> Self {
        Self { held: false, other_ticks: 0 }
    }

    /// Takes the contact at a tick, and returns whether the switch is held.
    pub fn update(&mut self, contact_closed: bool) -> bool {
        if contact_closed == self.held {
            self.other_ticks = 0;
            return self.held;
        }
        self.other_ticks += 1;
        let needed = if self.held { LET_GO_AFTER_TICKS } else { HELD_AFTER_TICKS };
        if self.other_ticks >= needed {
            self.held = contact_closed;
            self.other_ticks = 0;
        }
        self.held
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(switch: &mut ArmSwitch, contact_closed: bool, ticks: u32) -> bool {
        (0..ticks).map(|_| switch.update(contact_closed)).last().unwrap()
    }

    #[test]
    fn it_is_held_after_20_ms_and_let_go_after_1_ms() {
        let mut switch = ArmSwitch::new();
        assert!(!run(&mut switch, true, 799));
        assert!(run(&mut switch, true, 1));
        assert!(run(&mut switch, false, 39));
        assert!(!run(&mut switch, false, 1));
    }

    #[test]
    fn a_contact_that_bounces_changes_nothing() {
        let mut switch = ArmSwitch::new();
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
}
