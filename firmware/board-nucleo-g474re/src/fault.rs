//! Panics and faults: they set the output to zero, store the reason, and reset ([`frixel_board::fault`]). The next
//! start reports the reason.

use core::panic::PanicInfo;

use cortex_m::interrupt;
use cortex_m::peripheral::SCB;
use cortex_m_rt::exception;
use frixel_board::fault::{Ending, LastReset};
use frixel_board::hardware::Processor;
use frixel_cortex_m::outlasting;
use frixel_drivers::fault_record::{FaultRecord, Text};
use frixel_drivers::stm32g4;
use frixel_wire::fault::Fault;
use stm32_metapac::RCC;

use crate::{flash, output};

/// The last fault, in memory that the start-up code does not clear.
#[unsafe(link_section = ".uninit.RECORD")]
pub static RECORD: FaultRecord = FaultRecord::new();

static ENDING: Ending<Stm32> = Ending::new(Stm32, &RECORD);

struct Stm32;

impl Processor for Stm32 {
    fn disable_interrupts(&self) {
        interrupt::disable();
    }

    fn zero_output_for_good(&self) {
        output::zero_for_good();
    }

    fn reset(&self) -> ! {
        SCB::sys_reset()
    }
}

/// Reads the reset cause and the stored fault, and clears both.
pub fn last_reset(text: &'static mut Text) -> LastReset {
    let flags = RCC.csr().read().0;
    RCC.csr().modify(|w| w.set_rmvf(true));
    let record = outlasting(&RECORD);
    LastReset::take(stm32g4::reset_cause(flags, record.has_outlasted_reset()), record, text)
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    #[cfg(feature = "panic-message")]
    ENDING.panic_with_message(info.location(), info);
    #[cfg(not(feature = "panic-message"))]
    ENDING.panic(info.location())
}

/// An interrupt without a handler.
#[exception]
unsafe fn DefaultHandler(number: i16) {
    ENDING.unhandled_interrupt(number)
}

/// Non-maskable interrupt: an error of the flash, the RAM or the clock.
#[exception]
unsafe fn NonMaskableInt() {
    if !flash::take_unreadable() {
        ENDING.end(Fault::HardFault, 0, &mut |text| {
            text.text("NMI: flash, RAM or clock failed");
        })
    }
}

frixel_cortex_m::hard_fault_handler!(ENDING);

/// Panics where a static would be taken twice, which cannot happen.
pub fn never() -> ! {
    panic!("a static was taken twice")
}
