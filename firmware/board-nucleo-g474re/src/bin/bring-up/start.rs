//! Starts the firmware's own tick and main loop, with the host on the board.

use board_nucleo_g474re::adc::Adc;
use board_nucleo_g474re::fault;
use board_nucleo_g474re::indicator;
use board_nucleo_g474re::main_loop::MainLoop;
use board_nucleo_g474re::tick::{self, Tick};
use board_nucleo_g474re::watchdog::Watchdog;
use cortex_m::singleton;
use frixel_control::{Active, Board, Ticker};
use frixel_layers::BitmapPool;
use frixel_session::{Queues, Session};

use crate::still::Still;

/// Memory for bitmaps, of which bring-up's scene has none.
static POOL: BitmapPool = BitmapPool::new();

/// Starts the tick and the watchdog, and returns the main loop, whose turns feed it. Called once.
pub(crate) fn tick(board: Board, still: Still) -> MainLoop {
    let (Some(first), Some(second)) = (first_coefficients(), second_coefficients()) else { fault::never() };
    let Some(queues) = singleton!(: Queues = Queues::new()) else { fault::never() };
    let ticker = Ticker::new(&board, &POOL, first);
    let status = ticker.status();
    let Some(session) = session(board, second) else { fault::never() };
    let (session_ends, tick_ends) = queues.split();
    let Still { output, frames, dac } = still;
    let (amplifier, arm_switch) = (tick::amplifier(output), tick::arm_switch());
    tick::start(Tick { ticker, queues: tick_ends, adc: Adc::new(), dac: frames, amplifier, arm_switch });
    MainLoop {
        tick: session_ends,
        session,
        status,
        serial: None,
        dac,
        light: indicator::start(),
        #[cfg(feature = "store")]
        store: None,
        watchdog: Watchdog::start(),
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
