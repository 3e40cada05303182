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

/// The tick of a program, which its interrupt owns: [`tick_interrupt`](crate::tick_interrupt) declares both.
pub struct TickOwner<H: Hardware>(Owned<Tick<H>>);

impl<H: Hardware> TickOwner<H>
where
    Tick<H>: Send,
{
    /// No tick yet.
    #[allow(clippy::new_without_default, reason = "it belongs in a static")]
    pub const fn new() -> Self {
        Self(Owned::new())
    }

    /// Starts the tick. Called once.
    #[inline]
    pub fn start(&self, tick: Tick<H>) {
        // SAFETY: TIM3 is unmasked below.
        unsafe { self.0.give(tick) };
        period::start_interrupts();
        // SAFETY: no critical section depends on it being masked. Priority 0, the highest, is its priority from reset
        // on.
        unsafe { NVIC::unmask(Interrupt::TIM3) };
    }

    /// Runs the tick; its deadline is 21.8 us into the period.
    ///
    /// # Safety
    /// Only the handler of TIM3 calls this.
    #[inline]
    pub unsafe fn run(&self) {
        // SAFETY: the handler owns the value, says the caller.
        if let Some(tick) = unsafe { self.0.get() } {
            tick.run();
        }
    }
}

/// Declares `TICK`, the tick of a program whose parts are those of `$hardware`, and its interrupt.
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
    owner.start(Tick {
        shared: &SHARED,
        ticker,
        queues,
        period: Period,
        frames,
        amplifier: Amplifier::new(output, Pin::input_pulled_down(GPIOC, AMPLIFIER_READY)),
        monitor: Adc::new(),
        arm_switch: ArmSwitch::new(Pin::input_pulled_down(GPIOB, ARM_SWITCH), Nucleo::TICK_HZ),
    });
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
