//! Bulk uploads: their content, their cost, and their use of credit.
//!
//! The virtual line rejects bytes beyond the credit, and the board rejects a bitmap or a scene with a wrong byte.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::time::Duration;

use frixel_driver::{Bitmap, Device, DeviceError, Link, Upload, ignore_progress};
use frixel_hil_sim::Board;
use frixel_testkit::Random;
use frixel_wire::hello::BoardLimits;
use frixel_wire::message::{Command, Refusal};
use frixel_wire::scene::bitmap_crc32;

use crate::calls::{connected, reconnected, scene, virtual_board};
use crate::virtual_link::{BOARD, Fate, VirtualLine, VirtualLink, WINDOW, Weather, line_of};

const WIDTH: u16 = 250;

/// Pseudo-random samples.
pub(crate) fn samples(len: usize) -> Vec<u8> {
    let mut random = Random::new(1);
    (0..len).map(|_| random.byte()).collect()
}

pub(crate) fn picture(samples: &[u8]) -> Bitmap<'_> {
    let height = (samples.len() / usize::from(WIDTH)) as u16;
    Bitmap { crc32: bitmap_crc32(WIDTH, height, samples), width: WIDTH, height, samples }
}

fn is_chunk(frame: &[u8]) -> bool {
    frame.len() > 100
}

/// Uploads a picture of 62,500 samples and a scene.
pub(crate) fn upload(device: &mut Device<VirtualLink>) -> Result<(), DeviceError> {
    let (samples, scene) = (samples(62_500), scene(0.25));
    device.upload(&Upload { scene: &scene, bitmaps: vec![picture(&samples)] }, &mut ignore_progress)
}

/// Uploads picture and scene to a new host of the board, commits the scene, and checks that both have arrived.
fn upload_over(line: VirtualLine) -> Device<VirtualLink> {
    let mut device = connected(line);
    upload(&mut device).unwrap();
    let scene = scene(0.25);
    let scene_crc32 = Upload { scene: &scene, bitmaps: Vec::new() }.scene_crc32();
    device.commit(scene_crc32).unwrap();
    let mut next = reconnected(device);
    assert_eq!(next.hello().scene_crc32, scene_crc32);
    let payload_before = next.counters().payload_bytes;
    upload(&mut next).unwrap();
    assert_eq!(next.counters().payload_bytes - payload_before, scene.len() as u64, "the picture is held");
    next
}

#[test]
fn at_least_95_percent_of_the_line_is_payload() {
    let mut device = virtual_board();
    let before = device.counters();
    upload(&mut device).unwrap();
    let after = device.counters();

    assert_eq!(after.payload_bytes, (62_500 + scene(0.25).len()) as u64);
    assert_eq!(after.frames_rejected, 0);
    let share = after.payload_bytes as f64 / (after.wire_bytes - before.wire_bytes) as f64;
    println!("{:.2} % of {} bytes are payload", 100.0 * share, after.wire_bytes - before.wire_bytes);
    assert!(share >= 0.95, "{share}");
}

/// The credit keeps the line busy, except during the round trips of the commands.
#[test]
fn an_upload_takes_the_time_of_its_bytes() {
    let mut line = VirtualLine::new();
    line.board_delay = Duration::from_millis(2);
    let mut device = connected(line);
    let (bytes_before, started) = (device.counters().wire_bytes, device.now());
    upload(&mut device).unwrap();
    let line_time_s = (device.counters().wire_bytes - bytes_before) as f64 / 200_000.0;
    let took_s = device.now().as_secs_f64() - started.as_secs_f64();
    let line = line_of(&mut device);
    println!("{took_s:.3} s for {line_time_s:.3} s of bytes, at most {} under way", line.most_under_way);
    assert!((1.0..1.1).contains(&(took_s / line_time_s)), "{took_s} s for {line_time_s} s of bytes");
}

/// Without this, a line that rejects bytes beyond the credit would prove nothing.
#[test]
fn a_slow_board_fills_the_window() {
    let mut line = VirtualLine::new();
    line.board_delay = Duration::from_millis(40);
    let mut device = upload_over(line);
    let line = line_of(&mut device);
    assert!(line.most_under_way > usize::from(WINDOW) * 9 / 10, "{} bytes", line.most_under_way);
}

/// Pings go out while an upload waits for credit: two while the board pauses, and more once it answers again. The line
/// also rejects pings beyond the credit.
#[test]
fn pings_have_credit_of_their_own() {
    for armed in [false, true] {
        let mut line = VirtualLine::new();
        line.board_pause = Duration::from_millis(100)..Duration::from_millis(650);
        let mut device = connected(line);
        if armed {
            device.arm().unwrap();
        }
        let pings_before = line_of(&mut device).pings;
        upload(&mut device).unwrap();
        assert!(device.now() > Duration::from_millis(800), "the board paused in the upload");
        let pings = line_of(&mut device).pings - pings_before;
        assert!(pings >= 2, "{pings} pings");
    }
}

#[test]
fn a_board_with_room_for_a_frame_and_a_few_pings_takes_an_upload() {
    for window in [256, 384] {
        let limits = BoardLimits { receive_window_bytes: window, ..BOARD.limits };
        let mut device = upload_over(VirtualLine::to(Board { limits, ..BOARD }, 200_000));
        let line = line_of(&mut device);
        assert!(line.most_under_way <= usize::from(window), "{} bytes", line.most_under_way);
    }
}

