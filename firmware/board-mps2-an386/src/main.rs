//! The firmware on an emulated Cortex-M4F: `qemu-system-arm -M mps2-an386`.
//!
//! Tick, main loop and fault handling are those of every board (`frixel-board`). [`tick`] runs in the `SysTick` interrupt,
//! above everything. Amplifier and touch source are words of memory that it shares with the simulator ([`shared`]).
//! Instead of all that, [`lockstep`] ticks whenever the simulator sends it a tick. [`fault_injection`] causes faults on
//! demand.
//!
//! For `thumbv8m.main-none-eabihf` it is an image for `-M mps2-an505`, a Cortex-M33, which only ticks in lockstep: timer,
//! serial port and memory are others there.
#![no_std]
#![no_main]

mod board;
mod fault;
mod fault_injection;
mod inputs;
mod lockstep;
mod output;
mod period;
mod shared;
mod tick;
mod uart;

use cortex_m::Peripherals;
use cortex_m::singleton;
use cortex_m_rt::entry;
use frixel_board::fault::LastReset;
use frixel_board::hardware::Hardware;
use frixel_board::main_loop::MainLoop;
use frixel_control::{Active, Board, StreamBuffer, Ticker};
use frixel_cortex_m::guard;
use frixel_drivers::fault_record::Text;
use frixel_drivers::serial::SerialLink;
use frixel_drivers::state_light::StateLight;
use frixel_exchange::{BOARD, layout};
use frixel_layers::BitmapPool;
use frixel_session::{Queues, Session};
use frixel_wire::message::FAULT_TEXT_MAX_LEN;

use board::{Mps2, NoDac, NoLight, NoWatchdog};
use uart::Uart;

/// Whether the machine is the one of timer, serial port and stack guard.
const IS_AN386: bool = cfg!(not(an505));

/// Memory for bitmaps, written by the session and read by the tick.
static POOL: BitmapPool = BitmapPool::new();
/// Samples of a stream, likewise.
static STREAM: StreamBuffer = StreamBuffer::new();

#[entry]
fn main() -> ! {
    static mut TEXT: Text = [0; FAULT_TEXT_MAX_LEN];

    let Some(mut peripherals) = Peripherals::take() else { fault::never() };
    if IS_AN386 {
        guard::start(&mut peripherals.MPU);
    }
    shared::set(layout::OUTPUT_AT_START, shared::get(layout::OUTPUT));
    let (ticker, session) = make(started(TEXT));
    match shared::get(layout::MODE) {
        layout::MODE_LINK if IS_AN386 => run(session, ticker, peripherals),
        _ => lockstep::run(session, ticker),
    }
}

/// Starts the tick on the board's own timer, and runs the main loop with the host on the serial port.
fn run(session: &'static mut Session<'static>, ticker: Ticker<'static>, mut peripherals: Peripherals) -> ! {
    let (Some(queues), Some(bytes)) =
        (singleton!(: Queues = Queues::new()), singleton!(: uart::Queues = uart::Queues::new()))
    else {
        fault::never()
    };
    session.attach_tick_meter(&tick::SHARED.meter);
    let (session_ends, tick_ends) = queues.split();
    let status = ticker.status();
    tick::start(ticker, tick_ends, peripherals.SYST);
    let mut main_loop = MainLoop::<Mps2> {
        shared: &tick::SHARED,
        queues: session_ends,
        session,
        status,
        serial: Some(SerialLink::new(Uart::start(bytes, &mut peripherals.NVIC))),
        dac: NoDac,
        light: StateLight::new(NoLight, Mps2::TICK_HZ),
        store: (),
        watchdog: NoWatchdog,
        record: &fault::RECORD,
    };
    // Without sleep: an emulator whose processor sleeps until the next tick wakes it late, sometimes by several ticks,
    // which the tick treats as a missed deadline.
    loop {
        main_loop.turn(shared::touch(tick::SHARED.count()));
        fault_injection::in_main();
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

/// The board's description at the start.
fn started(text: &'static mut Text) -> Board {
    let LastReset { cause, fault, text, fault_starts } = fault::last_reset(text);
    let (number, detail) = fault.map_or((0, 0), |(fault, detail)| (fault.number(), detail));
    shared::set(layout::LAST_FAULT, number.into());
    shared::set(layout::LAST_FAULT_DETAIL, detail);
    shared::publish(layout::STARTS, shared::get(layout::STARTS).wrapping_add(1));
    Board { reset_cause: cause, reset_fault: fault, reset_text: text, reset_fault_starts: fault_starts, ..BOARD }
}
