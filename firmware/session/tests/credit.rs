//! What a host may have under way, and what becomes of a client that sends more (`PROTOCOL.md`, section 9).

mod support;

use frixel_control::{Board, Drive, Order};
use frixel_session::Touch;
use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::State;
use frixel_wire::message::{Command, FromBoard};
use support::{Desk, Memory, constant, request};

const OFF: Drive = Drive { dac_code: DacCode::ZERO, amplifier_enable: false };
/// Host timeout of the scenes here, in ticks.
const HOST_TIMEOUT_TICKS: u32 = 10_000;
const WINDOW: usize = Board::SIMULATOR.limits.receive_window_bytes as usize;

/// Requests of `command`, `len` bytes in all or a little more.
fn requests(command: Command, len: usize) -> Vec<u8> {
    let frame = request(0, command);
    frame.repeat(len.div_ceil(frame.len()))
}

/// Requests of `command` that fill the window, and fit into it.
fn window_of(command: Command) -> Vec<u8> {
    let frame = request(0, command);
    frame.repeat(WINDOW / frame.len())
}

/// A board that plays, without anything under way, for a client that from now on reads nothing.
fn playing(memory: &mut Memory) -> Desk<'_> {
    let mut desk = Desk::new(memory);
    desk.play(&constant(0.02));
    desk.slide(2000);
    desk.messages.clear();
    desk.reads = false;
    desk
}

/// Whether the host was heard, and the other orders that bytes lead to.
fn orders(desk: &mut Desk, bytes: &[u8]) -> (bool, usize) {
    desk.session.receive(bytes, &desk.status());
    let (mut heard, mut others) = (false, 0);
    while let Some(order) = desk.session.next_order() {
        match order {
            Order::HostHeard => heard = true,
            _ => others += 1,
        }
    }
    (heard, others)
}

#[test]
fn frames_within_the_window_are_taken_to_the_last_byte() {
    let mut memory = Memory::new();
    let mut desk = playing(&mut memory);
    let window = window_of(Command::Ping);
    let (last, before) = window.split_at(window.len() - 9);
    assert_eq!(orders(&mut desk, last), (true, 0));
    assert_eq!(orders(&mut desk, before), (true, 0));
}

#[test]
fn a_frame_beyond_the_credit_is_no_sign_of_life_and_no_order() {
    let mut memory = Memory::new();
    let mut desk = playing(&mut memory);
    orders(&mut desk, &window_of(Command::Ping));
    let (taken, _) = desk.session.frame_counts();
    for command in [Command::Ping, Command::Stop, Command::Disarm, Command::ClearFault] {
        assert_eq!(orders(&mut desk, &requests(command, 3 * WINDOW)), (false, 0), "{command:?}");
    }
    assert_eq!(desk.session.frame_counts().0, taken, "none of them counts as received");
}

#[test]
fn a_frame_beyond_the_credit_is_no_touch() {
    let mut memory = Memory::new();
    let mut desk = Desk::of(Board { touch_from_host: true, ..Board::SIMULATOR }, &mut memory);
    desk.greet();
    desk.reads = false;
    assert_eq!(orders(&mut desk, &window_of(Command::Lift)), (true, 1));
    let touch = Command::Touch { x_m: 0.02, y_m: 0.03, age_ticks: 0 };
    assert_eq!(orders(&mut desk, &requests(touch, WINDOW)), (false, 0));
}

/// What a client has left behind, however much it is, keeps nothing playing.
#[test]
fn a_client_that_ignores_credit_and_reads_nothing_is_silent_after_its_window() {
    let mut memory = Memory::new();
    let mut desk = playing(&mut memory);
    let flood = requests(Command::Ping, 1 << 20);
    // 5 bytes a tick are 2 Mbaud.
    let mut bytes = flood.chunks(5);
    let window_ticks = WINDOW as u32 / 5;
    let mut last_on = 0;
    for tick in 0..window_ticks + 2 * HOST_TIMEOUT_TICKS {
        if tick % 400 == 0 {
            desk.touch = Some(Touch::Down { x_m: 0.03 + 2.5e-6 * tick as f32, y_m: 0.03, age_ticks: 0 });
        }
        desk.session.receive(bytes.next().unwrap(), &desk.status());
        desk.obey();
        if desk.tick() != OFF {
            last_on = tick;
        }
    }
    let expected = window_ticks + HOST_TIMEOUT_TICKS;
    assert!(last_on.abs_diff(expected) <= 2, "on until tick {last_on}, not {expected}");
    assert_eq!(desk.status().telemetry.state, State::Disarmed);
}

