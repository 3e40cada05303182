//! From touch reports to the drive: lifts, late tracks, and a tick count that wraps.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use crate::support;

use frixel_control::{Board, Drive, Order, Track};
use frixel_layers::{Header, Record, Region};
use frixel_session::Touch;
use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::{Flags, State};
use frixel_wire::frame::{FRAME_MAX_LEN, crc32, encode};
use frixel_wire::hello::BoardLimits;
use frixel_wire::message::Command;
use frixel_wire::payload::chunk_frame;
use frixel_wire::scene::RECORDS_MAX;
use support::{HEADER, TestBoard, constant, constant_scene, request, scene};

const OFF: Drive = Drive { dac_code: DacCode::ZERO, amplifier_enable: false };
const REPORT_TICKS: u32 = 400;
/// 2 ms.
const LIFT_TICKS_MAX: u32 = 80;
/// Four report periods.
const STALE_TICKS: u32 = 4 * REPORT_TICKS;

/// The finger slides at 100 mm/s.
fn report(tick: u32) -> Touch {
    Touch::Down { x_m: 0.01 + 2.5e-6 * tick as f32, y_m: 0.03, age_ticks: 0 }
}

/// A board that plays a constant under a finger, `ticks` after the first report; the next report is due then.
fn playing() -> TestBoard {
    let mut board = TestBoard::of(Board { touch_from_host: true, ..Board::SIMULATOR });
    board.play(&constant_scene(0.02));
    for tick in 0..4 * REPORT_TICKS {
        slide(&mut board, tick);
    }
    assert!(board.status().telemetry.dac_code != 0);
    board
}

/// One tick, with a report every 10 ms.
fn slide(board: &mut TestBoard, tick: u32) -> Drive {
    if tick.is_multiple_of(REPORT_TICKS) {
        board.touch = Some(report(tick));
    }
    board.tick()
}

/// As many records as a scene has.
fn largest_scene() -> Vec<u8> {
    let beside = |number: usize| {
        let region = Region::Rectangle { x_m: 0.0015 * number as f32, y_m: 0.0, width_m: 0.0015, height_m: 0.1 };
        Record { region, ..constant(0.01) }
    };
    scene(&HEADER, &(0..RECORDS_MAX).map(beside).collect::<Vec<_>>())
}

/// Frames that a host may send after a commit without waiting for its answer: requests that depend on the commit,
/// chunks, and a request that cannot be parsed.
fn pipelined() -> Vec<u8> {
    let commands = [
        Command::SetLayer { layer: 0, on: true, gain: 1.0 },
        Command::Subscribe { period_ticks: 400 },
        Command::UploadBitmap { width: 1, height: 1, crc32: 0 },
        Command::EndStream,
        Command::Arm,
        Command::Play,
        Command::ClearFault,
        Command::UploadEnd,
    ];
    let mut bytes: Vec<u8> =
        (1_000..).zip(commands).flat_map(|(sequence, command)| request(sequence, command)).collect();
    let mut frame = [0; FRAME_MAX_LEN];
    bytes.extend(chunk_frame(0, &[1, 2, 3], &mut frame).unwrap());
    // A request without a sequence number.
    bytes.extend(encode(&[2], &mut frame).unwrap());
    bytes
}

/// The finger leaves at each step of the largest commit, and the touch source or the host reports it.
fn lift_during_the_largest_commit(pipelined: &[u8], lift: impl Fn(&mut TestBoard)) {
    let scene = largest_scene();
    let mut lifted_at_poll = 0;
    loop {
        let mut board = playing();
        board.upload_scene(&scene).unwrap();
        let commit = request(999, Command::Commit { crc32: crc32(&scene) });
        board.session.receive(&[&commit, pipelined].concat(), &board.ticker.status());
        for poll in 0..lifted_at_poll {
            assert_ne!(slide(&mut board, 1600 + poll), OFF);
        }
        board.collect();
        let finished = board.take_answer(999).is_some();
        lift(&mut board);
        let ticks_to_off = (1..=LIFT_TICKS_MAX).find(|_| board.tick() == OFF);
        // One for the host's sign of life, one for the scene that may be handed over, one for the lift.
        assert!(
            ticks_to_off.is_some_and(|ticks| ticks <= 3),
            "{lifted_at_poll} polls into the commit: {ticks_to_off:?}"
        );
        if finished {
            break;
        }
        lifted_at_poll += 1;
    }
    assert!(lifted_at_poll > 20, "the largest commit took {lifted_at_poll} steps: each is longer than it may be");
}

fn lift_of_touch_source(board: &mut TestBoard) {
    board.touch = Some(Touch::Up);
}

fn lift_of_host(board: &mut TestBoard) {
    board.session.receive(&request(998, Command::Lift), &board.ticker.status());
}

