//! The firmware on a NUCLEO-G474RE: assembles the parts from the library.
#![no_std]
#![no_main]

use board_nucleo_g474re::adc::Adc;
use board_nucleo_g474re::board::Nucleo;
use board_nucleo_g474re::flash::BankTwo;
#[cfg(feature = "optical-frame")]
use board_nucleo_g474re::optical_frame;
use board_nucleo_g474re::serial::Usart;
use board_nucleo_g474re::start::{Started, begin};
use board_nucleo_g474re::watchdog::Watchdog;
use board_nucleo_g474re::{board, dac, indicator, tick};
use cortex_m_rt::entry;
#[cfg(feature = "log")]
use defmt_rtt as _;
use frixel_board::main_loop::MainLoop;
use frixel_board::memory::Memory;
use frixel_board::start::{Parts, prepare};
use frixel_drivers::fault_record::Text;
use frixel_wire::message::FAULT_TEXT_MAX_LEN;
use stm32_metapac::interrupt;

frixel_cortex_m::tick_interrupt!(Nucleo, TIM3);

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
fn start(text: &'static mut Text, memory: &'static mut Memory) -> MainLoop<Nucleo> {
    let Started { boot, output, period, last_reset } = begin(text);
    let light = indicator::start();
    // Before the flash is searched, which takes up to 0.2 s: until then, the DAC has the settings of the last start.
    let (frames, mut dac) = dac::start(&boot);
    prepare(&mut dac);
    let made = memory.make(board::board(&last_reset, BankTwo::new().as_ref()));
    let serial = Some(Usart::start());
    let (ready, switch) = tick::start_inputs(&boot);
    let monitor = Adc::new(&boot);
    let parts = Parts { period, frames, dac, enable: output, ready, monitor, switch, light, serial };
    parts.start(made, &tick::SHARED, |tick| tick::start(&TICK, boot, tick), Watchdog::start)
}
