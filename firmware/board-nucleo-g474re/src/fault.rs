//! Panics and faults ([`frixel_cortex_m::fault_handlers!`]). The next start reports the reason.

use frixel_cortex_m::fault::Chip;
use frixel_drivers::stm32g4;
use frixel_wire::hello::ResetCause;
use stm32_metapac::RCC;

use crate::{flash, output};

struct Stm32;

impl Chip for Stm32 {
    fn reset_cause(ram_survived: bool) -> ResetCause {
        let flags = RCC.csr().read().0;
        RCC.csr().modify(|w| w.set_rmvf(true));
        stm32g4::reset_cause(flags, ram_survived)
    }

    fn zero_output_for_good() {
        output::zero_for_good();
    }
}

frixel_cortex_m::fault_handlers!(Stm32, nmi: flash::take_unreadable);
