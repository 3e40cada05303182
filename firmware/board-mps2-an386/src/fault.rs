//! Panics and faults: they set the output to zero, store the fault for the next start, and reset
//! ([`frixel_board::fault`]).

use core::panic::PanicInfo;

use cortex_m::interrupt;
use cortex_m::peripheral::SCB;
use cortex_m_rt::exception;
use frixel_board::fault::{Ending, LastReset};
use frixel_board::hardware::Processor;
use frixel_cortex_m::outlasting;
use frixel_drivers::fault_record::{FaultRecord, Text};
use frixel_wire::hello::ResetCause;

use crate::shared;

/// The last fault, in memory that the start-up code does not clear.
#[unsafe(link_section = ".uninit.RECORD")]
pub static RECORD: FaultRecord = FaultRecord::new();

static ENDING: Ending<Mps2Processor> = Ending::new(Mps2Processor, &RECORD);

struct Mps2Processor;

impl Processor for Mps2Processor {
    fn disable_interrupts(&self) {
        interrupt::disable();
    }

    fn zero_output_for_good(&self) {
        shared::output_off();
    }

    fn reset(&self) -> ! {
        SCB::sys_reset()
    }
}

/// Reads the stored fault, and clears it. This machine has no register of reset causes: a reset that RAM has survived
/// came from the firmware.
pub fn last_reset(text: &'static mut Text) -> LastReset {
    let record = outlasting(&RECORD);
    let cause = if record.has_outlasted_reset() { ResetCause::Software } else { ResetCause::PowerOn };
    LastReset::take(cause, record, text)
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    ENDING.panic(info.location())
}

/// An exception without a handler.
#[exception]
unsafe fn DefaultHandler(number: i16) {
    ENDING.unhandled_interrupt(number)
}

frixel_cortex_m::hard_fault_handler!(ENDING);

/// Panics where a static would be taken twice, which cannot happen.
pub fn never() -> ! {
    panic!("a static was taken twice")
}
