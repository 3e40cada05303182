//! The bytes of everything that goes over the wire, held in `golden/`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use crate::support;

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

use frixel_testkit::golden;
use frixel_wire::fault::{Fault, State};
use frixel_wire::frame::{Decoder, FRAME_MAX_LEN, encode};
use frixel_wire::hello::{BoardKind, ResetCause};
use frixel_wire::message::{Accepted, Answer, Command, ConfigField, FromBoard, Refusal, Telemetry};
use frixel_wire::payload::{PAYLOAD_MAX_LEN, Payload};
use frixel_wire::scene::SceneError;
use support::hex::{from_hex, to_hex};
use support::{samples, variants};

fn hold(name: &str, found: &str) {
    golden::hold(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name), found);
}

/// The bytes of all lines of this kind.
fn lines(text: &str, kind: &str) -> impl Iterator<Item = Vec<u8>> {
    text.lines().filter_map(move |line| line.strip_prefix(kind)?.strip_prefix(' ')).map(from_hex)
}

/// Compares the payloads and frames of these samples with the golden file, and reads them back.
fn hold_frames(name: &str, samples: &[Payload]) {
    let mut text = String::new();
    for sample in samples {
        let mut buffer = [0; PAYLOAD_MAX_LEN];
        let mut frame = [0; FRAME_MAX_LEN];
        writeln!(text, "# {sample:?}").unwrap();
        writeln!(text, "payload {}", to_hex(sample.write(&mut buffer).unwrap())).unwrap();
        writeln!(text, "frame {}", to_hex(sample.write_frame(&mut frame).unwrap())).unwrap();
    }
    hold(name, &text);

    let frames: Vec<u8> = lines(&text, "frame").flatten().collect();
    let mut decoder = Decoder::new();
    let mut input = frames.as_slice();
    for (golden, sample) in lines(&text, "payload").zip(samples) {
        let payload = decoder.next_frame(&mut input).unwrap();
        assert_eq!(payload, golden);
        assert_eq!(Payload::parse(payload).as_ref(), Ok(sample));
    }
    assert_eq!(decoder.next_frame(&mut input), None);
    assert_eq!((decoder.frames(), decoder.rejected()), (samples.len() as u32, 0));
}

#[test]
fn messages_of_a_host_have_golden_bytes() {
    hold_frames("host.hex", &samples::from_host());
}

#[test]
fn messages_of_a_board_have_golden_bytes() {
    hold_frames("board.hex", &samples::from_board());
}

/// Asserts that the values include every variant of their enum.
fn assert_all<'de, T: serde::Deserialize<'de> + std::fmt::Debug>(values: impl IntoIterator<Item = T>) {
    let found: BTreeSet<String> = values.into_iter().map(|value| variants::name(&value)).collect();
    let all: BTreeSet<String> = variants::all::<T>().into_iter().map(String::from).collect();
    assert_eq!(found, all, "a variant has no sample in tests/support/samples.rs");
}

#[test]
fn every_message_has_golden_bytes() {
    let mut commands = vec![];
    for payload in samples::from_host() {
        if let Payload::Request(request) = payload {
            commands.push(request.command);
        }
    }
    let (mut messages, mut outcomes, mut states) = (vec![], vec![], vec![]);
    for payload in samples::from_board() {
        let Payload::FromBoard(message) = payload else { continue };
        messages.push(message);
        match message {
            FromBoard::Answer(Answer { outcome, .. }) => outcomes.push(outcome),
            FromBoard::Telemetry(Telemetry { state, .. }) => states.push(state),
            FromBoard::Progress { .. } | FromBoard::StateChanged { .. } | FromBoard::StreamProgress { .. } => {}
        }
    }
    let refusals: Vec<Refusal> = outcomes.iter().filter_map(|outcome| outcome.err()).collect();
    let (mut scene_errors, mut fields) = (vec![], vec![]);
    for refusal in &refusals {
        match refusal {
            Refusal::Scene(error) => scene_errors.push(*error),
            Refusal::Config(config) => fields.push(config.field),
            _ => {}
        }
    }
    assert_all::<Command>(commands);
    assert_all::<FromBoard>(messages);
    assert_all::<State>(states);
    assert_all::<Accepted>(outcomes.into_iter().filter_map(Result::ok));
    assert_all::<Refusal>(refusals);
    assert_all::<SceneError>(scene_errors);
    assert_all::<ConfigField>(fields);
}

/// Types with explicit numbers instead of postcard discriminants: every named number, and one without a name.
#[test]
fn every_number_has_golden_bytes() {
    let hellos: Vec<_> = samples::from_board()
        .into_iter()
        .filter_map(|payload| if let Payload::Hello(hello) = payload { Some(hello) } else { None })
        .collect();
    for number in 0..=u8::MAX {
        let fault = Fault::try_from(number).ok();
        let named = fault.is_some_and(|fault| !matches!(fault, Fault::Other(_)));
        assert!(!named || hellos.iter().any(|hello| hello.last_fault == fault), "{fault:?}");

        let board = BoardKind::from(number);
        let named = !matches!(board, BoardKind::Other(_));
        assert!(!named || hellos.iter().any(|hello| hello.board == board), "{board:?}");

        let cause = ResetCause::from(number);
        let named = !matches!(cause, ResetCause::Other(_));
        assert!(!named || hellos.iter().any(|hello| hello.reset_cause == cause), "{cause:?}");

        let state = State::try_from(number);
        assert!(state.is_err() || hellos.iter().any(|hello| Ok(hello.state) == state), "{state:?}");
    }
}

/// The functions that write a frame directly give the same frames as [`Payload::write_frame`].
#[test]
fn direct_frame_writers_agree_with_payloads() {
    use frixel_wire::payload::{
        chunk_frame, from_board_frame, hello_frame, hello_request_frame, request_frame, samples_frame,
    };
    for payload in samples::from_host().into_iter().chain(samples::from_board()) {
        let mut direct = [0; FRAME_MAX_LEN];
        let direct = match payload {
            Payload::HelloRequest { .. } => hello_request_frame(&mut direct),
            Payload::Hello(hello) => hello_frame(&hello, &mut direct),
            Payload::Request(request) => request_frame(&request, &mut direct),
            Payload::FromBoard(message) => from_board_frame(&message, &mut direct),
            Payload::Chunk { number, bytes } => chunk_frame(number, bytes, &mut direct),
            Payload::Samples { first_index, samples } => {
                let samples: Vec<u16> = samples.iter().map(|sample| u16::from_le_bytes(*sample)).collect();
                samples_frame(first_index, &samples, &mut direct)
            }
        };
        let mut buffer = [0; PAYLOAD_MAX_LEN];
        let mut frame = [0; FRAME_MAX_LEN];
        assert_eq!(direct.unwrap(), encode(payload.write(&mut buffer).unwrap(), &mut frame).unwrap());
    }
}
