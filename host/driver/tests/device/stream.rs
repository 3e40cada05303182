//! Layers and streams through the driver, on a board that plays.

use std::time::Duration;

use frixel_driver::{Device, DeviceError, StreamSettings, StreamStatus, Upload, ignore_progress};
use frixel_layers::{Layer, Stream};
use frixel_testkit::HEADER;
use frixel_wire::message::{Command, Refusal};

use crate::calls::virtual_board;
use crate::virtual_link::{VirtualLink, line_of};

/// A board that plays a stream layer.
fn playing() -> Device<VirtualLink> {
    let layer = frixel_testkit::record(Layer::Stream(Stream { low_n: 0.0, high_n: 0.01 }));
    let scene = frixel_testkit::scene(&HEADER, &[layer]);
    let upload = Upload { scene: &scene, bitmaps: Vec::new() };
    let mut device = virtual_board();
    device.upload(&upload, &mut ignore_progress).unwrap();
    device.commit(upload.scene_crc32()).unwrap();
    device.arm().unwrap();
    device.play().unwrap();
    device
}

#[test]
fn a_layer_is_set_by_number_and_a_refusal_is_told_in_words() {
    let mut device = playing();
    device.set_layer(0, false, 0.25).unwrap();
    assert_eq!(line_of(&mut device).commands.last(), Some(&Command::SetLayer { layer: 0, on: false, gain: 0.25 }));
    let refused = device.set_layer(3, true, 1.0).unwrap_err();
    assert!(matches!(refused, DeviceError::Refused { refusal: Refusal::NoSuchLayer { layer: 3, layers: 1 }, .. }));
    assert!(refused.to_string().contains("change of a layer"), "{refused}");
}

#[test]
fn a_start_level_is_fifty_milliseconds_where_the_buffer_has_that() {
    let level = |sample_hz| StreamSettings::new(sample_hz).start_level;
    assert_eq!([level(1), level(1_000), level(8_000), level(40_000)], [1, 50, 400, 800]);
}

/// The board has room for 1,024 samples, and plays one per second. Exactly that many are sent, in full frames where
/// possible.
#[test]
fn no_more_is_sent_than_the_board_has_room_for() {
    let mut device = playing();
    device.start_stream(StreamSettings { sample_hz: 1, start_level: 800 }).unwrap();
    let samples: Vec<u16> = (0..3_000).collect();
    let mut sent = 0;
    for _ in 0..20 {
        sent += device.send_samples(&samples[sent..]).unwrap();
        device.ping().unwrap();
    }
    assert_eq!(sent, 990, "eleven whole frames");
    assert_eq!(device.send_samples(&samples[sent..sent + 34]).unwrap(), 34, "what is there fits");
    device.ping().unwrap();
    assert_eq!(device.send_samples(&samples[1_024..1_114]).unwrap(), 0);
    assert_eq!(device.stream_status(), Some(StreamStatus { sent: 1_024, underruns: 0, gaps: 0 }));
}

/// The board counts samples that it has no room for, or that come in another order, as gaps.
#[test]
fn a_stream_of_any_length_goes_over_as_it_is_played() {
    let mut device = playing();
    device.start_stream(StreamSettings::new(4_000)).unwrap();
    let samples: Vec<u16> = (0..20_000).map(|index| (index * 7) as u16).collect();
    let started = device.now();
    let mut sent = 0;
    while sent < samples.len() {
        sent += device.send_samples(&samples[sent..]).unwrap();
        device.wait(Duration::from_millis(5), &mut |_| ()).unwrap();
        assert!(device.now() < started + Duration::from_secs(6), "{sent} of {} samples", samples.len());
    }
    device.end_stream().unwrap();
    device.wait(Duration::from_secs(1), &mut |_| ()).unwrap();
    assert_eq!(device.stream_status(), Some(StreamStatus { sent: 20_000, underruns: 0, gaps: 0 }));
}

#[test]
fn without_a_stream_nothing_is_sent() {
    let mut device = virtual_board();
    assert_eq!(device.send_samples(&[1, 2, 3]).unwrap(), 0);
    assert_eq!(device.stream_status(), None);
}
