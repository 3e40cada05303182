//! The measurements of bring-up.

use board_nucleo_g474re::adc::Adc;
use board_nucleo_g474re::board::{LIMITS, TICK_HZ};
use board_nucleo_g474re::clock::CORE_HZ;
use board_nucleo_g474re::dac::{self, Dac, DacFrames};
use board_nucleo_g474re::output::{LIFE_US, Output};
use board_nucleo_g474re::{period, tick};
use cortex_m::peripheral::DWT;
use defmt::{error, info, println, warn};
use frixel_wire::dac_code::DacCode;
use stm32_metapac::GPIOC;

/// The blue button, PC13. Its level at rest shows which level means pressed.
const BUTTON: usize = 13;
/// Half a period of the square wave: 500 us.
const HALF_PERIOD_TICKS: u32 = TICK_HZ / 2000;
const CYCLES_PER_US: u32 = CORE_HZ / 1_000_000;

/// The board under test.
pub(crate) struct Bench {
    output: Output,
    frames: DacFrames,
    dac: Dac,
    adc: Adc,
    button_rests_high: bool,
}

impl Bench {
    /// Takes the board's peripherals.
    pub(crate) fn new(output: Output) -> Self {
        tick::start_inputs();
        let (frames, dac) = dac::start();
        Self { output, frames, dac, adc: Adc::new(), button_rests_high: button_is_high() }
    }

    /// Logs what to do, and waits for the button with the output at zero.
    pub(crate) fn prompt(&mut self, what: &str) {
        self.output.zero();
        println!("");
        println!("{=str} Then press the blue button to continue.", what);
        self.wait_for_button(|_| ());
    }

    /// Calls `meanwhile` every period until the button is pressed and released.
    fn wait_for_button(&mut self, mut meanwhile: impl FnMut(&mut Self)) {
        for pressed in [true, false] {
            // Pressed for 50 ms without a break, so that a bounce does not count.
            let mut periods = 0;
            while periods < TICK_HZ / 20 {
                next_period();
                meanwhile(self);
                periods = if (button_is_high() != self.button_rests_high) == pressed { periods + 1 } else { 0 };
            }
        }
        self.output.zero();
    }

    /// Measures how long the output stays enabled after a kick. Returns whether it is off in time.
    pub(crate) fn one_shot(&mut self) -> bool {
        let mut passed = true;
        if self.output.pins() != (false, false) {
            error!("amplifier enable (PB6) or DAC clear (PB7) is high without a kick");
            passed = false;
        }
        for _ in 0..3 {
            let start = DWT::cycle_count();
            let us = || DWT::cycle_count().wrapping_sub(start) / CYCLES_PER_US;
            self.output.kick();
            while us() < 10 {}
            if self.output.pins() != (true, true) {
                error!("a kick does not put both pins high: is one shorted?");
                passed = false;
            }
            while self.output.pins() != (false, false) && us() < 10_000 {}
            match us() {
                us if us <= 1000 => info!("output off {=u32} us after the last kick ({=u16} expected)", us, LIFE_US),
                us => {
                    error!("output still on {=u32} us after the last kick", us);
                    passed = false;
                }
            }
        }
        self.output.kick();
        self.output.zero();
        if self.output.pins() != (false, false) {
            error!("the output does not go off at once");
            passed = false;
        }
        passed
    }

    /// Configures the DAC and puts out some voltages. Returns whether the DAC answered.
    pub(crate) fn dac(&mut self) -> bool {
        if let Err(error) = self.dac.prepare() {
            error!("the DAC does not answer on PB14: check supply, SPI2 (PB13, PB15), SYNC (PC6): {}", error);
            return false;
        }
        info!("the DAC answers with its configuration");
        for (code, volts) in [(0, 0), (16_384, 5), (-16_384, -5)] {
            println!("the voltmeter shows {=i32} V; the button goes on", volts);
            self.wait_for_button(|bench| {
                bench.put(code);
            });
        }
        println!("now CLEAR: the voltmeter shows 0 V, though the last code was 5 V; the button goes on");
        for _ in 0..TICK_HZ {
            next_period();
            self.put(16_384);
        }
        self.output.zero();
        self.wait_for_button(|_| ());
        true
    }