/// `receive` never carries out a commit, whatever follows it on the line: each poll takes one step.
#[test]
fn a_lift_during_the_largest_commit_acts_within_2_ms() {
    for pipelined in [&[][..], &pipelined()] {
        lift_during_the_largest_commit(pipelined, lift_of_touch_source);
        lift_during_the_largest_commit(pipelined, lift_of_host);
    }
}

#[test]
fn a_lift_and_a_touch_down_in_one_tick_are_zero_output_for_a_tick() {
    let mut board = playing();
    let tick = board.status().telemetry.tick + 1;
    board.session.touch(Touch::Up, tick);
    board.session.touch(report(1_600), tick);
    assert_eq!(board.tick(), OFF);
    assert_ne!(board.tick(), OFF, "the finger is there again");
}

/// A lift that was not reported, but shows in the track's contact number.
#[test]
fn another_contact_is_a_lift_first() {
    let header = Header { slew_v_per_s: 1e5, ..HEADER };
    let mut board = TestBoard::new();
    board.play(&scene(&header, &[constant(0.02)]));
    for tick in 0..1_600 {
        slide(&mut board, tick);
    }
    let before_v_rms = board.status().telemetry.voltage_v_rms;
    let track = next_track(&mut board, report(1_600));
    board.ticker.apply(Order::Track(Track { contact: track.contact.wrapping_add(1), ..track }));
    assert_eq!(board.tick(), OFF);
    assert_ne!(board.tick(), OFF);
    let after_v_rms = board.status().telemetry.voltage_v_rms;
    assert!(before_v_rms > 100.0 && (after_v_rms - 2.5).abs() < 1e-3, "the envelope begins anew: {after_v_rms} V");
}

/// The session's track for a report; the ticker does not receive it.
fn next_track(board: &mut TestBoard, touch: Touch) -> Track {
    board.session.touch(touch, board.ticker.status().telemetry.tick + 1);
    loop {
        match board.session.next_order() {
            Some(Order::Track(track)) => return track,
            Some(_) => {}
            None => panic!("the report has no new data"),
        }
    }
}

#[test]
fn a_track_that_is_handed_over_late_is_the_same_track() {
    for delay_ticks in [0, 1, 7, 80] {
        let mut board = playing();
        let track = next_track(&mut board, report(4 * REPORT_TICKS));
        board.ticks(delay_ticks.max(1));
        board.ticker.apply(Order::Track(track));
        board.ticks(100 - delay_ticks.max(1));
        let x_m = board.status().telemetry.finger_x_m;
        assert!((x_m - (0.01 + 2.5e-6 * 1_700.0)).abs() < 1e-5, "{delay_ticks}: {x_m}");
        // Its end does not move: 100 ticks have passed.
        let on = (0..2 * STALE_TICKS).take_while(|_| board.tick() != OFF).count() as u32;
        assert!((STALE_TICKS - 102..=STALE_TICKS - 99).contains(&on), "{delay_ticks}: {on}");
    }
}

#[test]
fn a_track_that_is_handed_over_after_its_end_drives_nothing() {
    let mut board = playing();
    let track = next_track(&mut board, report(4 * REPORT_TICKS));
    board.ticks(STALE_TICKS + 10);
    board.ticker.apply(Order::Track(track));
    assert!((0..100).all(|_| board.tick() == OFF));
    assert!(board.status().telemetry.flags.contains(Flags::TOUCH_STALE));
}

/// The tick follows a track for at most four report periods, even if its end is later.
#[test]
fn a_track_with_a_late_end_expires_after_four_report_periods() {
    let mut board = playing();
    let track = next_track(&mut board, report(4 * REPORT_TICKS));
    for endless in [track.until_tick + 1_000_000, track.from_tick.wrapping_add(i32::MAX as u32)] {
        board.ticker.apply(Order::Track(Track { until_tick: endless, ..track }));
        let on = (0..2 * STALE_TICKS).take_while(|_| board.tick() != OFF).count() as u32;
        assert!((STALE_TICKS - 2..=STALE_TICKS + 2).contains(&on), "{on}");
    }
}

/// A source that dies in the middle of a stroke, on boards of any report period.
#[test]
fn without_a_report_for_40_ms_no_board_drives() {
    for (period_ms, expected_ms) in
        [(0.0, 0), (1.0, 4), (2.0, 8), (8.0, 32), (10.0, 40), (20.0, 40), (50.0, 40), (1e9, 40), (f32::NAN, 40)]
    {
        let limits = BoardLimits { touch_report_period_s: 1e-3 * period_ms, ..Board::SIMULATOR.limits };
        let mut board = TestBoard::of(Board { touch_from_host: true, limits, ..Board::SIMULATOR });
        board.play(&constant_scene(0.02));
        for tick in 0..=4_000 {
            if tick % 40 == 0 {
                board.touch = Some(report(tick));
            }
            board.tick();
        }
        let on = (1..10_000).take_while(|_| board.tick() != OFF).count() as u32;
        assert!(on.abs_diff(40 * expected_ms) <= 2, "a period of {period_ms} ms: on for {on} ticks");
        assert!((0..10_000).all(|_| board.tick() == OFF));
    }
}

