//! The reference of a stream of samples, independent of the firmware that plays it.

use std::collections::VecDeque;

/// Time in which a stream fades in and out, s (`PROTOCOL.md`, section 14).
const FADE_S: f64 = 0.01;
/// Time for which a board may have had samples without reporting underrun or play, s. Afterwards the recorder assumes
/// that a report was lost between two telemetry messages, and that the stream plays.
const START_MISSED_AFTER_S: f64 = 0.05;

/// A stream in progress. A flag of the board reports whether it plays or waits for samples. While it plays, its value
/// is interpolated linearly between the host's samples.
#[derive(Debug, Default)]
pub(super) struct Stream {
    tick_hz: f64,
    /// Samples from the current one on; `first_index` is the index of the first.
    samples: VecDeque<u16>,
    first_index: u64,
    samples_per_tick: f64,
    phase: Phase,
    /// Index of the current sample, plus the fraction of the interval to the next one.
    place: f64,
    /// Whether the host has ended the stream.
    ended: bool,
    /// Weight of the stream's layers, from 0 to 1.
    weight: f64,
    /// Whether the board last reported that it waits for samples.
    dry: bool,
    /// Ticks since the board may have begun to play.
    ticks_with_samples: u32,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Phase {
    /// There is no stream, or it is over.
    #[default]
    Over,
    /// The host has started the stream, but the board has not reported yet that it waits for samples.
    Requested,
    /// The board waits for samples.
    Waiting,
    /// The board reached the sample at this place in this tick, and leaves it two ticks later.
    Begun,
    Playing,
}

impl Stream {
    pub(super) fn new(tick_hz: u32) -> Self {
        Self { tick_hz: f64::from(tick_hz), ..Self::default() }
    }

    /// Starts a stream of `sample_hz` samples per second.
    pub(super) fn start(&mut self, sample_hz: u32) {
        self.samples.clear();
        self.samples_per_tick = f64::from(sample_hz) / self.tick_hz;
        (self.phase, self.first_index, self.place, self.ended) = (Phase::Requested, 0, 0.0, false);
        self.ticks_with_samples = 0;
    }

    /// Appends samples.
    pub(super) fn append(&mut self, samples: &[u16]) {
        self.samples.extend(samples);
    }

    /// Ends the stream after its last sample.
    pub(super) fn end(&mut self) {
        self.ended = true;
    }

    /// Ends the stream at once, because the output is off.
    pub(super) fn stop(&mut self) {
        (self.phase, self.weight) = (Phase::Over, 0.0);
    }

    /// Advances by `ticks` ticks. `dry` is the board's report after the last tick that it waits for samples; `None`
    /// without a report. Returns the sample, from 0 to 1, and the weight of the stream's layers, from 0 to 1.
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

    /// Handles a tick before the board has reported that it waits for samples; the request may still be in transit.
    fn wait_for_report(&mut self) -> Phase {
        self.ticks_with_samples += u32::from(!self.samples.is_empty());
        let missed = f64::from(self.ticks_with_samples) > START_MISSED_AFTER_S * self.tick_hz;
        if missed { self.begin() } else { Phase::Requested }
    }

    /// Begins to play. A stream that still fades out continues from the held sample; otherwise it begins with the
    /// sample that it waited for.
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
