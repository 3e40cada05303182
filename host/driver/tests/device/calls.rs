//! Commands, answers, pings and events, on a good line and with lost frames.

use std::time::Duration;

use frixel_driver::{Device, DeviceError, Event, Link, PollingLink, Upload, ignore_progress};
use frixel_layers::{Blend, Header, Layer, Record, Region, Stream};
use frixel_testkit::HEADER;
use frixel_wire::fault::{Fault, State};
use frixel_wire::frame::crc32;
use frixel_wire::hello::feature;
use frixel_wire::message::{Accepted, Command, Refusal, TickTimes};

use crate::uploads::{picture, samples};
use crate::virtual_link::{Fate, VirtualLine, VirtualLink, line_of};

pub(crate) const MS: Duration = Duration::from_millis(1);

pub(crate) fn connected(line: VirtualLine) -> Device<VirtualLink> {
    Device::connect(PollingLink::new(line)).unwrap()
}

/// The next host on the line of a device.
pub(crate) fn reconnected(device: Device<VirtualLink>) -> Device<VirtualLink> {
    Device::connect(device.into_link()).unwrap()
}

/// A device on a good line.
pub(crate) fn virtual_board() -> Device<VirtualLink> {
    connected(VirtualLine::new())
}

/// A device whose board reports these features.
fn with_features(features: u32) -> Device<VirtualLink> {
    let mut line = VirtualLine::new();
    line.change_hello(move |hello| hello.features = features);
    connected(line)
}

/// Uploads and commits a scene with this host timeout.
pub(crate) fn commit(device: &mut Device<VirtualLink>, host_timeout_s: f32) {
    let scene = scene(host_timeout_s);
    let upload = Upload { scene: &scene, bitmaps: Vec::new() };
    device.upload(&upload, &mut ignore_progress).unwrap();
    device.commit(upload.scene_crc32()).unwrap();
}

/// A scene without layers.
pub(crate) fn scene(host_timeout_s: f32) -> Vec<u8> {
    frixel_testkit::scene(&Header { host_timeout_s, ..HEADER }, &[])
}

fn nothing(_: Event) {}

#[test]
fn a_scene_goes_from_upload_to_play_and_back() {
    let mut device = virtual_board();
    commit(&mut device, 0.25);
    device.arm().unwrap();
    device.play().unwrap();
    device.wait(MS, &mut nothing).unwrap();
    assert_eq!(line_of(&mut device).state, State::Active);
    device.stop().unwrap();
    device.disarm().unwrap();
    device.wait(MS, &mut nothing).unwrap();

    let scene = scene(0.25);
    let crc32 = crc32(&scene);
    let line = line_of(&mut device);
    assert_eq!(line.state, State::Disarmed);
    assert_eq!(
        line.commands,
        [
            Command::UploadScene { len: scene.len() as u32, crc32 },
            Command::UploadEnd,
            Command::Commit { crc32 },
            Command::Arm,
            Command::Play,
            Command::Stop,
            Command::Disarm,
        ]
    );
    assert_eq!(reconnected(device).hello().scene_crc32, crc32);
}

#[test]
fn a_scene_that_the_firmware_cannot_play_is_refused_before_it_is_uploaded() {
    let stream = Layer::Stream(Stream { low_n: 0.0, high_n: 0.01 });
    let region = Region::Polygon { first: 0, count: 3 };
    let record = Record { region, blend: Blend::Replace, gain: 1.0, layer: stream };
    let mut scene = scene(0.25);
    scene[2] = 1;
    scene[53] = 3;
    scene.extend(record.write());
    scene.extend([0; 24]);
    for (features, refused) in [(feature::TELEMETRY, true), (feature::STREAM | feature::POLYGON, false)] {
        let mut device = with_features(features);
        let error = device.upload(&Upload { scene: &scene, bitmaps: Vec::new() }, &mut ignore_progress).err();
        let said = error.map(|error| error.to_string());
        assert_eq!(said.is_some(), refused, "{said:?}");
        assert!(said.is_none_or(|said| said.contains("needs stream and polygon") && said.contains("protocol 1.0")));
        assert_eq!(line_of(&mut device).commands.is_empty(), refused);
    }
}

