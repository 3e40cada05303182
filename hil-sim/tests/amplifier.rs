//! Amplifiers as they are, in the in-process rig: healthy ones never fault, and broken ones do in time.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use crate::script::{HEADER, Script, constant, scene};
use frixel_control::{AmplifierSpec, Board, ReadyWhileDisabled, SwitchingTime};
use frixel_hil_sim::{AmplifierConfig, Decay, FingerState, RigConfig, Stroke, WorldConfig};
use frixel_layers::{Header, Waveform};
use frixel_model::{SINGLE_FAULT_CURRENT_MAX_A_PEAK, TOUCH_CURRENT_MAX_A_PEAK, TouchBound};
use frixel_testkit::Random;
use frixel_wire::fault::{Fault, State};
use frixel_wire::hello::BoardLimits;
use frixel_wire::message::Command;

/// The board of `docs/hardware.md`, with limits that allow the full voltage at every carrier.
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
/// Ways to be below 8 V, 4 % of full scale, within a millisecond of 200 V.
const DECAYS: [(f64, Decay); 4] = [
    (0.0, Decay::Linear { v_per_s: 2e5 }),
    (0.0, Decay::Exponential { time_constant_s: 300e-6 }),
    (0.0, Decay::HighImpedance { time_constant_s: 300e-6 }),
    (700e-6, Decay::Exponential { time_constant_s: 80e-6 }),
];
/// Turn-off time, and the two ticks in which an edge of the enable shows.
const TURN_OFF_TICKS: u64 = 42;

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

/// Lifts, stops, disarms and re-touches at random for so many ticks. A finger is down for long enough that its report
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

/// The ticks from the first one without output, after a lift, until the board faults.
fn ticks_from_lift_to_fault(broken: AmplifierConfig, voltage_v_peak: f32) -> Option<u64> {
    let mut ticks = None;
    play(AMPLIFIER, &header(voltage_v_peak, 1_000.0, Waveform::Square), |script| {
        for _ in 0..3_000 {
            place_finger(script);
            script.step();
        }
        assert!(script.status().telemetry.dac_code != 0 && script.status().fault.is_none());
        script.rig.world_mut().set_amplifier(&broken).unwrap();
        script.rig.world_mut().lift_finger();
        while script.status().telemetry.voltage_v_rms > 0.0 {
            script.step();
        }
        let off_tick = script.rig.tick();
        ticks = (0..400).find_map(|_| {
            script.step();
            (script.status().telemetry.state == State::Faulted).then(|| {
                assert_eq!(script.status().fault.map(|(fault, _)| fault), Some(Fault::Monitor));
                script.rig.tick() - off_tick
            })
        });
    });
    ticks
}

#[test]
fn an_output_that_stays_or_is_slow_after_a_lift_faults_when_the_turn_off_time_is_over() {
    for decay in [
        Decay::Linear { v_per_s: 0.0 },
        Decay::Linear { v_per_s: 1.2e4 },
        Decay::Exponential { time_constant_s: 1.5e-3 },
        // 10 MOhm and 0.53 nF.
        Decay::HighImpedance { time_constant_s: 5.3e-3 },
    ] {
        for voltage_v_peak in [20.0, 50.0, 200.0] {
            let ticks = ticks_from_lift_to_fault(AmplifierConfig { decay, ..AMPLIFIER }, voltage_v_peak);
            assert_eq!(ticks, Some(TURN_OFF_TICKS), "{decay:?}, {voltage_v_peak} V");
        }
    }
}

#[test]
fn an_output_that_rises_after_a_lift_faults_within_two_ticks_of_its_rise() {
    for voltage_v_peak in [10.0, 50.0, 100.0] {
        let decay = Decay::Linear { v_per_s: -1e6 };
        let ticks = ticks_from_lift_to_fault(AmplifierConfig { decay, ..AMPLIFIER }, voltage_v_peak);
        // 25 V a tick, of which the monitor shows the first at the second reading.
        assert!(ticks.is_some_and(|ticks| ticks <= 4), "{voltage_v_peak} V: {ticks:?}");
    }
}

#[test]
fn a_monitor_that_dies_and_a_gain_that_changes_fault_within_half_a_millisecond() {
    for (broken, voltage_v_peak) in [
        (AmplifierConfig { monitor_gain: 0.0, ..AMPLIFIER }, 12.0),
        (AmplifierConfig { monitor_gain: 0.0, ..AMPLIFIER }, 200.0),
        (AmplifierConfig { monitor_gain: -1.0, ..AMPLIFIER }, 50.0),
        (AmplifierConfig { gain: 1.5, ..AMPLIFIER }, 100.0),
        (AmplifierConfig { gain: 0.5, ..AMPLIFIER }, 100.0),
    ] {
        play(AMPLIFIER, &header(voltage_v_peak, 1_000.0, Waveform::Square), |script| {
            for _ in 0..3_000 {
                place_finger(script);
                script.step();
            }
            assert_eq!(script.status().fault, None);
            script.rig.world_mut().set_amplifier(&broken).unwrap();
            let ticks = (1..100).find(|_| {
                place_finger(script);
                script.step();
                script.status().telemetry.state == State::Faulted
            });
            assert!(ticks.is_some_and(|ticks| (16..=20).contains(&ticks)), "{broken:?}: {ticks:?}");
        });
    }
}

/// The monitor tolerates a gain that is too high by a quarter. The current of that single fault is below its limit, and
/// so is the one of the few milliseconds in which the gain may be as high as a single tick tolerates.
#[test]
fn a_gain_is_too_high_by_no_more_than_a_single_fault_may_be_before_the_monitor_sees_it() {
    let bound = TouchBound::behind(Board::NUCLEO_G474RE.limits.series_resistance_ohm);
    for carrier_hz in [125.0, 250.0, 1_000.0] {
        let voltage_v_peak = bound.voltage_max_v_peak(carrier_hz);
        // A quarter; and, for 20 ms at most, 4 % of the full scale of 200 V more.
        let tolerated = 1.25;
        let at_first = tolerated + 8.0 / f64::from(voltage_v_peak);
        let [tolerated_a_peak, first_a_peak] = [tolerated, at_first].map(|gain| gain * TOUCH_CURRENT_MAX_A_PEAK);
        println!(
            "{carrier_hz} Hz: {voltage_v_peak:.1} V peak, gain up to {tolerated:.2}: {tolerated_a_peak} A; \
             {at_first:.2} for 20 ms: {first_a_peak} A"
        );
        assert!(first_a_peak < SINGLE_FAULT_CURRENT_MAX_A_PEAK);
        for (gain, is_seen) in [(tolerated - 0.05, false), (tolerated + 0.05, true)] {
            play(AMPLIFIER, &header(voltage_v_peak, carrier_hz, Waveform::Square), |script| {
                for tick in 0..6_000 {
                    if tick == 3_000 {
                        script.rig.world_mut().set_amplifier(&AmplifierConfig { gain, ..AMPLIFIER }).unwrap();
                    }
                    place_finger(script);
                    script.step();
                }
                let fault = script.status().fault.map(|(fault, _)| fault);
                assert_eq!(fault, is_seen.then_some(Fault::Monitor), "{carrier_hz} Hz, gain {gain}");
            });
        }
    }
}
