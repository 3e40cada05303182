//! Brings up a new board, step by step, with the output disconnected first: `cargo run --release --bin bring-up`,
//! described in `docs/hardware.md`. Every step states over RTT what to do; the blue button continues.
#![no_std]
#![no_main]

mod bench;
mod fault_injection;
mod store;

use board_nucleo_g474re::fault::{self, LastReset};
use board_nucleo_g474re::output::Output;
use board_nucleo_g474re::{clock, guard, indicator, output, period};
use cortex_m::Peripherals;
use cortex_m_rt::entry;
use defmt::{error, info, println};
use defmt_rtt as _;
use frixel_drivers::fault_record::Text;
use frixel_wire::message::FAULT_TEXT_MAX_LEN;

use bench::Bench;

#[entry]
fn main() -> ! {
    static mut TEXT: Text = [0; FAULT_TEXT_MAX_LEN];

    let output = Output::new();
    let Some(mut core) = Peripherals::take() else { fault::never() };
    guard::start(&mut core.MPU);
    let last_reset = LastReset::take(TEXT);
    clock::start();
    clock::start_peripherals();
    clock::keep_timers_running_in_debug();
    clock::start_cycle_counter(&mut core.DCB, &mut core.DWT);
    let _ = indicator::start();
    period::start();

    let mut bench = Bench::new(output);
    if fault_injection::continues_after(&last_reset) {
        fault_injection::next();
    }
    println!("");
    println!("frixel bring-up. Read docs/hardware.md first: this board drives hundreds of volts.");

    bench.prompt("1. Nothing is connected but USB.");
    stop_unless(bench.one_shot());

    bench.prompt("2. Connect the DAC, and a voltmeter to its output. The amplifier stays disconnected.");
    stop_unless(bench.dac());

    bench.prompt("3. Connect amplifier and arm switch, supply off. The electrode stays disconnected.");
    bench.inputs();

    bench.prompt(
        "4. Switch the amplifier's supply on, a high-voltage probe on its output. Hold the arm switch meanwhile.",
    );
    for peak_v in [10.0, 25.0, 50.0] {
        stop_unless(bench.square(peak_v));
    }

    bench.prompt("5. Connect series resistor and a capacitor of the electrode's worst case instead of the electrode.");
    stop_unless(bench.edge());

    bench.prompt("6. Switch the amplifier's supply off. The board will panic, fault and hang, and restart each time.");
    if !fault_injection::are_done() {
        fault_injection::next();
    }

    bench.prompt("7. The limits that were built in are stored.");
    store::limits();
    info!("done: flash the firmware with `cargo run --release`");
    loop {
        cortex_m::asm::wfi();
    }
}

/// Ends bring-up at a step that has failed, with the output at zero: no later step drives a board that failed an
/// earlier one.
fn stop_unless(passed: bool) {
    if passed {
        return;
    }
    output::zero_for_good();
    error!("the step has failed and bring-up stops here: mend it, and reset the board to begin again");
    loop {
        cortex_m::asm::wfi();
    }
}
