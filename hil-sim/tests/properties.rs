//! Invariants of every tick of the in-process rig, for any host, line damage and world faults: a million ticks each,
//! and more in `cargo xtask soak faults`.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::cell::RefCell;
use std::rc::Rc;

use crate::script::{HEADER, Script, constant, scene};
use frixel_hil_sim::{BoardMemory, NoiseConfig, Point, RigConfig, RigTick, Status, Stroke, TouchConfig, WorldFault};
use frixel_layers::{Header, Waveform};
use frixel_testkit::Random;
use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::{Fault, State};
use frixel_wire::message::Command;

const TICKS: u64 = 1_000_000;
const SOAK_TICKS: u64 = 40_000_000;
const TICK_HZ: f32 = 40_000.0;
const PEAK_V: f32 = 120.0;
const SLEW_V_PER_S: f32 = 2e5;
const HOST_TIMEOUT_TICKS: u64 = 10_000;
/// Time to act, in ticks: a millisecond.
const TO_ACT_TICKS: u64 = 40;
/// Half a period of the slowest carrier here, 500 Hz.
const HALF_PERIOD_TICKS: i64 = 40;
/// Most resets of one run: the memory of each is lost.
const RESETS_MAX: u32 = 200;

/// Scenes with the same limits.
fn some_scene(random: &mut Random) -> Vec<u8> {
    let waveform = random.pick([Waveform::Square, Waveform::Sine]);
    scene_of(waveform, random)
}

fn scene_of(waveform: Waveform, random: &mut Random) -> Vec<u8> {
    let carrier_hz = random.pick([500.0, 1_000.0, 4_000.0]);
    let voltage_max_v_rms = if waveform == Waveform::Sine { PEAK_V * core::f32::consts::FRAC_1_SQRT_2 } else { PEAK_V };
    let header = Header {
        waveform,
        carrier_hz,
        voltage_max_v_rms: voltage_max_v_rms * 0.99,
        voltage_max_v_peak: PEAK_V,
        slew_v_per_s: SLEW_V_PER_S,
        host_timeout_s: HOST_TIMEOUT_TICKS as f32 / TICK_HZ,
        ..HEADER
    };
    scene(&header, &[constant(random.pick([0.002, 0.01, 0.03]))])
}

/// Checks the invariants at each tick.
#[derive(Default)]
struct Monitor {
    ticks: u64,
    driven_ticks: u64,
    /// Ticks in each state.
    states: [u64; 4],
    last_v_rms: f32,
    /// Sum of all codes that went out.
    integral: i64,
    arrived: u64,
    silent_ticks: u64,
}

impl Monitor {
    fn see(&mut self, record: &RigTick<Status>, arrived: u64) {
        let telemetry = &record.status.telemetry;
        let code = record.drive.dac_code.bits();
        let state = telemetry.state;
        self.ticks += 1;
        self.driven_ticks += u64::from(code != 0);
        self.states[usize::from(state.number())] += 1;
        let at = record.tick;
        let is_off = code == 0 && !record.drive.amplifier_enable;
        assert!(state == State::Active || is_off, "tick {at}: {state:?} with {:?}", record.drive);

        let full_scale_v = RigConfig::default().board.limits.full_scale_v_peak;
        let code_max = (f64::from(PEAK_V / full_scale_v) * 32_767.0).ceil() as i64;
        assert!(i64::from(code).abs() <= code_max, "tick {at}: code {code} of {code_max}");
        let rise_v = telemetry.voltage_v_rms - self.last_v_rms;
        assert!(rise_v <= SLEW_V_PER_S / TICK_HZ + 1e-3, "tick {at}: the envelope rose by {rise_v} V");
        self.last_v_rms = telemetry.voltage_v_rms;
        self.integral += i64::from(code);
        let most = HALF_PERIOD_TICKS * code_max;
        assert!(self.integral.abs() <= most, "tick {at}: the integral is {} of {most}", self.integral);

        self.silent_ticks = if arrived > self.arrived { 0 } else { self.silent_ticks + 1 };
        self.arrived = arrived;
        let is_in_time = self.silent_ticks <= HOST_TIMEOUT_TICKS + TO_ACT_TICKS;
        assert!(is_in_time || is_off, "tick {at}: driven {} ticks after the last byte", self.silent_ticks);
    }
}

