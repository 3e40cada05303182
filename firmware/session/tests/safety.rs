//! When the output must be zero (`PROTOCOL.md` sections 10 and 11, "States" and "Time").

mod support;

use frixel_control::{AmplifierSpec, Board, Drive, ReadyWhileDisabled};
use frixel_layers::Header;
use frixel_session::Touch;
use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::{Fault, Flags, State};
use frixel_wire::hello::BoardKind;
use frixel_wire::message::{Command, FromBoard, Refusal};
use support::{HEADER, TestBoard, constant, constant_scene, scene};

const OFF: Drive = Drive { dac_code: DacCode::ZERO, amplifier_enable: false };
/// Host timeout of the scenes here, in ticks.
const HOST_TIMEOUT_TICKS: u32 = 10_000;

fn playing() -> TestBoard {
    let mut board = TestBoard::new();
    board.play(&constant_scene(0.02));
    let driven = board.slide(2000);
    assert!(driven[1000..].iter().all(|drive| drive.dac_code.bits() != 0 && drive.amplifier_enable));
    board
}

#[test]
fn nothing_is_driven_before_a_host_has_armed_and_played() {
    let mut board = TestBoard::new();
    assert!(board.slide(400).iter().all(|drive| *drive == OFF));
    board.hello();
    assert_eq!(board.command(Command::Play), Err(Refusal::NoScene));
    board.load(&constant_scene(0.02)).unwrap();
    assert_eq!(board.command(Command::Play), Err(Refusal::WrongState(State::Disarmed)));
    board.command(Command::Arm).unwrap();
    assert!(board.slide(400).iter().all(|drive| *drive == OFF));
}

#[test]
fn stop_and_disarm_set_the_output_to_zero_at_the_next_tick() {
    for command in [Command::Stop, Command::Disarm] {
        let mut board = playing();
        board.command(command).unwrap();
        assert_eq!(board.tick(), OFF);
    }
}

#[test]
fn a_lifted_finger_ends_the_drive_at_once() {
    let mut board = playing();
    board.touch = Some(Touch::Up);
    assert_eq!(board.tick(), OFF);
    assert!(board.status().telemetry.flags.contains(Flags::NO_FINGER));
    assert_eq!(board.status().telemetry.state, State::Active, "the scene goes on for the next touch");
}

#[test]
fn a_silent_host_disarms_within_its_timeout() {
    let mut board = playing();
    board.command(Command::Ping).unwrap();
    let mut on = 0;
    for i in 0..2 * HOST_TIMEOUT_TICKS {
        if i % 400 == 0 {
            board.touch = Some(Touch::Down { x_m: 0.03 + 0.1 * 25e-6 * i as f32, y_m: 0.03, age_ticks: 0 });
        }
        on += u32::from(board.tick() != OFF);
    }
    assert!((HOST_TIMEOUT_TICKS - 1..=HOST_TIMEOUT_TICKS).contains(&on), "{on}");
    let reported = board.messages.iter().any(|message| {
        matches!(message, FromBoard::StateChanged { state: State::Disarmed, fault: None, flags: Flags::HOST_SILENT })
    });
    assert!(reported, "{:?}", board.messages);
    board.play(&constant_scene(0.02));
    assert!(!board.status().telemetry.flags.contains(Flags::HOST_SILENT));
}

/// A board stays armed only for the client that armed it.
#[test]
fn the_hello_of_a_new_client_disarms_the_board() {
    let mut board = playing();
    assert_eq!(board.hello().state, State::Disarmed);
    assert_eq!(board.tick(), OFF);
    assert_eq!(board.status().telemetry.state, State::Disarmed);

    board.press_switch();
    board.command(Command::Arm).unwrap();
    assert_eq!(board.hello().state, State::Disarmed);
    // The new client may arm.
    board.press_switch();
    board.command(Command::Arm).unwrap();
    board.command(Command::Play).unwrap();
    board.tick();
    assert_eq!(board.status().telemetry.state, State::Active);
}

