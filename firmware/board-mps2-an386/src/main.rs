//! The firmware on an emulated Cortex-M4F: `qemu-system-arm -M mps2-an386`.
//!
//! Tick, main loop and fault handling are those of every board (`frixel-board`). [`tick`] runs in the `SysTick`
//! interrupt, above everything. Amplifier and touch source are words of memory that it shares with the simulator
//! ([`shared`]). [`lockstep`] replaces all that by a loop that ticks whenever the simulator sends a tick.
//! [`fault_injection`] causes faults on demand.
//!
//! For `thumbv8m.main-none-eabihf` it is an image for `-M mps2-an505`, a Cortex-M33, which only ticks in lockstep; its
//! timer, serial port and memory differ.
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
use frixel_board::memory::{BoardParts, Memory};
use frixel_board::start::Parts;
use frixel_control::Board;
use frixel_cortex_m::{Boot, guard, unreachable_state};
use frixel_drivers::fault_record::Text;
use frixel_drivers::pin::DirectPin;
use frixel_drivers::serial::BufferedSerial;
use frixel_exchange::{BOARD, layout};
use frixel_wire::message::FAULT_TEXT_MAX_LEN;

use board::{NoLight, NoWatchdog};
use inputs::{Monitor, Ready, Switch};
use output::{Enable, Frames};
use period::Period;
use uart::Uart;

/// Whether the machine has the timer, the serial port and the stack guard.
const IS_AN386: bool = cfg!(not(an505));

#[entry]
fn main() -> ! {
    static mut TEXT: Text = [0; FAULT_TEXT_MAX_LEN];
    static mut MEMORY: Memory = Memory::new();

    let (boot, mut peripherals) = Boot::take();
    if IS_AN386 {
        guard::start(&mut peripherals.MPU);
    }
    shared::set(layout::OUTPUT_AT_START, shared::get(layout::OUTPUT));
    let made = MEMORY.make(started(TEXT));
    match shared::get(layout::MODE) {
        layout::MODE_LINK if IS_AN386 => run(made, boot, peripherals),
        _ => lockstep::run(made.session, made.ticker),
    }
}

/// Starts the tick on the board's own timer, and runs the main loop with the host on the serial port.
fn run(made: BoardParts, boot: Boot, mut peripherals: Peripherals) -> ! {
    let Some(bytes) = singleton!(: uart::Queues = uart::Queues::new()) else { unreachable_state() };
    let parts = Parts {
        period: Period::default(),
        frames: Frames,
        dac: (),
        enable: Enable,
        ready: DirectPin(Ready),
        monitor: Monitor::new(),
        switch: DirectPin(Switch),
        light: DirectPin(NoLight),
        serial: None,
    };
    let start_tick = |tick| tick::start(boot, tick, peripherals.SYST);
    let mut main_loop = parts.start(made, &tick::SHARED, start_tick, || NoWatchdog);
    main_loop.serial = Uart::start(bytes, &mut peripherals.NVIC).map(BufferedSerial::new);
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
