//! The firmware on a NUCLEO-G474RE: assembles the parts from the library.
#![no_std]
#![no_main]

use board_nucleo_g474re::board::Nucleo;
use board_nucleo_g474re::dac::DacError;
use board_nucleo_g474re::fault;
use board_nucleo_g474re::flash::BankTwo;
use board_nucleo_g474re::output::Output;
use board_nucleo_g474re::serial::Serial;
use board_nucleo_g474re::tick;
use board_nucleo_g474re::watchdog::Watchdog;
use board_nucleo_g474re::{board, clock, dac, indicator, main_loop, period, tick_interrupt};
use cortex_m::Peripherals;
use cortex_m_rt::entry;
#[cfg(feature = "log")]
use defmt_rtt as _;
use frixel_board::main_loop::MainLoop;
use frixel_board::memory::Memory;
use frixel_control::Board;
#[cfg(feature = "stream")]
use frixel_control::StreamBuffer;
use frixel_cortex_m::guard;
use frixel_drivers::fault_record::Text;
use frixel_drivers::serial::SerialLink;
use frixel_wire::message::FAULT_TEXT_MAX_LEN;
use stm32_metapac::interrupt;

tick_interrupt!(Nucleo);

/// Samples of a stream, written by the session and read by the tick.
#[cfg(feature = "stream")]
static STREAM: StreamBuffer = StreamBuffer::new();

#[entry]
fn main() -> ! {
    static mut TEXT: Text = [0; FAULT_TEXT_MAX_LEN];
    static mut MEMORY: Memory = Memory::new();

    main_loop::run(start(TEXT, MEMORY))
}

/// Starts everything. A function of its own, so that its stack is free again afterwards.
#[inline(never)]
fn start(text: &'static mut Text, memory: &'static mut Memory) -> MainLoop<Nucleo> {
    let output = Output::new();
    let Some(mut core) = Peripherals::take() else { fault::never() };
    guard::start(&mut core.MPU);
    let last_reset = fault::last_reset(text);
    // First, so that a board that fails during start-up has logged the cause of its last reset.
    #[cfg(feature = "log")]
    last_reset.log();
    clock::start();
    clock::start_peripherals();
    clock::keep_timers_running_in_debug();
    clock::start_cycle_counter(&mut core.DCB, &mut core.DWT);
    let light = indicator::start();
    period::start();
    // Before the flash is searched, which takes up to 0.2 s: until then, the DAC has the settings of the last start.
    let (frames, mut dac) = dac::start();
    log_dac(dac.prepare());

    let board = board::board(&last_reset, BankTwo::new().as_ref());
    log(&board);
    #[cfg_attr(not(feature = "stream"), allow(unused_mut, reason = "a stream is attached to it"))]
    let (mut ticker, session, session_ends, tick_ends) = memory.make(board);
    #[cfg(feature = "telemetry")]
    session.attach_tick_meter(&tick::SHARED.meter);
    #[cfg(feature = "stream")]
    {
        ticker.attach_stream(&STREAM);
        session.attach_stream(&STREAM);
    }
    let status = ticker.status();

    let serial = Some(SerialLink::new(Serial::new()));
    tick::start(&TICK, ticker, tick_ends, frames, output);
    MainLoop {
        shared: &tick::SHARED,
        queues: session_ends,
        session,
        status,
        serial,
        dac,
        light,
        watchdog: Watchdog::start(),
    }
}

#[cfg(feature = "log")]
fn log(board: &Board) {
    defmt::info!("at most {=f32} V peak, notices {=u8:#b}", board.limits.voltage_max_v_peak, board.notices);
}

/// A missing DAC is not a fault yet: it is checked again before the board arms.
#[cfg(feature = "log")]
fn log_dac(prepared: Result<(), DacError>) {
    if let Err(error) = prepared {
        defmt::warn!("the DAC is not ready: {}", error);
    }
}

#[cfg(not(feature = "log"))]
fn log_dac(_: Result<(), DacError>) {}

#[cfg(not(feature = "log"))]
fn log(_: &Board) {}
