//! Inputs and outputs at the ends of the self-test's wires: TIM1 counts the clocks at SCLK, and captures SYNC; TIM2
//! captures the enable; DAC1 drives the monitor's input (RM0440, "General-purpose timers": "Input capture mode",
//! "External clock mode 1").
//!
//! | pin | function | wire |
//! |---|---|---|
//! | PC0 | TIM1_CH1 | from PB13, SCLK |
//! | PC1 | TIM1_CH2 | from PC6, SYNC |
//! | PB10 | TIM2_CH3 | from PB6, amplifier enable |
//! | PA4 | DAC1_OUT1 | to PA0, the monitor's input |
//! | PB14 | SPI2_MISO | from PB15, SPI2_MOSI |

use board_nucleo_g474re::clock::CORE_HZ;
use board_nucleo_g474re::period::{self, PERIOD_CYCLES};
use board_nucleo_g474re::pins;
use cortex_m::asm;
use frixel_board::self_test::{Fall, Levels, Wire};
use stm32_metapac::timer::vals::{CcmrInputCcs, Sms, Ts};
use stm32_metapac::{ADC1, DAC1, GPIOA, GPIOB, GPIOC, RCC, TIM1, TIM2};

const CYCLES_PER_US: u32 = CORE_HZ / 1_000_000;
/// Levels and alternate functions of the inputs (DS12288, "Alternate functions").
const CLOCK_IN: u32 = 0;
const SYNC_IN: u32 = 1;
const TIM1_FUNCTION: u8 = 2;
const ENABLE_IN: u32 = 10;
const TIM2_FUNCTION: u8 = 1;
const MONITOR: u32 = 0;

/// Supply of ADC and DAC, mV, and their largest code.
const SUPPLY_MV: u32 = 3_300;
const CODE_MAX: u32 = 4_095;
/// Number of averaged conversions, and time between two of them, us. The ADC takes 2.5 us for one.
const CONVERSIONS: u32 = 64;
const CONVERSION_US: u32 = 5;
/// Time for the DAC's buffer and the wire to settle (DS12288, "DAC characteristics": 3 us at most).
const SETTLING_US: u32 = 100;

/// Channels of TIM1: SYNC's rise and its fall. Channels of TIM2: the enable's rise and its fall.
const SYNC_ROSE: usize = 0;
const SYNC_FELL: usize = 1;
const ENABLE_ROSE: usize = 2;
const ENABLE_FELL: usize = 3;

/// The timers and the DAC.
pub(crate) struct Captures(());

/// Counts of the clocks at SCLK.
pub(crate) struct Counted {
    pub(crate) at_fall: u16,
    pub(crate) at_rise: u16,
    pub(crate) now: u16,
}

#[allow(clippy::unused_self, reason = "the registers belong to the value: there is one")]
impl Captures {
    /// Starts the timers. The DAC drives nothing yet.
    pub(crate) fn start() -> Self {
        RCC.apb2enr().modify(|w| w.set_tim1en(true));
        RCC.apb1enr1().modify(|w| w.set_tim2en(true));
        RCC.ahb2enr().modify(|w| w.set_dac1en(true));
        let _ = RCC.ahb2enr().read();
        // Both channels of TIM1 capture its second input: the first one is where it counts.
        TIM1.ccmr_input(0).write(|w| {
            w.set_ccs(SYNC_ROSE, CcmrInputCcs::TI3);
            w.set_ccs(SYNC_FELL, CcmrInputCcs::TI4);
        });
        TIM1.ccer().write(|w| {
            w.set_ccp(SYNC_FELL, true);
            w.set_cce(SYNC_ROSE, true);
            w.set_cce(SYNC_FELL, true);
        });
        // Both channels of TIM2 capture its third input.
        TIM2.ccmr_input(1).write(|w| {
            w.set_ccs(ENABLE_ROSE - 2, CcmrInputCcs::TI4);
            w.set_ccs(ENABLE_FELL - 2, CcmrInputCcs::TI3);
        });
        TIM2.ccer().write(|w| {
            w.set_ccp(ENABLE_FELL, true);
            w.set_cce(ENABLE_ROSE, true);
            w.set_cce(ENABLE_FELL, true);
        });
        TIM2.arr().write_value(u32::MAX);
        TIM2.cr1().modify(|w| w.set_cen(true));
        connect();
        Self(())
    }

    /// The levels at the end of a wire.
    pub(crate) fn levels(&mut self, wire: Wire) -> Levels {
        let (port, pin) = match wire {
            Wire::Clock => (GPIOC, CLOCK_IN),
            Wire::Sync => (GPIOC, SYNC_IN),
            Wire::Enable => (GPIOB, ENABLE_IN),
            Wire::Monitor => (GPIOA, MONITOR),
        };
        let [pulled_up, pulled_down] = pins::levels_through_pulls(port, pin);
        connect();
        Levels { pulled_up, pulled_down }
    }

