//! The board before the tick runs: kicks the one-shot, and sends codes to the DAC. There is no high voltage: the
//! amplifier is disabled while the DAC outputs a code. Only the tests of the one-shot and of the enable path enable it,
//! with the DAC at zero.

use board_nucleo_g474re::board::TICK_HZ;
use board_nucleo_g474re::clock::CORE_HZ;
use board_nucleo_g474re::dac::{Dac, Frames};
use board_nucleo_g474re::output::{LIFE_US, Output};
use board_nucleo_g474re::period::Period;
use board_nucleo_g474re::pins::Pin;
use board_nucleo_g474re::{tick, watchdog};
use cortex_m::peripheral::DWT;
use frixel_board::bring_up::{Sync, TestOutput};
use frixel_board::hardware::DacFrames as _;
use frixel_board::memory::Memory;
use frixel_cortex_m::Boot;
use frixel_drivers::amplifier::KickedEnable as _;
use frixel_wire::dac_code::DacCode;

use crate::Terminal;

const CYCLES_PER_US: u32 = CORE_HZ / 1_000_000;
/// Voltage of the DAC at full scale, V.
const DAC_FULL_SCALE_V: f32 = 10.0;
/// Longest time from the last kick until the output is off, us.
const OFF_WITHIN_US: u32 = 1000;
/// Periods in 2 ms.
const PERIODS_PER_2_MS: u32 = TICK_HZ / 500;

/// The parts that the tick takes over when it starts.
pub(crate) struct Still {
    pub(crate) memory: &'static mut Memory,
    pub(crate) boot: Boot,
    pub(crate) period: Period,
    pub(crate) inputs: (Pin, Pin),
    pub(crate) output: Output,
    pub(crate) frames: Frames,
    pub(crate) dac: Dac,
    /// Periods since SYNC has last risen for [`Sync::Every2Ms`].
    pub(crate) periods: u32,
}

impl Still {
    /// Waits for the next period, and outputs `output` at its end, or zero while the amplifier is ready.
    pub(crate) fn next_period(&mut self, output: TestOutput) {
        watchdog::feed();
        self.period.wait_for_next();
        match output {
            _ if tick::inputs().0 => self.output.disable(),
            TestOutput::Dac(volts) if self.frames.send(code(volts)).is_ok() => self.output.kick_dac_alone(),
            TestOutput::Enable { kicked, sync } if self.sync(sync) && kicked => self.output.kick(),
            _ => self.output.disable(),
        }
    }

    /// Raises SYNC in this period if it is due, with a frame of zero. Returns `false` if that failed.
    fn sync(&mut self, sync: Sync) -> bool {
        self.periods = (self.periods + 1) % PERIODS_PER_2_MS;
        let rises = match sync {
            Sync::Never => false,
            Sync::EveryPeriod => true,
            Sync::Every2Ms => self.periods == 0,
        };
        !rises || self.frames.send(DacCode::ZERO).is_ok()
    }

    /// Sets the output to zero. The last frame has been latched before, so that CLEAR comes after it.
    pub(crate) fn zero(&mut self) {
        for _ in 0..2 {
            self.period.wait_for_next();
        }
        self.output.disable();
    }

    /// Configures the DAC and reads it back.
    pub(crate) fn check_dac(&mut self, terminal: &mut Terminal) -> bool {
        let prepared = self.dac.prepare();
        if let Err(error) = &prepared {
            terminal.say(format_args!("On PB13 (SCLK), PB15 (SDI), PB14 (SDO), PC6 (SYNC): {error}."));
        }
        prepared.is_ok()
    }

    /// Measures how long the output stays enabled after a kick.
    pub(crate) fn check_one_shot(&mut self, terminal: &mut Terminal) -> bool {
        let mut passed = self.is(false, terminal, "Amplifier enable (PB6) or DAC clear (PB7) is high without a kick.");
        for _ in 0..3 {
            if tick::inputs().0 {
                terminal.say(format_args!("The amplifier is ready: switch its supply off."));
                return false;
            }
            let start = DWT::cycle_count();
            let us = || DWT::cycle_count().wrapping_sub(start) / CYCLES_PER_US;
            self.output.kick();
            while us() < 10 {}
            passed &= self.is(true, terminal, "A kick does not put both PB6 and PB7 high: is one shorted?");
            while self.output.pins() != (false, false) && us() < 10 * OFF_WITHIN_US {}
            let off_us = us();
            terminal.say(format_args!("Output off {off_us} us after the last kick; {LIFE_US} us expected."));
            passed &= off_us <= OFF_WITHIN_US;
        }
        self.output.kick();
        self.output.disable();
        passed & self.is(false, terminal, "The output does not go off at once.")
    }

    fn is(&self, high: bool, terminal: &mut Terminal, otherwise: &str) -> bool {
        let passed = self.output.pins() == (high, high);
        if !passed {
            terminal.say(format_args!("{otherwise}"));
        }
        passed
    }
}

fn code(volts: f32) -> DacCode {
    DacCode::from_bits((volts / DAC_FULL_SCALE_V * f32::from(i16::MAX)) as i16)
}

const _: () = assert!(TICK_HZ * 25 == 1_000_000, "the periods above are 25 us");
