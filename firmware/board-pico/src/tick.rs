//! The interrupt of PIO 0, which runs the tick of [`frixel_board::tick`], at priority 0.
//!
//! | pin | function | |
//! |---|---|---|
//! | GP10 | input, pulled down | amplifier: high while it is ready |
//! | GP14 | input, pulled down | arm switch: high while held |
//!
//! The two are far from one another on the connector, so that no bridge between neighbours closes the switch.

use cortex_m::peripheral::NVIC;
use frixel_board::hardware::Hardware;
use frixel_board::tick::{Tick, TickShared};
use frixel_control::Ticker;
use frixel_cortex_m::TickOwner;
use frixel_drivers::amplifier::Amplifier;
use frixel_drivers::arm_switch::ArmSwitch;
use frixel_session::TickEnds;
use rp_pac::{Interrupt, interrupt};

use crate::adc::Adc;
use crate::board::Pico;
use crate::dac::Frames;
use crate::output::Output;
use crate::period::{self, Period};
use crate::pins::Pin;

const AMPLIFIER_READY: usize = 10;
const ARM_SWITCH: usize = 14;

/// Every other interrupt has the priority below that of the tick, 0: the number is in the upper bits of eight.
const BELOW_THE_TICK: u8 = 1 << 6;

static TICK: TickOwner<Pico> = TickOwner::new();
/// What the tick shares with the main loop.
pub static SHARED: TickShared = TickShared::new::<Period>();

#[cfg(feature = "log")]
defmt::timestamp!("tick {=u32}", SHARED.count());

/// Starts the tick. Called once: a second call leaves the first tick as it is. The input pins are configured here.
pub fn start(nvic: &mut NVIC, ticker: Ticker<'static>, queues: TickEnds, frames: Frames, output: Output) {
    let tick = Tick {
        shared: &SHARED,
        ticker,
        queues,
        period: Period,
        frames,
        amplifier: Amplifier::new(output, Pin::input_pulled_down(AMPLIFIER_READY)),
        monitor: Adc::new(),
        arm_switch: ArmSwitch::new(Pin::input_pulled_down(ARM_SWITCH), Pico::TICK_HZ),
    };
    if TICK.give(tick).is_none() {
        return;
    }
    period::start_interrupts();
    // SAFETY: no critical section depends on a priority, and none on the interrupt being masked.
    unsafe {
        nvic.set_priority(Interrupt::UART0_IRQ, BELOW_THE_TICK);
        nvic.set_priority(Interrupt::PIO0_IRQ_0, 0);
        NVIC::unmask(Interrupt::PIO0_IRQ_0);
    }
}

/// The tick.
#[interrupt]
fn PIO0_IRQ_0() {
    // SAFETY: this is the handler.
    unsafe { TICK.run() }
}
