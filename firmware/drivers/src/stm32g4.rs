//! Interpretation of the STM32G4's registers, as pure functions that tests can call without the processor. RM0440 is
//! the reference manual.

use frixel_wire::hello::ResetCause;

// Flags of RCC_CSR (RM0440, section 7.4.29).
const OPTION_BYTES: u32 = 1 << 25;
const PIN: u32 = 1 << 26;
const BROWN_OUT: u32 = 1 << 27;
const SOFTWARE: u32 = 1 << 28;
const INDEPENDENT_WATCHDOG: u32 = 1 << 29;
const WINDOW_WATCHDOG: u32 = 1 << 30;

/// The cause of a reset from the flags of `RCC_CSR`. Every reset sets the pin flag, and power-on sets the brown-out
/// flag: it was a brown-out if RAM has kept its content (`ram_survived`).
pub const fn reset_cause(rcc_csr: u32, ram_survived: bool) -> ResetCause {
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

// Flags of FLASH_ECCR (RM0440, "Flash ECC register (FLASH_ECCR)"; bit positions from stm32-metapac).
const ECC_IN_BANK_2: u32 = 1 << 21;
const ECC_NOT_CORRECTED: u32 = 1 << 31;

/// Whether a non-maskable interrupt reports an error from reading bank 2, which holds the stores, as when power failed
/// while the word was written. This is not a reason to reset, since every start reads the stores.
///
/// While a store is read (`reading_store`), the bank stated by `FLASH_ECCR` does not matter: the register's content may
/// be corrupt after a reset or a loss of power during programming, which is when such words arise (errata sheet ES0430,
/// on `FLASH_ECCR` after a reset or power-down during programming or erasing, not read).
///
/// An error in the image's own flash during that time therefore counts as one of the store, and the read fails; errors
/// in the processor's own fetches are left to the fault handlers.
pub const fn is_store_ecc_error(flash_eccr: u32, reading_store: bool) -> bool {
    flash_eccr & ECC_NOT_CORRECTED != 0 && (reading_store || flash_eccr & ECC_IN_BANK_2 != 0)
}

// Fields of FLASH_OPTR (RM0440, "Flash option register (FLASH_OPTR)"; bit positions from stm32-metapac).
const BROWN_OUT_LEVEL: u32 = 0b111 << 8;
const BROWN_OUT_LEVEL_4: u32 = 4 << 8;
const SOFTWARE_WATCHDOG: u32 = 1 << 16;
const BOOT_FROM_BANK_2: u32 = 1 << 20;
const TWO_BANKS: u32 = 1 << 22;
const NO_RAM_PARITY: u32 = 1 << 24;
const RESET_PIN_IN_AND_OUT: u32 = 0b11 << 28;

/// Whether the option bytes, as shown by `FLASH_OPTR`, are those required by `docs/board/hardware.md` ("Option bytes").
pub const fn option_bytes_are_right(flash_optr: u32) -> bool {
    const SET: u32 = BROWN_OUT_LEVEL_4 | TWO_BANKS | NO_RAM_PARITY | RESET_PIN_IN_AND_OUT;
    flash_optr & (SET | BROWN_OUT_LEVEL | SOFTWARE_WATCHDOG | BOOT_FROM_BANK_2) == SET
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pin_is_the_cause_only_when_there_is_no_other() {
        assert_eq!(reset_cause(PIN, true), ResetCause::Pin);
        assert_eq!(reset_cause(PIN | SOFTWARE, true), ResetCause::Software);
        assert_eq!(reset_cause(PIN | INDEPENDENT_WATCHDOG, true), ResetCause::Watchdog);
        assert_eq!(reset_cause(PIN | BROWN_OUT, false), ResetCause::PowerOn);
        assert_eq!(reset_cause(PIN | BROWN_OUT, true), ResetCause::BrownOut);
        assert_eq!(reset_cause(0, false), ResetCause::PowerOn);
    }

    #[test]
    fn an_ecc_error_while_reading_the_store_counts_as_the_stores_for_any_bank_bit() {
        for noise in [0, u32::MAX >> 1] {
            for bank in [0, ECC_IN_BANK_2] {
                let eccr = noise & !ECC_IN_BANK_2 | bank;
                assert!(is_store_ecc_error(eccr | ECC_NOT_CORRECTED, true), "{eccr:#010x}");
                assert!(!is_store_ecc_error(eccr, true), "{eccr:#010x}: an error that was corrected, or none");
                assert_eq!(is_store_ecc_error(eccr | ECC_NOT_CORRECTED, false), bank != 0, "{eccr:#010x}");
            }
        }
    }

    /// The factory's option bytes of the STM32G474 (RM0440, "Option bytes": `0xffef_f8aa`, not read).
    const FACTORY: u32 = 0xffef_f8aa;

    #[test]
    fn the_documented_command_makes_the_factory_option_bytes_right() {
        let set = FACTORY & !(BROWN_OUT_LEVEL | SOFTWARE_WATCHDOG) | BROWN_OUT_LEVEL_4;
        assert!(option_bytes_are_right(set) && !option_bytes_are_right(FACTORY));
        assert!(!option_bytes_are_right(set | SOFTWARE_WATCHDOG));
    }

    #[test]
    fn each_option_byte_that_differs_is_wrong() {
        let right = BROWN_OUT_LEVEL_4 | TWO_BANKS | NO_RAM_PARITY | RESET_PIN_IN_AND_OUT;
        let bits = [8, 9, 10, 16, 20, 22, 24, 28, 29];
        for bit in 0..32 {
            assert_eq!(option_bytes_are_right(right ^ 1 << bit), !bits.contains(&bit), "bit {bit}");
        }
    }
}
