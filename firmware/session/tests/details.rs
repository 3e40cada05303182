//! Details of `PROTOCOL.md`: frames that cannot be parsed, the order of refusals, uploads, numbers of a scene.

use crate::support::{TestBoard, constant_scene};
use frixel_wire::fault::State;
use frixel_wire::frame::{FRAME_MAX_LEN, crc32, encode};
use frixel_wire::message::{Accepted, Command, FromBoard, Refusal};

/// Ticks of the host timeout of these scenes, and a margin.
const TIMEOUT_TICKS: u32 = 11_000;

/// Sends a payload, which need not be valid.
fn send(board: &mut TestBoard, payload: &[u8]) -> usize {
    let mut frame = [0; FRAME_MAX_LEN];
    let frame = encode(payload, &mut frame).unwrap().to_vec();
    board.send(&frame);
    frame.len()
}

/// The state of a playing board after its host timeout, with this payload every eighth of it.
fn state_with_only(payload: &[u8]) -> State {
    let mut board = TestBoard::new();
    board.play(&constant_scene(0.01));
    for _ in 0..8 {
        board.ticks(TIMEOUT_TICKS / 8);
        send(&mut board, payload);
    }
    board.status().telemetry.state
}

#[test]
fn unreadable_frames_are_dropped_or_refused_and_cost_credit() {
    let mut board = TestBoard::connected();
    let mut sent = 0;
    // A sequence number of four bytes, an empty request, an unknown kind, and a message of a board.
    for payload in [&[2, 0xff, 0xff, 0xff, 0x01][..], &[2], &[0x42, 1, 2], &[3, 0, 0, 0, 0, 0]] {
        sent += send(&mut board, payload);
    }
    assert_eq!(board.answers(), []);
    // An unknown command, and a known one followed by an extra byte.
    sent += send(&mut board, &[2, 7, 99]);
    sent += send(&mut board, &[2, 8, 0, 1]);
    let unknown = Err(Refusal::UnknownCommand);
    assert_eq!(board.answers(), [(7, unknown), (8, unknown)]);
    // A ping with sequence 5, whose varint is two bytes longer than necessary.
    sent += send(&mut board, &[2, 0x85, 0x80, 0x00, 0]);
    let FromBoard::Answer(answer) = board.messages.remove(0) else { panic!("no answer") };
    assert_eq!((answer.sequence, answer.outcome), (5, Ok(Accepted::Done)));
    assert_eq!(answer.received_bytes as usize, sent);
}

#[test]
fn only_readable_frames_are_signs_of_life() {
    for payload in [&[2, 0xff, 0xff, 0xff, 0x01][..], &[0x42, 1, 2], &[3, 0, 0, 0, 0, 0]] {
        assert_eq!(state_with_only(payload), State::Disarmed, "{payload:?}");
    }
    // An unknown command, and a chunk without an upload.
    for payload in [&[2, 7, 99][..], &[0x80, 0, 1, 2, 3]] {
        assert_eq!(state_with_only(payload), State::Active, "{payload:?}");
    }
}

#[test]
fn the_first_refusal_of_several() {
    let mut board = TestBoard::connected();
    let crc = crc32(&constant_scene(0.01));
    assert_eq!(board.command(Command::Play), Err(Refusal::NoScene));
    assert_eq!(board.command(Command::Stop), Err(Refusal::WrongState(State::Disarmed)));
    assert_eq!(board.command(Command::Disarm), Ok(Accepted::Done));
    assert_eq!(board.command(Command::Commit { crc32: crc }), Err(Refusal::NoScene));
    board.command(Command::Arm).unwrap();
    assert_eq!(board.command(Command::Play), Err(Refusal::NoScene));
    board.command(Command::Disarm).unwrap();
    board.press_switch();
    board.upload_scene(&constant_scene(0.01)).unwrap();
    let mismatch = Refusal::CrcMismatch { expected: crc, found: !crc };
    let refused = board.command(Command::Commit { crc32: !crc }).unwrap_err();
    assert_eq!(std::mem::discriminant(&refused), std::mem::discriminant(&mismatch));
    board.command(Command::UploadScene { len: 10, crc32: 1 }).unwrap();
    assert_eq!(board.command(Command::Commit { crc32: crc }), Err(Refusal::UploadIncomplete { next_chunk: 0 }));
}

#[test]
fn an_empty_upload_ends_at_once_and_is_no_scene() {
    let mut board = TestBoard::connected();
    board.command(Command::UploadScene { len: 0, crc32: 0 }).unwrap();
    assert_eq!(board.command(Command::UploadEnd), Ok(Accepted::Done));
    let refused = board.command(Command::Commit { crc32: 0 });
    assert!(matches!(refused, Err(Refusal::Scene(_))), "{refused:?}");
}

#[test]
fn a_scene_is_committed_as_often_as_a_client_likes() {
    let mut board = TestBoard::new();
    board.play(&constant_scene(0.01));
    for _ in 0..2 {
        assert_eq!(board.command(Command::Commit { crc32: crc32(&constant_scene(0.01)) }), Ok(Accepted::Done));
        board.ticks(400);
    }
    assert_eq!(board.status().telemetry.state, State::Active);
}
