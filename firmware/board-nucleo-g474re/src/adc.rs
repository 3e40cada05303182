//! The amplifier's monitor on ADC1, which converts continuously; the tick reads the last conversion.
//!
//! | pin | function | |
//! |---|---|---|
//! | PA0 | ADC12_IN1 | monitor, 1.65 V for 0 V at the amplifier's output |

use cortex_m::asm;
use frixel_board::hardware::Monitor;
use frixel_cortex_m::Boot;
use frixel_drivers::monitor::MonitorScale;
use stm32_metapac::adc::vals::{Adcaldif, Ovrmod, Res, SampleTime};
use stm32_metapac::adccommon::vals::Ckmode;
use stm32_metapac::{ADC1, ADC12_COMMON};

use crate::clock::CORE_HZ;
use crate::wait_until;

const CHANNEL: u8 = 1;

/// The monitor's ADC. PA0 is analog from reset on.
pub struct Adc(());

impl Adc {
    /// Calibrates the ADC and starts conversion (RM0440, "ADC": "ADC deep-power-down mode and ADC voltage regulator",
    /// "Calibration", "ADC on-off control").
    pub fn new(_: &Boot) -> Self {
        // 42.5 MHz; the ADC allows 60.
        ADC12_COMMON.ccr().modify(|w| w.set_ckmode(Ckmode::SYNC_DIV4));
        ADC1.cr().modify(|w| w.set_deeppwd(false));
        ADC1.cr().modify(|w| w.set_advregen(true));
        // The regulator takes 20 us at most (DS12288, "ADC characteristics").
        asm::delay(CORE_HZ / 1_000_000 * 40);
        ADC1.cr().modify(|w| {
            w.set_adcaldif(Adcaldif::SINGLE_ENDED);
            w.set_adcal(true);
        });
        wait_until(|| !ADC1.cr().read().adcal(), "the calibration of ADC1");
        // The ADC ignores an enable within four of its clocks after the calibration (RM0440, "ADC on-off control").
        asm::delay(64);
        ADC1.isr().write(|w| w.set_adrdy(true));
        ADC1.cr().modify(|w| w.set_aden(true));
        wait_until(|| ADC1.isr().read().adrdy(), "ADC1");
        ADC1.cfgr().modify(|w| {
            w.set_res(Res::BITS12);
            w.set_cont(true);
            w.set_ovrmod(Ovrmod::OVERWRITE);
        });
        // 92.5 + 12.5 clocks, 2.5 us, of which 2.2 us sample: enough for 1 kOhm in front of the pin, and for ten times
        // that.
        ADC1.smpr().modify(|w| w.set_smp(usize::from(CHANNEL), SampleTime::CYCLES92_5));
        ADC1.sqr1().modify(|w| {
            w.set_l(0);
            w.set_sq(0, CHANNEL);
        });
        ADC1.cr().modify(|w| w.set_adstart(true));
        Self(())
    }
}

impl Monitor for Adc {
    /// Converted at most 2.5 us ago.
    #[inline]
    fn monitor_v(&mut self) -> f32 {
        MonitorScale::SHIFTED.volts(ADC1.dr().read().rdata())
    }
}
