//! Mean friction under a carrier, against the mean over every tick of a wave followed step by step.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]
#![allow(clippy::float_cmp, reason = "exact results are compared exactly")]

use frixel_model::{Carrier, Contact, Finger, InverseTable, LoadedContact, Waveform};

const TICK_S: f64 = 25e-6;
const BOUND: f64 = InverseTable::RELATIVE_ERROR as f64;

fn carrier(waveform: Waveform, half_period_ticks: u32, lag_us: f64) -> Carrier {
    Carrier::new(waveform, half_period_ticks, 40_000, (1e-6 * lag_us) as f32)
}

/// Mean square of the electrode voltage in each tick of a half period, over that of all ticks.
fn relative_squares(carrier: &Carrier) -> Vec<f64> {
    let half = carrier.half_period_ticks;
    let level = |tick: u32| match carrier.waveform {
        Waveform::Square => 1.0 - 2.0 * f64::from((tick / half) % 2),
        Waveform::Sine => (core::f64::consts::PI * f64::from(tick) / f64::from(half)).sin(),
    };
    let lags = TICK_S / f64::from(carrier.edge_time_constant_s);
    let followed = -(-lags).exp_m1();
    let mut v = 0.0;
    let mut tick_square = |tick: u32| {
        let target = level(tick);
        let rest = v - target;
        v = target + rest * (1.0 - followed);
        if lags.is_infinite() {
            return target * target;
        }
        let rest_square = -(-2.0 * lags).exp_m1() / (2.0 * lags) * rest * rest;
        target * target + 2.0 * target * rest * followed / lags + rest_square
    };
    let periods = 2 * half * (2 + (80.0 / lags / f64::from(half)) as u32);
    let squares: Vec<f64> = (0..periods + half).map(&mut tick_square).skip(periods as usize).collect();
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    squares.into_iter().map(|square| square / mean).collect()
}

fn mean_friction_n(contact: &LoadedContact<f64>, squares: &[f64], voltage_v_rms: f64) -> f64 {
    let sum: f64 = squares.iter().map(|square| contact.electric_friction_n(voltage_v_rms * square.sqrt())).sum();
    sum / squares.len() as f64
}

/// Carriers, and the bound on the relative error of the mean friction.
fn carriers() -> impl Iterator<Item = (Carrier, f64)> {
    let square = |half, lag_us, bound| (carrier(Waveform::Square, half, lag_us), bound);
    let sine = |half, lag_us, bound| (carrier(Waveform::Sine, half, lag_us), bound);
    let squares = [4, 5, 8, 9, 20, 80, 160].into_iter().flat_map(move |half| {
        let settled = [0.0, 1.0, 5.0, 20.0, 37.5].map(|lag_us| square(half, lag_us, 1e-6));
        let slow = [65.0, 80.0, 100.0, 199.0, 400.0, 1e3, 3e3].map(|lag_us| square(half, lag_us, 4.1e-3));
        settled.into_iter().chain([square(half, 60.0, 5e-5), square(8, 400.0, 5e-5)]).chain(slow)
    });
    let lags_us = [0.0, 5.0, 20.0, 60.0];
    let smooth = [20, 50, 160].into_iter().flat_map(move |half| lags_us.map(|lag_us| sine(half, lag_us, 3e-5)));
    let coarse = [4, 5, 6, 8, 9].into_iter().flat_map(move |half| lags_us.map(|lag_us| sine(half, lag_us, 3e-3)));
    squares.chain(smooth).chain(coarse)
}

fn contact(finger: &Finger<f64>, gap_m: f64, load_n: f64) -> LoadedContact<f64> {
    Contact::new(finger, gap_m).unwrap().under_load(load_n).unwrap()
}

fn soft_and_hard_fingers() -> impl Iterator<Item = LoadedContact<f64>> {
    let example = Finger::<f64>::EXAMPLE;
    [1e5, 1.8e7, 1e13].into_iter().flat_map(move |stiffness_pa_per_m| {
        let finger = Finger { stiffness_pa_per_m, ..example };
        [0.0, 1e-3, 0.5, 2.0].map(|load_n| contact(&finger, 5e-6, load_n))
    })
}

#[test]
fn mean_friction_is_that_of_every_tick() {
    for (carrier, bound) in carriers() {
        let squares = relative_squares(&carrier);
        for contact in soft_and_hard_fingers() {
            let carried = contact.under_carrier(carrier.ripple());
            for voltage_v_rms in [1.0, 20.0, 80.0, 150.0, 200.0] {
                let expected_n = mean_friction_n(&contact, &squares, voltage_v_rms);
                let found_n = carried.electric_friction_n(voltage_v_rms);
                let error = (found_n / expected_n - 1.0).abs();
                assert!(error < bound, "{carrier:?}, {voltage_v_rms} V: {error:.2e}");
            }
        }
    }
}

