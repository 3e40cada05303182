//! Bulk uploads: what arrives, what it costs, and that credit is kept. The virtual line itself refuses bytes beyond the
//! credit.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::time::Duration;

use frixel_driver::{Bitmap, Device, DeviceError, Link, Upload};
use frixel_testkit::Random;
use frixel_wire::frame::crc32;
use frixel_wire::message::{Command, Refusal};

use crate::calls::{connected, reconnected, scene};
use crate::fake_board::{FakeBoard, WINDOW};
use crate::virtual_link::{Fate, VirtualLine, VirtualLink, Weather, line_of};

const WIDTH: u16 = 250;

/// Samples that look like nothing in particular.
fn samples(len: usize) -> Vec<u8> {
    let mut random = Random::new(1);
    (0..len).map(|_| random.byte()).collect()
}

fn bitmap(samples: &[u8]) -> Bitmap<'_> {
    Bitmap { crc32: crc32(samples), width: WIDTH, height: (samples.len() / usize::from(WIDTH)) as u16, samples }
}

fn is_chunk(frame: &[u8]) -> bool {
    frame.len() > 100
}

/// Uploads a bitmap of 62,500 samples and a scene, and checks that both have arrived.
fn upload_over(line: VirtualLine) -> Device<VirtualLink> {
    let (samples, scene) = (samples(62_500), scene(0.25));
    let mut device = connected(line);
    let upload = Upload { scene: &scene, bitmaps: vec![bitmap(&samples)] };
    device.upload(&upload, &mut |_| ControlFlow::Continue(())).unwrap();
    device.commit(upload.scene_crc32()).unwrap();
    let board = &line_of(&mut device).board;
    assert_eq!(board.bitmaps.get(&crc32(&samples)), Some(&samples));
    assert_eq!(board.scene.as_ref(), Some(&scene));
    reconnected(device)
}

#[test]
fn at_least_95_percent_of_the_line_is_payload() {
    let samples = samples(62_500);
    let scene = scene(0.25);
    let mut device = connected(VirtualLine::new(FakeBoard::new()));
    let before = device.counters();
    device
        .upload(&Upload { scene: &scene, bitmaps: vec![bitmap(&samples)] }, &mut |_| ControlFlow::Continue(()))
        .unwrap();
    let after = device.counters();

    assert_eq!(after.payload_bytes, (samples.len() + scene.len()) as u64);
    assert_eq!(after.frames_rejected, 0);
    let share = after.payload_bytes as f64 / (after.wire_bytes - before.wire_bytes) as f64;
    println!("{:.2} % of {} bytes are payload", 100.0 * share, after.wire_bytes - before.wire_bytes);
    assert!(share >= 0.95, "{share}");
}

/// Credit is used so well that the line never rests, but for the round trips of the commands.
#[test]
fn an_upload_takes_the_time_of_its_bytes() {
    let samples = samples(62_500);
    let scene = scene(0.25);
    let mut line = VirtualLine::new(FakeBoard::new());
    line.board_delay = Duration::from_millis(2);
    let mut device = connected(line);
    let bytes_before = device.counters().wire_bytes;
    let started = device.now();
    device = reconnected(device);
    device
        .upload(&Upload { scene: &scene, bitmaps: vec![bitmap(&samples)] }, &mut |_| ControlFlow::Continue(()))
        .unwrap();
    let line_time_s = (device.counters().wire_bytes - bytes_before) as f64 / 200_000.0;
    let took_s = device.now().as_secs_f64() - started.as_secs_f64();
    let line = line_of(&mut device);
    println!("{took_s:.3} s for {line_time_s:.3} s of bytes, at most {} under way", line.most_under_way);
    assert!(took_s < 1.1 * line_time_s, "{took_s} s for {line_time_s} s of bytes");
}

