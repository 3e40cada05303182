//! Panics and faults: they set the output to zero, store the reason, and reset ([`frixel_board::fault`]). The next
//! start reports the reason.

use core::panic::PanicInfo;

use cortex_m::interrupt;
use cortex_m_rt::exception;
use frixel_board::fault::{Ending, LastReset};
use frixel_board::hardware::Processor;
use frixel_cortex_m::outlasting;
use frixel_drivers::fault_record::{FaultRecord, Text};
use frixel_drivers::rp2;

use crate::{chip, output, watchdog};

/// The last fault, in memory that the start-up code does not clear.
#[unsafe(link_section = ".uninit.RECORD")]
pub static RECORD: FaultRecord = FaultRecord::new();

static ENDING: Ending<Rp2> = Ending::new(Rp2, &RECORD);

struct Rp2;

impl Processor for Rp2 {
    fn disable_interrupts(&self) {
        interrupt::disable();
    }

    fn zero_output_for_good(&self) {
        output::zero_for_good();
    }

    fn reset(&self) -> ! {
        watchdog::reset()
    }
}

/// Reads the reset cause and the stored fault, and clears the latter.
pub fn last_reset(text: &'static mut Text) -> LastReset {
    let record = outlasting(&RECORD);
    LastReset::take(rp2::reset_cause(chip::reset_flags(), record.has_outlasted_reset()), record, text)
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

frixel_cortex_m::hard_fault_handler!(ENDING);

/// Panics where a static would be taken twice, which cannot happen.
pub fn never() -> ! {
    panic!("a static was taken twice")
}
