//! Parsers under arbitrary bytes.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use crate::support;

use frixel_wire::hello::Hello;
use frixel_wire::message::{Command, Request};
use frixel_wire::payload::{
    CHUNK_LEN, PAYLOAD_MAX_LEN, ParseError, Payload, SAMPLES_MAX, WriteError, chunk_frame, samples_frame,
};
use proptest::prelude::*;
use support::samples;

fn written(payload: &Payload) -> Vec<u8> {
    payload.write(&mut [0; PAYLOAD_MAX_LEN]).unwrap().to_vec()
}

/// Nearly valid payloads: valid ones with a few bytes changed and the end truncated or extended.
fn nearly() -> impl Strategy<Value = Vec<u8>> {
    let good: Vec<Vec<u8>> = samples::from_host().iter().chain(&samples::from_board()).map(written).collect();
    let change = (any::<prop::sample::Index>(), any::<u8>());
    (prop::sample::select(good), prop::collection::vec(change, 0..4), 0..200usize).prop_map(
        |(mut bytes, changes, len)| {
            for (at, byte) in changes {
                let at = at.index(bytes.len());
                bytes[at] = byte;
            }
            if len < 190 {
                bytes.resize(len.min(PAYLOAD_MAX_LEN), 0);
            }
            bytes
        },
    )
}

/// Asserts that a payload that can be read can be written, and that reading it back gives the same payload.
fn assert_stable(bytes: &[u8]) -> Result<(), TestCaseError> {
    if let Ok(payload) = Payload::parse(bytes) {
        let once = written(&payload);
        let twice = written(&Payload::parse(&once).unwrap());
        prop_assert_eq!(once, twice);
    }
    Ok(())
}

proptest! {
    #[test]
    fn arbitrary_payloads_do_not_panic(bytes in prop::collection::vec(any::<u8>(), 0..=PAYLOAD_MAX_LEN)) {
        assert_stable(&bytes)?;
    }

    #[test]
    fn nearly_valid_payloads_do_not_panic(bytes in nearly()) {
        assert_stable(&bytes)?;
    }

    /// The receiver's parser reads the payloads that the sender may send as [`Payload::parse`] does; the sender's own
    /// parser refuses them.
    #[test]
    fn each_side_reads_only_the_other(bytes in nearly()) {
        let (host, board) = (Payload::parse_from_host(&bytes), Payload::parse_from_board(&bytes));
        prop_assert!(host.is_err() || board.is_err());
        let read = [host, board].into_iter().find(Result::is_ok).map(|payload| written(&payload.unwrap()));
        prop_assert_eq!(Payload::parse(&bytes).ok().map(|payload| written(&payload)), read);
    }

    #[test]
    fn arbitrary_hellos_do_not_panic(tail in prop::collection::vec(any::<u8>(), 0..150)) {
        let bytes = [b"FRXL", tail.as_slice()].concat();
        if let Ok(hello) = Hello::parse(&bytes) {
            prop_assert_eq!(hello.write(), Hello::parse(&hello.write()).unwrap().write());
        }
    }
}

#[test]
fn chunks_and_samples_that_do_not_fit_are_refused() {
    let mut frame = [0; 192];
    assert_eq!(chunk_frame(0x8000, &[1], &mut frame), Err(WriteError::ChunkNumber { number: 0x8000 }));
    assert_eq!(chunk_frame(0, &[], &mut frame), Err(WriteError::ChunkLength { len: 0 }));
    assert_eq!(chunk_frame(0, &[1; CHUNK_LEN + 1], &mut frame), Err(WriteError::ChunkLength { len: CHUNK_LEN + 1 }));
    for count in [0, SAMPLES_MAX + 1] {
        let samples = vec![1; count];
        assert_eq!(samples_frame(0, &samples, &mut frame), Err(WriteError::SampleCount { count }));
    }
}

#[test]
fn malformed_payloads_are_refused() {
    assert_eq!(Payload::parse(&[]), Err(ParseError::Empty));
    assert_eq!(Payload::parse(&[0x05]), Err(ParseError::UnknownKind { kind: 0x05 }));
    assert_eq!(Payload::parse(&[0x7f, 1]), Err(ParseError::UnknownKind { kind: 0x7f }));
    assert_eq!(Payload::parse(&[0x00, 1]), Err(ParseError::Malformed { kind: 0x00 }));
    assert_eq!(Payload::parse(&[0x02, 0x80]), Err(ParseError::Malformed { kind: 0x02 }));
    assert_eq!(Payload::parse(&[0x03, 0x09]), Err(ParseError::Malformed { kind: 0x03 }));
    assert_eq!(Payload::parse(&[0x04, 1, 2, 3, 4]), Err(ParseError::Malformed { kind: 0x04 }), "no sample");
    assert_eq!(
        Payload::parse(&[0x04, 1, 2, 3, 4, 5, 6, 7]),
        Err(ParseError::Malformed { kind: 0x04 }),
        "half a sample"
    );
    assert_eq!(Payload::parse(&[0x80]), Err(ParseError::Malformed { kind: 0x80 }));
    assert_eq!(Payload::parse(&[0x80, 0x00]), Err(ParseError::Malformed { kind: 0x80 }));
}

/// An unreadable command, of a newer protocol or with excess bytes, can still be answered by its sequence number.
#[test]
fn unknown_commands_keep_their_sequence_number() {
    let unknown = Err(ParseError::UnknownCommand { sequence: 300 });
    assert_eq!(Payload::parse(&[0x02, 0xac, 0x02, 0x0b]), unknown);
    assert_eq!(Payload::parse(&[0x02, 0xac, 0x02]), unknown);
    assert_eq!(Payload::parse(&[0x02, 0xac, 0x02, 0x00, 0x00]), unknown);
    let ping = Request { sequence: 300, command: Command::Ping };
    assert_eq!(Payload::parse(&[0x02, 0xac, 0x02, 0x00]), Ok(Payload::Request(ping)));
}

/// A hello request of a later protocol may be longer.
#[test]
fn longer_hello_requests_are_read() {
    assert_eq!(Payload::parse(&[0x00, 9, 3, 1, 2, 3]), Ok(Payload::HelloRequest { protocol: (9, 3) }));
}