fn watched(seed: u64) -> (Script, Rc<RefCell<Monitor>>) {
    let mut config = RigConfig::default();
    config.world.touch = TouchConfig::IDEAL;
    let left = Point { x_m: 0.01, y_m: 0.04 };
    let right = Point { x_m: 0.11, y_m: 0.04 };
    let stroke = Stroke::constant_speed(left, right, 0.05).unwrap().looped(0.1).unwrap();
    let mut script = Script::new(&config, stroke, seed);
    let monitor = Rc::new(RefCell::new(Monitor::default()));
    let watching = Rc::clone(&monitor);
    script.watch = Some(Box::new(move |record, arrived| watching.borrow_mut().see(record, arrived)));
    (script, monitor)
}

/// A fault of the world that lasts for a while.
fn some_fault(random: &mut Random) -> WorldFault {
    random.pick([
        WorldFault::AmplifierNotReady,
        WorldFault::AmplifierStuckOn,
        WorldFault::AmplifierGain(0.5),
        WorldFault::AmplifierSlowOff { delay_s: 2e-3 },
        WorldFault::MonitorGain(0.0),
        WorldFault::DacStuck(DacCode::from_bits(9_000)),
        WorldFault::SwitchOpen,
        WorldFault::TouchSilent,
        WorldFault::TouchStuck,
        WorldFault::TouchJumps { by_m: 0.03 },
        WorldFault::FingerLifted,
    ])
}

fn some_command(random: &mut Random) -> Command {
    let gain = random.pick([0.0, 0.3, 1.0, 100.0, -5.0]);
    random.pick([
        Command::Ping,
        Command::Ping,
        Command::Arm,
        Command::Play,
        Command::Stop,
        Command::Disarm,
        Command::ClearFault,
        Command::SetLayer { layer: 0, on: true, gain },
        Command::Subscribe { period_ticks: 40 },
        Command::UploadEnd,
    ])
}

/// A random host on a line with random damage, in a world with random faults.
fn anything(ticks: u64, seed: u64) -> Rc<RefCell<Monitor>> {
    let mut random = Random::new(seed);
    let (mut script, monitor) = watched(seed);
    let mut resets = 0;
    while script.rig.tick() < ticks {
        match random.below(12) {
            0..=3 => {
                script.send(Command::ClearFault);
                script.play(&some_scene(&mut random));
            }
            4 => {
                // Another scene in place of the one that plays.
                let commit = script.upload(&some_scene(&mut random));
                script.command(commit);
            }
            5 => {
                let noise: Vec<u8> = (0..random.below(60)).map(|_| random.byte()).collect();
                script.rig.send(&noise);
            }
            6 => {
                let [bit_error_rate, lost_share] = [0; 2].map(|_| random.pick([0.0, 0.0, 0.0, 1e-3]));
                script.noise.set(NoiseConfig { bit_error_rate, lost_share, ..NoiseConfig::default() }).unwrap();
            }
            7 => {
                let (now, lasts) = (script.rig.tick(), u64::from(random.below(3_000)));
                script.rig.world_mut().schedule_fault(now..now + lasts, some_fault(&mut random)).unwrap();
            }
            8 if resets < RESETS_MAX && random.below(5) == 0 => {
                resets += 1;
                script.rig.reset(Box::leak(BoardMemory::new()));
                // The board begins anew, and the electrode has discharged before it drives again.
                monitor.borrow_mut().integral = 0;
            }
            9 => script.rig.raise(Fault::Deadline, 4_300),
            _ => script.send(some_command(&mut random)),
        }
        // Often with pings, and now and then in silence.
        let waits = random.pick([20, 400, 2_000, 4_000, 12_000]);
        if random.below(4) > 0 { script.run(waits) } else { script.steps(waits) }
    }
    monitor
}