/// The friction falls from the third report period on; a report in between brings it back, without a lift.
#[test]
fn friction_falls_before_touch_data_is_stale() {
    let mut board = playing();
    board.touch = Some(report(4 * REPORT_TICKS));
    let commanded_n = |board: &TestBoard| board.status().telemetry.commanded_electric_friction_n;
    let is_stale = |board: &TestBoard| board.status().telemetry.flags.contains(Flags::TOUCH_STALE);
    board.ticks(3 * REPORT_TICKS);
    assert!((commanded_n(&board) - 0.02).abs() < 1e-6 && !is_stale(&board));
    board.ticks(REPORT_TICKS / 2);
    assert!((commanded_n(&board) - 0.01).abs() < 1e-4 && is_stale(&board), "{}", commanded_n(&board));
    assert!(!board.status().telemetry.flags.contains(Flags::NO_FINGER));
    board.touch = Some(report(7 * REPORT_TICKS + REPORT_TICKS / 2));
    assert!((0..REPORT_TICKS).all(|_| board.tick() != OFF));
    assert!((commanded_n(&board) - 0.02).abs() < 1e-6 && !is_stale(&board));
}

#[test]
fn a_track_that_ended_long_ago_never_comes_back() {
    let mut board = TestBoard::new();
    board.play(&constant_scene(0.02));
    let first_tick = board.status().telemetry.tick;
    for tick in 0..400 {
        slide(&mut board, tick);
    }
    board.ticks(2 * STALE_TICKS);
    assert_eq!(board.tick(), OFF);
    // The tick count wraps to the same value.
    board.ticker.set_tick(first_tick);
    board.command(Command::Ping).unwrap();
    assert!((0..1_000).all(|_| board.tick() == OFF));
    assert_eq!(board.status().telemetry.state, State::Active);
}

/// A board whose tick count wraps in `ticks`.
fn playing_until_wrap(ticks: u32) -> TestBoard {
    let mut board = TestBoard::new();
    board.ticker.set_tick(0_u32.wrapping_sub(ticks));
    board.play(&constant_scene(0.02));
    board
}

#[test]
fn the_finger_is_followed_while_the_tick_count_wraps() {
    for ticks in [10, 390, 399, 401, 1_000] {
        let mut board = playing_until_wrap(ticks);
        for tick in 0..4_000 {
            let drive = slide(&mut board, tick);
            assert_ne!(drive, OFF, "wraps in {ticks}, tick {tick}");
            let expected_m = 0.01 + 2.5e-6 * tick as f32;
            let x_m = board.status().telemetry.finger_x_m;
            assert!(tick < REPORT_TICKS || (x_m - expected_m).abs() < 1e-5, "wraps in {ticks}, tick {tick}: {x_m}");
        }
        assert!(board.status().telemetry.tick < 4_000, "it has wrapped");
    }
}

#[test]
fn lost_reports_and_a_silent_host_end_the_drive_while_the_tick_count_wraps() {
    for ticks in [1, 500, 1_199, 1_200, 1_599, 1_600, 1_601] {
        let mut board = playing_until_wrap(ticks);
        board.touch = Some(report(0));
        let on = (0..2 * STALE_TICKS).take_while(|_| board.tick() != OFF).count() as u32;
        assert!((STALE_TICKS - 1..=STALE_TICKS + 1).contains(&on), "wraps in {ticks}: on for {on}");
    }
    for ticks in [5, 5_000, 9_999, 10_001] {
        let mut board = playing_until_wrap(ticks);
        let on = (0..20_000).take_while(|tick| slide(&mut board, *tick) != OFF).count();
        assert!((9_998..=10_001).contains(&on), "wraps in {ticks}: on for {on}");
        assert!(board.status().telemetry.flags.contains(Flags::HOST_SILENT));
    }
}

#[test]
fn a_still_finger_is_ramped_down_while_the_tick_count_wraps() {
    for ticks in [100, 2_100, 2_300, 2_500] {
        let mut board = playing_until_wrap(ticks);
        let mut volts = Vec::new();
        for tick in 0..4_000_u32 {
            if tick.is_multiple_of(REPORT_TICKS) {
                board.touch = Some(Touch::Down { x_m: 0.05, y_m: 0.03, age_ticks: 0 });
            }
            board.tick();
            volts.push(board.status().telemetry.voltage_v_rms);
        }
        assert!(volts[1_990] > 100.0, "slow for less than 50 ms");
        assert!(volts[2_410] <= 0.0, "wraps in {ticks}: {} V 10 ms later", volts[2_410]);
        // Downward only, and without a jump.
        assert!(volts[2_000..2_380].windows(2).all(|pair| pair[1] <= pair[0] && pair[0] - pair[1] < 2.0), "{ticks}");
    }
}
