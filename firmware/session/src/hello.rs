//! Handles the hello, which begins a new session.

use frixel_wire::fault::State;
use frixel_wire::hello::{Hello, PROTOCOL_MAJOR, PROTOCOL_MINOR, feature, notice};

use crate::commands::Commands;
use crate::link::transmit_queue::TransmitQueue;
use frixel_control::Status;
use frixel_control::{Board, Order};

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

impl Commands<'_> {
    /// Begins a session with a new client: resets the credit, drops an unfinished upload or commit, and disarms the
    /// board, because the previous client is gone. A scene that continues without a host keeps playing.
    pub(crate) fn handle_hello(&mut self, status: &Status, queue: &mut TransmitQueue) {
        if !(self.state == State::Active && self.playing.is_autonomous()) {
            // Ignore a refusal: there was nothing to disarm. There is always room for this order.
            let _ = self.change_state(Order::Disarm, &[State::Armed, State::Active], State::Disarmed);
        }
        self.credit.restart();
        self.telemetry_period_ticks = 0;
        self.drop_upload();
        self.drop_commit();
        self.announced_bitmaps.clear();
        self.forget_fingers(status);
        // Ignore a full order queue: the stream then runs dry instead.
        #[cfg(feature = "stream")]
        let _ = self.end_stream();
        queue.send_hello(&Hello {
            protocol: (PROTOCOL_MAJOR, PROTOCOL_MINOR),
            firmware: FIRMWARE,
            board: self.board.kind,
            id: self.board.id,
            tick_hz: self.board.tick_hz,
            frame_max_len: frixel_wire::frame::FRAME_MAX_LEN as u16,
            features: features(&self.board, self.has_stream()),
            scene_crc32: self.committed_crc32,
            reset_cause: self.board.reset_cause,
            last_fault: status.fault.map(|(fault, _)| fault),
            fault_detail: status.fault.map_or(0, |(_, detail)| detail),
            state: self.state,
            limits: self.board.limits,
            notices: self.notices(),
        });
    }

    /// What a person should know before playing.
    fn notices(&self) -> u8 {
        let is_skipped = self.stored_scene_skipped && self.committed_crc32 == 0;
        self.board.notices | if is_skipped { notice::STORED_SCENE_SKIPPED } else { 0 }
    }

    #[cfg(feature = "stream")]
    fn has_stream(&self) -> bool {
        self.stream.is_some()
    }

    #[cfg(not(feature = "stream"))]
    #[allow(clippy::unused_self, reason = "used when the feature is enabled")]
    fn has_stream(&self) -> bool {
        false
    }
}
