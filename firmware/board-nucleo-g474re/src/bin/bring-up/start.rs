//! Starts the firmware's own tick and main loop, with the host on the board.

use board_nucleo_g474re::board::Nucleo;
use board_nucleo_g474re::fault;
use board_nucleo_g474re::indicator;
use board_nucleo_g474re::tick;
use board_nucleo_g474re::tick_interrupt;
use board_nucleo_g474re::watchdog::Watchdog;
use cortex_m::singleton;
use frixel_board::main_loop::MainLoop;
use frixel_board::memory::Memory;
use frixel_control::Board;
use stm32_metapac::interrupt;

use crate::still::Still;

tick_interrupt!(Nucleo);

/// Starts the tick and the watchdog, and returns the main loop, whose turns feed it. Called once.
pub(crate) fn tick(board: Board, still: Still) -> MainLoop<Nucleo> {
    let Some(memory) = singleton!(: Memory = Memory::new()) else { fault::never() };
    let (ticker, session, session_ends, tick_ends) = memory.make(board);
    let status = ticker.status();
    let Still { output, frames, dac, periods: _ } = still;
    tick::start(&TICK, ticker, tick_ends, frames, output);
    MainLoop {
        shared: &tick::SHARED,
        queues: session_ends,
        session,
        status,
        serial: None,
        dac,
        light: indicator::start(),
        watchdog: Watchdog::start(),
    }
}
