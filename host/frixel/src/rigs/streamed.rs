//! What a host streams, as a finger should feel it: heard on the line, and independent of the firmware that plays it.

use frixel_wire::fault::Flags;
use frixel_wire::frame::Decoder;
use frixel_wire::message::{Command, Request};
use frixel_wire::payload::Payload;

/// Time in which a stream fades in and out, in s (PROTOCOL, section 15).
const FADE_S: f64 = 0.01;

/// The stream of a host, from the frames that it sends. When it plays, waits and goes on, the board decides and tells; what
/// it is worth then are straight lines between the host's samples.
pub(super) struct Streamed {
    decoder: Decoder,
    tick_hz: f64,
    samples: Vec<u16>,
    samples_per_tick: f64,
    phase: Phase,
    /// Place among the samples.
    place: f64,
    /// Whether the host has said that no more samples come.
    ended: bool,
    weight: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// No stream, or one that is over.
    Over,
    /// The host has started it, and the board has not taken notice.
    Asked,
    /// The board waits for samples.
    Waiting,
    /// The sample at this place came with this tick: it is left at the tick after the next.
    Begun,
    Playing,
}

impl Streamed {
    pub(super) fn new(tick_hz: u32) -> Self {
        Self {
            decoder: Decoder::new(),
            tick_hz: f64::from(tick_hz),
            samples: Vec::new(),
            samples_per_tick: 0.0,
            phase: Phase::Over,
            place: 0.0,
            ended: false,
            weight: 0.0,
        }
    }

    /// Hears what the host sends.
    pub(super) fn hear(&mut self, mut bytes: &[u8]) {
        let mut decoder = std::mem::take(&mut self.decoder);
        while let Some(payload) = decoder.next_frame(&mut bytes) {
            match Payload::parse_from_host(payload) {
                Ok(Payload::Request(Request { command, .. })) => self.obey(command),
                Ok(Payload::Samples { first_index, samples }) => self.keep(first_index, samples),
                _ => {}
            }
        }
        self.decoder = decoder;
    }

    /// The sample, from 0 to 1, and how much of the stream's layers there is, from 0 to 1, at the next tick, whose flags
    /// these are.
    pub(super) fn next(&mut self, flags: Flags) -> (f64, f64) {
        self.go_on(flags.contains(Flags::STREAM_DRY));
        let step = 1.0 / (FADE_S * self.tick_hz);
        let plays = matches!(self.phase, Phase::Begun | Phase::Playing);
        self.weight = if plays { (self.weight + step).min(1.0) } else { (self.weight - step).max(0.0) };
        (self.value(), self.weight)
    }

    fn obey(&mut self, command: Command) {
        match command {
            Command::StartStream { sample_hz, .. } => {
                self.samples.clear();
                self.samples_per_tick = f64::from(sample_hz) / self.tick_hz;
                (self.phase, self.place, self.ended) = (Phase::Asked, 0.0, false);
            }
            Command::EndStream => self.ended = true,
            Command::Stop | Command::Disarm => (self.phase, self.weight) = (Phase::Over, 0.0),
            _ => {}
        }
    }

    fn keep(&mut self, first_index: u32, samples: &[[u8; 2]]) {
        let first = first_index as usize;
        if first <= self.samples.len() {
            self.samples.truncate(first);
            self.samples.extend(samples.iter().map(|sample| u16::from_le_bytes(*sample)));
        }
    }

    fn go_on(&mut self, dry: bool) {
        self.phase = match (self.phase, dry) {
            (Phase::Over, _) => Phase::Over,
            (Phase::Asked, false) => Phase::Asked,
            (Phase::Asked | Phase::Waiting, true) => Phase::Waiting,
            (Phase::Waiting, false) => self.begin(),
            (Phase::Begun | Phase::Playing, true) => {
                // The sample that the board has come to is held, and fades.
                self.place = self.place.round();
                Phase::Waiting
            }
            (Phase::Begun, false) => Phase::Playing,
            (Phase::Playing, false) => self.play(),
        };
    }

    /// What has faded is nothing to go on from: then the sample that was waited for is there at once.
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
        let last = self.samples.len().saturating_sub(1) as f64;
        if self.place < last {
            return Phase::Playing;
        }
        self.place = last;
        if self.ended { Phase::Over } else { Phase::Playing }
    }

    fn value(&self) -> f64 {
        let before = self.place as usize;
        let sample = |at: usize| self.samples.get(at).or(self.samples.last()).map_or(0.0, |sample| f64::from(*sample));
        let (from, to) = (sample(before), sample(before + 1));
        (from + (self.place - before as f64) * (to - from)) / f64::from(u16::MAX)
    }
}
