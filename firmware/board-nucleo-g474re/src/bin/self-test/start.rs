//! Starts the tick and the main loop with the parts of the self-test.

use board_nucleo_g474re::adc::Adc;
use board_nucleo_g474re::board::TICK_HZ;
use board_nucleo_g474re::dac::Frames;
use board_nucleo_g474re::output::Output;
use board_nucleo_g474re::period::Period;
use board_nucleo_g474re::watchdog::Watchdog;
use board_nucleo_g474re::{fault, indicator, tick, tick_interrupt};
use cortex_m::singleton;
use frixel_board::main_loop::MainLoop;
use frixel_board::memory::Memory;
use frixel_board::tick::Tick;
use frixel_control::Board;
use frixel_drivers::amplifier::Amplifier;
use frixel_drivers::arm_switch::ArmSwitch;
use stm32_metapac::interrupt;

use crate::hardware::{AlwaysHigh, NoDac, NoEnable, ScriptedSwitch, Wired, ZeroFrames};

tick_interrupt!(Wired);

/// Starts the tick and the watchdog, and returns the main loop, whose turns feed it. Called once. The enable is low
/// from here on.
pub(crate) fn tick(board: Board, mut output: Output, frames: Frames, adc: Adc) -> MainLoop<Wired> {
    let Some(memory) = singleton!(: Memory = Memory::new()) else { fault::never() };
    let (ticker, session, session_ends, tick_ends) = memory.make(board);
    let status = ticker.status();
    output.zero();
    let parts = Tick {
        shared: &tick::SHARED,
        ticker,
        queues: tick_ends,
        period: Period,
        frames: ZeroFrames(frames),
        amplifier: Amplifier::new(NoEnable, AlwaysHigh),
        monitor: adc,
        arm_switch: ArmSwitch::new(ScriptedSwitch, TICK_HZ),
    };
    tick::start_interrupt(&TICK, parts);
    MainLoop {
        shared: &tick::SHARED,
        queues: session_ends,
        session,
        status,
        serial: None,
        dac: NoDac,
        light: indicator::start(),
        watchdog: Watchdog::start(),
    }
}
