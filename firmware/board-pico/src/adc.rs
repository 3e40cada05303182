//! The amplifier's monitor on the ADC, which converts continuously; the tick reads the last conversion.
//!
//! | pin | function | |
//! |---|---|---|
//! | GP26 | ADC0 | monitor, 1.65 V for 0 V at the amplifier's output |

use frixel_board::hardware::Monitor;
use frixel_cortex_m::Boot;
use frixel_drivers::monitor::MonitorScale;
use rp_pac::ADC;

use crate::{pins, wait_until};

const MONITOR_PIN: usize = 26;
const CHANNEL: u8 = 0;

/// The monitor's ADC.
pub struct Adc(());

impl Adc {
    /// Starts the ADC, with a conversion every 2 us (RP2040, 4.9.2, "SAR ADC").
    pub fn new(_: &Boot) -> Self {
        pins::analog(MONITOR_PIN);
        ADC.cs().write(|w| w.set_en(true));
        wait_until(|| ADC.cs().read().ready(), "the ADC");
        ADC.cs().write(|w| {
            w.set_en(true);
            w.set_ainsel(CHANNEL);
            w.set_start_many(true);
        });
        Self(())
    }
}

impl Monitor for Adc {
    /// Volts at the amplifier's output, before the series resistor, at most 4 us ago.
    #[inline]
    fn monitor_v(&mut self) -> f32 {
        MonitorScale::SHIFTED.volts(ADC.result().read().result())
    }
}
