//! Selects the next fault to inject: each resets the board, and the next start checks that it was stored.

use frixel_wire::fault::Fault;

/// The faults that bring-up injects, in this order.
pub const FAULTS: [Fault; 4] = [Fault::Panic, Fault::HardFault, Fault::StackOverflow, Fault::Watchdog];

/// Progress of the fault injection at a start of the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Injection {
    /// No fault had been injected, or another reset occurred: all of them are still to come.
    NotBegun,
    /// The last one was stored; this one is next.
    Next(Fault),
    /// All were stored.
    Passed,
    /// This one was injected, but not stored.
    NotStored(Fault),
}

impl Injection {
    /// Returns the progress after a reset, given the number of [`FAULTS`] injected before it and the stored reason
    /// `found`. The board clears `injected` when it calls this: only the start directly after the last injected fault
    /// passes.
    pub fn after_reset(injected: usize, found: Option<Fault>) -> Self {
        let Some(expected) = injected.checked_sub(1).and_then(|index| FAULTS.get(index)) else { return Self::NotBegun };
        match found {
            // Power-on or the reset button.
            None => Self::NotBegun,
            Some(found) if found == *expected => FAULTS.get(injected).map_or(Self::Passed, |next| Self::Next(*next)),
            Some(_) => Self::NotStored(*expected),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_follow_one_another_until_all_were_stored() {
        assert_eq!(Injection::after_reset(0, None), Injection::NotBegun);
        for (injected, fault) in FAULTS.into_iter().enumerate() {
            let expected = FAULTS.get(injected + 1).map_or(Injection::Passed, |next| Injection::Next(*next));
            assert_eq!(Injection::after_reset(injected + 1, Some(fault)), expected);
        }
    }

    #[test]
    fn any_other_reset_begins_again() {
        for injected in 0..=5 {
            assert_eq!(Injection::after_reset(injected, None), Injection::NotBegun);
        }
        assert_eq!(Injection::after_reset(0, Some(Fault::Panic)), Injection::NotBegun);
        assert_eq!(Injection::after_reset(5, Some(Fault::Watchdog)), Injection::NotBegun);
        assert_eq!(Injection::after_reset(2, Some(Fault::Panic)), Injection::NotStored(Fault::HardFault));
    }
}
