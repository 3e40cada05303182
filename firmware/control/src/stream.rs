//! A stream: samples that the host sends while a scene plays, with a jitter buffer.
//!
//! Session and tick share the memory of a [`StreamBuffer`]. The session writes samples into it through a
//! [`StreamIntake`]; the tick plays them through a [`Player`]. Neither waits for the other.
//!
//! A sample has a *position*: its index, counted over all streams, modulo 2^32. Each slot of the buffer stores a sample
//! with its round of the ring, so that an old sample is not mistaken for the next one. The round has 16 bits: the check
//! fails only for a slot that was skipped 65,535 times in a row.

use core::num::NonZeroU32;
use core::sync::atomic::{AtomicU32, Ordering};
use frixel_layers::StreamSample;
use frixel_model::divide_wide;
use frixel_wire::payload::SAMPLES_MAX;

/// Capacity of a stream's buffer, in samples.
pub const STREAM_LEN: usize = 1024;

const LEN: u32 = STREAM_LEN as u32;
/// Time in which a stream fades in and out, in s. Short compared with a touch, long compared with a carrier edge.
const FADE_S: f32 = 0.01;
/// One sample, in units of [`StreamStart::step`].
const ONE: u32 = 1 << 31;
const VALUE_PER_SAMPLE: f32 = 1.0 / 65_535.0;

/// Samples written by the session and not yet read by the tick.
///
/// Every slot is an atomic, which costs nothing on a Cortex-M and needs no `unsafe`.
pub struct StreamBuffer {
    /// The sample in the low half, its round in the high half. Initially zero, so that the buffer takes no space in
    /// flash.
    slots: [AtomicU32; STREAM_LEN],
    /// Position after the last sample received; written by the session.
    end: AtomicU32,
    /// Position of the sample that the player takes next; written by the tick.
    next: AtomicU32,
    /// Positions of the current stream before `end` whose samples have not arrived; written by the session.
    holes: AtomicU32,
}

impl StreamBuffer {
    /// An empty buffer.
    #[allow(clippy::new_without_default, reason = "it belongs in a static, not on the stack")]
    pub const fn new() -> Self {
        Self {
            slots: [const { AtomicU32::new(0) }; STREAM_LEN],
            end: AtomicU32::new(0),
            next: AtomicU32::new(0),
            holes: AtomicU32::new(0),
        }
    }

    fn put(&self, position: u32, sample: u16) {
        if let Some(slot) = self.slots.get((position % LEN) as usize) {
            slot.store(round(position) | u32::from(sample), Ordering::Relaxed);
        }
    }

    #[inline]
    fn get(&self, position: u32) -> Option<u16> {
        let slot = self.slots.get((position % LEN) as usize)?.load(Ordering::Relaxed);
        (slot & !0xffff == round(position)).then_some(slot as u16)
    }
}

/// The round of a position, in the high half. The first round is 1, since an unused slot holds 0.
#[inline]
fn round(position: u32) -> u32 {
    (position / LEN + 1) << 16
}

/// Number of samples from `from` to `to`; 0 if `to` is before `from`.
#[inline]
fn count(from: u32, to: u32) -> u32 {
    (to.wrapping_sub(from) as i32).max(0) as u32
}

/// Start parameters of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StreamStart {
    /// Position of its first sample.
    pub(crate) first: u32,
    /// Samples per tick, in units of 2^-31.
    pub(crate) step: u32,
    /// Samples that must have arrived before the stream plays.
    pub(crate) start_level: u32,
}

/// The session's side of a [`StreamBuffer`]: stores the samples sent by the host.
pub struct StreamIntake<'a> {
    buffer: &'a StreamBuffer,
    /// Position of the current stream's first sample; `None` without a stream.
    first: Option<u32>,
}

impl<'a> StreamIntake<'a> {
    /// An intake into `buffer`, without a stream.
    pub fn new(buffer: &'a StreamBuffer) -> Self {
        Self { buffer, first: None }
    }

