//! Recordings of the simulator's people, with every effect of its plant.

use frixel_control::Drive;
use frixel_hil_sim::{FingerState, FingertipConfig, Person, Point, Stroke, World, WorldConfig, WorldOptions};
use frixel_lab::fit::Row;
use frixel_model::{Contact, Finger};
use frixel_wire::dac_code::DacCode;

use super::person::{Protocol, Random};

/// Coating of the example screen, as an effective gap in metres.
pub(super) const COATING_GAP_M: f64 = 1e-6 / 3.9;
/// Two half-periods of a carrier of 1 kHz a millisecond.
const TICK_HZ: u32 = 8_000;
const HALF_PERIOD_TICKS: u32 = 4;
const TICKS_PER_ROW: u32 = 8;
const FULL_SCALE_V_PEAK: f64 = 200.0;

fn config(fingertip: FingertipConfig) -> WorldConfig {
    let realistic = WorldConfig::IDEAL.with(&WorldOptions::default());
    WorldConfig { tick_hz: TICK_HZ, full_scale_v_peak: FULL_SCALE_V_PEAK, fingertip, ..realistic }
}

fn drive(tick: u32, voltage_v_rms: f64) -> Drive {
    let sign = if (tick / HALF_PERIOD_TICKS).is_multiple_of(2) { 1.0 } else { -1.0 };
    let code = (sign * voltage_v_rms / FULL_SCALE_V_PEAK * 32_767.0).round() as i16;
    Drive { dac_code: DacCode::from_bits(code), amplifier_enable: true }
}

/// A world that nothing moves but the caller.
fn world(person: &Person, fingertip: FingertipConfig, load_n: f64, seed: u64) -> World {
    let place = Point { x_m: 0.01, y_m: 0.03 };
    // The plant's friction coefficient at a load, put into the contact whose own load that is.
    let gain = (load_n / person.normal_load_n).powf(person.fingertip.load_exponent);
    let finger = Finger { friction_coefficient: gain * person.finger.friction_coefficient, ..person.finger };
    let contact = Contact::new(&finger, person.skin_gap_m + COATING_GAP_M).unwrap();
    let own_finger = Some(contact.under_load(load_n).unwrap().into());
    let config = WorldConfig { own_finger, ..config(fingertip) };
    World::new(config, Stroke::still(place, 1.0).unwrap(), seed).unwrap()
}

/// The strokes of a protocol by a person, and the force sensor's rows: means over a millisecond, and 1 mN of noise.
pub(super) fn record(person: &Person, protocol: &Protocol, seed: u64) -> Vec<Row> {
    let mut random = Random::new(seed);
    let (mut rows, mut time_s) = (Vec::new(), 0.0);
    for stroke in 0..protocol.strokes {
        let voltage_v_rms = protocol.voltages_v_rms[stroke % protocol.voltages_v_rms.len()];
        let load_n = person.normal_load_n * (1.0 + 0.03 * random.gaussian());
        let mut world = world(person, person.fingertip, load_n, seed.wrapping_mul(1000) + stroke as u64);
        let row_count = (protocol.stroke_s * 1e3) as u32;
        let (mut is_on, mut left_ms) = (false, 0.0);
        for row in 0..row_count {
            if left_ms <= 0.0 {
                is_on = !is_on;
                left_ms = random.between(20.0, 30.0);
            }
            left_ms -= 1.0;
            let voltage = if is_on { voltage_v_rms } else { 0.0 };
            let (mut friction_n, mut load_n, mut speed_m_per_s) = (0.0, 0.0, 0.0);
            for tick in row * TICKS_PER_ROW..(row + 1) * TICKS_PER_ROW {
                let part = f64::from(tick) / f64::from(row_count * TICKS_PER_ROW);
                // Minimum jerk.
                let way = part.powi(3) * (10.0 - 15.0 * part + 6.0 * part * part);
                speed_m_per_s = 1e-3 * protocol.length_mm / protocol.stroke_s * 30.0 * (part * (1.0 - part)).powi(2);
                let x_m = 0.01 + 1e-3 * protocol.length_mm * way;
                world.place_finger(FingerState { x_m, y_m: 0.03, speed_m_per_s });
                let felt = world.apply(drive(tick, voltage));
                friction_n += felt.friction_n / f64::from(TICKS_PER_ROW);
                load_n += felt.normal_load_n / f64::from(TICKS_PER_ROW);
            }
            rows.push(Row {
                number: rows.len() as u64 + 2,
                voltage_v_rms: voltage,
                normal_force_n: load_n + 1e-3 * random.gaussian(),
                friction_n: friction_n + 1e-3 * random.gaussian(),
                time_s: Some(time_s),
                stroke: Some((stroke + 1).to_string()),
                speed_mm_s: Some(1e3 * speed_m_per_s),
                is_simulated: false,
            });
            time_s += 1e-3;
        }
        time_s += 0.2;
    }
    rows
}

/// What a finger does while it slides steadily.
pub(super) struct Steady {
    pub(super) friction_coefficient: f64,
    pub(super) electric_friction_n: f64,
    /// Voltage on the electrode, behind the amplifier.
    #[allow(dead_code, reason = "the test of the command reads it")]
    pub(super) electrode_v_rms: f64,
}

/// What the person's finger does in full slip under a load that stays, without noise, at a drive.
pub(super) fn steady(person: &Person, load_n: f64, drive_v_rms: f64) -> Steady {
    let fingertip = FingertipConfig { load_sd_n: 0.0, noise_rms_n: 0.0, ..person.fingertip };
    let mut world = world(person, fingertip, load_n, 1);
    let (mut natural_n, mut electric_n, mut square_v2, mut count) = (0.0, 0.0, 0.0, 0.0);
    for tick in 0..TICK_HZ {
        let x_m = 0.01 + 0.06 * f64::from(tick) / f64::from(TICK_HZ);
        world.place_finger(FingerState { x_m, y_m: 0.03, speed_m_per_s: 0.06 });
        let felt = world.apply(drive(tick, drive_v_rms));
        if tick >= TICK_HZ / 2 {
            natural_n += felt.natural_friction_n;
            electric_n += felt.electric_friction_n;
            square_v2 += felt.mean_square_v2;
            count += 1.0;
        }
    }
    Steady {
        friction_coefficient: natural_n / count / load_n,
        electric_friction_n: electric_n / count,
        electrode_v_rms: (square_v2 / count).sqrt(),
    }
}

/// The person's friction coefficient, and what a drive of 150 V rms adds to its friction, in newtons.
pub(super) fn truth(person: &Person, load_n: f64) -> (f64, f64) {
    let steady = steady(person, load_n, 150.0);
    (steady.friction_coefficient, steady.electric_friction_n)
}