#[test]
fn wait_lets_its_time_pass_and_hands_over_telemetry() {
    let mut device = virtual_board();
    device.subscribe(80).unwrap();
    let mut ticks = Vec::new();
    device
        .wait(Duration::from_secs(1), &mut |event| match event {
            Event::Telemetry(telemetry) => ticks.push(telemetry.tick),
            Event::StateChanged { .. } => panic!("nothing changed the state"),
        })
        .unwrap();
    assert!((99..=100).contains(&ticks.len()), "{} messages in 1 s at 100 Hz", ticks.len());
    assert!(ticks.windows(2).all(|pair| pair[1] - pair[0] == 80));

    device.subscribe(0).unwrap();
    let started = device.now();
    let mut device = reconnected(device);
    let mut late = 0;
    device.wait(Duration::from_secs(1), &mut |_| late += 1).unwrap();
    assert_eq!(late, 0, "telemetry was ended");
    assert!(device.now() >= started + Duration::from_secs(1));
}

#[test]
fn events_during_a_call_are_delivered_later() {
    let mut device = virtual_board();
    line_of(&mut device).rig.raise(Fault::Deadline, 1);
    let (samples, scene) = (samples(6_250), scene(0.25));
    device.upload(&Upload { scene: &scene, bitmaps: vec![picture(&samples)] }, &mut ignore_progress).unwrap();
    let mut changes = Vec::new();
    device
        .wait(Duration::ZERO, &mut |event| {
            if let Event::StateChanged { state, fault, .. } = event {
                changes.push((state, fault));
            }
        })
        .unwrap();
    assert_eq!(changes, [(State::Faulted, Some(Fault::Deadline))]);
}

/// Longest time without a frame over the next second.
fn silence_of(device: &mut Device<VirtualLink>) -> Duration {
    line_of(device).longest_silence = Duration::ZERO;
    let mut buffer = Vec::new();
    let end = device.now() + Duration::from_secs(1);
    while device.now() < end {
        device.link_mut().read(&mut buffer, Duration::from_millis(100)).unwrap();
    }
    line_of(device).longest_silence
}

#[test]
fn pings_follow_the_committed_scenes_host_timeout() {
    for (host_timeout_s, longest_ms) in [(0.02, 6), (0.1, 26), (1.0, 61)] {
        let mut device = virtual_board();
        commit(&mut device, host_timeout_s);
        device.arm().unwrap();
        let silence = silence_of(&mut device);
        assert!(silence <= Duration::from_millis(longest_ms), "{silence:?} with a timeout of {host_timeout_s} s");
        assert!(silence > Duration::from_millis(longest_ms / 2), "{silence:?} with a timeout of {host_timeout_s} s");
    }
}

/// Two pings in a row are damaged, then one to three get through. The board never goes a host timeout without one.
#[test]
fn a_scene_plays_on_when_two_pings_in_a_row_are_damaged_or_lost() {
    let hit = [Fate::Lost, Fate::Tail(1)].into_iter().chain((0..12).map(Fate::Damaged));
    for (fate, good) in hit.flat_map(|fate| [1, 2, 3].map(|good| (fate, good))) {
        for host_timeout_ms in [20, 250] {
            let mut device = virtual_board();
            commit(&mut device, host_timeout_ms as f32 / 1000.0);
            device.arm().unwrap();
            device.play().unwrap();
            let played_at = device.counters().frames_sent;
            line_of(&mut device).to_board_weather = Box::new(move |number, _| {
                let of_round = (number - played_at) % (2 + good);
                if of_round < 2 { fate } else { Fate::Arrives }
            });
            let silence = silence_of(&mut device);
            assert!(silence < Duration::from_millis(host_timeout_ms), "{fate:?}, {good} good: {silence:?}");
            assert_eq!(line_of(&mut device).state, State::Active, "{fate:?}, {good} good");
        }
    }
}

