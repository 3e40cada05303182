//! The interrupt of TIM3, 40,000 times a second, which runs the tick of [`frixel_board::tick`], at priority 0.
//!
//! | pin | function | |
//! |---|---|---|
//! | PC10 | input, pulled down | amplifier: high while it is ready |
//! | PB2 | input, pulled down | arm switch: high while held |
//!
//! The two lie on different connectors (PC10 on CN7, PB2 on CN10 beside a ground pin), so that no bridge between
//! neighbours closes the switch (UM2505, "Extension connectors", unread).

use cortex_m::peripheral::NVIC;
use frixel_board::hardware::Hardware;
use frixel_board::tick::{Tick, TickShared};
use frixel_control::Ticker;
use frixel_cortex_m::Owned;
use frixel_drivers::amplifier::Amplifier;
use frixel_drivers::arm_switch::ArmSwitch;
use frixel_session::TickEnds;
use stm32_metapac::{GPIOB, GPIOC, Interrupt, interrupt};

use crate::adc::Adc;
use crate::board::Nucleo;
use crate::dac::Frames;
use crate::output::Output;
use crate::period::Period;
use crate::pins::Pin;
use crate::{period, pins};

const AMPLIFIER_READY: u32 = 10;
const ARM_SWITCH: u32 = 2;

static TICK: Owned<Tick<Nucleo>> = Owned::new();
/// What the tick shares with the main loop.
pub static SHARED: TickShared = TickShared::new::<Period>();

#[cfg(feature = "log")]
defmt::timestamp!("tick {=u32}", count());

/// Starts the tick. The input pins are configured here.
pub fn start(ticker: Ticker<'static>, queues: TickEnds, frames: Frames, output: Output) {
    let tick = Tick {
        shared: &SHARED,
        ticker,
        queues,
        period: Period,
        frames,
        amplifier: Amplifier::new(output, Pin::input_pulled_down(GPIOC, AMPLIFIER_READY)),
        monitor: Adc::new(),
        arm_switch: ArmSwitch::new(Pin::input_pulled_down(GPIOB, ARM_SWITCH), Nucleo::TICK_HZ),
    };
    // SAFETY: TIM3 is unmasked below.
    unsafe { TICK.give(tick) };
    period::start_interrupts();
    // SAFETY: no critical section depends on it being masked. Priority 0, the highest, is its priority from reset on.
    unsafe { NVIC::unmask(Interrupt::TIM3) };
}

/// Configures both input pins before the tick runs, for bring-up.
pub fn start_inputs() {
    pins::input_pulled_down(GPIOC, AMPLIFIER_READY);
    pins::input_pulled_down(GPIOB, ARM_SWITCH);
}

/// Ticks since reset, modulo 2^32.
pub fn count() -> u32 {
    SHARED.count()
}

/// The levels of the inputs: the amplifier is ready, and the contact of the arm switch is closed.
pub fn inputs() -> (bool, bool) {
    (pins::is_high(GPIOC, AMPLIFIER_READY), pins::is_high(GPIOB, ARM_SWITCH))
}

/// The tick; its deadline is 21.8 us into the period.
#[interrupt]
fn TIM3() {
    // SAFETY: this is the handler that owns the value.
    if let Some(tick) = unsafe { TICK.get() } {
        tick.run();
    }
}
