//! The interface of the bring-up script to this board and to the person operating it.

use core::fmt::Arguments;

use board_nucleo_g474re::board::{Nucleo, TICK_HZ};
use board_nucleo_g474re::clock::CORE_HZ;
use board_nucleo_g474re::flash::BankTwo;
use board_nucleo_g474re::tick;
use cortex_m::peripheral::DWT;
use frixel_board::bring_up::{
    Bench, Check, Drive, DriveError, FAULTS, Injection, Inputs, Line, Pressed, Reading, TestOutput,
};
use frixel_board::main_loop::MainLoop;
use frixel_control::Board;
use frixel_drivers::monitor::MonitorScale;
use frixel_wire::fault::State;
use frixel_wire::hello::BoardLimits;
use stm32_metapac::ADC1;

use crate::still::Still;
use crate::{Terminal, fault_injection, limits, start};

/// Longest time for storing the limits, 1 s. A page and its words take 26 ms at most (STM32G474 data sheet, "Flash
/// memory").
const STORE_TICKS_MAX: u32 = TICK_HZ;

/// The board under test.
pub(crate) struct NucleoBench {
    pub(crate) board: Board,
    pub(crate) terminal: Terminal,
    pub(crate) flash: Option<BankTwo>,
    pub(crate) injection: Injection,
    pub(crate) stage: Stage,
}

/// Owner of the output.
#[allow(clippy::large_enum_variant, reason = "there is only one, in the frame of `main`")]
pub(crate) enum Stage {
    /// The script itself, with the amplifier off.
    Still(Still),
    /// The tick.
    Ticking(MainLoop<Nucleo>),
    /// Transition between the two.
    Neither,
}

impl NucleoBench {
    /// Does one round of background work while the script waits.
    pub(crate) fn turn(&mut self, output: TestOutput) {
        match &mut self.stage {
            Stage::Still(still) => still.next_period(output),
            Stage::Ticking(main_loop) => {
                main_loop.turn(None);
                // Bring-up's host reads the state from the status instead.
                while main_loop.session.transmit(&mut [0; 64]) > 0 {}
            }
            Stage::Neither => {}
        }
    }

    fn check_storage(&mut self) -> bool {
        if self.flash.is_none() {
            self.terminal
                .say(format_args!("The flash is not in dual-bank mode: set the option bit DBANK and clear BFB2."));
        }
        self.flash.is_some()
    }

    fn check_faults(&mut self) -> bool {
        match self.injection {
            Injection::Passed => true,
            Injection::NotStored(fault) => {
                self.terminal.say(format_args!("{fault}: injected, but not stored as the reason of the reset"));
                false
            }
            Injection::NotBegun | Injection::Next(_) => {
                self.terminal.say(format_args!(
                    "The board panics, faults, overflows its stack and hangs, restarts each time, and begins again."
                ));
                fault_injection::inject(FAULTS[0])
            }
        }
    }

    /// Starts the tick, and lets it run for a second.
    fn check_ticks(&mut self) -> bool {
        let Stage::Still(still) = core::mem::replace(&mut self.stage, Stage::Neither) else { return false };
        self.stage = Stage::Ticking(start::tick(self.board, still));
        let (start, first_tick) = (DWT::cycle_count(), tick::count());
        while DWT::cycle_count().wrapping_sub(start) < CORE_HZ {
            self.turn(TestOutput::Zero);
        }
        let ticks = tick::count().wrapping_sub(first_tick);
        let Stage::Ticking(main_loop) = &self.stage else { return false };
        let (state, late) = (main_loop.status.telemetry.state, main_loop.status.counters.missed_deadlines);
        self.terminal.say(format_args!("{ticks} ticks in a second, {late} of them late; {state}"));
        // Both counts come from one clock; the loop above ends a little late.
        state == State::Disarmed && late == 0 && (TICK_HZ - 1..=TICK_HZ + TICK_HZ / 100).contains(&ticks)
    }
}

impl Bench for NucleoBench {
    fn say(&mut self, text: Arguments<'_>) {
        self.terminal.say(text);
    }

    fn read_line(&mut self, output: TestOutput) -> Line {
        self.terminal.forget();
        loop {
            self.turn(output);
            if let Some(line) = self.terminal.line() {
                if let Stage::Still(still) = &mut self.stage {
                    still.zero();
                }
                return line;
            }
        }
    }

    fn check(&mut self, check: Check) -> bool {
        match (check, &mut self.stage) {
            (Check::Storage, _) => self.check_storage(),
            (Check::FaultsAreStored, _) => self.check_faults(),
            (Check::OneShot, Stage::Still(still)) => still.check_one_shot(&mut self.terminal),
            (Check::Dac, Stage::Still(still)) => still.check_dac(&mut self.terminal),
            (Check::Ticks, _) => self.check_ticks(),
            (Check::OneShot | Check::Dac, _) => false,
        }
    }

    fn inputs(&mut self) -> Inputs {
        self.turn(TestOutput::Zero);
        let (amplifier_ready, switch_closed) = tick::inputs();
        Inputs { amplifier_ready, switch_closed }
    }

    fn switch_is_held(&mut self) -> bool {
        self.turn(TestOutput::Zero);
        matches!(&self.stage, Stage::Ticking(main_loop) if main_loop.status.arm_switch)
    }

    fn drive(&mut self, _pressed: Pressed, peak_v: f32) -> Result<Reading, DriveError> {
        let mut drive = Drive::new(peak_v, &self.board);
        loop {
            self.turn(TestOutput::Zero);
            let Stage::Ticking(main_loop) = &mut self.stage else { return Err(DriveError::State(State::Disarmed)) };
            // The tick reads the same register, and reading it changes nothing.
            let monitor_v = MonitorScale::SHIFTED.volts(ADC1.dr().read().rdata());
            let result = drive.step(&main_loop.status, tick::count(), monitor_v, main_loop.session);
            if let Some(result) = result {
                return result;
            }
        }
    }

    fn may_store(&mut self, limits: &BoardLimits) -> bool {
        let written = limits::written(limits);
        if let Err(error) = &written {
            self.terminal.say(format_args!("Limits: {error}."));
        }
        written.is_ok()
    }

    fn store(&mut self, limits: &BoardLimits) -> bool {
        let Some(mut flash) = self.flash.take() else { return false };
        let begin = tick::count();
        let goes_on = || {
            self.turn(TestOutput::Zero);
            tick::count().wrapping_sub(begin) < STORE_TICKS_MAX
        };
        let stored = limits::store(&mut flash, limits, goes_on);
        let Stage::Ticking(main_loop) = &self.stage else { return false };
        let late = main_loop.status.counters.missed_deadlines;
        self.terminal.say(format_args!("{late} ticks were late while the flash was written"));
        stored && late == 0
    }
}