fn assert_faults(board: &mut TestBoard, fault: Fault, within_ticks: u32) {
    let driven = board.slide(within_ticks + 400);
    assert!(driven[within_ticks as usize..].iter().all(|drive| *drive == OFF), "{fault:?}");
    assert_eq!(board.status().telemetry.state, State::Faulted);
    assert_eq!(board.status().fault.map(|(fault, _)| fault), Some(fault));
    // The host is not silent, so no flag is reported, whatever flags the tick has.
    let changed = FromBoard::StateChanged { state: State::Faulted, fault: Some(fault), flags: Flags(0) };
    assert!(board.messages.contains(&changed), "{:?}", board.messages);
    for command in [Command::Arm, Command::Play, Command::Stop, Command::Disarm] {
        assert_eq!(board.command(command), Err(Refusal::Faulted(fault)));
    }
    assert_eq!(board.hello().last_fault, Some(fault));
}

#[test]
fn an_amplifier_fault_latches() {
    let mut board = playing();
    board.sense.amplifier_fault = true;
    assert_faults(&mut board, Fault::Amplifier, 1);
    board.command(Command::ClearFault).unwrap();
    board.tick();
    assert_eq!(board.status().telemetry.state, State::Faulted, "the cause is still there");
    board.sense.amplifier_fault = false;
    board.command(Command::ClearFault).unwrap();
    board.tick();
    assert_eq!(board.status().telemetry.state, State::Disarmed);
}

#[test]
fn a_released_switch_faults() {
    let mut board = playing();
    board.sense.arm_switch = false;
    assert_faults(&mut board, Fault::ArmSwitch, 0);
    board.command(Command::ClearFault).unwrap();
    assert_eq!(board.command(Command::Arm), Err(Refusal::ArmSwitch));
}

#[test]
fn a_missed_deadline_faults() {
    let mut board = playing();
    board.ticker.raise(Fault::Deadline, 4300);
    board.ticker.raise(Fault::Watchdog, 1);
    assert_faults(&mut board, Fault::Deadline, 0);
    assert_eq!(board.status().fault, Some((Fault::Deadline, 4300)), "the first fault is the one that is reported");
    assert_eq!(board.status().counters.missed_deadlines, 1);
}

#[test]
fn friction_out_of_reach_is_clamped_flagged_and_counted() {
    for electric_friction_n in [0.5, -0.01] {
        let mut board = TestBoard::new();
        board.play(&constant_scene(electric_friction_n));
        let driven = board.slide(1200);
        let status = board.status();
        assert!(status.telemetry.flags.contains(Flags::SATURATED));
        assert_eq!(status.counters.saturated_ticks, 1200, "{:?}", status.counters);
        let voltage_v_rms = status.telemetry.voltage_v_rms;
        let expected = if electric_friction_n > 0.0 { 150.0 } else { 0.0 };
        assert!((voltage_v_rms - expected).abs() < 0.01, "{voltage_v_rms}");
        assert!(driven.iter().all(|drive| i32::from(drive.dac_code.bits()).abs() <= 26_213), "200 V peak");
    }
}

#[test]
fn the_envelope_keeps_its_slew_limit() {
    let mut board = TestBoard::new();
    board.play(&scene(&Header { slew_v_per_s: 2e5, ..HEADER }, &[constant(0.02)]));
    board.touch = Some(Touch::Down { x_m: 0.05, y_m: 0.05, age_ticks: 0 });
    for tick in 1..=20 {
        board.tick();
        let voltage_v_rms = board.status().telemetry.voltage_v_rms;
        assert!((voltage_v_rms - 5.0 * tick as f32).abs() < 1e-3, "2e5 V/s are 5 V a tick: {voltage_v_rms}");
    }
    board.ticks(180);
    assert_eq!(board.status().counters.slewed_ticks, 25);
}

#[test]
fn a_touch_source_that_repeats_one_report_stops_the_output() {
    let mut board = playing();
    for i in 0..4000 {
        if i % 400 == 0 {
            board.command(Command::Ping).unwrap();
            board.touch = Some(Touch::Down { x_m: 0.05, y_m: 0.03, age_ticks: 1000 + i });
        }
        let drive = board.tick();
        assert!(i < 1202 || drive == OFF, "driven {i} ticks after the last news of the finger");
    }
}

