//! Panics and faults ([`frixel_cortex_m::fault_handlers!`]). The next start reports the reason.

use frixel_cortex_m::fault::Chip;
use frixel_drivers::rp2;
use frixel_wire::hello::ResetCause;

use crate::{chip, output, watchdog};

struct Rp2;

impl Chip for Rp2 {
    fn reset_cause(ram_survived: bool) -> ResetCause {
        rp2::reset_cause(chip::reset_flags(), ram_survived)
    }

    fn zero_output_for_good() {
        output::zero_for_good();
    }

    fn reset() -> ! {
        watchdog::reset()
    }
}

frixel_cortex_m::fault_handlers!(Rp2);
