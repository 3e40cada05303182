//! The firmware on a Raspberry Pi Pico 2 or Pico: assembles the parts from the library.
#![no_std]
#![no_main]

#[cfg(feature = "optical-frame")]
use core::pin::pin;

use board_pico::board::Pico;
use board_pico::dac::DacError;
#[cfg(feature = "optical-frame")]
use board_pico::optical_frame;
use board_pico::output::Output;
use board_pico::serial::Serial;
use board_pico::watchdog::Watchdog;
use board_pico::{board, boot, clock, dac, fault, indicator, output, tick};
use cortex_m::Peripherals;
use cortex_m_rt::entry;
#[cfg(feature = "log")]
use defmt_rtt as _;
use frixel_board::main_loop::MainLoop;
use frixel_board::memory::Memory;
#[cfg(feature = "optical-frame")]
use frixel_board::optical_frame::{OpticalFrame, Reports};
#[cfg(feature = "stream")]
use frixel_control::StreamBuffer;
use frixel_cortex_m::guard;
use frixel_drivers::fault_record::Text;
use frixel_drivers::serial::SerialLink;
use frixel_wire::message::FAULT_TEXT_MAX_LEN;

/// Samples of a stream, written by the session and read by the tick.
#[cfg(feature = "stream")]
static STREAM: StreamBuffer = StreamBuffer::new();

#[entry]
fn main() -> ! {
    static mut TEXT: Text = [0; FAULT_TEXT_MAX_LEN];
    static mut MEMORY: Memory = Memory::new();

    let mut main_loop = start(TEXT, MEMORY);
    #[cfg(feature = "optical-frame")]
    let reports = Reports::new(None);
    #[cfg(feature = "optical-frame")]
    let reading = pin!(optical_frame::read(&reports));
    #[cfg(feature = "optical-frame")]
    let mut touch_source = OpticalFrame::new(reading, &reports);
    loop {
        #[cfg(feature = "optical-frame")]
        let touch = touch_source.next_touch();
        #[cfg(not(feature = "optical-frame"))]
        let touch = None;
        main_loop.turn(touch);
    }
}

/// Starts everything. A function of its own, so that its stack is free again afterwards.
#[inline(never)]
fn start(text: &'static mut Text, memory: &'static mut Memory) -> MainLoop<Pico> {
    output::zero_for_good();
    let Some(mut core) = Peripherals::take() else { fault::never() };
    boot::move_vectors(&mut core.SCB);
    guard::start(&mut core.MPU);
    let last_reset = fault::last_reset(text);
    // First, so that a board that fails during start-up has logged the cause of its last reset.
    #[cfg(feature = "log")]
    last_reset.log();
    clock::start();
    clock::start_peripherals();
    let output = Output::new();
    let light = indicator::start();
    // Before the flash is searched: until then, the DAC has the settings of the last start.
    let (frames, mut dac) = dac::start();
    log_dac(dac.prepare());

    let board = board::board(&last_reset);
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
    tick::start(&mut core.NVIC, ticker, tick_ends, frames, output);
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

/// A missing DAC is not a fault yet: it is checked again before the board arms.
#[cfg(feature = "log")]
fn log_dac(prepared: Result<(), DacError>) {
    if let Err(error) = prepared {
        defmt::warn!("the DAC is not ready: {}", error);
    }
}

#[cfg(not(feature = "log"))]
fn log_dac(_: Result<(), DacError>) {}
