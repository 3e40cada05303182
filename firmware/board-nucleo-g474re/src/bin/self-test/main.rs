//! Measures a new board with wires between its own pins, without DAC, amplifier and voltage: `cargo run --release --bin
//! self-test`, described in `docs/first-board.md`. The script is `frixel_board::self_test`; here is what it needs of
//! this board. `frixel selftest --wires` answers it on the ST-Link's serial port, at 2 Mbaud, or a person at a
//! terminal.
#![no_std]
#![no_main]

mod captures;
mod hardware;
mod looped;
mod start;

use core::sync::atomic::{AtomicU32, Ordering};

use board_nucleo_g474re::adc::Adc;
use board_nucleo_g474re::flash::BankTwo;
use board_nucleo_g474re::output::{self, Output};
use board_nucleo_g474re::serial::Serial;
use board_nucleo_g474re::terminal::Terminal;
use board_nucleo_g474re::{board, clock, dac, fault, period, tick};
use cortex_m::Peripherals;
use cortex_m::peripheral::SCB;
use cortex_m_rt::entry;
use defmt_rtt as _;
use frixel_board::self_test;
use frixel_cortex_m::{guard, outlasting};
use frixel_drivers::fault_record::Text;
use frixel_wire::message::FAULT_TEXT_MAX_LEN;

use captures::Captures;
use looped::{Looped, Stage, Still};

/// Marks the memory below as valid; what the script keeps over a reset stands in its lowest byte.
const MARK: u32 = 0x7374_6500;

/// Kept over a reset: [`MARK`] and what the script keeps.
#[unsafe(link_section = ".uninit.KEPT")]
static KEPT: AtomicU32 = AtomicU32::new(0);

#[entry]
fn main() -> ! {
    static mut TEXT: Text = [0; FAULT_TEXT_MAX_LEN];

    let output = Output::new();
    let Some(mut core) = Peripherals::take() else { fault::never() };
    guard::start(&mut core.MPU);
    let last_reset = fault::last_reset(TEXT);
    clock::start();
    clock::start_peripherals();
    clock::keep_timers_running_in_debug();
    clock::start_cycle_counter(&mut core.DCB, &mut core.DWT);
    period::start();
    tick::start_inputs();

    let kept = outlasting(&KEPT).swap(0, Ordering::Relaxed);
    let kept = if kept & !0xff == MARK { kept & 0xff } else { 0 };
    let (frames, dac) = dac::start();
    let (spi, _) = dac.release();
    let mut terminal = Terminal::new(Serial::new());
    if let Some((fault, _)) = last_reset.fault {
        let text = str::from_utf8(last_reset.text).unwrap_or_default();
        terminal.say(format_args!("The last start ended in {fault} ({text})"));
    }
    let stage = Stage::Still(Still { output, frames, captures: Captures::start(), adc: Adc::new(), spi });
    let mut looped = Looped { board: board::board(&last_reset, None), terminal, flash: BankTwo::new(), stage };
    if self_test::run(&mut looped, kept).is_err() {
        output::zero_for_good();
    }
    loop {
        looped.turn(false);
    }
}

/// Resets the board; the next start finds `kept`.
fn reset(kept: u32) -> ! {
    KEPT.store(MARK | kept & 0xff, Ordering::Relaxed);
    SCB::sys_reset()
}