fn check_anything(ticks: u64, seed: u64) {
    let monitor = anything(ticks, seed);
    let monitor = monitor.borrow();
    assert!(monitor.ticks >= ticks);
    // A board that is never, or always, in a state would prove nothing.
    assert!(monitor.states.iter().all(|ticks_in| ticks_in * 200 > ticks), "{:?}", monitor.states);
    assert!(monitor.driven_ticks * 20 > ticks, "{} ticks were driven", monitor.driven_ticks);
}

#[test]
fn the_output_is_zero_but_for_active_within_its_limits_and_without_direct_voltage_whatever_happens() {
    check_anything(TICKS, 3);
}

#[test]
#[ignore = "minutes: cargo xtask soak faults"]
fn whatever_happens_for_longer() {
    for seed in 0..4 {
        check_anything(SOAK_TICKS / 4, seed);
    }
}

/// How a hard fault is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FoundBy {
    /// By a pin or a counter, in the tick in which it is read.
    Pin,
    /// By a monitor that is wrong in every tick.
    Monitor,
    /// By a monitor that is wrong in half of the ticks.
    HalfOfTicks,
}

/// Largest number of ticks, of many trials, from a hard fault of one kind to the end of the tick that outputs zero.
fn ticks_to_off(found_by: FoundBy, ticks: u64, seed: u64) -> u64 {
    let mut random = Random::new(seed);
    let (mut script, monitor) = watched(seed);
    let full_scale_v_peak = RigConfig::default().board.limits.full_scale_v_peak;
    let (mut most, mut faults) = (0, 0);
    while script.rig.tick() < ticks {
        script.send(Command::ClearFault);
        script.play(&scene_of(Waveform::Square, &mut random));
        script.run(1_000 + u64::from(random.below(400)));
        // A voltage at which the monitor's tolerance of 4 % of full scale is exceeded. Of the envelope, only a
        // sixteenth is driven while volt-seconds of a slower carrier are taken back.
        let record = script.step();
        let code = record.drive.dac_code;
        if full_scale_v_peak * f32::from(code.bits().unsigned_abs()) < 30.0 * f32::from(i16::MAX) {
            continue;
        }
        let now = script.rig.tick();
        let fault = match found_by {
            FoundBy::Pin => random.pick([WorldFault::AmplifierNotReady, WorldFault::SwitchOpen]),
            FoundBy::Monitor => random.pick([WorldFault::MonitorGain(0.0), WorldFault::AmplifierGain(0.3)]),
            FoundBy::HalfOfTicks => WorldFault::DacStuck(code),
        };
        if found_by == FoundBy::Pin && random.below(3) == 0 {
            script.rig.raise(Fault::Deadline, 4_300);
        } else {
            script.rig.world_mut().schedule_fault(now..now + 400, fault).unwrap();
        }
        faults += 1;
        let off = (1..=400).find(|_| {
            let record = script.step();
            record.drive.dac_code.bits() == 0 && !record.drive.amplifier_enable
        });
        most = most.max(off.unwrap_or(400));
        script.run(500);
    }
    assert!(faults * 20_000 > ticks && monitor.borrow().ticks >= ticks, "{faults} faults");
    most
}

fn check_time_to_off(found_by: FoundBy, ticks: u64, seed: u64) {
    let expected = match found_by {
        // The second low sample of the ready line is the fault.
        FoundBy::Pin => 2..=2,
        FoundBy::Monitor => 16..=20,
        FoundBy::HalfOfTicks => 40..=60,
    };
    let most = ticks_to_off(found_by, ticks, seed);
    println!("at most {most} ticks of 25 us from a fault until the output is off: {found_by:?}");
    assert!(expected.contains(&most), "{most} ticks: {found_by:?}");
}