/// A client that reads is granted credit again; what it had sent too much is lost to it, as on a bad line.
#[test]
fn credit_comes_back_when_answers_are_read() {
    let mut memory = Memory::new();
    let mut desk = playing(&mut memory);
    orders(&mut desk, &requests(Command::Ping, 2 * WINDOW));
    assert_eq!(orders(&mut desk, &request(1, Command::Ping)), (false, 0));
    desk.reads = true;
    desk.collect();
    desk.messages.clear();
    let before = desk.answer(Command::Ping).received_bytes;
    let after = desk.answer(Command::Ping).received_bytes;
    assert_eq!((after - before) as usize, request(2, Command::Ping).len());
}

/// Several hello requests may be under way before the first answer comes.
#[test]
fn a_hello_request_needs_no_credit_and_sets_it_anew() {
    let mut memory = Memory::new();
    let mut desk = playing(&mut memory);
    orders(&mut desk, &requests(Command::Ping, 2 * WINDOW));
    desk.reads = true;
    assert_eq!(desk.greet().state, State::Disarmed);
    desk.reads = false;
    assert_eq!(orders(&mut desk, &window_of(Command::Ping)), (true, 0));
    assert_eq!(orders(&mut desk, &request(1, Command::Ping)), (false, 0));
}

/// The end of a frame has come when there is credit again, its beginning was beyond it.
#[test]
fn a_frame_that_begins_beyond_the_credit_is_discarded_whole() {
    let mut memory = Memory::new();
    let mut desk = playing(&mut memory);
    orders(&mut desk, &window_of(Command::Ping));
    let frame = request(1, Command::Ping);
    let (beginning, end) = frame.split_at(frame.len() - 1);
    assert_eq!(orders(&mut desk, beginning), (false, 0));
    desk.reads = true;
    desk.collect();
    assert_eq!(orders(&mut desk, end), (false, 0));
    assert_eq!(orders(&mut desk, &frame), (true, 0));
}

/// A bad frame that runs beyond the credit ends with its zero byte, and with it what is discarded.
#[test]
fn a_good_frame_behind_a_bad_one_that_ran_beyond_the_credit_is_taken() {
    let mut memory = Memory::new();
    let mut desk = playing(&mut memory);
    orders(&mut desk, &window_of(Command::Ping));
    assert_eq!(orders(&mut desk, &[0x55; 40]), (false, 0));
    assert_eq!(orders(&mut desk, &[0]), (false, 0));
    desk.reads = true;
    desk.collect();
    assert_eq!(orders(&mut desk, &request(1, Command::Ping)), (true, 0));
}

/// Bytes that noise adds to the line are taken for bytes of the host: they are told to it, and do not add up.
#[test]
fn noise_does_not_use_credit_up() {
    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    desk.greet();
    for _ in 0..100 {
        desk.send(&[0x55; 400]);
        desk.send(&[0]);
        desk.command(Command::Ping).unwrap();
    }
    assert!(!desk.messages.iter().any(|message| matches!(message, FromBoard::StateChanged { .. })));
}

/// The most that may be outstanding, each of them a refusal with all its numbers, behind a host that is away.
#[cfg(feature = "telemetry")]
#[test]
fn an_answer_always_has_its_place_and_telemetry_is_left_out() {
    let mut memory = Memory::new();
    let mut desk = Desk::of(Board { touch_from_host: true, ..Board::SIMULATOR }, &mut memory);
    desk.greet();
    desk.command(Command::Subscribe { period_ticks: 40 }).unwrap();
    desk.messages.clear();
    desk.reads = false;
    desk.ticks(40_000);
    for sequence in 65_000..65_064 {
        desk.send(&request(sequence, Command::Touch { x_m: f32::NAN, y_m: 0.0, age_ticks: 0 }));
        desk.ticks(400);
    }
    desk.reads = true;
    desk.collect();
    let answered = desk.messages.iter().filter_map(|message| match message {
        FromBoard::Answer(answer) => Some((answer.sequence, answer.outcome.is_err())),
        _ => None,
    });
    assert_eq!(answered.collect::<Vec<_>>(), (65_000..65_064).map(|sequence| (sequence, true)).collect::<Vec<_>>());
    desk.messages.clear();
    desk.ticks(400);
    let telemetry = desk.messages.iter().filter(|message| matches!(message, FromBoard::Telemetry(_)));
    assert_eq!(telemetry.count(), 10, "it goes on");
}
