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
use frixel_board::tick::Tick;
use frixel_control::{Active, Board, Ticker};
use frixel_drivers::amplifier::Amplifier;
use frixel_drivers::arm_switch::ArmSwitch;
use frixel_layers::BitmapPool;
use frixel_session::{Queues, Session};
use stm32_metapac::interrupt;

use crate::hardware::{AlwaysHigh, NoDac, NoEnable, ScriptedSwitch, Wired, ZeroFrames};

tick_interrupt!(Wired);

/// Memory for bitmaps, of which the largest scene has none.
static POOL: BitmapPool = BitmapPool::new();

/// Starts the tick and the watchdog, and returns the main loop, whose turns feed it. Called once. The enable is low from
/// here on.
pub(crate) fn tick(board: Board, mut output: Output, frames: Frames, adc: Adc) -> MainLoop<Wired> {
    let (Some(first), Some(second)) = (first_coefficients(), second_coefficients()) else { fault::never() };
    let Some(queues) = singleton!(: Queues = Queues::new()) else { fault::never() };
    let ticker = Ticker::new(&board, &POOL, first);
    let status = ticker.status();
    let Some(session) = session(board, second) else { fault::never() };
    let (session_ends, tick_ends) = queues.split();
    output.zero();
    TICK.start(Tick {
        shared: &tick::SHARED,
        ticker,
        queues: tick_ends,
        period: Period,
        frames: ZeroFrames(frames),
        amplifier: Amplifier::new(NoEnable, AlwaysHigh),
        monitor: adc,
        arm_switch: ArmSwitch::new(ScriptedSwitch, TICK_HZ),
    });
    MainLoop {
        shared: &tick::SHARED,
        queues: session_ends,
        session,
        status,
        serial: None,
        dac: NoDac,
        light: indicator::start(),
        store: (),
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
