//! The firmware on an emulated Cortex-M4F: `qemu-system-arm -M mps2-an386`.
//!
//! Tick, main loop and fault handling are those of every board (`frixel-board`). [`tick`] runs in the `SysTick`
//! interrupt, above everything. Amplifier and touch source are words of memory that it shares with the simulator
//! ([`shared`]). Instead of all that, [`lockstep`] ticks whenever the simulator sends it a tick. [`fault_injection`]
//! causes faults on demand.
//!
//! For `thumbv8m.main-none-eabihf` it is an image for `-M mps2-an505`, a Cortex-M33, which only ticks in lockstep:
//! timer, serial port and memory are others there.
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
use frixel_board::memory::Memory;
use frixel_control::{Board, StreamBuffer, Ticker};
use frixel_cortex_m::guard;
use frixel_drivers::fault_record::Text;
use frixel_drivers::serial::SerialLink;
use frixel_drivers::state_light::StateLight;
use frixel_exchange::{BOARD, layout};
use frixel_session::{Session, SessionEnds, TickEnds};
use frixel_wire::message::FAULT_TEXT_MAX_LEN;

use board::{Mps2, NoDac, NoLight, NoWatchdog};
use uart::Uart;

/// Whether the machine is the one of timer, serial port and stack guard.
const IS_AN386: bool = cfg!(not(an505));

/// Samples of a stream, written by the session and read by the tick.
static STREAM: StreamBuffer = StreamBuffer::new();

#[entry]
fn main() -> ! {
    static mut TEXT: Text = [0; FAULT_TEXT_MAX_LEN];
    static mut MEMORY: Memory = Memory::new();

    let Some(mut peripherals) = Peripherals::take() else { fault::never() };
    if IS_AN386 {
        guard::start(&mut peripherals.MPU);
    }
    shared::set(layout::OUTPUT_AT_START, shared::get(layout::OUTPUT));
    let (mut ticker, session, session_ends, tick_ends) = MEMORY.make(started(TEXT));
    ticker.attach_stream(&STREAM);
    session.attach_stream(&STREAM);
    match shared::get(layout::MODE) {
        layout::MODE_LINK if IS_AN386 => run(session, ticker, (session_ends, tick_ends), peripherals),
        _ => lockstep::run(session, ticker),
    }
}

/// Starts the tick on the board's own timer, and runs the main loop with the host on the serial port.
fn run(
    session: &'static mut Session<'static>,
    ticker: Ticker<'static>,
    (session_ends, tick_ends): (SessionEnds, TickEnds),
    mut peripherals: Peripherals,
) -> ! {
    let Some(bytes) = singleton!(: uart::Queues = uart::Queues::new()) else { fault::never() };
    session.attach_tick_meter(&tick::SHARED.meter);
    let status = ticker.status();
    tick::start(ticker, tick_ends, peripherals.SYST);
    let mut main_loop = MainLoop::<Mps2> {
        shared: &tick::SHARED,
        queues: session_ends,
        session,
        status,
        serial: Uart::start(bytes, &mut peripherals.NVIC).map(SerialLink::new),
        dac: NoDac,
        light: StateLight::new(NoLight, Mps2::TICK_HZ),
        watchdog: NoWatchdog,
    };
    // Without sleep: an emulator whose processor sleeps until the next tick wakes it late, sometimes by several ticks,
    // which the tick treats as a missed deadline.
    loop {
        main_loop.turn(shared::touch(tick::SHARED.count()));
        fault_injection::in_main();
    }
}

/// The board's description at the start.
fn started(text: &'static mut Text) -> Board {
    let LastReset { cause, fault, text } = fault::last_reset(text);
    let (number, detail) = fault.map_or((0, 0), |(fault, detail)| (fault.number(), detail));
    shared::set(layout::LAST_FAULT, number.into());
    shared::set(layout::LAST_FAULT_DETAIL, detail);
    shared::publish(layout::STARTS, shared::get(layout::STARTS).wrapping_add(1));
    Board { reset_cause: cause, reset_fault: fault, reset_text: text, ..BOARD }
}
