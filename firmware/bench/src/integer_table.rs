//! The inverse table in integers on a Cortex-M3, which has no FPU.
//!
//! `hil-sim/tests/integer_table.rs` runs this image in the emulator and compares what it writes with the same table on
//! the desktop; a panic ends the emulator with an error, which that test reports. The words on the emulator's command
//! line, all in hexadecimal, are the bits of eight `f64` (the finger's radius in m, its stiffness in Pa/m, its friction
//! coefficient, the effective gap in m, the normal load in N, the least and the largest voltage in V rms, the relative
//! error) and the step from one friction to the next, a `u32`.
//!
//! The image writes one line for each row of the table, with its coefficients, then one line for each friction, with
//! friction and voltage as raw bits, all in hexadecimal.
#![no_std]
#![no_main]

mod semihosting;

use core::str;

// Its critical section.
use cortex_m as _;
use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprint, hprintln};
use frixel_model::{Contact, Finger, FixedTable, TableBuilder, U0F32};
use semihosting::{COMMAND_LINE_MAX_LEN, command_line};

/// Rows that a table may need.
const ROWS: usize = 512;

#[entry]
fn main() -> ! {
    let mut line = [0; COMMAND_LINE_MAX_LEN];
    let (numbers, step) = parse(command_line(&mut line)).expect("eight numbers and a step on the command line");
    let [radius_m, stiffness_pa_per_m, friction_coefficient, gap_m, load_n, voltage_min, voltage_max, error] = numbers;
    let finger = Finger { radius_m, stiffness_pa_per_m, friction_coefficient };
    let contact = Contact::new(&finger, gap_m).and_then(|contact| contact.under_load(load_n)).expect("a contact");
    let friction_n = |voltage_v_rms| contact.electric_friction_n(voltage_v_rms);
    let mut rows = [[0; 4]; ROWS];
    let table = TableBuilder::new(&contact, friction_n(voltage_min), friction_n(voltage_max), error)
        .and_then(|builder| builder.build_fixed(&mut rows))
        .expect("a table");
    write(&table, step);
    debug::exit(debug::EXIT_SUCCESS);
    panic!("semihosting exit returned")
}

fn write(table: &FixedTable<4>, step: usize) {
    for row in table.rows() {
        hprint!("row");
        for coefficient in row {
            hprint!(" {:x}", coefficient);
        }
        hprintln!("");
    }
    for friction in (0..=u32::MAX).step_by(step) {
        hprintln!("{:x} {:x}", friction, table.voltage(U0F32::from_bits(friction)).to_bits());
    }
}

fn parse(line: &[u8]) -> Option<([f64; 8], usize)> {
    let mut words = str::from_utf8(line).ok()?.split_ascii_whitespace().skip(1);
    let mut numbers = [0.0; 8];
    for number in &mut numbers {
        *number = f64::from_bits(u64::from_str_radix(words.next()?, 16).ok()?);
    }
    let step = usize::from_str_radix(words.next()?, 16).ok()?;
    Some((numbers, step))
}
