//! Credit: the number of bytes that a host may have in flight, and clients that exceed it (`PROTOCOL.md`, section 9).

use crate::support;

use frixel_control::{Board, Drive, Order};
use frixel_session::Touch;
use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::State;
use frixel_wire::message::{Command, FromBoard};
use support::{TestBoard, constant_scene, request};

const OFF: Drive = Drive { dac_code: DacCode::ZERO, amplifier_enable: false };
/// Host timeout of the scenes here, in ticks.
const HOST_TIMEOUT_TICKS: u32 = 10_000;
const WINDOW: usize = Board::SIMULATOR.limits.receive_window_bytes as usize;

/// Requests of `command`, `len` bytes in all or a little more.
fn requests(command: Command, len: usize) -> Vec<u8> {
    let frame = request(0, command);
    frame.repeat(len.div_ceil(frame.len()))
}

/// Requests of `command` that fill the window without exceeding it.
fn window_of(command: Command) -> Vec<u8> {
    let frame = request(0, command);
    frame.repeat(WINDOW / frame.len())
}

/// A playing board with no bytes in flight, and a client that stops reading.
fn playing() -> TestBoard {
    let mut board = TestBoard::new();
    board.play(&constant_scene(0.02));
    board.slide(2000);
    board.messages.clear();
    board.reads = false;
    board
}

/// Whether the host was heard, and the number of other orders that these bytes cause.
fn count_orders(board: &mut TestBoard, bytes: &[u8]) -> (bool, usize) {
    board.session.receive(bytes, &board.status());
    let (mut heard, mut others) = (false, 0);
    while let Some(order) = board.session.next_order() {
        match order {
            Order::HostHeard => heard = true,
            _ => others += 1,
        }
    }
    (heard, others)
}

#[test]
fn frames_within_the_window_are_taken_to_the_last_byte() {
    let mut board = playing();
    let window = window_of(Command::Ping);
    let (last, before) = window.split_at(window.len() - 9);
    assert_eq!(count_orders(&mut board, last), (true, 0));
    assert_eq!(count_orders(&mut board, before), (true, 0));
}

#[test]
fn a_frame_beyond_the_credit_is_no_sign_of_life_and_no_order() {
    let mut board = playing();
    count_orders(&mut board, &window_of(Command::Ping));
    let (taken, _) = board.session.frame_counts();
    for command in [Command::Ping, Command::Stop, Command::Disarm, Command::ClearFault] {
        assert_eq!(count_orders(&mut board, &requests(command, 3 * WINDOW)), (false, 0), "{command:?}");
    }
    assert_eq!(board.session.frame_counts().0, taken, "none of them counts as received");
}

#[test]
fn a_frame_beyond_the_credit_is_no_touch() {
    let mut board = TestBoard::of(Board { touch_from_host: true, ..Board::SIMULATOR });
    board.hello();
    board.reads = false;
    assert_eq!(count_orders(&mut board, &window_of(Command::Lift)), (true, 1));
    let touch = Command::Touch { x_m: 0.02, y_m: 0.03, age_ticks: 0 };
    assert_eq!(count_orders(&mut board, &requests(touch, WINDOW)), (false, 0));
}

/// Bytes left behind by a client do not keep a scene playing, however many there are.
#[test]
fn a_client_that_ignores_credit_and_reads_nothing_is_silent_after_its_window() {
    let mut board = playing();
    let flood = requests(Command::Ping, 1 << 20);
    // 5 bytes a tick are 2 Mbaud.
    let mut bytes = flood.chunks(5);
    let window_ticks = WINDOW as u32 / 5;
    let mut last_on = 0;
    for tick in 0..window_ticks + 2 * HOST_TIMEOUT_TICKS {
        if tick % 400 == 0 {
            board.touch = Some(Touch::Down { x_m: 0.03 + 2.5e-6 * tick as f32, y_m: 0.03, age_ticks: 0 });
        }
        board.session.receive(bytes.next().unwrap(), &board.status());
        board.deliver_orders();
        if board.tick() != OFF {
            last_on = tick;
        }
    }
    let expected = window_ticks + HOST_TIMEOUT_TICKS;
    assert!(last_on.abs_diff(expected) <= 2, "on until tick {last_on}, not {expected}");
    assert_eq!(board.status().telemetry.state, State::Disarmed);
}

