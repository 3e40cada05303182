//! Reset cause of the STM32G4.

use frixel_wire::hello::ResetCause;

// Flags of RCC_CSR on the STM32G4 (RM0440, section 7.4.29).
const OPTION_BYTES: u32 = 1 << 25;
const PIN: u32 = 1 << 26;
const BROWN_OUT: u32 = 1 << 27;
const SOFTWARE: u32 = 1 << 28;
const INDEPENDENT_WATCHDOG: u32 = 1 << 29;
const WINDOW_WATCHDOG: u32 = 1 << 30;

/// The cause of a reset from the flags of `RCC_CSR`. Every reset sets the flag of the pin, and power-on sets that of a
/// brown-out: it was a brown-out if RAM has kept its content (`ram_survived`).
pub const fn cause(rcc_csr: u32, ram_survived: bool) -> ResetCause {
    if rcc_csr & (INDEPENDENT_WATCHDOG | WINDOW_WATCHDOG) != 0 {
        ResetCause::Watchdog
    } else if rcc_csr & (SOFTWARE | OPTION_BYTES) != 0 {
        ResetCause::Software
    } else if rcc_csr & BROWN_OUT != 0 {
        if ram_survived { ResetCause::BrownOut } else { ResetCause::PowerOn }
    } else if rcc_csr & PIN != 0 {
        ResetCause::Pin
    } else {
        ResetCause::PowerOn
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pin_is_the_cause_only_when_there_is_no_other() {
        assert_eq!(cause(PIN, true), ResetCause::Pin);
        assert_eq!(cause(PIN | SOFTWARE, true), ResetCause::Software);
        assert_eq!(cause(PIN | INDEPENDENT_WATCHDOG, true), ResetCause::Watchdog);
        assert_eq!(cause(PIN | BROWN_OUT, false), ResetCause::PowerOn);
        assert_eq!(cause(PIN | BROWN_OUT, true), ResetCause::BrownOut);
        assert_eq!(cause(0, false), ResetCause::PowerOn);
    }
}