#[test]
fn a_touch_report_of_nan_changes_nothing() {
    let mut board = playing();
    board.touch = Some(Touch::Down { x_m: f32::NAN, y_m: f32::INFINITY, age_ticks: 0 });
    assert!(board.tick().dac_code.bits() != 0);
    assert!(board.slide(1200).iter().all(|drive| drive.dac_code.bits() != 0));
}

#[test]
fn a_new_scenes_voltage_limit_holds_from_its_first_tick() {
    let mut board = playing();
    assert!(board.status().telemetry.voltage_v_rms > 100.0);
    let header = Header { voltage_max_v_rms: 20.0, slew_v_per_s: 10.0, ..HEADER };
    board.load(&scene(&header, &[constant(1e-5)])).unwrap();
    board.tick();
    assert!(board.status().telemetry.voltage_v_rms <= 20.0);
}

/// A tick of a finger that slides, and rests from tick 4,000 on.
fn slide_and_rest(board: &mut TestBoard, tick: u32) {
    if tick.is_multiple_of(400) {
        let x_m = 0.03 + 2.5e-6 * tick.min(4_000) as f32;
        board.touch = Some(Touch::Down { x_m, y_m: 0.03, age_ticks: 0 });
        assert!(board.command(Command::Ping).is_ok());
    }
    board.tick();
}

/// The scene is swapped around the tick in which the standstill ramp begins.
#[test]
fn a_new_scenes_voltage_limit_holds_while_the_standstill_ramp_begins() {
    let mut board = playing();
    let still = |board: &TestBoard| board.status().telemetry.flags.contains(Flags::STILL);
    let still_at = (0..20_000).find(|tick| {
        slide_and_rest(&mut board, *tick);
        still(&board)
    });
    let still_at = still_at.unwrap();
    for ticks in still_at - 12..still_at + 4 {
        let mut board = playing();
        (0..ticks).for_each(|tick| slide_and_rest(&mut board, tick));
        assert!(board.status().telemetry.voltage_v_rms > 100.0, "{ticks}");
        let header = Header { voltage_max_v_rms: 20.0, slew_v_per_s: 1e9, ..HEADER };
        board.load(&scene(&header, &[constant(1e-5)])).unwrap();
        for tick in ticks..ticks + 40 {
            slide_and_rest(&mut board, tick);
            assert!(board.status().telemetry.voltage_v_rms <= 20.0, "{ticks}, {tick}");
        }
    }
}

#[test]
fn a_still_finger_is_ramped_down_and_up_again_at_any_report_rate() {
    for period_ticks in (1..=24).chain([40, 400, 667]) {
        let mut board = playing();
        let mut x_m = 0.03;
        let mut slide = |board: &mut TestBoard, step_m: f32| {
            for tick in 0..6_000_u32.max(40 * period_ticks) {
                x_m += step_m;
                if tick.is_multiple_of(period_ticks) {
                    board.touch = Some(Touch::Down { x_m, y_m: 0.03, age_ticks: 0 });
                }
                if tick.is_multiple_of(2_000) {
                    board.command(Command::Ping).unwrap();
                }
                board.tick();
            }
            board.status().telemetry
        };
        let still = slide(&mut board, 0.0);
        assert!(still.flags.contains(Flags::STILL) && still.dac_code == 0, "every {period_ticks}: {still:?}");
        let moving = slide(&mut board, 2.5e-6);
        assert!(!moving.flags.contains(Flags::STILL) && moving.dac_code != 0, "every {period_ticks}: {moving:?}");
    }
}

#[test]
fn a_source_that_reports_at_every_tick_is_followed_as_any_other() {
    for period_ticks in 1..6 {
        let mut board = playing();
        for tick in 0..2_000_u32 {
            if tick.is_multiple_of(period_ticks) {
                let x_m = 0.03 + 0.1 * 25e-6 * tick as f32;
                board.touch = Some(Touch::Down { x_m, y_m: 0.03, age_ticks: 0 });
            }
            board.tick();
        }
        let telemetry = board.status().telemetry;
        assert!((telemetry.finger_x_m - 0.035).abs() < 5e-5, "every {period_ticks}: {telemetry:?}");
        assert_ne!(telemetry.dac_code, 0, "every {period_ticks}");
    }
}