    /// Logs the inputs whenever they change.
    pub(crate) fn inputs(&mut self) {
        println!("let the amplifier report a fault, hold the arm switch, pull each wire; the button goes on");
        let mut last = None;
        self.wait_for_button(|_| {
            let now = tick::inputs();
            if last != Some(now) {
                last = Some(now);
                info!("amplifier ready: {=bool}, arm switch held: {=bool}", now.0, now.1);
            }
        });
    }

    /// Puts out a square wave of 1 kHz for two seconds while the arm switch is held, and logs the monitor's readings.
    ///
    /// Returns whether the monitor is within a fifth of the wave.
    pub(crate) fn square(&mut self, peak_v: f32) -> bool {
        let code = (peak_v / LIMITS.full_scale_v_peak * f32::from(i16::MAX)) as i16;
        println!("hold the arm switch: a square wave of {=f32} V peak follows", peak_v);
        wait_for_switch();
        let (mut high_v, mut low_v, mut halves) = (0.0, 0.0, 0.0);
        for period in 0..2 * TICK_HZ {
            next_period();
            let positive = (period / HALF_PERIOD_TICKS).is_multiple_of(2);
            if !tick::inputs().1 {
                self.output.zero();
                warn!("the arm switch was released");
                return false;
            }
            self.put(if positive { code } else { -code });
            // The last reading of each half wave, when the voltage has settled.
            if (period + 1).is_multiple_of(HALF_PERIOD_TICKS) {
                let volts = self.adc.monitor_v();
                if positive {
                    high_v += volts;
                    halves += 1.0;
                } else {
                    low_v += volts;
                }
            }
        }
        self.output.zero();
        let (high_v, low_v) = (high_v / halves, low_v / halves);
        info!(
            "the monitor shows {=f32} V and {=f32} V; full scale would be {=f32} V",
            high_v,
            low_v,
            0.5 * (high_v - low_v) / peak_v * LIMITS.full_scale_v_peak
        );
        let passed = (0.8 * peak_v..=1.2 * peak_v).contains(&(0.5 * (high_v - low_v)));
        if !passed {
            error!("that is more than a fifth off: check the amplifier's gain and the monitor's level shifter");
        }
        passed
    }

    /// Measures the time constant of an edge from -20 V to 20 V: reads the monitor every 2.5 us, until it has covered
    /// 63 % of the edge.
    ///
    /// Returns whether an edge was seen.
    pub(crate) fn edge(&mut self) -> bool {
        let code = (20.0 / LIMITS.full_scale_v_peak * f32::from(i16::MAX)) as i16;
        println!("hold the arm switch: edges of 40 V follow");
        wait_for_switch();
        let (mut sum_us, mut edges) = (0, 0);
        for _ in 0..200 {
            for _ in 0..HALF_PERIOD_TICKS {
                next_period();
                self.put(-code);
            }
            let from_v = self.adc.monitor_v();
            next_period();
            self.put(code);
            while period::cycles() < period::LATCH_CYCLES {}
            let start = DWT::cycle_count();
            let us = || DWT::cycle_count().wrapping_sub(start) / CYCLES_PER_US;
            while self.adc.monitor_v() < from_v + 0.632 * 40.0 && us() < 400 {}
            if us() < 400 {
                sum_us += us();
                edges += 1;
            }
            for _ in 0..HALF_PERIOD_TICKS {
                next_period();
                self.put(code);
            }
            if !tick::inputs().1 {
                break;
            }
        }
        self.output.zero();
        let Some(us) = sum_us.checked_div(edges) else {
            error!("no edge was seen on the monitor");
            return false;
        };
        info!("an edge takes {=u32} us to 63 %, mean of {=u32} edges", us, edges);
        true
    }

    /// Puts a code out at the end of this period, and keeps the output enabled.
    fn put(&mut self, code: i16) {
        if self.frames.send(DacCode::from_bits(code)) {
            self.output.kick();
        } else {
            self.output.zero();
        }
    }
}

fn wait_for_switch() {
    while !tick::inputs().1 {
        next_period();
    }
}

fn next_period() {
    let _ = period::has_begun();
    while !period::has_begun() {}
}

fn button_is_high() -> bool {
    GPIOC.idr().read().idr(BUTTON) == stm32_metapac::gpio::vals::Idr::HIGH
}