/// Else a line that refuses bytes beyond the credit would prove nothing.
#[test]
fn a_slow_board_fills_the_window() {
    let mut line = VirtualLine::new(FakeBoard::new());
    line.board_delay = Duration::from_millis(40);
    let mut device = upload_over(line);
    let line = line_of(&mut device);
    assert!(line.most_under_way > usize::from(WINDOW) * 9 / 10, "{} bytes", line.most_under_way);
}

/// Pings go out while an upload waits for credit, and the line refuses them too when they go beyond it: two while the
/// board pauses, and more when it answers again.
#[test]
fn pings_have_credit_of_their_own() {
    for armed in [false, true] {
        let mut line = VirtualLine::new(FakeBoard::new());
        line.board_pause = Duration::from_millis(100)..Duration::from_millis(650);
        let (samples, scene) = (samples(62_500), scene(0.25));
        let mut device = connected(line);
        if armed {
            device.arm().unwrap();
        }
        let upload = Upload { scene: &scene, bitmaps: vec![bitmap(&samples)] };
        let pings_before = line_of(&mut device).board.pings;
        device.upload(&upload, &mut |_| ControlFlow::Continue(())).unwrap();
        assert!(device.now() > Duration::from_millis(800), "the board paused in the upload");
        let pings = line_of(&mut device).board.pings - pings_before;
        assert!(pings >= 2, "{pings} pings");
    }
}

#[test]
fn a_board_with_room_for_one_frame_takes_an_upload() {
    let mut board = FakeBoard::new();
    board.hello.limits.receive_window_bytes = 192;
    let mut device = upload_over(VirtualLine::new(board));
    let line = line_of(&mut device);
    assert!(line.most_under_way <= 192, "{} bytes", line.most_under_way);
}

