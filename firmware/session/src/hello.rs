//! The hello: the board's description of itself.

use frixel_control::{Board, Status};
use frixel_wire::fault::State;
use frixel_wire::hello::{Hello, PROTOCOL_MAJOR, PROTOCOL_MINOR, feature};

use crate::scene::Scenes;

/// Version of this firmware: major, minor, patch.
const FIRMWARE: (u8, u8, u8) = (
    part(env!("CARGO_PKG_VERSION_MAJOR")),
    part(env!("CARGO_PKG_VERSION_MINOR")),
    part(env!("CARGO_PKG_VERSION_PATCH")),
);

/// Parses a part of the package's version at compile time.
const fn part(text: &str) -> u8 {
    match u8::from_str_radix(text, 10) {
        Ok(part) => part,
        Err(_) => u8::MAX,
    }
}

/// Feature bits of this firmware.
const fn features(board: &Board, has_stream: bool) -> u32 {
    const fn bit(present: bool, bit: u32) -> u32 {
        if present { bit } else { 0 }
    }
    (frixel_layers::FEATURES & !feature::STREAM)
        | bit(has_stream, feature::STREAM)
        | bit(cfg!(feature = "sine-carrier"), feature::SINE_CARRIER)
        | bit(cfg!(feature = "telemetry"), feature::TELEMETRY)
        | bit(board.touch_from_host, feature::HOST_TOUCH)
}

/// The hello of a board in this state, with these scenes.
pub(crate) fn hello(board: &Board, status: &Status, state: State, scenes: &Scenes) -> Hello {
    Hello {
        protocol: (PROTOCOL_MAJOR, PROTOCOL_MINOR),
        firmware: FIRMWARE,
        board: board.kind,
        id: board.id,
        tick_hz: board.tick_hz,
        frame_max_len: frixel_wire::frame::FRAME_MAX_LEN as u16,
        features: features(board, scenes.stream.is_attached()),
        scene_crc32: scenes.crc32(),
        reset_cause: board.reset_cause,
        last_fault: status.fault.map(|(fault, _)| fault),
        fault_detail: status.fault.map_or(0, |(_, detail)| detail),
        state,
        limits: board.limits,
        notices: board.notices,
    }
}