/// A client that reads again is granted credit again. The frames that it sent beyond its credit stay lost.
#[test]
fn credit_comes_back_when_answers_are_read() {
    let mut board = playing();
    count_orders(&mut board, &requests(Command::Ping, 2 * WINDOW));
    assert_eq!(count_orders(&mut board, &request(1, Command::Ping)), (false, 0));
    board.reads = true;
    board.collect();
    board.messages.clear();
    let before = board.answer(Command::Ping).received_bytes;
    let after = board.answer(Command::Ping).received_bytes;
    assert_eq!((after - before) as usize, request(2, Command::Ping).len());
}

/// Several hello requests may be in flight before the first answer arrives.
#[test]
fn a_hello_request_needs_no_credit_and_sets_it_anew() {
    let mut board = playing();
    count_orders(&mut board, &requests(Command::Ping, 2 * WINDOW));
    board.reads = true;
    assert_eq!(board.hello().state, State::Disarmed);
    board.reads = false;
    assert_eq!(count_orders(&mut board, &window_of(Command::Ping)), (true, 0));
    assert_eq!(count_orders(&mut board, &request(1, Command::Ping)), (false, 0));
}

/// The frame begins beyond the credit, and ends when there is credit again.
#[test]
fn a_frame_that_begins_beyond_the_credit_is_discarded_whole() {
    let mut board = playing();
    count_orders(&mut board, &window_of(Command::Ping));
    let frame = request(1, Command::Ping);
    let (beginning, end) = frame.split_at(frame.len() - 1);
    assert_eq!(count_orders(&mut board, beginning), (false, 0));
    board.reads = true;
    board.collect();
    assert_eq!(count_orders(&mut board, end), (false, 0));
    assert_eq!(count_orders(&mut board, &frame), (true, 0));
}

/// The board discards a bad frame that runs beyond the credit up to its zero byte, and no further.
#[test]
fn a_good_frame_behind_a_bad_one_that_ran_beyond_the_credit_is_taken() {
    let mut board = playing();
    count_orders(&mut board, &window_of(Command::Ping));
    assert_eq!(count_orders(&mut board, &[0x55; 40]), (false, 0));
    assert_eq!(count_orders(&mut board, &[0]), (false, 0));
    board.reads = true;
    board.collect();
    assert_eq!(count_orders(&mut board, &request(1, Command::Ping)), (true, 0));
}

/// The window contains nothing to answer, so no credit is granted for it.
#[test]
fn a_window_without_a_zero_byte_leaves_credit_for_a_hello_request_alone() {
    let mut board = playing();
    board.reads = true;
    assert_eq!(count_orders(&mut board, &[0x55; WINDOW]), (false, 0));
    assert_eq!(count_orders(&mut board, &request(1, Command::Ping)), (false, 0));
    assert_eq!(count_orders(&mut board, &request(2, Command::Ping)), (false, 0));
    board.send(&[0]);
    board.hello();
    assert_eq!(board.answer(Command::Ping).received_bytes as usize, request(1, Command::Ping).len());
}

/// The board counts bytes that noise adds to the line as the host's. It reports the count, so the loss of credit does
/// not accumulate.
#[test]
fn noise_does_not_use_credit_up() {
    let mut board = TestBoard::connected();
    for _ in 0..100 {
        board.send(&[0x55; 400]);
        board.send(&[0]);
        board.command(Command::Ping).unwrap();
    }
    assert!(!board.messages.iter().any(|message| matches!(message, FromBoard::StateChanged { .. })));
}

/// The largest number of outstanding answers, each a refusal with all its numbers, to a host that does not read.
#[cfg(feature = "telemetry")]
#[test]
fn an_answer_always_has_its_place_and_telemetry_is_left_out() {
    let mut board = TestBoard::of(Board { touch_from_host: true, ..Board::SIMULATOR });
    board.hello();
    board.command(Command::Subscribe { period_ticks: 40 }).unwrap();
    board.messages.clear();
    board.reads = false;
    board.ticks(40_000);
    for sequence in 65_000..65_064 {
        board.send(&request(sequence, Command::Touch { x_m: f32::NAN, y_m: 0.0, age_ticks: 0 }));
        board.ticks(400);
    }
    board.reads = true;
    board.collect();
    let answered = board.messages.iter().filter_map(|message| match message {
        FromBoard::Answer(answer) => Some((answer.sequence, answer.outcome.is_err())),
        _ => None,
    });
    assert_eq!(answered.collect::<Vec<_>>(), (65_000..65_064).map(|sequence| (sequence, true)).collect::<Vec<_>>());
    board.messages.clear();
    board.ticks(400);
    let telemetry = board.messages.iter().filter(|message| matches!(message, FromBoard::Telemetry(_)));
    assert_eq!(telemetry.count(), 10, "it goes on");
}
