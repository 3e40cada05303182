//! The firmware on an emulated Cortex-M4F: `qemu-system-arm -M mps2-an386`.
//!
//! [`tick`] runs in the `SysTick` interrupt, above everything; [`main_loop`] runs the session in the main loop, between
//! [`uart`] and the tick. Amplifier and touch source are words of memory that it shares with the simulator
//! ([`shared`]). Instead of all that, [`lockstep`] ticks whenever the simulator sends it a tick. [`fault`] stores a
//! fault for the next hello, [`guard`] makes a stack overflow one, and [`fault_injection`] causes one on demand.
#![no_std]
#![no_main]

mod fault;
mod fault_injection;
// The NUCLEO's own file, so that the tests on the emulator run it. Below RAM the emulator has no memory, but no bus fault
// either: without the guard, an overflow reads zeros there.
#[path = "../../board-nucleo-g474re/src/guard.rs"]
mod guard;
mod lockstep;
mod main_loop;
#[path = "../../board-nucleo-g474re/src/owned.rs"]
mod owned;
mod shared;
mod tick;
mod uart;

use cortex_m::Peripherals;
use cortex_m::singleton;
use cortex_m_rt::entry;
use frixel_control::{Active, Board, StreamBuffer, Ticker};
use frixel_drivers::fault_record::Text;
use frixel_exchange::{BOARD, layout};
use frixel_layers::BitmapPool;
use frixel_session::Session;
use frixel_wire::hello::ResetCause;
use frixel_wire::message::FAULT_TEXT_MAX_LEN;

/// Memory for bitmaps, written by the session and read by the tick.
static POOL: BitmapPool = BitmapPool::new();
/// Samples of a stream, likewise.
static STREAM: StreamBuffer = StreamBuffer::new();

#[entry]
fn main() -> ! {
    static mut TEXT: Text = [0; FAULT_TEXT_MAX_LEN];

    let Some(mut peripherals) = Peripherals::take() else { fault::never() };
    guard::start(&mut peripherals.MPU);
    shared::set(layout::OUTPUT_AT_START, shared::get(layout::OUTPUT));
    let board = started(TEXT);
    let (ticker, session) = make(board);
    match shared::get(layout::MODE) {
        layout::MODE_LINK => main_loop::run(&board, session, ticker, peripherals),
        _ => lockstep::run(session, ticker),
    }
}

/// Makes the tick and the session.
#[inline(never)]
fn make(board: Board) -> (Ticker<'static>, &'static mut Session<'static>) {
    let (Some(first), Some(second)) = (first_coefficients(), second_coefficients()) else { fault::never() };
    let mut ticker = Ticker::new(&board, &POOL, first);
    ticker.attach_stream(&STREAM);
    let Some(session) = session(board, second) else { fault::never() };
    session.attach_stream(&STREAM);
    (ticker, session)
}

// Large values are made on the stack, so that no copy of them lies in flash. Each has a function of its own, so that
// the stack holds only one at a time, and none for ever, as in `main`.

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

/// The board's description at the start. A stored fault is the cause of the reset.
fn started(text: &'static mut Text) -> Board {
    let last_fault = fault::take(text);
    let (number, detail) = last_fault.map_or((0, 0), |(fault, detail, _)| (fault.number(), detail));
    shared::set(layout::LAST_FAULT, number.into());
    shared::set(layout::LAST_FAULT_DETAIL, detail);
    shared::publish(layout::STARTS, shared::get(layout::STARTS).wrapping_add(1));
    match last_fault {
        Some((fault, detail, reset_text)) => {
            Board { reset_cause: ResetCause::Software, reset_fault: Some((fault, detail)), reset_text, ..BOARD }
        }
        None => BOARD,
    }
}