/// A board that a person can touch. Its amplifier takes a millisecond to switch.
const REAL_BOARD: Board = Board {
    kind: BoardKind::NucleoG474re,
    amplifier: AmplifierSpec { time_constant_s: 0.0, ..Board::NUCLEO_G474RE.amplifier },
    ..Board::SIMULATOR
};
/// The switching times in ticks, plus the two ticks after which the monitor shows an edge of the enable.
const SWITCHING_TICKS: u32 = 42;
/// Ticks with a wrong monitor voltage after which the board faults.
const WRONG_TICKS: u32 = 16;

/// The monitor's tolerance at zero and its timing are tested in `frixel-control` (`monitor`).
#[test]
fn an_output_that_is_not_at_zero_after_the_turn_off_time_is_a_fault() {
    for command in [Command::Stop, Command::Disarm] {
        let mut board = TestBoard::of(REAL_BOARD);
        board.play(&constant_scene(0.02));
        board.slide(2000);
        board.command(command).unwrap();
        board.tick();
        board.sense.monitor_v = 30.0;
        board.ticks(SWITCHING_TICKS - 1);
        assert_eq!(board.status().fault, None, "{command:?}");
        board.tick();
        assert_eq!(board.status().fault.map(|(fault, _)| fault), Some(Fault::Monitor), "{command:?}");
    }
}

#[test]
fn a_dead_amplifier_is_a_fault_half_a_millisecond_after_its_turn_on_time() {
    let mut board = TestBoard::of(REAL_BOARD);
    board.play(&constant_scene(0.02));
    board.amplifier_dead = true;
    let ticks = (1..400).find(|_| {
        board.slide(1);
        board.status().telemetry.state == State::Faulted
    });
    assert!(
        ticks.is_some_and(
            |ticks| (SWITCHING_TICKS + WRONG_TICKS - 2..=SWITCHING_TICKS + WRONG_TICKS + 2).contains(&ticks)
        ),
        "{ticks:?}"
    );
}

#[test]
fn an_amplifier_that_is_ready_only_while_enabled_can_be_armed_and_faults_when_it_fails() {
    for ready_while_disabled in [ReadyWhileDisabled::Low, ReadyWhileDisabled::DontCare] {
        let amplifier = AmplifierSpec { ready_while_disabled, ..REAL_BOARD.amplifier };
        let mut board = TestBoard::of(Board { amplifier, ..REAL_BOARD });
        let is_low = ready_while_disabled == ReadyWhileDisabled::Low;
        let stuck = if is_low { (State::Faulted, Some((Fault::Amplifier, 0))) } else { (State::Disarmed, None) };
        // A line that is high as if it were stuck: from the start, and later.
        for _ in 0..2 {
            board.sense.amplifier_fault = false;
            board.ticks(2);
            let status = board.status();
            assert_eq!((status.telemetry.state, status.fault), stuck);
            board.sense.amplifier_fault = true;
            board.ticks(100);
            if is_low {
                board.command(Command::ClearFault).unwrap();
                board.press_switch();
            }
        }
        board.play(&constant_scene(0.02));
        let (mut is_enabled, mut edge_tick) = (false, -40);
        for tick in 0..4_000 {
            if tick == 2_000 {
                board.touch = Some(Touch::Up);
            }
            let drive = if (2_000..3_000).contains(&tick) { board.tick() } else { board.slide(1)[0] };
            if drive.amplifier_enable != is_enabled {
                (is_enabled, edge_tick) = (drive.amplifier_enable, tick);
            }
            // The line follows each edge of the enable a millisecond later.
            board.sense.amplifier_fault = is_enabled == (tick - edge_tick < 40);
            assert_eq!(board.status().telemetry.state, State::Active, "{ready_while_disabled:?}, tick {tick}");
        }
        assert!(edge_tick >= 3_000, "the finger came back");
        board.slide(40);
        board.sense.amplifier_fault = false;
        board.slide(100);
        board.sense.amplifier_fault = true;
        assert_faults(&mut board, Fault::Amplifier, 1);
    }
}
