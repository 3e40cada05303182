//! The interrupt of PIO 0, which runs the tick of [`frixel_board::tick`], at priority 0.
//!
//! | pin | function | |
//! |---|---|---|
//! | GP10 | input, pulled down | amplifier: high while it is ready |
//! | GP14 | input, pulled down | arm switch: high while held |
//!
//! The two are far apart on the connector, so that no bridge between neighbours closes the switch.

use cortex_m::peripheral::NVIC;
use frixel_board::tick::{Tick, TickShared};
use frixel_cortex_m::Boot;
use rp_pac::{Interrupt, interrupt};

use crate::board::Pico;
use crate::period::{self, Period};
use crate::pins::{self, Pin};

const AMPLIFIER_READY: usize = 10;
const ARM_SWITCH: usize = 14;

/// Priority of every other interrupt, below the tick's priority 0. The number is in the upper bits of eight.
const BELOW_THE_TICK: u8 = 1 << 6;

frixel_cortex_m::tick_interrupt!(Pico, PIO0_IRQ_0);

/// Data shared between the tick and the main loop.
pub static SHARED: TickShared = TickShared::new::<Period>();

#[cfg(feature = "log")]
defmt::timestamp!("tick {=u32}", SHARED.count());

/// Configures both input pins: the amplifier's ready line, and the arm switch.
pub fn start_inputs(_: &Boot) -> (Pin, Pin) {
    (pins::input_pulled_down(AMPLIFIER_READY), pins::input_pulled_down(ARM_SWITCH))
}

/// Gives the tick to its interrupt, and enables the interrupt.
pub fn start(nvic: &mut NVIC, boot: Boot, tick: Tick<Pico>) {
    TICK.give(boot, tick);
    period::start_interrupts();
    // SAFETY: no critical section depends on a priority, and none on the interrupt being masked.
    unsafe {
        nvic.set_priority(Interrupt::UART0_IRQ, BELOW_THE_TICK);
        nvic.set_priority(Interrupt::PIO0_IRQ_0, 0);
        NVIC::unmask(Interrupt::PIO0_IRQ_0);
    }
}
