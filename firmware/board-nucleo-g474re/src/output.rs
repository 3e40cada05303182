//! The output enable: DAC clear and amplifier enable, held by a one-shot timer.
//!
//! Both pins are channels of TIM4 in one-pulse mode. A kick sets them high, and they go low by themselves [`LIFE_US`]
//! after the last kick, whatever the core does (RM0440, "General-purpose timers": "One-pulse mode", "PWM mode"). They
//! are low while the counter is zero, which is where it stops. External resistors pull both wires down, so that they
//! are low in reset, too: that disables the amplifier, but a frame that is latched meanwhile leaves its code in the
//! DAC. So [`zero_for_good`] is the first thing after every reset.
//!
//! | pin | function | |
//! |---|---|---|
//! | PB6 | TIM4_CH1 | amplifier enable, high enables |
//! | PB7 | TIM4_CH2 | CLEAR of the DAC, low clears |

use frixel_cortex_m::Boot;
use frixel_drivers::ad5761r::zero_output;
use frixel_drivers::amplifier::KickedEnable;
use stm32_metapac::timer::vals::Ocm;
use stm32_metapac::{GPIOB, GPIOC, RCC, TIM4};

use crate::clock::CORE_HZ;
use crate::period::SYNC;
use crate::pins::{self, forced};

/// Time from the last kick until the output is zero, in us. The specification is 1 ms.
pub const LIFE_US: u16 = 900;

const AMPLIFIER_ENABLE: u32 = 6;
const DAC_CLEAR: u32 = 7;
const TIM4_FUNCTION: u8 = 2;

/// The one-shot timer.
pub struct Output(());

impl Output {
    /// Takes the pins of the one-shot, which are low. [`zero_for_good`] has set them low before.
    pub fn new(_: &Boot) -> Self {
        RCC.apb1enr1().modify(|w| w.set_tim4en(true));
        let _ = RCC.apb1enr1().read();
        TIM4.psc().write_value((CORE_HZ / 1_000_000 - 1) as u16);
        TIM4.arr().write(|w| w.set_arr(LIFE_US));
        TIM4.cr1().write(|w| w.set_opm(true));
        TIM4.ccr(0).write(|w| w.set_ccr(1));
        TIM4.ccr(1).write(|w| w.set_ccr(1));
        let output = Self(());
        mode(Ocm::FORCE_INACTIVE, Ocm::FORCE_INACTIVE);
        // Loads the prescaler. The counter does not run.
        TIM4.egr().write(|w| w.set_ug(true));
        TIM4.ccer().write(|w| {
            w.set_cce(0, true);
            w.set_cce(1, true);
        });
        pins::alternate(GPIOB, AMPLIFIER_ENABLE, TIM4_FUNCTION);
        pins::alternate(GPIOB, DAC_CLEAR, TIM4_FUNCTION);
        output
    }

    /// Enables the DAC's output for another [`LIFE_US`], with the amplifier disabled, regardless of earlier kicks.
    pub fn kick_dac_alone(&mut self) {
        TIM4.ccmr_output(0).modify(|w| w.set_ocm(0, Ocm::FORCE_INACTIVE));
        restart(Ocm::FORCE_INACTIVE);
    }

    /// Levels of the pins: amplifier enable, DAC clear.
    pub fn pins(&self) -> (bool, bool) {
        (pins::is_high(GPIOB, AMPLIFIER_ENABLE), pins::is_high(GPIOB, DAC_CLEAR))
    }
}

impl KickedEnable for Output {
    /// Enables the output for another [`LIFE_US`].
    #[inline]
    fn kick(&mut self) {
        restart(Ocm::PWM_MODE2);
    }

    /// Sets the output to zero at once.
    #[inline]
    fn disable(&mut self) {
        mode(Ocm::FORCE_INACTIVE, Ocm::FORCE_INACTIVE);
        TIM4.cr1().modify(|w| w.set_cen(false));
        TIM4.cnt().write(|w| w.set_cnt(0));
    }
}

/// Restarts the timer. If it was stopped, this also sets the output mode of the amplifier enable, and makes CLEAR a
/// one-shot.
#[inline]
fn restart(enable: Ocm) {
    if TIM4.cr1().read().cen() && TIM4.cnt().read().cnt() >= 1 {
        TIM4.cnt().write(|w| w.set_cnt(1));
    } else {
        // Start from zero: the pins rise when the counter passes 1, because only a change of the comparison moves
        // them.
        TIM4.cnt().write(|w| w.set_cnt(0));
        mode(enable, Ocm::PWM_MODE2);
    }
    // Always: if the counter has just reached its end and stopped, it must not stay at 1 with the pins high.
    TIM4.cr1().modify(|w| w.set_cen(true));
}

/// Sets the output modes of both channels.
#[inline]
fn mode(enable: Ocm, clear: Ocm) {
    TIM4.ccmr_output(0).write(|w| {
        w.set_ocm(0, enable);
        w.set_ocm(1, clear);
    });
}

/// Sets the output to zero until the next reset, from any context: disconnects amplifier enable, SYNC and CLEAR from
/// their timers, in the order that [`zero_output`] explains.
pub fn zero_for_good() {
    pins::start();
    zero_output(&mut forced(GPIOB, AMPLIFIER_ENABLE), &mut forced(GPIOC, SYNC), &mut forced(GPIOB, DAC_CLEAR));
}
