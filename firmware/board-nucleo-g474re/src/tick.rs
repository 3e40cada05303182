//! The interrupt of TIM3, 40,000 times a second, which runs the tick of [`frixel_board::tick`], at priority 0.
//!
//! | pin | function | |
//! |---|---|---|
//! | PC10 | input, pulled down | amplifier: high while it is ready |
//! | PB2 | input, pulled down | arm switch: high while held |
//!
//! The two lie on different connectors (PC10 on CN7, PB2 on CN10 beside a ground pin), so that no bridge between
//! neighbours closes the switch (UM2505, "Extension connectors", not read).

use cortex_m::peripheral::NVIC;
use frixel_board::hardware::Hardware;
use frixel_board::tick::{Tick, TickShared};
use frixel_cortex_m::{Boot, TickOwner};
use stm32_metapac::{GPIOB, GPIOC, Interrupt};

use crate::period;
use crate::period::Period;
use crate::pins::{self, Pin};

const AMPLIFIER_READY: u32 = 10;
const ARM_SWITCH: u32 = 2;

/// Data shared between the tick and the main loop.
pub static SHARED: TickShared = TickShared::new::<Period>();

#[cfg(feature = "log")]
defmt::timestamp!("tick {=u32}", count());

/// Gives the tick to its interrupt, and enables the interrupt. The tick's deadline is 21.8 us into the period.
#[inline]
pub fn start<H: Hardware>(owner: &TickOwner<H>, boot: Boot, tick: Tick<H>)
where
    Tick<H>: Send,
{
    owner.give(boot, tick);
    period::start_interrupts();
    // SAFETY: no critical section depends on it being masked. Priority 0, the highest, is its priority from reset on.
    unsafe { NVIC::unmask(Interrupt::TIM3) };
}

/// Configures both input pins: the amplifier's ready line, and the arm switch.
pub fn start_inputs(_: &Boot) -> (Pin, Pin) {
    (pins::input_pulled_down(GPIOC, AMPLIFIER_READY), pins::input_pulled_down(GPIOB, ARM_SWITCH))
}

/// Ticks since reset, modulo 2^32.
pub fn count() -> u32 {
    SHARED.count()
}

/// The levels of the inputs: the amplifier is ready, and the contact of the arm switch is closed.
pub fn inputs() -> (bool, bool) {
    (pins::is_high(GPIOC, AMPLIFIER_READY), pins::is_high(GPIOB, ARM_SWITCH))
}
