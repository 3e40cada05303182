//! Frames on a line that loses, changes and adds bytes.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use frixel_wire::frame::{Crc32, Decoder, FRAME_MAX_LEN, PayloadLengthError, crc32, encode};
use frixel_wire::payload::PAYLOAD_MAX_LEN;
use proptest::prelude::*;

fn frame(payload: &[u8]) -> Vec<u8> {
    encode(payload, &mut [0; FRAME_MAX_LEN]).unwrap().to_vec()
}

/// All payloads that a decoder finds in these bytes, and the decoder.
fn decode(bytes: &[u8]) -> (Vec<Vec<u8>>, Decoder) {
    let mut decoder = Decoder::new();
    let mut input = bytes;
    let mut payloads = Vec::new();
    while let Some(payload) = decoder.next_frame(&mut input) {
        payloads.push(payload.to_vec());
    }
    assert!(input.is_empty());
    (payloads, decoder)
}

/// COBS as in its paper, implemented independently of the crate under test; `None` if the bytes are not valid COBS.
fn reference_uncobs(mut encoded: &[u8]) -> Option<Vec<u8>> {
    let mut decoded = Vec::new();
    while let Some((&code, rest)) = encoded.split_first() {
        let (run, rest) = rest.split_at_checked(usize::from(code).checked_sub(1)?)?;
        decoded.extend(run);
        if code != 0xff && !rest.is_empty() {
            decoded.push(0);
        }
        encoded = rest;
    }
    Some(decoded)
}

/// CRC-32 bit by bit, implemented independently of the crate under test.
fn reference_crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 })
    })
}

/// Reference decoder for a stream: the valid payloads, and the number of invalid frames.
fn reference_decode(bytes: &[u8]) -> (Vec<Vec<u8>>, u32) {
    let mut frames: Vec<&[u8]> = bytes.split(|byte| *byte == 0).collect();
    frames.pop();
    let mut payloads = Vec::new();
    let mut rejected = 0;
    for encoded in frames.into_iter().filter(|frame| !frame.is_empty()) {
        let decoded = reference_uncobs(encoded).filter(|decoded| decoded.len() <= PAYLOAD_MAX_LEN + 4);
        let split = decoded.as_deref().and_then(<[u8]>::split_last_chunk::<4>);
        match split {
            Some((payload @ [_, ..], crc)) if reference_crc32(payload).to_le_bytes() == *crc => {
                payloads.push(payload.to_vec());
            }
            _ => rejected += 1,
        }
    }
    (payloads, rejected)
}

/// A disturbance of the bytes on a serial line.
#[derive(Clone, Debug)]
enum Noise {
    Flip { at: prop::sample::Index, bit: u8 },
    Lose { at: prop::sample::Index, len: usize },
    Add { at: prop::sample::Index, bytes: Vec<u8> },
}

fn noise() -> impl Strategy<Value = Noise> {
    let at = any::<prop::sample::Index>;
    prop_oneof![
        (at(), 0..8u8).prop_map(|(at, bit)| Noise::Flip { at, bit }),
        (at(), 1..300usize).prop_map(|(at, len)| Noise::Lose { at, len }),
        (at(), prop::collection::vec(any::<u8>(), 1..300)).prop_map(|(at, bytes)| Noise::Add { at, bytes }),
    ]
}

fn disturb(line: &mut Vec<u8>, noise: &Noise) {
    if line.is_empty() {
        return;
    }
    match noise {
        Noise::Flip { at, bit } => {
            let at = at.index(line.len());
            line[at] ^= 1 << bit;
        }
        Noise::Lose { at, len } => {
            let at = at.index(line.len());
            line.drain(at..line.len().min(at + len));
        }
        Noise::Add { at, bytes } => {
            let at = at.index(line.len());
            line.splice(at..at, bytes.iter().copied());
        }
    }
}

fn payload() -> impl Strategy<Value = Vec<u8>> {
    // Zeros and full runs are the special cases of COBS: make them frequent.
    let byte = prop_oneof![Just(0u8), Just(1), Just(0xff), any::<u8>()];
    prop::collection::vec(byte, 1..=PAYLOAD_MAX_LEN)
}

#[test]
fn empty_and_overlong_payloads_are_refused() {
    for len in [0, PAYLOAD_MAX_LEN + 1] {
        assert_eq!(encode(&vec![0x55; len], &mut [0; FRAME_MAX_LEN]), Err(PayloadLengthError { len }));
    }
}

