//! Starts the firmware's own tick and main loop, with the host on the board.

use board_nucleo_g474re::board::Nucleo;
use board_nucleo_g474re::fault;
use board_nucleo_g474re::indicator;
use board_nucleo_g474re::tick;
use board_nucleo_g474re::watchdog::Watchdog;
use cortex_m::singleton;
use frixel_board::hardware::Hardware;
use frixel_board::main_loop::MainLoop;
use frixel_control::{Active, Board, Ticker};
use frixel_layers::BitmapPool;
use frixel_session::{Queues, Session};

use crate::still::Still;

/// Memory for bitmaps, of which bring-up's scene has none.
static POOL: BitmapPool = BitmapPool::new();

/// Starts the tick and the watchdog, and returns the main loop, whose turns feed it. Called once.
pub(crate) fn tick(board: Board, still: Still) -> MainLoop<Nucleo> {
    let (Some(first), Some(second)) = (first_coefficients(), second_coefficients()) else { fault::never() };
    let Some(queues) = singleton!(: Queues = Queues::new()) else { fault::never() };
    let ticker = Ticker::new(&board, &POOL, first);
    let status = ticker.status();
    let Some(session) = session(board, second) else { fault::never() };
    let (session_ends, tick_ends) = queues.split();
    let Still { output, frames, dac } = still;
    tick::start(ticker, tick_ends, frames, output);
    MainLoop {
        shared: &tick::SHARED,
        queues: session_ends,
        session,
        status,
        serial: None,
        dac,
        light: indicator::start(),
        store: <Nucleo as Hardware>::Store::default(),
        watchdog: Watchdog::start(),
        record: &fault::RECORD,
    }
}

// Large values are made on the stack, so that no copy of them lies in flash. Each has a function of its own, so that
// the stack holds only one at a time.

#[inline(never)]
fn first_coefficients() -> Option<&'static mut Active> {
    singleton!(: Active = Active::new())
}

#[inline(never)]
fn second_coefficients() -> Option<&'static mut Active> {
    singleton!(: Active = Active::new())
}

#[inline(never)]
fn session(board: Board, spare: &'static mut Active) -> Option<&'static mut Session<'static>> {
    singleton!(: Session<'static> = Session::new(board, &POOL, spare))
}