    /// Begins a stream of `sample_hz` samples a second, from 1 to `tick_hz`.
    pub fn start(&mut self, sample_hz: u32, tick_hz: u32, start_level: u16) -> StreamStart {
        let first = self.buffer.end.load(Ordering::Relaxed);
        self.first = Some(first);
        self.buffer.holes.store(0, Ordering::Relaxed);
        // In units of `ONE`, half of 2^32. Without a tick rate no sample is played.
        let step = NonZeroU32::new(tick_hz).map_or(0, |tick_hz| (divide_wide(sample_hz, 0, tick_hz).0 >> 1) as u32);
        StreamStart { first, step, start_level: u32::from(start_level) }
    }

    /// Ends the stream: no more samples are taken. Returns the position after the last one; `None` without a stream.
    pub fn end(&mut self) -> Option<u32> {
        self.first.take().map(|_| self.buffer.end.load(Ordering::Relaxed))
    }

    /// Stores little-endian samples, the first of which has the index `first_index`. Samples that are late, do not fit,
    /// or arrive without a stream are dropped.
    pub fn take(&mut self, first_index: u32, samples: &[[u8; 2]]) {
        let Some(first) = self.first else { return };
        let next_position = self.next_position(first);
        let mut end = self.buffer.end.load(Ordering::Relaxed);
        let mut holes = self.buffer.holes.load(Ordering::Relaxed);
        let mut position = first.wrapping_add(first_index);
        for sample in samples {
            if position.wrapping_sub(next_position) < LEN {
                let after = position.wrapping_add(1);
                if count(end, after) > 0 {
                    holes = holes.wrapping_add(count(end, position));
                    end = after;
                } else if self.buffer.get(position).is_none() {
                    holes = holes.wrapping_sub(1);
                }
                self.buffer.put(position, u16::from_le_bytes(*sample));
            }
            position = position.wrapping_add(1);
        }
        self.buffer.holes.store(holes, Ordering::Relaxed);
        self.buffer.end.store(end, Ordering::Release);
    }

    /// Index after the last sample received, and the number of further samples that fit; `None` without a stream.
    pub fn progress(&self) -> Option<(u32, u16)> {
        let first = self.first?;
        let end = self.buffer.end.load(Ordering::Relaxed);
        let room = LEN.saturating_sub(count(self.next_position(first), end));
        Some((end.wrapping_sub(first), room as u16))
    }

    /// Position that the player needs next: the stream's first one until the player has started the stream.
    fn next_position(&self, first: u32) -> u32 {
        let next = self.buffer.next.load(Ordering::Relaxed);
        if count(first, next) > 0 { next } else { first }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// There is no stream, or it is over.
    Over,
    /// Waits until enough samples have arrived.
    Filling,
    Playing,
}

/// Plays a stream, one tick at a time.
pub(crate) struct Player<'a> {
    /// `None` on a board without a stream buffer, which plays nothing.
    buffer: Option<&'a StreamBuffer>,
    phase: Phase,
    start: StreamStart,
    /// Position after the last sample, once the host has ended the stream.
    last: Option<u32>,
    /// Position of the sample after `to`.
    next: u32,
    /// The samples before and after the current time, and the fraction of the interval between them.
    from: f32,
    to: f32,
    fraction: u32,
    /// Whether the next sample has not arrived, so that `to` still holds the previous one.
    missing: bool,
    /// Holes of this stream before `next`, whose samples never arrived.
    skipped: u32,
    weight: f32,
    fade_step: f32,
    underruns: u32,
    gaps: u32,
}

impl<'a> Player<'a> {
    pub(crate) fn new(tick_period_s: f32) -> Self {
        Self {
            buffer: None,
            phase: Phase::Over,
            start: StreamStart { first: 0, step: 0, start_level: 0 },
            last: None,
            next: 0,
            from: 0.0,
            to: 0.0,
            fraction: 0,
            missing: false,
            skipped: 0,
            weight: 0.0,
            fade_step: tick_period_s / FADE_S,
            underruns: 0,
            gaps: 0,
        }
    }

    /// Plays streams from `buffer` from now on.
    pub(crate) fn attach(&mut self, buffer: &'a StreamBuffer) {
        self.buffer = Some(buffer);
    }

    /// Begins another stream. The current value fades out while samples arrive.
    pub(crate) fn start(&mut self, start: StreamStart) {
        if self.buffer.is_none() {
            return;
        }
        let held = self.now().value;
        (self.from, self.to, self.fraction) = (held, held, 0);
        self.start = start;
        self.last = None;
        self.phase = Phase::Filling;
        self.missing = false;
        self.skipped = 0;
        self.go_to(start.first);
    }