#[test]
fn the_inverse_in_f64_returns_the_voltage() {
    for (carrier, _) in carriers() {
        for contact in soft_and_hard_fingers() {
            let carried = contact.under_carrier(carrier.ripple());
            for voltage_v_rms in [1e-3, 1.0, 20.0, 80.0, 150.0, 200.0] {
                let found_v_rms = carried.voltage_v_rms(carried.electric_friction_n(voltage_v_rms));
                let error = (found_v_rms / voltage_v_rms - 1.0).abs();
                assert!(error < 1e-13, "{carrier:?}, {voltage_v_rms} V: {error:.2e}");
            }
        }
    }
}

#[test]
fn tables_stay_within_their_bound_of_the_mean() {
    for (carrier, _) in carriers() {
        for stiffness_pa_per_m in [1e5_f32, 1.8e7, 1e13] {
            let finger = Finger::<f32> { stiffness_pa_per_m, ..Finger::<f32>::EXAMPLE };
            let Finger { radius_m, stiffness_pa_per_m, friction_coefficient } = finger;
            let exact = Finger {
                radius_m: radius_m.into(),
                stiffness_pa_per_m: stiffness_pa_per_m.into(),
                friction_coefficient: friction_coefficient.into(),
            };
            for load_n in [0.0_f32, 1e-3, 0.5, 2.0] {
                let carried = contact(&exact, 5e-6_f32.into(), load_n.into()).under_carrier(carrier.ripple());
                let table = InverseTable::of_finger(&finger, 5e-6, load_n, &carrier.ripple(), 200.0, f32::INFINITY);
                let table = table.unwrap();
                let knee_n = carried.electric_friction_n(1.0).next_up() as f32;
                let most_n = table.electric_friction_max_n();
                let points = (0..400).map(|step| knee_n * (most_n / knee_n).powf(step as f32 / 399.0));
                for friction_n in points.filter(|friction_n| *friction_n <= most_n && *friction_n > knee_n) {
                    let voltage_v_rms = table.voltage_v_rms(friction_n);
                    assert!(voltage_v_rms <= 200.0);
                    let found_n = carried.electric_friction_n(voltage_v_rms.into());
                    let error = (found_n / f64::from(friction_n) - 1.0).abs();
                    assert!(error < BOUND, "{carrier:?}, {load_n} N, {friction_n} N: {error:.2e}");
                }
            }
        }
    }
}

#[test]
fn zero_volts_and_no_friction_belong_together() {
    for (carrier, _) in carriers() {
        for contact in soft_and_hard_fingers() {
            let carried = contact.under_carrier(carrier.ripple());
            assert_eq!(carried.electric_friction_n(0.0), 0.0);
            for friction_n in [0.0, -1.0, f64::NAN] {
                assert_eq!(carried.voltage_v_rms(friction_n), 0.0);
            }
        }
    }
}

/// The extremes of the parameters that a board takes: a table is refused, or rises to the largest voltage.
#[test]
fn tables_of_extreme_fingers_are_refused_or_rise() {
    let (mut built, mut refused) = (0, 0);
    let lengths = [[1e-4_f32, 1.0], [1e3, 1e14], [1e-3, 100.0], [1e-12, 1e-2], [0.0, 50.0], [1.0, 200.0]];
    for (waveform, corner) in
        [Waveform::Square, Waveform::Sine].into_iter().flat_map(|form| (0..64).map(move |at| (form, at)))
    {
        let mut chosen = lengths.iter().enumerate().map(|(bit, ends)| ends[corner >> bit & 1]);
        let mut next = || chosen.next().unwrap();
        let finger = Finger { radius_m: next(), stiffness_pa_per_m: next(), friction_coefficient: next() };
        let (gap_m, load_n, voltage_max_v_rms) = (next(), next(), next());
        let ripple = carrier(waveform, 20, 20.0).ripple();
        let table = InverseTable::of_finger(&finger, gap_m, load_n, &ripple, voltage_max_v_rms, f32::INFINITY);
        let Ok(table) = table else {
            refused += 1;
            continue;
        };
        built += 1;
        let most_n = table.electric_friction_max_n();
        let voltages = (0..=1000).map(|step| table.voltage_v_rms(most_n * (step as f32 / 1000.0)));
        let mut before_v_rms = 0.0;
        for voltage_v_rms in voltages {
            assert!((before_v_rms..=voltage_max_v_rms).contains(&voltage_v_rms), "{finger:?} {gap_m} {load_n}");
            before_v_rms = voltage_v_rms;
        }
    }
    assert!(built > 0 && refused > 0, "{built} {refused}");
}
