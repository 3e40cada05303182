//! Panics and faults ([`frixel_cortex_m::fault_handlers!`]).

use frixel_cortex_m::fault::Chip;
use frixel_wire::hello::ResetCause;

use crate::shared;

struct Mps2Chip;

impl Chip for Mps2Chip {
    /// This machine has no register of reset causes: a reset that RAM has survived came from the firmware.
    fn reset_cause(ram_survived: bool) -> ResetCause {
        if ram_survived { ResetCause::Software } else { ResetCause::PowerOn }
    }

    fn zero_output_for_good() {
        shared::output_off();
    }
}

frixel_cortex_m::fault_handlers!(Mps2Chip);
