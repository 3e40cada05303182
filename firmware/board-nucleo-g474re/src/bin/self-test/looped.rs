//! The interface of the self-test script to this board and its wires.

use core::fmt::Arguments;
use core::mem;
use core::sync::atomic::Ordering;

use board_nucleo_g474re::adc::Adc;
use board_nucleo_g474re::clock::CORE_HZ;
use board_nucleo_g474re::dac::{DacBus, Frames};
use board_nucleo_g474re::output::{LIFE_US, Output};
use board_nucleo_g474re::period::{LATCH_CYCLES, Period};
use board_nucleo_g474re::{tick, watchdog};
use frixel_board::hardware::DacFrames as _;
use frixel_board::main_loop::MainLoop;
use frixel_board::memory::Memory;
use frixel_board::self_test::{Clocks, Fall, Inputs, Levels, Line, LoopedBoard, Round, Wire};
use frixel_control::Board;
use frixel_cortex_m::{Boot, unreachable_state};
use frixel_drivers::ad5761r::FrameBus as _;
use frixel_drivers::amplifier::KickedEnable as _;
use frixel_wire::dac_code::DacCode;
use frixel_wire::message::TickTimes;

use crate::captures::{Captures, Counted};
use crate::hardware::{SWITCH_HELD, Wired};
use crate::{Terminal, start};

/// The board.
pub(crate) struct Looped {
    pub(crate) board: Board,
    pub(crate) terminal: Terminal,
    pub(crate) stage: Stage,
}

/// Owner of the pins.
#[allow(clippy::large_enum_variant, reason = "there is only one, in the frame of `main`")]
pub(crate) enum Stage {
    /// The script itself.
    Still(Still),
    /// The tick. The captures go on.
    Ticking(MainLoop<Wired>, Captures),
    /// Transition between the two.
    Neither,
}

/// The pins before the tick runs.
pub(crate) struct Still {
    pub(crate) memory: &'static mut Memory,
    pub(crate) boot: Boot,
    pub(crate) period: Period,
    pub(crate) output: Output,
    pub(crate) frames: Frames,
    pub(crate) captures: Captures,
    pub(crate) adc: Adc,
    pub(crate) spi: DacBus,
}

impl Still {
    /// Waits until a period begins, sends a frame of zero, and waits until the next one begins. Returns `false` if the
    /// frame was not sent.
    fn frame(&mut self) -> bool {
        self.next_period();
        let is_sent = self.frames.send(DacCode::ZERO).is_ok();
        self.next_period();
        is_sent
    }

    fn next_period(&mut self) {
        watchdog::feed();
        self.period.wait_for_next();
    }
}

impl Looped {
    /// Does one round of background work. `held` is the level of the arm switch for the tick.
    pub(crate) fn turn(&mut self, held: bool) {
        match &mut self.stage {
            Stage::Still(_) | Stage::Neither => watchdog::feed(),
            Stage::Ticking(main_loop, _) => {
                SWITCH_HELD.store(held, Ordering::Relaxed);
                main_loop.turn(None);
                // The host on the board reads the state from the status instead.
                while main_loop.session.transmit(&mut [0; 64]) > 0 {}
            }
        }
    }

    fn still(&mut self) -> &mut Still {
        match &mut self.stage {
            Stage::Still(still) => still,
            Stage::Ticking(..) | Stage::Neither => unreachable_state(),
        }
    }

    fn captures(&mut self) -> &mut Captures {
        match &mut self.stage {
            Stage::Still(still) => &mut still.captures,
            Stage::Ticking(_, captures) => captures,
            Stage::Neither => unreachable_state(),
        }
    }
}

impl LoopedBoard for Looped {
    const LATCH_CYCLES: u32 = LATCH_CYCLES;
    const ONE_SHOT_US: u32 = LIFE_US as u32;
    const CYCLES_PER_US: u32 = CORE_HZ / 1_000_000;
    const MONITOR_ZERO_MV: u32 = 1_650;
    // The level shifter's 0.75, of 1 V for 100 V.
    const MONITOR_MV_PER_V: f32 = 7.5;

    fn board(&self) -> &Board {
        &self.board
    }

    fn say(&mut self, text: Arguments<'_>) {
        self.terminal.say(text);
    }

    fn read_line(&mut self) -> Line {
        self.terminal.forget();
        loop {
            self.turn(false);
            if let Some(line) = self.terminal.line() {
                return line;
            }
        }
    }

    fn idle(&mut self) {
        self.turn(false);
    }

    fn inputs(&mut self) -> Inputs {
        let (amplifier_ready, switch_closed) = tick::inputs();
        Inputs { amplifier_ready, switch_closed }
    }

    fn levels(&mut self, wire: Wire) -> Levels {
        self.captures().levels(wire)
    }

    fn loop_mv(&mut self, driven_mv: u32) -> u32 {
        self.captures().loop_mv(driven_mv)
    }

    fn exchange(&mut self, bytes: &mut [u8]) -> bool {
        self.still().spi.exchange(bytes).is_ok()
    }

    fn clocks(&mut self) -> Option<Clocks> {
        let still = self.still();
        still.captures.count_clocks();
        let is_sent = still.frame();
        let Counted { at_fall, at_rise, now } = still.captures.counted().filter(|_| is_sent)?;
        Some(Clocks { before: at_fall, inside: at_rise.wrapping_sub(at_fall), after: now.wrapping_sub(at_rise) })
    }

    fn latch_cycles(&mut self) -> Option<u32> {
        match &mut self.stage {
            Stage::Still(still) => {
                still.captures.measure_time();
                let is_sent = still.frame();
                still.captures.latch_cycles().filter(|_| is_sent)
            }
            Stage::Ticking(_, captures) => captures.latch_cycles(),
            Stage::Neither => None,
        }
    }

    fn cycles(&mut self) -> u32 {
        Captures::now()
    }

    fn forget_edges(&mut self) -> u32 {
        self.captures().forget_edges()
    }

    fn kick(&mut self) {
        self.still().output.kick();
    }

    fn disable(&mut self) {
        self.still().output.disable();
    }

    fn enable_rose(&mut self) -> Option<u32> {
        self.captures().enable_rose()
    }

    fn enable_fell(&mut self) -> Option<Fall> {
        self.captures().enable_fell()
    }

    fn start_ticks(&mut self) {
        if let Stage::Still(mut still) = mem::replace(&mut self.stage, Stage::Neither) {
            still.captures.measure_time();
            let (main_loop, captures) = start::tick(self.board, still);
            self.stage = Stage::Ticking(main_loop, captures);
        }
    }

    fn round(&mut self, held: bool) -> Round<'_> {
        self.turn(held);
        match &mut self.stage {
            Stage::Ticking(main_loop, _) => {
                Round { status: &main_loop.status, now_tick: tick::count(), session: main_loop.session }
            }
            Stage::Still(_) | Stage::Neither => unreachable_state(),
        }
    }

    fn tick_times(&mut self) -> TickTimes {
        let missed_deadlines = match &self.stage {
            Stage::Ticking(main_loop, _) => main_loop.status.counters.missed_deadlines,
            Stage::Still(_) | Stage::Neither => 0,
        };
        tick::SHARED.meter.times(missed_deadlines)
    }

    fn read(&mut self, bytes: &mut [u8]) -> usize {
        self.terminal.read(bytes)
    }

    fn write(&mut self, bytes: &[u8]) -> usize {
        self.terminal.send(bytes)
    }
}
