//! Layers and streams through the driver, over a fake board's line.

use frixel_driver::{Device, DeviceError, StreamSettings, StreamStatus};
use frixel_wire::message::{Command, Refusal};

use crate::calls::connected;
use crate::fake_board::FakeBoard;
use crate::virtual_link::{VirtualLine, VirtualLink, line_of};

/// A stream of 8,000 samples a second to a board that plays so many at every ping.
fn streaming(plays_per_ping: usize) -> Device<VirtualLink> {
    let mut board = FakeBoard::new();
    board.plays_per_ping = plays_per_ping;
    let mut device = connected(VirtualLine::new(board));
    device.start_stream(StreamSettings::new(8_000)).unwrap();
    device
}

#[test]
fn a_layer_is_set_by_number_and_a_refusal_is_told_in_words() {
    let mut device = connected(VirtualLine::new(FakeBoard::new()));
    device.set_layer(3, false, 0.25).unwrap();
    let mut board = FakeBoard::new();
    board.refuse = Some(Box::new(|command| {
        matches!(command, Command::SetLayer { .. }).then_some(Refusal::NoSuchLayer { layer: 3, layers: 1 })
    }));
    let refused = connected(VirtualLine::new(board)).set_layer(3, true, 1.0).unwrap_err();
    assert!(matches!(refused, DeviceError::Refused { refusal: Refusal::NoSuchLayer { layer: 3, layers: 1 }, .. }));
    assert!(refused.to_string().contains("change of a layer"), "{refused}");
    assert_eq!(line_of(&mut device).board.commands, [Command::SetLayer { layer: 3, on: false, gain: 0.25 }]);
}

#[test]
fn a_start_level_is_fifty_milliseconds_where_the_buffer_has_that() {
    let level = |sample_hz| StreamSettings::new(sample_hz).start_level;
    assert_eq!([level(1), level(1_000), level(8_000), level(40_000)], [1, 50, 400, 800]);
}

/// The board says that there is room for 1,024, and plays none: that many are sent, in whole frames as long as there
/// are.
#[test]
fn no_more_is_sent_than_the_board_has_room_for() {
    let mut device = streaming(0);
    let samples: Vec<u16> = (0..3_000).collect();
    let mut sent = 0;
    for _ in 0..20 {
        sent += device.send_samples(&samples[sent..]).unwrap();
        device.ping().unwrap();
    }
    assert_eq!(sent, 990, "eleven whole frames");
    assert_eq!(device.send_samples(&samples[sent..sent + 34]).unwrap(), 34, "what is there fits");
    device.ping().unwrap();
    assert_eq!(device.send_samples(&samples[1_024..]).unwrap(), 0);
    assert_eq!(device.stream_status(), Some(StreamStatus { sent: 1_024, underruns: 0, gaps: 0 }));
    assert_eq!(line_of(&mut device).board.samples, samples[..1_024]);
}

/// The fake board asserts that samples come in order, and never more than it has room for.
#[test]
fn a_stream_of_any_length_goes_over_as_it_is_played() {
    let mut device = streaming(300);
    let samples: Vec<u16> = (0..20_000).map(|index| (index * 7) as u16).collect();
    let mut sent = 0;
    let mut rounds = 0;
    while sent < samples.len() {
        sent += device.send_samples(&samples[sent..]).unwrap();
        device.ping().unwrap();
        rounds += 1;
        assert!(rounds < 200, "{sent} of {} samples", samples.len());
    }
    device.end_stream().unwrap();
    let board = &line_of(&mut device).board;
    assert_eq!(board.samples, samples);
    assert_eq!(board.commands, [Command::StartStream { sample_hz: 8_000, start_level: 400 }, Command::EndStream]);
}

#[test]
fn without_a_stream_nothing_is_sent() {
    let mut device = connected(VirtualLine::new(FakeBoard::new()));
    assert_eq!(device.send_samples(&[1, 2, 3]).unwrap(), 0);
    assert_eq!(device.stream_status(), None);
}
