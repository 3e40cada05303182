//! Counts the instructions that the firmware takes.
//!
//! `cargo xtask bench` runs this image in the emulator with `-icount shift=10,sleep=off`, where every instruction
//! takes 1,024 ns of virtual time and nothing else takes any. Every line of output is a name, the largest count over
//! all inputs, the number of that input, and the mean count. Then a debugger traces that one input ([`count`]), to
//! list the instructions.
#![no_std]
#![no_main]

mod angle;
mod count;
mod host;
mod inverse;
mod layers;
mod programs;
mod semihosting;
mod tick;

use cortex_m::Peripherals;
use cortex_m_rt::entry;
use cortex_m_semihosting::debug;

use count::Counter;
use programs::Seeds;
use semihosting::{COMMAND_LINE_MAX_LEN, command_line};

#[entry]
fn main() -> ! {
    if let Some(peripherals) = Peripherals::take() {
        let mut counter = Counter::new(peripherals.SYST);
        let mut line = [0; COMMAND_LINE_MAX_LEN];
        if let Some(seeds) = Seeds::of_command_line(command_line(&mut line)) {
            programs::run(&seeds, &mut counter);
            debug::exit(debug::EXIT_SUCCESS);
        }
        inverse::run(&mut counter);
        // The Cortex-M4F and M33, and the Cortex-M0+, which has no atomic exchange.
        if cfg!(any(target_abi = "eabihf", not(target_has_atomic = "32"))) {
            angle::run(&mut counter);
            tick::run(&mut counter);
        }
        debug::exit(debug::EXIT_SUCCESS);
    }
    panic!("semihosting exit returned")
}