#[test]
fn an_upload_alone_commits_no_scene() {
    let mut device = connected(VirtualLine::new(FakeBoard::new()));
    let scene = scene(0.25);
    device.upload(&Upload { scene: &scene, bitmaps: Vec::new() }, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(line_of(&mut device).board.scene, None);
}

#[test]
fn a_bitmap_that_the_board_holds_is_not_sent_again() {
    let mut device = upload_over(VirtualLine::new(FakeBoard::new()));
    let payload_before = device.counters().payload_bytes;
    let (samples, scene) = (samples(62_500), scene(0.25));
    device
        .upload(&Upload { scene: &scene, bitmaps: vec![bitmap(&samples)] }, &mut |_| ControlFlow::Continue(()))
        .unwrap();
    assert_eq!(device.counters().payload_bytes - payload_before, scene.len() as u64);
}

#[test]
fn progress_only_grows_and_ends_with_all() {
    let (samples, scene) = (samples(62_500), scene(0.25));
    let mut device = connected(VirtualLine::new(FakeBoard::new()));
    let mut steps = Vec::new();
    let upload = Upload { scene: &scene, bitmaps: vec![bitmap(&samples)] };
    let mut note = |progress| {
        steps.push(progress);
        ControlFlow::Continue(())
    };
    device.upload(&upload, &mut note).unwrap();
    assert!(steps.iter().all(|step| step.total_bytes == samples.len() + scene.len()));
    assert!(steps.windows(2).all(|pair| pair[0].done_bytes <= pair[1].done_bytes));
    assert_eq!(steps.last().unwrap().done_bytes, samples.len() + scene.len());
    assert!(steps.len() > 50, "{} steps", steps.len());
}

#[test]
fn one_lost_or_damaged_chunk_costs_no_more_than_a_window() {
    for fate in [Fate::Lost, Fate::Tail(50), Fate::Damaged(70), Fate::Damaged(191)] {
        let mut line = VirtualLine::new(FakeBoard::new());
        line.to_board_weather = Box::new(move |number, _| if number == 100 { fate } else { Fate::Arrives });
        let clean = upload_over(VirtualLine::new(FakeBoard::new())).counters();
        let stormy = upload_over(line).counters();
        let extra = stormy.wire_bytes - clean.wire_bytes;
        assert!((192..=u64::from(WINDOW) + 192).contains(&extra), "{fate:?} cost {extra} bytes");
    }
}

/// Far more than a window is lost in all: credit comes back, or the upload would stop for good.
#[test]
fn lost_bytes_do_not_use_up_the_credit() {
    let mut line = VirtualLine::new(FakeBoard::new());
    let mut seen = BTreeSet::new();
    line.to_board_weather = Box::new(move |_, frame| {
        let first = is_chunk(frame) && seen.insert(frame.to_vec());
        if first && seen.len().is_multiple_of(10) { Fate::Lost } else { Fate::Arrives }
    });
    let mut device = upload_over(line);
    assert!(device.link_mut().written().bytes > 62_500 + 4 * u64::from(WINDOW));
}

/// The last chunk has no later one behind it that would show the gap.
#[test]
fn a_lost_last_chunk_is_sent_again() {
    let mut line = VirtualLine::new(FakeBoard::new());
    let mut lost = false;
    line.to_board_weather = Box::new(move |_, frame| {
        let last = frame.len() == 62_500 % 184 + 8;
        let fate = if last && !lost { Fate::Lost } else { Fate::Arrives };
        lost |= last;
        fate
    });
    upload_over(line);
}

#[test]
fn any_weather_in_which_no_frame_is_hit_twice_lets_an_upload_through() {
    for seed in 1..=60 {
        let mut line = VirtualLine::new(FakeBoard::new());
        line.board_delay = Duration::from_micros(seed * 50);
        line.to_board_weather = storm(seed);
        line.to_host_weather = storm(seed + 1000);
        upload_over(line);
    }
}

/// Hits one frame in thirty, each frame at most once, and no control frame's neighbour through its last byte.
fn storm(seed: u64) -> Weather {
    let mut random = Random::new(seed);
    let mut hit = BTreeSet::new();
    Box::new(move |_, frame| {
        if !random.once_in(30) || !hit.insert(frame.to_vec()) {
            return Fate::Arrives;
        }
        let len = frame.len() as u32;
        match random.below(3) {
            0 => Fate::Lost,
            1 => Fate::Tail(random.below(len) as usize),
            _ => Fate::Damaged(random.below(len - 1) as usize),
        }
    })
}

#[test]
fn an_upload_that_does_not_get_on_ends_within_a_second() {
    let mut line = VirtualLine::new(FakeBoard::new());
    let mut chunks = 0;
    line.to_board_weather = Box::new(move |_, frame| {
        chunks += u32::from(is_chunk(frame));
        if is_chunk(frame) && chunks > 50 { Fate::Lost } else { Fate::Arrives }
    });
    let mut device = connected(line);
    let (samples, scene) = (samples(62_500), scene(0.25));
    let upload = Upload { scene: &scene, bitmaps: vec![bitmap(&samples)] };
    let error = device.upload(&upload, &mut |_| ControlFlow::Continue(())).unwrap_err();
    let expected = DeviceError::UploadStalled {
        port: "the virtual line".into(),
        arrived_bytes: 50 * 184,
        total_bytes: samples.len(),
    };
    assert_eq!(error, expected);
    assert!(device.now() < Duration::from_secs(1), "{:?}", device.now());
    assert_eq!(line_of(&mut device).board.scene, None);
}

#[test]
fn a_refused_upload_is_not_sent() {
    let mut board = FakeBoard::new();
    let full = Refusal::BitmapPoolFull { len: 62_500, free: 1000 };
    board.refuse = Some(Box::new(move |command| matches!(command, Command::UploadBitmap { .. }).then_some(full)));
    let mut device = connected(VirtualLine::new(board));
    let (samples, scene) = (samples(62_500), scene(0.25));
    let error = device
        .upload(&Upload { scene: &scene, bitmaps: vec![bitmap(&samples)] }, &mut |_| ControlFlow::Continue(()))
        .unwrap_err();
    assert!(matches!(error, DeviceError::Refused { refusal, .. } if refusal == full), "{error}");
    assert!(device.counters().wire_bytes < 200);
}

#[test]
fn a_bitmap_of_another_size_is_refused_before_anything_is_sent() {
    let samples = samples(62_500);
    let scene = scene(0.25);
    let mut device = connected(VirtualLine::new(FakeBoard::new()));
    let before = device.counters();
    let wrong = Bitmap { height: 249, ..bitmap(&samples) };
    let error =
        device.upload(&Upload { scene: &scene, bitmaps: vec![wrong] }, &mut |_| ControlFlow::Continue(())).unwrap_err();
    assert!(matches!(error, DeviceError::BitmapSize { found: 62_500, .. }), "{error}");
    assert_eq!(device.counters(), before);
}

/// A board that has every chunk, and asks for all of them again.
#[test]
fn a_board_that_forgets_every_upload_is_given_up() {
    let mut board = FakeBoard::new();
    let forgets = |command: &Command| {
        let forgotten = Refusal::UploadIncomplete { next_chunk: 0 };
        (*command == Command::UploadEnd).then_some(forgotten)
    };
    board.refuse = Some(Box::new(forgets));
    let mut device = connected(VirtualLine::new(board));
    let (samples, scene) = (samples(6_250), scene(0.25));
    let error = device
        .upload(&Upload { scene: &scene, bitmaps: vec![bitmap(&samples)] }, &mut |_| ControlFlow::Continue(()))
        .unwrap_err();
    assert!(matches!(error, DeviceError::UploadForgotten { total_bytes: 6_250, times: 4, .. }), "{error}");
    assert!(error.to_string().contains("reset the board"), "{error}");
    assert!(device.now() < Duration::from_secs(1));
}

/// 57,600 baud and less: a full window ahead of a request takes most of a second, or several.
#[test]
fn a_slow_line_uploads_in_the_end() {
    let (samples, scene) = (samples(25_000), scene(0.25));
    for bytes_per_s in [11_520, 5_760, 2_880, 1_500] {
        let mut line = VirtualLine::new(FakeBoard::new());
        line.bytes_per_s = bytes_per_s;
        let mut device = connected(line);
        let upload = Upload { scene: &scene, bitmaps: vec![bitmap(&samples)] };
        device.upload(&upload, &mut |_| ControlFlow::Continue(())).unwrap();
        device.commit(upload.scene_crc32()).unwrap();
        let written = device.counters().wire_bytes;
        let line = line_of(&mut device);
        assert_eq!(line.board.bitmaps.get(&crc32(&samples)), Some(&samples));
        let line_s = written as f64 / f64::from(bytes_per_s);
        println!("{bytes_per_s} bytes a second: {:.1} s for {line_s:.1} s of bytes", device.now().as_secs_f64());
        assert!(written < 40_000, "{written} bytes at {bytes_per_s} a second: nothing is sent twice");
    }
}

#[test]
fn an_upload_ends_when_its_caller_breaks_it_off() {
    let (samples, scene) = (samples(62_500), scene(0.25));
    let upload = Upload { scene: &scene, bitmaps: vec![bitmap(&samples)] };
    let mut device = connected(VirtualLine::new(FakeBoard::new()));
    let started = device.now();
    let deadline = started + Duration::from_millis(100);
    let mut calls = 0;
    let error = device.upload(&upload, &mut |progress| {
        calls += 1;
        let enough = progress.done_bytes > 10_000 || calls > 1_000;
        if enough { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(matches!(error, Err(DeviceError::Interrupted { .. })), "{error:?}");
    assert!(device.now() <= deadline + Duration::from_secs(1));
    let line = line_of(&mut device);
    assert_eq!((line.board.bitmaps.len(), &line.board.scene), (0, &None));
}
