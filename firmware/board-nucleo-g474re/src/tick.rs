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
pub use frixel_cortex_m::TickOwner;
use frixel_drivers::amplifier::Amplifier;
use frixel_drivers::arm_switch::ArmSwitch;
use frixel_session::TickEnds;
use stm32_metapac::{GPIOB, GPIOC, Interrupt};

use crate::adc::Adc;
use crate::board::Nucleo;
use crate::dac::Frames;
use crate::output::Output;
use crate::period::Period;
use crate::pins::Pin;
use crate::{period, pins};

const AMPLIFIER_READY: u32 = 10;
const ARM_SWITCH: u32 = 2;

/// Gives the tick to its interrupt, and starts that. A second call changes nothing: the first tick goes on.
#[inline]
pub fn start_interrupt<H: Hardware>(owner: &TickOwner<H>, tick: Tick<H>)
where
    Tick<H>: Send,
{
    if owner.give(tick).is_some() {
        period::start_interrupts();
        // SAFETY: no critical section depends on it being masked. Priority 0, the highest, is its priority from reset
        // on.
        unsafe { NVIC::unmask(Interrupt::TIM3) };
    }
}

/// Declares `TICK`, the tick of a program whose parts are those of `$hardware`, and its interrupt. The tick's deadline is
/// 21.8 us into the period.
#[macro_export]
macro_rules! tick_interrupt {
    ($hardware:ty) => {
        static TICK: $crate::tick::TickOwner<$hardware> = $crate::tick::TickOwner::new();

        #[interrupt]
        fn TIM3() {
            // SAFETY: this is the handler.
            unsafe { TICK.run() }
        }
    };
}

/// What the tick shares with the main loop.
pub static SHARED: TickShared = TickShared::new::<Period>();

#[cfg(feature = "log")]
defmt::timestamp!("tick {=u32}", count());

/// Starts the tick of a program with all parts of this board. The input pins are configured here.
pub fn start(owner: &TickOwner<Nucleo>, ticker: Ticker<'static>, queues: TickEnds, frames: Frames, output: Output) {
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
    start_interrupt(owner, tick);
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
