//! Friction to voltage, by tables and in closed form.

use core::hint::black_box;

use frixel_model::{Contact, Finger, FixedTable, InverseTable, LoadedContact, Real, TableBuilder, U0F32};

use crate::count::Counter;

/// The example finger: radius, stiffness, friction coefficient; coating; load; largest voltage.
const FINGER: Finger<f64> = Finger::<f64>::EXAMPLE;
const EFFECTIVE_GAP_M: f64 = 1e-5;
const NORMAL_LOADS_N: [f64; 2] = [0.0, 0.5];
const VOLTAGE_MAX_V_RMS: f64 = 200.0;

/// Every `STEP`-th positive `f32` is looked up, by bit pattern.
const STEP: usize = 0x1_0003;
const SPECIALS: [f32; 6] = [0.0, -0.0, -1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

/// Lowest voltage and relative error of the integer table, which covers a limited range.
const VOLTAGE_MIN_V_RMS: f64 = 1.0;
const RELATIVE_ERROR: f64 = 1e-5;
/// Largest number of rows of the table.
const FIXED_ROWS: usize = 512;
/// Every `CODE_STEP`-th code is looked up.
const CODE_STEP: usize = 0x2_0003;

/// Counts the look-ups of all three methods, without and with a load.
pub fn run(counter: &mut Counter) {
    let mut by_table = counter.case("inverse_table");
    let mut by_fixed_table = counter.case("inverse_table_fixed");
    let mut in_closed_form = counter.case("inverse_closed_form");
    for load_n in NORMAL_LOADS_N {
        let contact = contact(&FINGER, EFFECTIVE_GAP_M, load_n);
        let Ok(mut table) = InverseTable::build(&contact, VOLTAGE_MAX_V_RMS) else { panic!("no table") };
        let mut single = single(load_n);
        for x in (0..0x7f80_0000).step_by(STEP).map(f32::from_bits).chain(SPECIALS) {
            let x = black_box(x);
            black_box(by_table.take(from_table, &mut table, x));
            black_box(in_closed_form.take(from_closed_form, &mut single, x));
        }
        let mut rows = [[0; 4]; FIXED_ROWS];
        let mut fixed = fixed(&contact, &mut rows);
        for code in (0..=u32::MAX).step_by(CODE_STEP) {
            black_box(by_fixed_table.take(from_fixed_table, &mut fixed, black_box(code)));
        }
    }
    by_table.report();
    by_fixed_table.report();
    in_closed_form.report();
}

fn single(load_n: f64) -> LoadedContact<f32> {
    let finger = Finger {
        radius_m: FINGER.radius_m as f32,
        stiffness_pa_per_m: FINGER.stiffness_pa_per_m as f32,
        friction_coefficient: FINGER.friction_coefficient as f32,
    };
    contact(&finger, EFFECTIVE_GAP_M as f32, load_n as f32)
}

fn contact<T: Real>(finger: &Finger<T>, effective_gap_m: T, load_n: T) -> LoadedContact<T> {
    match Contact::new(finger, effective_gap_m).and_then(|contact| contact.under_load(load_n)) {
        Ok(contact) => contact,
        Err(error) => panic!("the contact model refuses the example finger: {error:?}"),
    }
}

fn fixed<'rows>(contact: &LoadedContact<f64>, rows: &'rows mut [[i32; 4]]) -> FixedTable<'rows, 4> {
    let friction_n = |voltage_v_rms| contact.electric_friction_n(voltage_v_rms);
    let (least_n, largest_n) = (friction_n(VOLTAGE_MIN_V_RMS), friction_n(VOLTAGE_MAX_V_RMS));
    match TableBuilder::new(contact, least_n, largest_n, RELATIVE_ERROR).and_then(|builder| builder.build_fixed(rows)) {
        Ok(table) => table,
        Err(error) => panic!("no table in integers: {error}"),
    }
}

#[inline(never)]
fn from_fixed_table(table: &mut FixedTable<4>, friction: u32) -> u32 {
    table.voltage(U0F32::from_bits(friction)).to_bits()
}

#[inline(never)]
fn from_table(table: &mut InverseTable, electric_friction_n: f32) -> f32 {
    table.voltage_v_rms(electric_friction_n)
}

#[inline(never)]
fn from_closed_form(contact: &mut LoadedContact<f32>, electric_friction_n: f32) -> f32 {
    contact.voltage_v_rms(electric_friction_n)
}