/// The old scene's timeout applies until the new one is committed. The timeout of an earlier host's scene is unknown.
#[test]
fn pings_suit_any_scene_on_an_armed_board_until_the_own_one_is_committed() {
    let scene = scene(1.0);
    let upload = Upload { scene: &scene, bitmaps: Vec::new() };
    let mut armed = virtual_board();
    armed.arm().unwrap();
    let mut uploaded = virtual_board();
    uploaded.arm().unwrap();
    uploaded.upload(&upload, &mut ignore_progress).unwrap();
    let mut refused = virtual_board();
    refused.upload(&upload, &mut ignore_progress).unwrap();
    refused.commit(upload.scene_crc32() + 1).unwrap_err();
    refused.arm().unwrap();
    for device in [&mut armed, &mut uploaded, &mut refused] {
        let silence = silence_of(device);
        assert!(silence <= Duration::from_millis(6), "{silence:?}");
    }
}

#[test]
fn a_period_of_zero_does_not_hold_up_a_wait() {
    let mut device = virtual_board();
    device.link_mut().keep_alive(Duration::ZERO);
    device.wait(10 * MS, &mut nothing).unwrap();
}

#[test]
fn a_disarmed_board_is_pinged_at_leisure() {
    let mut device = virtual_board();
    device.arm().unwrap();
    device.disarm().unwrap();
    let silence = silence_of(&mut device);
    assert!(silence > Duration::from_millis(50), "{silence:?}");
}

#[test]
fn busy_is_tried_again_for_a_second() {
    for busy_times in [20, u32::MAX] {
        let mut line = VirtualLine::new();
        let mut left = busy_times;
        line.refuse = Some(Box::new(move |command| {
            left -= u32::from(*command == Command::Arm);
            (left > 0 && *command == Command::Arm).then_some(Refusal::Busy)
        }));
        let mut device = connected(line);
        match device.arm() {
            Ok(()) => assert_eq!((busy_times, line_of(&mut device).state), (20, State::Armed)),
            Err(error) => {
                assert!(matches!(error, DeviceError::Refused { refusal: Refusal::Busy, .. }), "{error}");
                assert_eq!(busy_times, u32::MAX);
                assert!(device.now() < Duration::from_secs(1));
            }
        }
    }
}

/// The first copy of the command armed the board. The refusal of the second copy therefore counts as success.
#[test]
fn a_lost_answer_does_not_fail_a_command() {
    let mut line = VirtualLine::new();
    // After the hello and the answer to the first ping.
    line.to_host_weather = Box::new(|number, _| if number == 2 { Fate::Lost } else { Fate::Arrives });
    let mut device = connected(line);
    device.arm().unwrap();
    let line = line_of(&mut device);
    assert_eq!((line.state, &line.commands[..]), (State::Armed, &[Command::Arm, Command::Arm][..]));
}

#[test]
fn damaged_frames_of_the_board_are_counted() {
    let mut line = VirtualLine::new();
    line.to_host_weather = Box::new(|number, _| if number == 2 { Fate::Damaged(3) } else { Fate::Arrives });
    let mut device = connected(line);
    assert_eq!(device.counters().frames_rejected, 0);
    device.ping().unwrap();
    assert_eq!(device.counters().frames_rejected, 1);
}

#[test]
fn tick_times_are_read_only_from_a_board_with_telemetry() {
    let measured = TickTimes { deadline_cycles: 3_700, worst_cycles: 2_131, ..TickTimes::default() };
    for (features, board_says, found, is_asked) in [
        (feature::TELEMETRY, measured, Some(measured), true),
        (feature::TELEMETRY, TickTimes::default(), None, true),
        (0, measured, None, false),
    ] {
        let mut device = with_features(features);
        line_of(&mut device).change_answers(move |answer| {
            if let Ok(Accepted::TickTimes(times)) = &mut answer.outcome {
                *times = board_says;
            }
        });
        assert_eq!(device.tick_times().unwrap(), found, "{features:#x}");
        assert_eq!(!line_of(&mut device).commands.is_empty(), is_asked, "{features:#x}");
    }
}
