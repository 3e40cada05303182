//! Starts the tick and the main loop with the parts of the self-test.

use board_nucleo_g474re::watchdog::Watchdog;
use board_nucleo_g474re::{indicator, tick};
use frixel_board::main_loop::MainLoop;
use frixel_board::start::Parts;
use frixel_control::Board;
use frixel_drivers::amplifier::KickedEnable as _;
use frixel_drivers::pin::DirectPin;
use stm32_metapac::interrupt;

use crate::captures::Captures;
use crate::hardware::{AlwaysHigh, NoEnable, ScriptedSwitch, Wired, ZeroFrames};
use crate::looped::Still;

frixel_cortex_m::tick_interrupt!(Wired, TIM3);

/// Starts the tick and the watchdog, and returns the main loop, whose turns feed it, and the captures. Called once. The
/// enable is low from here on.
pub(crate) fn tick(board: Board, still: Still) -> (MainLoop<Wired>, Captures) {
    let Still { memory, boot, mut output, period, frames, captures, adc, spi: _ } = still;
    output.disable();
    let parts = Parts {
        period,
        frames: ZeroFrames(frames),
        dac: (),
        enable: NoEnable,
        ready: DirectPin(AlwaysHigh),
        monitor: adc,
        switch: DirectPin(ScriptedSwitch),
        light: indicator::start(),
        serial: None,
    };
    let start_tick = |tick| tick::start(&TICK, boot, tick);
    (parts.start(memory.make(board), &tick::SHARED, start_tick, Watchdog::start), captures)
}
