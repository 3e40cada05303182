//! Brings up a new board, step by step: `cargo run --release --bin bring-up`, described in `docs/board/hardware.md`.
//! The script is `frixel_board::bring_up`; this program implements its interface to the board. The person types at a
//! terminal on the ST-Link's serial port, at 2 Mbaud.
#![no_std]
#![no_main]

mod bench;
mod fault_injection;
mod limits;
mod start;
mod still;

use board_nucleo_g474re::board::CEILINGS;
use board_nucleo_g474re::flash::{self, BankTwo};
use board_nucleo_g474re::serial::{Serial, Usart};
use board_nucleo_g474re::start::{Started, begin};
use board_nucleo_g474re::{board, dac, output, tick, watchdog};
use cortex_m_rt::entry;
use defmt_rtt as _;
use frixel_board::bring_up::{self, Injection, TestOutput};
use frixel_board::memory::Memory;
use frixel_control::Board;
use frixel_drivers::fault_record::Text;
use frixel_session::store::CeilingPolicy;
use frixel_wire::hello::BoardLimits;
use frixel_wire::message::{FAULT_TEXT_MAX_LEN, Refusal};

use bench::{NucleoBench, Stage};
use still::Still;

/// The person's terminal, on the ST-Link's serial port.
type Terminal = frixel_board::terminal::Terminal<Serial>;

#[entry]
fn main() -> ! {
    static mut TEXT: Text = [0; FAULT_TEXT_MAX_LEN];
    static mut MEMORY: Memory = Memory::new();

    let Started { boot, output, period, last_reset } = begin(TEXT);
    let inputs = tick::start_inputs(&boot);

    let injection = fault_injection::after(&last_reset);
    if let Injection::Next(fault) = injection
        && !tick::inputs().0
    {
        fault_injection::inject(fault);
    }
    let (frames, dac) = dac::start(&boot);
    let mut terminal = Terminal::new(Usart::start());
    let Some(limits) = limits::built_in() else {
        terminal.say(format_args!("a limit in the environment of this build is not a number"));
        stop()
    };
    if let (Some((fault, _)), Injection::NotBegun) = (last_reset.fault, injection) {
        let text = str::from_utf8(last_reset.text).unwrap_or_default();
        terminal.say(format_args!("The last start ended in {fault} ({text})"));
    }
    if matches!(CEILINGS, CeilingPolicy::Lifted) {
        terminal.say(format_args!("This build stores limits above the ceilings: nobody may touch this board."));
    }
    if !flash::option_bytes_are_right() {
        terminal.say(format_args!("Before step 4: {}.", Refusal::OptionBytes));
    }
    let flash = BankTwo::new();
    // A capacitor replaces the electrode, and is not touched: the script asks for that before any voltage.
    let untouched = BoardLimits { series_resistance_ohm: f32::INFINITY, ..limits };
    let board = Board { limits: untouched, ..board::board(&last_reset, None) };
    let stage = Stage::Still(Still { memory: MEMORY, boot, output, period, inputs, frames, dac, periods: 0 });
    let mut bench = NucleoBench { board, terminal, flash, injection, stage };
    match bring_up::run(&mut bench, &limits) {
        Ok(limits) => {
            bench.terminal.say(format_args!(
                "Stored: up to {} V peak, full scale {:.1} V peak, edges {:.1} us. Flash the firmware with `cargo run \
                 --release`.",
                limits.voltage_max_v_peak,
                limits.full_scale_v_peak,
                limits.edge_time_constant_s * 1e6
            ));
        }
        Err(stop) => {
            output::zero_for_good();
            bench
                .terminal
                .say(format_args!("STOP. {stop}. Switch the amplifier's supply off, fix it, reset the board."));
        }
    }
    // The watchdog may run.
    loop {
        bench.turn(TestOutput::Zero);
    }
}

/// Ends the program with the output at zero.
fn stop() -> ! {
    output::zero_for_good();
    loop {
        watchdog::feed();
    }
}