#[test]
fn the_output_is_off_within_0_5_ms_of_a_hard_fault_and_1_5_ms_of_a_dac_that_holds_its_code() {
    for found_by in [FoundBy::Pin, FoundBy::Monitor, FoundBy::HalfOfTicks] {
        check_time_to_off(found_by, TICKS, 5);
    }
}

/// Tests of their own, so that they run side by side.
#[test]
#[ignore = "minutes: cargo xtask soak faults"]
fn the_output_is_off_within_two_ticks_of_many_faults_at_a_pin() {
    check_time_to_off(FoundBy::Pin, SOAK_TICKS, 6);
}

#[test]
#[ignore = "minutes: cargo xtask soak faults"]
fn the_output_is_off_within_0_5_ms_of_many_faults_that_the_monitor_finds() {
    check_time_to_off(FoundBy::Monitor, SOAK_TICKS, 6);
}

#[test]
#[ignore = "minutes: cargo xtask soak faults"]
fn the_output_is_off_within_1_5_ms_of_a_dac_that_holds_many_codes() {
    check_time_to_off(FoundBy::HalfOfTicks, SOAK_TICKS, 6);
}

/// The condition for Active that a random host does not meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Without {
    /// Nothing.
    Nothing,
    /// The switch is welded: it has no edge.
    SwitchEdge,
    /// The host never sends the command to arm.
    ArmCommand,
}

/// Sends messages of every kind at random for `ticks` ticks. Returns the number of ticks in Active, and of driven
/// ticks.
fn host_at_random(ticks: u64, seed: u64, without: Without) -> (u64, u64) {
    let mut random = Random::new(seed);
    let (mut script, monitor) = watched(seed);
    if without == Without::SwitchEdge {
        script.rig.world_mut().schedule_fault(0..u64::MAX, WorldFault::SwitchWelded).unwrap();
    }
    script.rig.world_mut().start_stroke();
    while script.rig.tick() < ticks {
        match random.below(8) {
            0 => {
                let commit = script.upload(&some_scene(&mut random));
                script.command(commit);
            }
            1 => {
                let noise: Vec<u8> = (0..random.below(300)).map(|_| random.byte()).collect();
                script.rig.send(&noise);
            }
            2 => script.hello(),
            _ => {
                let command = some_command(&mut random);
                if without != Without::ArmCommand || command != Command::Arm {
                    script.send(command);
                }
            }
        }
        script.steps(random.below(300).into());
    }
    let monitor = monitor.borrow();
    (monitor.states[usize::from(State::Active.number())], monitor.driven_ticks)
}

/// Asserts that a random host never drives without this condition. As a control, a tenth of the ticks with it must
/// drive.
fn check_never_active(ticks: u64, seed: u64, without: Without) {
    let (active_ticks, driven_ticks) = host_at_random(ticks / 10, seed, Without::Nothing);
    assert!(active_ticks > 0 && driven_ticks > 0, "{active_ticks} ticks in Active, {driven_ticks} driven");
    assert_eq!(host_at_random(ticks, seed, without), (0, 0), "{without:?}");
}

#[test]
fn no_bytes_reach_active_without_an_edge_of_the_arm_switch() {
    check_never_active(TICKS, 7, Without::SwitchEdge);
}

#[test]
fn no_bytes_reach_active_without_the_command_to_arm() {
    check_never_active(TICKS, 8, Without::ArmCommand);
}

#[test]
#[ignore = "minutes: cargo xtask soak faults"]
fn no_bytes_reach_active_for_longer() {
    check_never_active(SOAK_TICKS / 4, 9, Without::SwitchEdge);
    check_never_active(SOAK_TICKS / 4, 10, Without::ArmCommand);
}
