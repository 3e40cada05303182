//! Friction to voltage, by table and in closed form.

use core::hint::black_box;

use frixel_model::{Contact, Finger, InverseTable, LoadedContact};

use crate::count::{Counter, Worst};

/// The example finger: radius, stiffness, friction coefficient; coating; load; largest voltage.
const FINGER: Finger<f64> = Finger { radius_m: 8e-3, stiffness_pa_per_m: 1.8e7, friction_coefficient: 0.5 };
const EFFECTIVE_GAP_M: f64 = 1e-5;
const NORMAL_LOADS_N: [f64; 2] = [0.0, 0.5];
const VOLTAGE_MAX_V_RMS: f64 = 200.0;

/// One positive `f32` in so many is looked up, by bit pattern.
const STEP: usize = 0x1_0003;
const SPECIALS: [f32; 6] = [0.0, -0.0, -1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

/// Counts both, without and with a load.
pub fn run(counter: &Counter) {
    let (mut table_worst, mut closed_worst) = (Worst::new(), Worst::new());
    for load_n in NORMAL_LOADS_N {
        let Ok(contact) = Contact::new(&FINGER, EFFECTIVE_GAP_M).and_then(|contact| contact.under_load(load_n)) else {
            panic!("the contact model refuses the example finger");
        };
        let Ok(table) = InverseTable::build(&contact, VOLTAGE_MAX_V_RMS) else { panic!("no table") };
        let single = single(load_n);
        for x in (0..0x7f80_0000).step_by(STEP).map(f32::from_bits).chain(SPECIALS) {
            table_worst.take(net(counter, |x| by_table(black_box(&table), x), |x| nothing(black_box(&table), x), x));
            closed_worst.take(net(
                counter,
                |x| in_closed_form(black_box(&single), x),
                |x| nothing(black_box(&single), x),
                x,
            ));
        }
    }
    table_worst.report("inverse_table");
    closed_worst.report("inverse_closed_form");
}

fn single(load_n: f64) -> LoadedContact<f32> {
    let finger = Finger {
        radius_m: FINGER.radius_m as f32,
        stiffness_pa_per_m: FINGER.stiffness_pa_per_m as f32,
        friction_coefficient: FINGER.friction_coefficient as f32,
    };
    match Contact::new(&finger, EFFECTIVE_GAP_M as f32).and_then(|contact| contact.under_load(load_n as f32)) {
        Ok(contact) => contact,
        Err(_) => panic!("the contact model refuses the example finger"),
    }
}

/// Instructions of one function less those of a function that does nothing: without call and return.
#[inline(always)]
fn net(counter: &Counter, full: impl FnOnce(f32) -> f32, empty: impl FnOnce(f32) -> f32, x: f32) -> u32 {
    let x = black_box(x);
    let (gross, result) = counter.count(|| full(x));
    black_box(result);
    let (call, result) = counter.count(|| empty(x));
    black_box(result);
    gross - call
}

#[inline(never)]
fn by_table(table: &InverseTable, electric_friction_n: f32) -> f32 {
    table.voltage_v_rms(electric_friction_n)
}

#[inline(never)]
fn in_closed_form(contact: &LoadedContact<f32>, electric_friction_n: f32) -> f32 {
    contact.voltage_v_rms(electric_friction_n)
}

#[inline(never)]
fn nothing<T>(state: &T, electric_friction_n: f32) -> f32 {
    black_box(state);
    electric_friction_n
}
