//! The firmware on an emulated Cortex-M4F: `qemu-system-arm -M mps2-an386`.
//!
//! [`tick`] runs in the `SysTick` interrupt, above everything; [`main_loop`] runs the session in the main loop, between
//! [`uart`] and the tick. Amplifier and touch source are words of memory that it shares with the simulator
//! ([`shared`]). Instead of all that, [`lockstep`] ticks whenever the simulator sends it a tick. [`fault`] stores a
//! fault for the next hello, and [`fault_injection`] causes one on demand.
#![no_std]
#![no_main]

mod fault;
mod fault_injection;
mod lockstep;
mod main_loop;
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

    shared::set(layout::OUTPUT_AT_START, shared::get(layout::OUTPUT));
    shared::set(layout::STARTS, shared::get(layout::STARTS).wrapping_add(1));
    let board = started(TEXT);
    // Built in place, so that no copy of them lies in flash.
    let (Some(first), Some(second)) = (singleton!(: Active = Active::new()), singleton!(: Active = Active::new()))
    else {
        fault::never()
    };
    let mut ticker = Ticker::new(&board, &POOL, first);
    ticker.attach_stream(&STREAM);
    let Some(session) = session(board, second) else { fault::never() };
    session.attach_stream(&STREAM);
    match (shared::get(layout::MODE), Peripherals::take()) {
        (layout::MODE_LINK, Some(peripherals)) => main_loop::run(&board, session, ticker, peripherals),
        _ => lockstep::run(session, ticker),
    }
}

/// Makes the session. Not in `main`, whose stack would keep the space for it for ever.
#[inline(never)]
fn session(board: Board, spare: &'static mut Active) -> Option<&'static mut Session<'static>> {
    singleton!(: Session<'static> = Session::new(board, &POOL, spare))
}

/// The board's description at the start. A stored fault is the cause of the reset.
fn started(text: &'static mut Text) -> Board {
    match fault::take(text) {
        Some((fault, detail, reset_text)) => {
            Board { reset_cause: ResetCause::Software, reset_fault: Some((fault, detail)), reset_text, ..BOARD }
        }
        None => BOARD,
    }
}
