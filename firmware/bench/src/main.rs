//! Counts the instructions that the firmware takes.
//!
//! `cargo xtask bench` runs this image in the emulator with `-icount shift=10,sleep=off`, where an instruction takes
//! 1,024 ns of virtual time and nothing else takes any. Every line that it writes is a name, the largest count over all
//! inputs, the number of that input, and the mean count. Then a debugger follows that one input ([`count`]), to see which instructions
//! they are.
#![no_std]
#![no_main]

mod count;
mod host;
mod inverse;
mod layers;
mod tick;

use core::panic::PanicInfo;

use cortex_m::Peripherals;
use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprintln};

use count::Counter;

#[entry]
fn main() -> ! {
    if let Some(peripherals) = Peripherals::take() {
        let mut counter = Counter::new(peripherals.SYST);
        inverse::run(&mut counter);
        if cfg!(target_abi = "eabihf") {
            tick::run(&mut counter);
        }
        debug::exit(debug::EXIT_SUCCESS);
    }
    panic!("the emulator goes on after the end")
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    hprintln!("{}", info);
    debug::exit(debug::EXIT_FAILURE);
    loop {}
}
