//! Commands that change a scene while it plays: layers on or off, their gains, and the samples of a stream.

#[cfg(feature = "stream")]
use frixel_layers::within;
use frixel_layers::{ActiveLayers, Header, Leader, Scene, range};
use frixel_wire::fault::State;
use frixel_wire::message::{Accepted, Command, Refusal};
#[cfg(feature = "stream")]
use frixel_wire::message::{ConfigField, ConfigRefusal, FromBoard, STREAM_START_LEVEL_MAX};

use crate::commands::Commands;
#[cfg(feature = "stream")]
use crate::link::transmit_queue::TransmitQueue;
use frixel_control::{Order, Status};
#[cfg(feature = "stream")]
use frixel_control::{StreamBuffer, StreamIntake};

/// Frames of samples after which the board reports the progress of the stream: less than 1 KiB, as with uploads.
#[cfg(feature = "stream")]
const PROGRESS_FRAMES: u32 = 4;
/// Time after which the board reports the progress of the stream in any case, in s.
#[cfg(feature = "stream")]
const PROGRESS_PERIOD_S: f32 = 0.02;

/// Facts about the ticker's scene that are still needed after its bytes were overwritten.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Playing {
    pub(crate) header: Option<Header>,
    layers: u8,
    #[cfg(feature = "stream")]
    has_stream: bool,
}

impl Playing {
    #[cfg_attr(not(feature = "stream"), allow(unused_variables, reason = "no layer is streamed"))]
    pub(crate) fn new(scene: &Scene, active: &ActiveLayers) -> Self {
        Self {
            header: Some(*scene.header()),
            // This fits: a scene has at most `RECORDS_MAX` records.
            layers: scene.record_count() as u8,
            #[cfg(feature = "stream")]
            has_stream: active.has_stream(),
        }
    }
}

/// The stream that the host sends.
#[cfg(feature = "stream")]
pub(crate) struct Stream<'a> {
    intake: StreamIntake<'a>,
    /// Frames of samples since the last progress report.
    frames: u32,
    reported_at_tick: u32,
    /// Send a progress report as soon as there is room.
    report_due: bool,
}

#[cfg(feature = "stream")]
impl<'a> Stream<'a> {
    pub(crate) fn new(buffer: &'a StreamBuffer) -> Self {
        Self { intake: StreamIntake::new(buffer), frames: 0, reported_at_tick: 0, report_due: false }
    }
}

impl Playing {
    /// Whether the scene continues without a host.
    pub(crate) fn is_autonomous(&self) -> bool {
        self.header.is_some_and(|header| header.autonomous)
    }

    /// The rule for which of several fingers is followed; the earliest one without a scene.
    pub(crate) fn leader(&self) -> Leader {
        self.header.map_or(Leader::First, |header| header.leader)
    }
}

impl Commands<'_> {
    /// Handles the commands that need a playing scene.
    pub(crate) fn change_playing(&mut self, command: Command, status: &Status) -> Result<Accepted, Refusal> {
        match (self.state, status.fault) {
            (State::Active, _) => {}
            (State::Faulted, Some((fault, _))) => return Err(Refusal::Faulted(fault)),
            (state, _) => return Err(Refusal::WrongState(state)),
        }
        match command {
            Command::SetLayer { layer, on, gain } => self.set_layer(layer, on, gain),
            #[cfg(feature = "stream")]
            Command::StartStream { sample_hz, start_level } => self.start_stream(sample_hz, start_level),
            _ => Err(Refusal::UnknownCommand),
        }
    }

    fn set_layer(&mut self, layer: u8, on: bool, gain: f32) -> Result<Accepted, Refusal> {
        if self.playing.header.is_some_and(|header| header.layers_fixed) {
            return Err(Refusal::LayersFixed);
        }
        let layers = self.playing.layers;
        if layer >= layers {
            return Err(Refusal::NoSuchLayer { layer, layers });
        }
        range::GAIN.check(gain, layer).map_err(Refusal::Config)?;
        self.send_order(Order::SetLayer { layer, on, gain })?;
        Ok(Accepted::Done)
    }
}

#[cfg(feature = "stream")]
impl<'a> Commands<'a> {
    pub(crate) fn attach_stream(&mut self, buffer: &'a StreamBuffer) {
        self.stream = Some(Stream::new(buffer));
    }

    fn start_stream(&mut self, sample_hz: u32, start_level: u16) -> Result<Accepted, Refusal> {
        let tick_hz = self.board.tick_hz;
        if self.stream.is_none() {
            return Err(Refusal::UnknownCommand);
        }
        if !self.playing.has_stream {
            return Err(Refusal::NoStreamLayer);
        }
        for (field, found, max) in [
            (ConfigField::SampleRate, sample_hz as f32, tick_hz as f32),
            (ConfigField::StartLevel, f32::from(start_level), f32::from(STREAM_START_LEVEL_MAX)),
        ] {
            within(field, found, 1.0, max, ConfigRefusal::WHOLE_SCENE).map_err(Refusal::Config)?;
        }
        self.room_for_order()?;
        let Some(stream) = &mut self.stream else { return Err(Refusal::UnknownCommand) };
        let start = stream.intake.start(sample_hz, tick_hz, start_level);
        stream.report_due = true;
        self.send_order(Order::StartStream(start))?;
        Ok(Accepted::Done)
    }

    /// Ends the stream if the new scene has no layer for it. The ticker does the same on its own.
    pub(crate) fn drop_stream_without_layer(&mut self) {
        if let Some(stream) = self.stream.as_mut().filter(|_| !self.playing.has_stream) {
            stream.intake.end();
        }
    }

    /// Takes no more samples, and lets the ticker play those that have arrived.
    pub(crate) fn end_stream(&mut self) -> Result<Accepted, Refusal> {
        if self.stream.is_none() {
            return Err(Refusal::UnknownCommand);
        }
        self.room_for_order()?;
        if let Some(last) = self.stream.as_mut().and_then(|stream| stream.intake.end()) {
            self.send_order(Order::EndStream { last })?;
        }
        Ok(Accepted::Done)
    }

    /// Takes no more samples. No order is needed: the ticker stops the stream itself when it leaves the Active state.
    pub(crate) fn forget_stream(&mut self) {
        if let Some(stream) = &mut self.stream {
            stream.intake.end();
        }
    }

    pub(crate) fn take_samples(&mut self, first_index: u32, samples: &[[u8; 2]]) {
        if let Some(stream) = &mut self.stream {
            stream.intake.take(first_index, samples);
            stream.frames += 1;
            stream.report_due |= stream.frames >= PROGRESS_FRAMES;
        }
    }

    /// Reports the progress of the stream, if a report is pending and the transmit queue is not too full.
    pub(crate) fn report_stream(&mut self, status: &Status, queue: &mut TransmitQueue) {
        let Some(stream) = &mut self.stream else { return };
        let Some((next_index, room)) = stream.intake.progress() else { return };
        let now_tick = status.telemetry.tick;
        let period_over = now_tick.wrapping_sub(stream.reported_at_tick) >= self.board.ticks(PROGRESS_PERIOD_S);
        if !stream.report_due && !period_over {
            return;
        }
        let progress = FromBoard::StreamProgress {
            next_index,
            room,
            underruns: status.counters.stream_underruns,
            gaps: status.counters.stream_gaps,
            received_bytes: self.credit.received(),
        };
        // If the queue is too full, the next call tries again.
        if queue.send_unsolicited(&progress) {
            self.credit.reported();
            stream.report_due = false;
            stream.frames = 0;
            stream.reported_at_tick = now_tick;
        }
    }
}
