//! The firmware on a Raspberry Pi Pico 2 or Pico: assembles the parts from the library.
#![no_std]
#![no_main]

#[cfg(feature = "optical-frame")]
use core::pin::pin;

use board_pico::board::Pico;
#[cfg(feature = "store")]
use board_pico::chip::TICK_HZ;
use board_pico::flash::StoreFlash;
#[cfg(feature = "optical-frame")]
use board_pico::optical_frame;
use board_pico::output::Output;
use board_pico::serial::Serial;
use board_pico::watchdog::Watchdog;
use board_pico::{board, boot, clock, dac, fault, indicator, output, tick};
use cortex_m::{Peripherals, singleton};
use cortex_m_rt::entry;
use frixel_board::main_loop::MainLoop;
#[cfg(feature = "optical-frame")]
use frixel_board::optical_frame::{OpticalFrame, Reports};
#[cfg(feature = "stream")]
use frixel_control::StreamBuffer;
use frixel_control::{Active, Board, Ticker};
use frixel_cortex_m::guard;
use frixel_drivers::fault_record::Text;
use frixel_drivers::serial::SerialLink;
use frixel_layers::BitmapPool;
#[cfg(feature = "store")]
use frixel_session::store::SceneStore;
use frixel_session::{Queues, Session};
use frixel_wire::message::FAULT_TEXT_MAX_LEN;

/// Memory for bitmaps, written by the session and read by the tick.
static POOL: BitmapPool = BitmapPool::new();
/// Samples of a stream, likewise.
#[cfg(feature = "stream")]
static STREAM: StreamBuffer = StreamBuffer::new();

#[entry]
fn main() -> ! {
    static mut TEXT: Text = [0; FAULT_TEXT_MAX_LEN];
    static mut QUEUES: Queues = Queues::new();

    let mut main_loop = start(TEXT, QUEUES);
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
fn start(text: &'static mut Text, queues: &'static mut Queues) -> MainLoop<Pico> {
    output::zero_for_good();
    let Some(mut core) = Peripherals::take() else { fault::never() };
    boot::move_vectors(&mut core.SCB);
    guard::start(&mut core.MPU);
    let last_reset = fault::last_reset(text);
    clock::start();
    clock::start_peripherals();
    let output = Output::new();
    let light = indicator::start();
    // Before the flash is searched: until then, the DAC has the settings of the last start.
    let (frames, mut dac) = dac::start();
    // A missing DAC is not a fault yet: it is checked again before the board arms.
    let _ = dac.prepare();

    let flash = StoreFlash::new();
    let board = board::board(&last_reset, flash.as_ref());
    let (ticker, session) = make(board);
    let status = ticker.status();
    #[cfg(not(feature = "store"))]
    let store = ();
    #[cfg(feature = "store")]
    let store = flash.map(|flash| (SceneStore::new(board::SCENE_SLOT, TICK_HZ, &flash, session), flash));

    let (session_ends, tick_ends) = queues.split();
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
        store,
        watchdog: Watchdog::start(),
        record: &fault::RECORD,
    }
}

/// Makes the tick and the main loop.
#[inline(never)]
fn make(board: Board) -> (Ticker<'static>, &'static mut Session<'static>) {
    let (Some(first), Some(second)) = (first_coefficients(), second_coefficients()) else { fault::never() };
    #[cfg_attr(not(feature = "stream"), allow(unused_mut, reason = "a stream is attached to it"))]
    let mut ticker = Ticker::new(&board, &POOL, first);
    let Some(session) = session(board, second) else { fault::never() };
    #[cfg(feature = "telemetry")]
    session.attach_tick_meter(&tick::SHARED.meter);
    #[cfg(feature = "stream")]
    {
        ticker.attach_stream(&STREAM);
        session.attach_stream(&STREAM);
    }
    (ticker, session)
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