    /// Ends the stream before position `last`.
    pub(crate) fn end(&mut self, last: u32) {
        self.last = Some(last);
    }

    /// Stops the stream at once, without a fade, and clears `now`.
    pub(crate) fn stop(&mut self, now: &mut StreamSample) {
        self.phase = Phase::Over;
        self.weight = 0.0;
        *now = StreamSample::default();
    }

    /// Whether the stream waits for samples, or the next one is missing.
    pub(crate) fn is_dry(&self) -> bool {
        match self.phase {
            Phase::Over => false,
            Phase::Filling => true,
            Phase::Playing => self.missing,
        }
    }

    /// Whether the stream has ended and has faded out.
    fn is_over(&self) -> bool {
        self.phase == Phase::Over && self.weight <= 0.0
    }

    /// Number of underruns, and of runs of samples that never arrived, since power-on.
    pub(crate) fn counts(&self) -> (u32, u32) {
        (self.underruns, self.gaps)
    }

    /// The stream's current value and weight.
    #[inline]
    fn now(&self) -> StreamSample {
        let part = self.fraction as f32 * (1.0 / ONE as f32);
        StreamSample { value: self.from + part * (self.to - self.from), weight: self.weight }
    }

    /// Advances by a tick, and sets `now` to the stream's sample, unless the stream is over.
    #[inline]
    pub(crate) fn advance(&mut self, now: &mut StreamSample) {
        if !self.is_over() {
            self.step();
            *now = self.now();
        }
    }

    #[inline(never)]
    fn step(&mut self) {
        match self.phase {
            Phase::Over => {}
            Phase::Filling => self.begin_when_filled(),
            Phase::Playing => {
                self.fraction += self.start.step;
                if self.fraction >= ONE {
                    self.fraction -= ONE;
                    self.from = self.to;
                    self.take_next();
                }
            }
        }
        self.weight = if self.phase == Phase::Playing && !self.missing {
            (self.weight + self.fade_step).min(1.0)
        } else {
            (self.weight - self.fade_step).max(0.0)
        };
    }

    fn begin_when_filled(&mut self) {
        let Some(buffer) = self.buffer else { return };
        let end = buffer.end.load(Ordering::Acquire);
        let span = count(self.next, end);
        let holes = count(self.skipped, buffer.holes.load(Ordering::Relaxed));
        let there = span.saturating_sub(holes);
        // Without room for another frame, no further sample arrives.
        let is_full = span + SAMPLES_MAX as u32 > LEN;
        if there >= self.start.start_level || is_full || (span > 0 && self.last == Some(end)) {
            self.phase = Phase::Playing;
            self.take_next();
            if self.weight <= 0.0 {
                // Start at the first sample; the next tick takes the second.
                self.fraction = ONE - self.start.step;
            }
        } else if span == 0 && self.last == Some(self.next) {
            self.phase = Phase::Over;
        }
    }

    /// Takes the next sample into `to`.
    fn take_next(&mut self) {
        let Some(buffer) = self.buffer else { return };
        if let Some(sample) = buffer.get(self.next).filter(|_| self.last != Some(self.next)) {
            self.to = f32::from(sample) * VALUE_PER_SAMPLE;
            self.missing = false;
            if self.weight <= 0.0 {
                // The previous value has faded out: do not interpolate from it.
                self.from = self.to;
            }
        } else if self.last == Some(self.next) {
            return self.end_here(Phase::Over);
        } else if count(self.next, buffer.end.load(Ordering::Acquire)) == 0 {
            self.underruns = self.underruns.wrapping_add(1);
            return self.end_here(Phase::Filling);
        } else {
            if !self.missing {
                self.gaps = self.gaps.wrapping_add(1);
            }
            self.missing = true;
            self.skipped = self.skipped.wrapping_add(1);
        }
        self.go_to(self.next.wrapping_add(1));
    }

    /// Holds the last sample while it fades out.
    fn end_here(&mut self, phase: Phase) {
        self.phase = phase;
        self.missing = false;
        self.fraction = 0;
    }

    fn go_to(&mut self, next: u32) {
        self.next = next;
        if let Some(buffer) = self.buffer {
            buffer.next.store(next, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests;
