//! Measures a new board with wires between its own pins, without DAC, amplifier and voltage: `cargo run --release --bin
//! self-test`, described in `docs/board/first-board.md`. The script is `frixel_board::self_test`; this program
//! implements its interface to the board. `frixel board selftest --wires` answers it on the ST-Link's serial port, at 2
//! Mbaud, or a person at a terminal.
#![no_std]
#![no_main]

mod captures;
mod hardware;
mod looped;
mod start;

use board_nucleo_g474re::adc::Adc;
use board_nucleo_g474re::serial::{Serial, Usart};
use board_nucleo_g474re::start::{Started, begin};
use board_nucleo_g474re::{board, dac, output, tick};
use cortex_m_rt::entry;
use defmt_rtt as _;
use frixel_board::memory::Memory;
use frixel_board::self_test;
use frixel_control::Board;
use frixel_drivers::ad5761r::FrameDevice;
use frixel_drivers::fault_record::Text;
use frixel_wire::message::FAULT_TEXT_MAX_LEN;

use captures::Captures;
use looped::{Looped, Stage, Still};

/// The person's terminal, on the ST-Link's serial port.
type Terminal = frixel_board::terminal::Terminal<Serial>;

#[entry]
fn main() -> ! {
    static mut TEXT: Text = [0; FAULT_TEXT_MAX_LEN];
    static mut MEMORY: Memory = Memory::new();

    let Started { boot, output, period, last_reset } = begin(TEXT);
    let _ = tick::start_inputs(&boot);

    let (frames, dac) = dac::start(&boot);
    let (FrameDevice(spi), _) = dac.release();
    let mut terminal = Terminal::new(Usart::start());
    if let Some((fault, _)) = last_reset.fault {
        let text = str::from_utf8(last_reset.text).unwrap_or_default();
        terminal.say(format_args!("The last start ended in {fault} ({text})"));
    }
    let adc = Adc::new(&boot);
    let captures = Captures::start();
    let stage = Stage::Still(Still { memory: MEMORY, boot, output, period, frames, captures, adc, spi });
    // There is no amplifier, so it arms regardless of the option bytes.
    let board = Board { notices: 0, ..board::board(&last_reset, None) };
    let mut looped = Looped { board, terminal, stage };
    if self_test::run(&mut looped).is_err() {
        output::zero_for_good();
    }
    loop {
        looped.turn(false);
    }
}
