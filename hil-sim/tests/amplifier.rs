//! Realistic amplifiers in the in-process rig: a healthy one never faults, however it decays and is switched. Broken
//! ones are in the tests of `frixel-control`.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use crate::script::{HEADER, Script, constant, scene};
use frixel_control::{AmplifierSpec, Board, ReadyWhileDisabled, SwitchingTime};
use frixel_hil_sim::{AmplifierConfig, Decay, FingerState, RigConfig, Stroke, WorldConfig};
use frixel_layers::{Header, Waveform};
use frixel_testkit::Random;
use frixel_wire::fault::State;
use frixel_wire::hello::BoardLimits;
use frixel_wire::message::Command;

/// The board of `docs/board/hardware.md`, with limits that allow the full voltage at every carrier.
const BOARD: Board = Board {
    limits: BoardLimits {
        full_scale_v_peak: 200.0,
        voltage_max_v_peak: 200.0,
        current_max_a_rms: 1.0,
        current_max_a_peak: 1.0,
        ..Board::SIMULATOR.limits
    },
    amplifier: AmplifierSpec {
        time_constant_s: 8e-6,
        turn_on: SwitchingTime::from_s(1e-3),
        turn_off: SwitchingTime::from_s(1e-3),
        ready_while_disabled: ReadyWhileDisabled::High,
    },
    ..Board::SIMULATOR
};
/// An amplifier that takes as long to switch on as the board allows.
const AMPLIFIER: AmplifierConfig = AmplifierConfig {
    output_time_constant_s: 8e-6,
    electrode_time_constant_s: 36e-6,
    turn_on_s: 1e-3,
    offset_v: 0.5,
    ..AmplifierConfig::IDEAL
};
/// Decays from 200 V to below 8 V, 4 % of full scale, within a millisecond.
const DECAYS: [(f64, Decay); 4] = [
    (0.0, Decay::Linear { v_per_s: 2e5 }),
    (0.0, Decay::Exponential { time_constant_s: 300e-6 }),
    (0.0, Decay::HighImpedance { time_constant_s: 300e-6 }),
    (700e-6, Decay::Exponential { time_constant_s: 80e-6 }),
];

/// Plays a constant on a board with this amplifier.
fn play(amplifier: AmplifierConfig, header: &Header, play: impl FnOnce(&mut Script)) {
    let world = WorldConfig {
        tick_hz: BOARD.tick_hz,
        full_scale_v_peak: f64::from(BOARD.limits.full_scale_v_peak),
        amplifier,
        ..WorldConfig::IDEAL
    };
    let config = RigConfig { board: BOARD, world, ..RigConfig::default() };
    let mut script = Script::new(&config, Stroke::sweep(0.12, 0.08, 3.0).unwrap(), 1);
    script.hello();
    // More friction than any voltage gives.
    script.play(&scene(header, &[constant(1.0)]));
    assert_eq!(script.status().telemetry.state, State::Active);
    play(&mut script);
}

fn header(voltage_v_peak: f32, carrier_hz: f32, waveform: Waveform) -> Header {
    let voltage_max_v_rms =
        voltage_v_peak * if waveform == Waveform::Sine { core::f32::consts::FRAC_1_SQRT_2 } else { 1.0 };
    Header { voltage_max_v_rms, voltage_max_v_peak: voltage_v_peak, carrier_hz, waveform, slew_v_per_s: 1e9, ..HEADER }
}

/// A finger that slides back and forth.
fn place_finger(script: &mut Script) {
    let tick = script.rig.tick() as f64;
    let x_m = 0.06 + 0.03 * libm::sin(tick / 12_000.0);
    script.rig.world_mut().place_finger(FingerState { x_m, y_m: 0.04, speed_m_per_s: 0.1 });
}

/// Lifts, stops, disarms and re-touches at random for `ticks` ticks. A finger is down for long enough that its report
/// arrives, and up for as little as a tick.
fn lift_and_stop(script: &mut Script, random: &mut Random, ticks: u64) {
    let end = script.rig.tick() + ticks;
    while script.rig.tick() < end {
        script.command(Command::Ping);
        for _ in 0..600 + random.below(900) {
            place_finger(script);
            script.step();
        }
        match random.below(4) {
            0 => {
                script.command(Command::Stop);
                for _ in 0..random.below(120) {
                    script.step();
                }
                script.command(Command::Play);
            }
            1 => {
                script.command(Command::Disarm);
                for _ in 0..random.below(120) {
                    script.step();
                }
                script.command(Command::Arm);
                script.command(Command::Play);
            }
            _ => {
                script.rig.world_mut().lift_finger();
                for _ in 0..=random.below(120) {
                    script.step();
                }
            }
        }
        assert_eq!(script.status().fault, None, "tick {}", script.rig.tick());
    }
}

/// Together more than a million ticks.
#[test]
fn a_healthy_amplifier_never_faults_however_often_it_is_switched() {
    let mut random = Random::new(19);
    let mut driven = false;
    for (turn_off_delay_s, decay) in DECAYS {
        for voltage_v_peak in [10.0, 50.0, 100.0, 200.0] {
            for (carrier_hz, waveform) in [
                (5_000.0, Waveform::Square),
                (1_000.0, Waveform::Square),
                (125.0, Waveform::Square),
                (5_000.0, Waveform::Sine),
                (1_000.0, Waveform::Sine),
            ] {
                let amplifier = AmplifierConfig { turn_off_delay_s, decay, ..AMPLIFIER };
                play(amplifier, &header(voltage_v_peak, carrier_hz, waveform), |script| {
                    lift_and_stop(script, &mut random, 13_000);
                    driven |= script.status().telemetry.voltage_v_rms > 100.0;
                });
            }
        }
    }
    assert!(driven, "nothing was driven at high voltage");
}
