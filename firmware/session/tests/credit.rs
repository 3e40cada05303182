//! Credit: the number of bytes that a host may have in flight, and clients that exceed it (`PROTOCOL.md`, section 9).

use crate::support::{TestBoard, constant_scene, request};
use frixel_control::{Board, Order};
use frixel_wire::fault::State;
use frixel_wire::message::{Command, FromBoard};

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
            Order::SignOfLife => heard = true,
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
fn a_good_frame_after_a_bad_one_beyond_the_credit_is_taken() {
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
fn answers_always_have_room_and_telemetry_is_skipped() {
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
    let answered: Vec<(u16, bool)> =
        board.answers().into_iter().map(|(sequence, outcome)| (sequence, outcome.is_err())).collect();
    assert_eq!(answered, (65_000..65_064).map(|sequence| (sequence, true)).collect::<Vec<_>>());
    board.messages.clear();
    board.ticks(400);
    let telemetry = board.messages.iter().filter(|message| matches!(message, FromBoard::Telemetry(_)));
    assert_eq!(telemetry.count(), 10, "it goes on");
}
