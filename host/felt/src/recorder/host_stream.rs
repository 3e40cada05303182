//! Decodes the stream that a host sends and computes how a finger should feel it, independently of the firmware that
//! plays the stream.

use std::collections::VecDeque;

use frixel_wire::frame::Decoder;
use frixel_wire::message::{Command, Request};
use frixel_wire::payload::Payload;

/// Time in which a stream fades in and out, s (PROTOCOL, section 15).
const FADE_S: f64 = 0.01;
/// How long a board may have had samples without reporting that it waits for more, s. After this time the recorder
/// assumes that a report was lost between two telemetry messages, and that the stream plays.
const START_MISSED_AFTER_S: f64 = 0.05;

/// A stream under way. The board decides when it plays and when it waits for samples, and reports this by a flag. While
/// it plays, its value is interpolated linearly between the host's samples.
#[derive(Debug)]
pub(super) struct HostStream {
    decoder: Decoder,
    tick_hz: f64,
    /// Samples from the one that plays now; `first_index` is the index of the first.
    samples: VecDeque<u16>,
    first_index: u64,
    samples_per_tick: f64,
    phase: Phase,
    /// Index of the sample that plays now, plus the fraction of the interval to the next one.
    place: f64,
    /// The host has sent the end of the stream.
    ended: bool,
    /// Weight of the stream's layers, from 0 to 1.
    weight: f64,
    /// The board last reported that it waits for samples.
    dry: bool,
    /// Ticks since the board may have begun to play.
    ticks_with_samples: u32,
    /// Changes of layers that the caller has not taken yet.
    layer_changes: Vec<LayerChange>,
}

/// A change of a layer while it plays.
#[derive(Clone, Copy, Debug)]
pub(super) struct LayerChange {
    /// Number of the record, from zero.
    pub(super) layer: u8,
    pub(super) on: bool,
    pub(super) gain: f32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// There is no stream, or it is over.
    Over,
    /// The host has started the stream, and the board has not reported that it waits for samples.
    Requested,
    /// The board waits for samples.
    Waiting,
    /// The board reached the sample at this place in this tick, and leaves it two ticks later.
    Begun,
    Playing,
}

impl HostStream {
    pub(super) fn new(tick_hz: u32) -> Self {
        Self {
            decoder: Decoder::new(),
            tick_hz: f64::from(tick_hz),
            samples: VecDeque::new(),
            first_index: 0,
            samples_per_tick: 0.0,
            phase: Phase::Over,
            place: 0.0,
            ended: false,
            weight: 0.0,
            dry: false,
            ticks_with_samples: 0,
            layer_changes: Vec::new(),
        }
    }

    /// Reads bytes that the host sends.
    pub(super) fn receive(&mut self, mut bytes: &[u8]) {
        let mut decoder = std::mem::take(&mut self.decoder);
        while let Some(payload) = decoder.next_frame(&mut bytes) {
            match Payload::parse_from_host(payload) {
                Ok(Payload::Request(Request { command, .. })) => self.handle(command),
                Ok(Payload::Samples { first_index, samples }) => self.append(first_index, samples),
                _ => {}
            }
        }
        self.decoder = decoder;
    }

    /// Advances by `ticks` ticks. `dry` is the board's report after the last of them, whether it waits for samples;
    /// `None` if there was no report. Returns the sample, from 0 to 1, and the weight of the stream's layers, from 0 to
    /// 1.
    ///
    /// A change between two reports is placed halfway between them.
    pub(super) fn advance(&mut self, ticks: u32, dry: Option<bool>) -> (f64, f64) {
        let before = self.dry;
        self.dry = dry.unwrap_or(before);
        if self.phase == Phase::Over && self.weight <= 0.0 {
            return (0.0, 0.0);
        }
        for tick in 0..ticks {
            self.tick(if tick < ticks / 2 { before } else { self.dry });
        }
        (self.value(), self.weight)
    }

