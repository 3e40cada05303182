//! Slow boards: every call ends, and its caller can report what it waits for.

use std::ops::ControlFlow;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use frixel_driver::{Device, DeviceError, Upload, ignore_progress};
use frixel_wire::message::{Accepted, Refusal};

use crate::calls::{connected, scene, virtual_board};
use crate::uploads::picture;
use crate::virtual_link::{BOARD, VirtualLine, VirtualLink, line_of};

const SECOND: Duration = Duration::from_secs(1);

/// A board that takes `time_per_frame` for each frame after the hello, one frame at a time.
fn slow(time_per_frame: Duration) -> Device<VirtualLink> {
    let mut device = virtual_board();
    line_of(&mut device).board_time_per_frame = time_per_frame;
    device
}

/// Uploads a picture of 25,000 samples. Returns the outcome; the numbers of frames, pings and bytes; and the time.
fn uploaded(time_per_frame: Duration) -> (Result<(), DeviceError>, [u64; 3], Duration) {
    let samples = vec![7; 25_000];
    let mut device = slow(time_per_frame);
    let (before, started) = (device.counters(), device.now());
    let result = device.upload(&Upload { scene: &scene(0.25), bitmaps: vec![picture(&samples)] }, &mut ignore_progress);
    let (after, took) = (device.counters(), device.now().saturating_sub(started));
    let frames = after.frames_sent - before.frames_sent;
    println!("{time_per_frame:?} a frame: {frames} frames in {took:?}, {result:?}");
    let pings = u64::from(line_of(&mut device).pings);
    (result, [frames, pings, after.wire_bytes - before.wire_bytes], took)
}

/// Otherwise nearly all of its frames would be pings: 735 of 762 in 150 s. Chunks that have arrived are not resent:
/// little more than the picture's 136 chunks is sent.
#[test]
fn a_slow_board_is_drowned_neither_in_pings_nor_in_chunks() {
    for ms in [50, 100, 120] {
        let (result, [frames, pings, bytes], took) = uploaded(ms * SECOND / 1000);
        result.unwrap();
        assert!(pings * 2 < frames, "{pings} of {frames} frames are pings");
        assert!(took < 600 * ms * SECOND / 1000, "{took:?} for 137 chunks");
        assert!(bytes < 30_000, "{bytes} bytes");
    }
}

#[test]
fn an_upload_to_a_board_that_is_too_slow_ends() {
    for ms in [200, 300, 500, 700, 1000, 5000] {
        let (result, _, took) = uploaded(ms * SECOND / 1000);
        assert!(result.is_err() && took < 12 * SECOND, "{ms} ms a frame: {took:?}");
    }
}

#[test]
fn one_request_takes_10_s_at_most() {
    // So slow that the requests that are sent again pile up before the board.
    let mut device = slow(SECOND * 7 / 10);
    let started = device.now();
    let mut longest = Duration::ZERO;
    for _ in 0..20 {
        let before = device.now();
        if let Err(error) = device.subscribe(0) {
            assert!(matches!(error, DeviceError::TooSlow { .. } | DeviceError::Silent { .. }), "{error}");
        }
        longest = longest.max(device.now().saturating_sub(before));
    }
    println!("{:?} for 20 requests, {longest:?} for one", device.now().saturating_sub(started));
    assert!(longest <= 10 * SECOND, "{longest:?}");
}

/// A board that takes chunks and never acknowledges them. It drops the chunks of an upload that it has refused, and the
/// test turns the refusal into an acceptance.
#[test]
fn an_upload_ends_10_s_after_the_last_acknowledged_byte() {
    let scene = vec![7; 2_000_000];
    let mut device = connected(VirtualLine::to(BOARD, 60_000));
    let started = device.now();
    line_of(&mut device).change_answers(|answer| {
        if matches!(answer.outcome, Err(Refusal::SceneTooLarge { .. })) {
            answer.outcome = Ok(Accepted::Done);
        }
    });
    let upload = Upload { scene: &scene, bitmaps: Vec::new() };
    let error = device.upload(&upload, &mut ignore_progress).unwrap_err();
    assert!(matches!(error, DeviceError::UploadTooSlow { arrived_bytes: 0, .. }), "{error}");
    let took = device.now().saturating_sub(started);
    assert!(took >= 10 * SECOND && took < 11 * SECOND, "{took:?}");
}

#[test]
fn a_caller_learns_what_is_waited_for_and_may_break_the_wait_off() {
    let mut device = slow(SECOND * 7 / 10);
    let told = Arc::new(Mutex::new(Vec::new()));
    let teller = Arc::clone(&told);
    device.while_waiting(move |waiting| {
        teller.lock().unwrap().push((waiting.command, waiting.waited));
        if waiting.waited >= SECOND / 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let before = device.now();
    let error = device.subscribe(400).unwrap_err();
    assert!(matches!(error, DeviceError::BrokenOff { command: "telemetry", .. }), "{error}");
    assert!(device.now().saturating_sub(before) <= SECOND * 7 / 10);
    let told = told.lock().unwrap();
    assert!(told.len() >= 4 && told.iter().all(|(command, _)| *command == "telemetry"), "{told:?}");
}