#[test]
fn progress_only_grows_and_ends_with_all() {
    let (samples, scene) = (samples(62_500), scene(0.25));
    let mut device = virtual_board();
    let mut steps = Vec::new();
    let upload = Upload { scene: &scene, bitmaps: vec![picture(&samples)] };
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
        let mut line = VirtualLine::new();
        line.to_board_weather = Box::new(move |number, _| if number == 100 { fate } else { Fate::Arrives });
        let clean = upload_over(VirtualLine::new()).counters();
        let stormy = upload_over(line).counters();
        let extra = stormy.wire_bytes - clean.wire_bytes;
        assert!((192..=u64::from(WINDOW) + 192).contains(&extra), "{fate:?} cost {extra} bytes");
    }
}

/// In total, far more than a window is lost. Credit must recover, or the upload would stall for good.
#[test]
fn lost_bytes_do_not_use_up_the_credit() {
    let mut line = VirtualLine::new();
    let mut seen = BTreeSet::new();
    line.to_board_weather = Box::new(move |_, frame| {
        let first = is_chunk(frame) && seen.insert(frame.to_vec());
        if first && seen.len().is_multiple_of(10) { Fate::Lost } else { Fate::Arrives }
    });
    let mut device = upload_over(line);
    assert!(device.link_mut().written().bytes > 62_500 + 4 * u64::from(WINDOW));
}

#[test]
fn any_weather_in_which_no_frame_is_hit_twice_lets_an_upload_through() {
    for seed in 1..=60 {
        let mut line = VirtualLine::new();
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
    let mut line = VirtualLine::new();
    let mut chunks = 0;
    line.to_board_weather = Box::new(move |_, frame| {
        chunks += u32::from(is_chunk(frame));
        if is_chunk(frame) && chunks > 50 { Fate::Lost } else { Fate::Arrives }
    });
    let mut device = connected(line);
    let error = upload(&mut device).unwrap_err();
    let expected =
        DeviceError::UploadStalled { port: "the virtual line".into(), arrived_bytes: 50 * 184, total_bytes: 62_500 };
    assert_eq!(error, expected);
    assert!(device.now() < Duration::from_secs(1), "{:?}", device.now());
}

#[test]
fn a_refused_upload_is_not_sent() {
    let samples = vec![0; 66_000];
    let scene = scene(0.25);
    let mut device = virtual_board();
    let upload = Upload { scene: &scene, bitmaps: vec![picture(&samples)] };
    let error = device.upload(&upload, &mut ignore_progress).unwrap_err();
    let full = Refusal::BitmapPoolFull { len: 66_000, free: 65_536 };
    assert!(matches!(error, DeviceError::Refused { refusal, .. } if refusal == full), "{error}");
    assert!(device.counters().wire_bytes < 200);
}

#[test]
fn a_bitmap_of_another_size_is_refused_before_anything_is_sent() {
    let (samples, scene) = (samples(62_500), scene(0.25));
    let mut device = virtual_board();
    let before = device.counters();
    let wrong = Bitmap { height: 249, ..picture(&samples) };
    let error = device.upload(&Upload { scene: &scene, bitmaps: vec![wrong] }, &mut ignore_progress).unwrap_err();
    assert!(matches!(error, DeviceError::BitmapSize { found: 62_500, .. }), "{error}");
    assert_eq!(device.counters(), before);
}

/// The board has received every chunk, and requests all of them again.
#[test]
fn a_board_that_forgets_every_upload_is_given_up() {
    let mut line = VirtualLine::new();
    let forgotten = Refusal::UploadIncomplete { next_chunk: 0 };
    line.refuse = Some(Box::new(move |command| (*command == Command::UploadEnd).then_some(forgotten)));
    let mut device = connected(line);
    let (samples, scene) = (samples(6_250), scene(0.25));
    let upload = Upload { scene: &scene, bitmaps: vec![picture(&samples)] };
    let error = device.upload(&upload, &mut ignore_progress).unwrap_err();
    assert!(matches!(error, DeviceError::UploadForgotten { total_bytes: 6_250, times: 4, .. }), "{error}");
    assert!(error.to_string().contains("reset the board"), "{error}");
    assert!(device.now() < Duration::from_secs(1));
}

/// 57,600 baud and less: a full window ahead of a request takes most of a second, or several.
#[test]
fn a_slow_line_uploads_in_the_end() {
    let (samples, scene) = (samples(25_000), scene(0.25));
    for bytes_per_s in [11_520, 5_760, 2_880, 1_500] {
        let mut device = connected(VirtualLine::to(BOARD, bytes_per_s));
        let upload = Upload { scene: &scene, bitmaps: vec![picture(&samples)] };
        device.upload(&upload, &mut ignore_progress).unwrap();
        let written = device.counters().wire_bytes;
        let line_s = written as f64 / f64::from(bytes_per_s);
        println!("{bytes_per_s} bytes a second: {:.1} s for {line_s:.1} s of bytes", device.now().as_secs_f64());
        assert!(written < 40_000, "{written} bytes at {bytes_per_s} a second: nothing is sent twice");
    }
}

#[test]
fn an_upload_ends_when_its_caller_breaks_it_off() {
    let (samples, scene) = (samples(62_500), scene(0.25));
    let upload = Upload { scene: &scene, bitmaps: vec![picture(&samples)] };
    let mut device = virtual_board();
    let error = device.upload(&upload, &mut |progress| {
        if progress.done_bytes > 10_000 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(matches!(error, Err(DeviceError::Interrupted { .. })), "{error:?}");
    let line = line_of(&mut device);
    assert!(!line.commands.contains(&Command::UploadEnd), "{:?}", line.commands);
}