    /// Lets TIM1 count the clocks at SCLK, from zero.
    pub(crate) fn count_clocks(&mut self) {
        TIM1.cr1().modify(|w| w.set_cen(false));
        TIM1.smcr().write(|w| {
            w.set_ts(Ts::TI1FP1);
            w.set_sms(Sms::EXT_CLOCK_MODE);
        });
        TIM1.arr().write(|w| w.set_arr(u16::MAX));
        TIM1.cnt().write(|w| w.set_cnt(0));
        TIM1.sr().write(|w| w.0 = 0);
        TIM1.cr1().modify(|w| w.set_cen(true));
    }

    /// The clocks since [`Self::count_clocks`]; `None` if SYNC did not fall and rise.
    pub(crate) fn counted(&self) -> Option<Counted> {
        let status = TIM1.sr().read();
        let has_moved = status.ccif(SYNC_FELL) && status.ccif(SYNC_ROSE);
        has_moved.then(|| Counted {
            at_fall: TIM1.ccr(SYNC_FELL).read().ccr(),
            at_rise: TIM1.ccr(SYNC_ROSE).read().ccr(),
            now: TIM1.cnt().read().cnt(),
        })
    }

    /// Lets TIM1 count the core's clock, with the length of the tick's period.
    pub(crate) fn measure_time(&mut self) {
        TIM1.cr1().modify(|w| w.set_cen(false));
        TIM1.smcr().write(|w| w.set_sms(Sms::DISABLED));
        TIM1.arr().write(|w| w.set_arr((PERIOD_CYCLES - 1) as u16));
        TIM1.cnt().write(|w| w.set_cnt(0));
        TIM1.sr().write(|w| w.0 = 0);
        TIM1.cr1().modify(|w| w.set_cen(true));
    }

    /// Cycle of the tick's period at which SYNC has risen since the last call. Call [`Self::measure_time`] before.
    pub(crate) fn latch_cycles(&mut self) -> Option<u32> {
        if !TIM1.sr().read().ccif(SYNC_ROSE) {
            return None;
        }
        let captured = u32::from(TIM1.ccr(SYNC_ROSE).read().ccr());
        Some((captured + PERIOD_CYCLES - ahead()) % PERIOD_CYCLES)
    }

    /// Discards the captured edges of the enable, and returns the time, in cycles.
    pub(crate) fn forget_edges(&mut self) -> u32 {
        TIM2.sr().write(|w| w.0 = 0);
        Self::now()
    }

    /// The time, in cycles.
    pub(crate) fn now() -> u32 {
        TIM2.cnt().read()
    }

    /// The cycle at which the enable rose since the last call; `None` if it did not.
    pub(crate) fn enable_rose(&mut self) -> Option<u32> {
        TIM2.sr().read().ccif(ENABLE_ROSE).then(|| TIM2.ccr(ENABLE_ROSE).read())
    }

    /// The last fall of the enable since the last call; `None` if it did not fall.
    pub(crate) fn enable_fell(&mut self) -> Option<Fall> {
        let status = TIM2.sr().read();
        status
            .ccif(ENABLE_FELL)
            .then(|| Fall { at: TIM2.ccr(ENABLE_FELL).read(), had_fallen_before: status.ccof(ENABLE_FELL) })
    }

    /// Drives a voltage into the monitor's wire, and returns what ADC1 reads.
    pub(crate) fn loop_mv(&mut self, driven_mv: u32) -> u32 {
        // Above 160 MHz (RM0440, "DAC_MCR": HFSEL). The output is buffered, and goes to the pin: mode 0.
        DAC1.mcr().modify(|w| w.set_hfsel(0b10));
        DAC1.cr().modify(|w| w.set_en(0, true));
        DAC1.dhr12r(0).write(|w| w.set_dhr((driven_mv.min(SUPPLY_MV) * CODE_MAX / SUPPLY_MV) as u16));
        asm::delay(SETTLING_US * CYCLES_PER_US);
        let mut sum = 0;
        for _ in 0..CONVERSIONS {
            asm::delay(CONVERSION_US * CYCLES_PER_US);
            sum += u32::from(ADC1.dr().read().rdata());
        }
        sum * SUPPLY_MV / CODE_MAX / CONVERSIONS
    }
}

/// Cycles by which TIM1 is ahead of the tick's period. Both have the same length, so the lead is constant. TIM1 is
/// compared with the midpoint of two reads of the period, because a read takes some cycles.
fn ahead() -> u32 {
    cortex_m::interrupt::free(|_| {
        let before = period::cycles();
        let time = u32::from(TIM1.cnt().read().cnt());
        let after = period::cycles();
        // A period may end between the reads.
        let after = if after < before { after + PERIOD_CYCLES } else { after };
        (time + 2 * PERIOD_CYCLES - before.midpoint(after)) % PERIOD_CYCLES
    })
}

/// Connects the pins to the timers, and PA0 to the ADC.
fn connect() {
    pins::alternate(GPIOC, CLOCK_IN, TIM1_FUNCTION);
    pins::alternate(GPIOC, SYNC_IN, TIM1_FUNCTION);
    pins::alternate(GPIOB, ENABLE_IN, TIM2_FUNCTION);
    pins::analog(GPIOA, MONITOR);
}
