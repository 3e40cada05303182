//! Interpretation of the registers of the RP2040 and the RP2350, as pure functions that tests can call without the
//! processor. Also the location of the limits in the flash, for tools that write them in advance.

use frixel_wire::hello::ResetCause;

/// Offset of the stored limits in the flash, after the image.
pub const LIMITS_OFFSET: u32 = 1 << 20;

/// The chips' flags about the last reset, independent of their registers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools, reason = "they are flags of registers")]
pub struct ResetFlags {
    /// The watchdog's counter has run out (`WATCHDOG.REASON`).
    pub watchdog_timer: bool,
    /// The watchdog was triggered by software, which is how the firmware resets itself (`WATCHDOG.REASON`).
    pub watchdog_forced: bool,
    /// Power came on; on the RP2040 also after a brown-out.
    pub power_on: bool,
    /// The supply was too low. Always `false` on the RP2040.
    pub brown_out: bool,
    /// Pin RUN was low.
    pub run_pin: bool,
}

/// The cause of a reset. It was a brown-out if the chip reports power-on, but RAM has kept its content
/// (`ram_survived`).
pub const fn reset_cause(flags: ResetFlags, ram_survived: bool) -> ResetCause {
    if flags.watchdog_timer {
        ResetCause::Watchdog
    } else if flags.watchdog_forced {
        ResetCause::Software
    } else if flags.brown_out || flags.power_on && ram_survived {
        ResetCause::BrownOut
    } else if flags.power_on {
        ResetCause::PowerOn
    } else if flags.run_pin {
        ResetCause::Pin
    } else {
        // A debugger, which resets only the processor.
        ResetCause::Software
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: ResetFlags =
        ResetFlags { watchdog_timer: false, watchdog_forced: false, power_on: false, brown_out: false, run_pin: false };

    /// The chip's own flags survive a reset by the watchdog, so the watchdog's flag takes precedence.
    #[test]
    fn the_watchdog_takes_precedence_over_the_chips_own_flags() {
        let power_on = ResetFlags { power_on: true, ..NONE };
        let run_pin = ResetFlags { run_pin: true, ..NONE };
        for (flags, ram_survived, cause) in [
            (power_on, false, ResetCause::PowerOn),
            (power_on, true, ResetCause::BrownOut),
            (ResetFlags { brown_out: true, ..power_on }, false, ResetCause::BrownOut),
            (run_pin, true, ResetCause::Pin),
            (ResetFlags { watchdog_timer: true, ..power_on }, true, ResetCause::Watchdog),
            (ResetFlags { watchdog_forced: true, ..run_pin }, true, ResetCause::Software),
            (NONE, true, ResetCause::Software),
        ] {
            assert_eq!(reset_cause(flags, ram_survived), cause, "{flags:?}");
        }
    }
}
