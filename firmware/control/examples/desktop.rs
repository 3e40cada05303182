//! Fills the coefficients of a tick from a finger on a coating and a scene of one layer, and runs the tick on the
//! desktop, like firmware with a built-in scene.
//!
//! `cargo run -p frixel-control --example desktop` runs it, and so does `cargo test`.

use std::error::Error;

use frixel_control::{Active, Board, CarrierTiming, Order, Sense, StandstillRamp, Ticker, Track};
use frixel_layers::{BitmapPool, Blend, Constant, Header, Layer, Record, Region};
use frixel_model::{Contact, Finger, InverseTable};
use frixel_testkit::{HEADER, IdealMonitor};

const FINGER: Finger<f32> = Finger::<f32>::EXAMPLE;
const GAP_M: f32 = 1e-5;
const LOAD_N: f32 = 0.5;
/// Electric friction of the only layer, N.
const TARGET_N: f32 = 0.02;
/// 20 ms, of which the carrier of 1 kHz takes 20 periods.
const TICKS: u32 = 800;

/// The coefficients of a scene: its carrier, its limits, the table of its finger, and its layers.
fn coefficients(board: &Board, scene: &Header, records: &[Record]) -> Result<Active, Box<dyn Error>> {
    let carrier = scene.carrier(&board.limits, board.tick_hz);
    let codes_per_v_rms = carrier.peak_per_rms() * f32::from(i16::MAX) / board.limits.full_scale_v_peak;
    let code_max = board.ceilings().code(scene.voltage_max_v_peak);
    let mut active = Active::new();
    active.carrier = CarrierTiming::new(scene.waveform, carrier.half_period_ticks, codes_per_v_rms, code_max);
    active.voltage_max_v_rms = scene.voltage_max_v_rms.min(scene.voltage_max_v_peak / carrier.peak_per_rms());
    active.slew_step_v = scene.slew_v_per_s * board.tick_period_s();
    active.host_timeout_ticks = board.ticks(scene.host_timeout_s);
    let max_v_rms = active.voltage_max_v_rms;
    active.table = InverseTable::of_finger(&FINGER, GAP_M, LOAD_N, &carrier.ripple(), max_v_rms, f32::INFINITY)?;
    active.layers.begin(scene, std::iter::empty());
    for record in records {
        active.layers.push(record, board.tick_hz, &|_| None)?;
    }
    Ok(active)
}

fn main() -> Result<(), Box<dyn Error>> {
    let board = Board::SIMULATOR;
    let layer = Layer::Constant(Constant { electric_friction_n: TARGET_N });
    let plate = Record { region: Region::Screen, blend: Blend::Replace, gain: 1.0, layer };
    let (mut active, pool) = (coefficients(&board, &HEADER, &[plate])?, BitmapPool::new());
    let mut ticker = Ticker::new(&board, &pool, &mut active);
    // The arm switch is released, and then held.
    ticker.tick(&Sense::default());
    for order in [Order::Arm, Order::Play, Order::Track(track())] {
        ticker.apply(order);
    }
    let time_constant_ticks = board.amplifier.time_constant_s / board.tick_period_s();
    let mut amplifier = IdealMonitor::new(board.limits.full_scale_v_peak, time_constant_ticks);
    let mut codes = Vec::new();
    for _ in 0..TICKS {
        let drive = ticker.tick(&Sense { arm_switch: true, monitor_v: amplifier.voltage_v(), ..Sense::default() });
        amplifier.follow(drive.dac_code);
        codes.push(drive.dac_code.bits());
    }
    let telemetry = ticker.status().telemetry;
    let Finger { radius_m, stiffness_pa_per_m, friction_coefficient } = FINGER;
    let finger = Finger::<f64> {
        radius_m: radius_m.into(),
        stiffness_pa_per_m: stiffness_pa_per_m.into(),
        friction_coefficient: friction_coefficient.into(),
    };
    let carrier = HEADER.carrier(&board.limits, board.tick_hz);
    let contact = Contact::new(&finger, GAP_M.into())?.under_load(LOAD_N.into())?.under_carrier(carrier.ripple());
    let felt_n = contact.electric_friction_n(telemetry.voltage_v_rms.into());
    println!("{} V rms for {TARGET_N} N: the finger feels {felt_n:.6} N", telemetry.voltage_v_rms);
    assert!((felt_n / f64::from(TARGET_N) - 1.0).abs() < f64::from(InverseTable::RELATIVE_ERROR), "{felt_n} N");
    assert!(codes.iter().any(|code| *code > 0) && codes.iter().any(|code| *code < 0), "the carrier alternates");
    Ok(())
}

/// A finger that slides to the right. The track lasts longer than the example, since friction falls before its end.
fn track() -> Track {
    Track {
        contact: 1,
        from_tick: 0,
        until_tick: 2 * TICKS,
        place_m: [0.05; 2],
        path_velocity_m_per_s: [0.1, 0.0],
        path_half_acceleration_m_per_s2: [0.0; 2],
        velocity_m_per_s: [0.1, 0.0],
        half_acceleration_m_per_s2: [0.0; 2],
        ramp: StandstillRamp::MOVING,
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_tick_drives_the_friction_of_the_layer() {
        super::main().unwrap();
    }
}