    /// The changes of layers that the host has sent since the last call.
    pub(super) fn take_layer_changes(&mut self) -> Vec<LayerChange> {
        std::mem::take(&mut self.layer_changes)
    }

    fn handle(&mut self, command: Command) {
        match command {
            Command::StartStream { sample_hz, .. } => {
                self.samples.clear();
                self.samples_per_tick = f64::from(sample_hz) / self.tick_hz;
                (self.phase, self.first_index, self.place, self.ended) = (Phase::Requested, 0, 0.0, false);
                self.ticks_with_samples = 0;
            }
            Command::EndStream => self.ended = true,
            Command::SetLayer { layer, on, gain } => self.layer_changes.push(LayerChange { layer, on, gain }),
            Command::Stop | Command::Disarm => (self.phase, self.weight) = (Phase::Over, 0.0),
            _ => {}
        }
    }

    /// Appends samples. If the index is already in the buffer, the new samples replace those from that index on.
    fn append(&mut self, first_index: u32, samples: &[[u8; 2]]) {
        // Indices on the line are modulo 2^32.
        let offset = first_index.wrapping_sub(self.first_index as u32) as usize;
        if offset <= self.samples.len() {
            self.samples.truncate(offset);
            self.samples.extend(samples.iter().map(|sample| u16::from_le_bytes(*sample)));
        }
    }

    fn tick(&mut self, dry: bool) {
        self.phase = match (self.phase, dry) {
            (Phase::Over, _) => Phase::Over,
            (Phase::Requested, false) => self.wait_for_report(),
            (Phase::Requested | Phase::Waiting, true) => Phase::Waiting,
            (Phase::Waiting, false) => self.begin(),
            (Phase::Begun | Phase::Playing, true) => {
                // While the board fades the stream out, it holds the sample that it has reached.
                self.place = self.place.round();
                Phase::Waiting
            }
            (Phase::Begun, false) => Phase::Playing,
            (Phase::Playing, false) => self.play(),
        };
        let step = 1.0 / (FADE_S * self.tick_hz);
        let plays = matches!(self.phase, Phase::Begun | Phase::Playing);
        self.weight = if plays { (self.weight + step).min(1.0) } else { (self.weight - step).max(0.0) };
    }

    /// Handles a tick before the board has reported that it waits for samples: the request may still be in transit.
    fn wait_for_report(&mut self) -> Phase {
        self.ticks_with_samples += u32::from(!self.samples.is_empty());
        let missed = f64::from(self.ticks_with_samples) > START_MISSED_AFTER_S * self.tick_hz;
        if missed { self.begin() } else { Phase::Requested }
    }

    /// Begins to play. If the stream still fades out, the board continues from the sample that it held; otherwise it
    /// begins with the sample that it waited for.
    fn begin(&mut self) -> Phase {
        if self.weight > 0.0 {
            return Phase::Playing;
        }
        if self.place > 0.0 {
            self.place += 1.0;
        }
        Phase::Begun
    }

    fn play(&mut self) -> Phase {
        self.place += self.samples_per_tick;
        let end = self.first_index + self.samples.len() as u64;
        let last = end.saturating_sub(1) as f64;
        let over = self.place >= last;
        if over {
            self.place = last;
        }
        self.forget_played();
        if over && self.ended { Phase::Over } else { Phase::Playing }
    }

    /// Drops samples that were played, so that a stream of any length fits in memory.
    fn forget_played(&mut self) {
        while self.first_index < self.place as u64 && self.samples.len() > 1 {
            self.samples.pop_front();
            self.first_index += 1;
        }
    }

    fn value(&self) -> f64 {
        let before = self.place.floor();
        let offset = (before as u64).saturating_sub(self.first_index) as usize;
        let sample = |at: usize| self.samples.get(at).or(self.samples.back()).map_or(0.0, |sample| f64::from(*sample));
        let (from, to) = (sample(offset), sample(offset + 1));
        (from + (self.place - before) * (to - from)) / f64::from(u16::MAX)
    }
}