/// Overlong but otherwise valid frames, one of which begins with a valid payload of the largest length; and a valid
/// frame inside an overlong one, which must not be found.
#[test]
fn overlong_frames_are_dropped_whole() {
    let with_crc = |len| {
        let payload = vec![0x55; len];
        [payload.as_slice(), &crc32(&payload).to_le_bytes()].concat()
    };
    let right = with_crc(PAYLOAD_MAX_LEN);
    for body in [with_crc(PAYLOAD_MAX_LEN + 1), [right.as_slice(), &[0x55]].concat(), right.repeat(2)] {
        // Encoded here, since `encode` makes no such frame.
        let cobs: Vec<u8> = body.chunks(253).flat_map(|run| [&[run.len() as u8 + 1], run].concat()).collect();
        assert!(!cobs.contains(&0));
        let (payloads, decoder) = decode(&[cobs.as_slice(), &[0], &frame(b"next")].concat());
        assert_eq!(payloads, [b"next"]);
        assert_eq!((decoder.frames(), decoder.rejected()), (1, 1));
    }

    let hiding = [vec![0x55; 1_000], frame(b"hidden"), frame(b"next")].concat();
    let (payloads, decoder) = decode(&hiding);
    assert_eq!(payloads, [b"next"]);
    assert_eq!((decoder.frames(), decoder.rejected()), (1, 1));
}

/// An empty payload has a CRC of zero, so a single flipped bit in a run of zeros could produce its frame.
#[test]
fn a_flipped_bit_in_zeros_makes_no_frame_of_an_empty_payload() {
    let mut line = frame(&[0; 100]);
    assert_eq!(line[..6], [1; 6]);
    line[5] ^= 1;
    let (payloads, decoder) = decode(&line);
    assert_eq!((payloads.len(), decoder.frames(), decoder.rejected()), (0, 0, 2));
}

proptest! {

    #[test]
    fn frames_match_the_reference_implementations(payload in payload()) {
        let frame = frame(&payload);
        let body = [payload.as_slice(), &reference_crc32(&payload).to_le_bytes()].concat();
        prop_assert_eq!(reference_uncobs(&frame[..frame.len() - 1]), Some(body));
    }

    /// Under any disturbance, the decoder returns only payloads that were sent, and finds the frame after the next
    /// zero.
    #[test]
    fn a_noisy_line_loses_frames_but_never_invents_one(
        payloads in prop::collection::vec(payload(), 1..6),
        noises in prop::collection::vec(noise(), 1..6),
        last in payload(),
    ) {
        let mut line: Vec<u8> = payloads.iter().flat_map(|payload| frame(payload)).collect();
        for noise in &noises {
            disturb(&mut line, noise);
        }
        let (expected, rejected) = reference_decode(&line);
        let (found, decoder) = decode(&line);
        prop_assert!(found.iter().all(|payload| payloads.contains(payload)));
        prop_assert_eq!(&found, &expected);
        prop_assert_eq!((decoder.frames() as usize, decoder.rejected()), (expected.len(), rejected));

        line.push(0);
        let before = decode(&line).0.len();
        line.extend(frame(&last));
        let (found, _) = decode(&line);
        prop_assert_eq!(found.len(), before + 1);
        prop_assert_eq!(found.last(), Some(&last));
    }

    /// Arbitrary bytes.
    #[test]
    fn garbage_is_read_as_by_the_reference(garbage in prop::collection::vec(0..20u8, 0..2_000)) {
        let (expected, rejected) = reference_decode(&garbage);
        let (found, decoder) = decode(&garbage);
        prop_assert_eq!(found, expected);
        prop_assert_eq!(decoder.rejected(), rejected);
    }

    /// Decoding byte by byte and all at once gives the same result.
    #[test]
    fn pushing_bytes_equals_reading_a_slice(garbage in prop::collection::vec(any::<u8>(), 0..300), payload in payload()) {
        let line = [garbage.as_slice(), &[0], &frame(&payload)].concat();
        let mut decoder = Decoder::new();
        let mut found = Vec::new();
        for byte in &line {
            found.extend(decoder.push(*byte).map(<[u8]>::to_vec));
        }
        prop_assert_eq!(found, decode(&line).0);
    }

    #[test]
    fn crc_in_pieces_equals_the_crc_of_the_whole(
        bytes in prop::collection::vec(any::<u8>(), 0..500),
        cut in any::<prop::sample::Index>(),
    ) {
        let (head, tail) = bytes.split_at(cut.index(bytes.len() + 1));
        prop_assert_eq!(Crc32::new().update(head).update(tail).finish(), reference_crc32(&bytes));
        prop_assert_eq!(crc32(&bytes), reference_crc32(&bytes));
    }
}
