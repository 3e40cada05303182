//! The firmware on a Raspberry Pi Pico 2 or Pico: assembles the parts from the library.
#![no_std]
#![no_main]

use board_pico::adc::Adc;
use board_pico::board::Pico;
#[cfg(feature = "optical-frame")]
use board_pico::optical_frame;
use board_pico::output::Output;
use board_pico::serial::Uart0;
use board_pico::watchdog::Watchdog;
use board_pico::{board, boot, clock, dac, fault, indicator, output, tick};
use cortex_m_rt::entry;
#[cfg(feature = "log")]
use defmt_rtt as _;
use frixel_board::main_loop::MainLoop;
use frixel_board::memory::Memory;
use frixel_board::start::{Parts, prepare};
use frixel_cortex_m::{Boot, guard};
use frixel_drivers::fault_record::Text;
use frixel_wire::message::FAULT_TEXT_MAX_LEN;

#[entry]
fn main() -> ! {
    static mut TEXT: Text = [0; FAULT_TEXT_MAX_LEN];
    static mut MEMORY: Memory = Memory::new();

    let main_loop = start(TEXT, MEMORY);
    #[cfg(feature = "optical-frame")]
    optical_frame::run(main_loop);
    #[cfg(not(feature = "optical-frame"))]
    main_loop.run(|| None)
}

/// Starts everything ([`frixel_board::start`]). A function of its own, so that its stack is free again afterwards.
#[inline(never)]
fn start(text: &'static mut Text, memory: &'static mut Memory) -> MainLoop<Pico> {
    output::zero_for_good();
    let (boot, mut core) = Boot::take();
    boot::move_vectors(&mut core.SCB);
    guard::start(&mut core.MPU);
    let last_reset = fault::last_reset(text);
    // First, so that a board that fails during start-up has logged the cause of its last reset.
    last_reset.log();
    clock::start();
    clock::start_peripherals();
    let enable = Output::new(&boot);
    let light = indicator::start();
    // Before the flash is searched: until then, the DAC has the settings of the last start.
    let (frames, mut dac, period) = dac::start(&boot);
    prepare(&mut dac);
    let made = memory.make(board::board(&last_reset));
    let serial = Some(Uart0::start());
    let (ready, switch) = tick::start_inputs(&boot);
    let monitor = Adc::new(&boot);
    let parts = Parts { period, frames, dac, enable, ready, monitor, switch, light, serial };
    parts.start(made, &tick::SHARED, |tick| tick::start(&mut core.NVIC, boot, tick), Watchdog::start)
}
