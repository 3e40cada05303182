//! A stream: samples that the host sends while a scene plays, behind a jitter buffer.
//!
//! The [`StreamBuffer`] is memory that both sides share. The session puts samples into it through an [`StreamIntake`]; the
//! tick plays them through a [`Player`], and never waits for the other side.
//!
//! A sample has a *position*: its index, counted on from all streams before it, modulo 2^32. A slot of the buffer keeps
//! with its sample the round of the ring that it belongs to, so that a sample of another round is not mistaken for the
//! one that is due. Rounds have 16 bits: only a slot that was passed over 65,535 times in a row could deceive.

use core::sync::atomic::{AtomicU32, Ordering};
use frixel_layers::StreamSample;

/// Samples that a stream's buffer holds.
pub const STREAM_LEN: usize = 1024;

const LEN: u32 = STREAM_LEN as u32;
/// Time in which a stream fades in and out, in s. Short beside a touch, long beside the edge of a carrier.
const FADE_S: f32 = 0.01;
/// One sample, in the player's steps.
const ONE: u32 = 1 << 31;
const VALUE_PER_SAMPLE: f32 = 1.0 / 65_535.0;

/// Samples on their way from the session, which writes, to the tick, which reads.
///
/// Every slot is an atomic of its own, which costs nothing on a Cortex-M and keeps the sharing free of `unsafe`.
pub struct StreamBuffer {
    /// The sample in the low half, its round in the high half; all zeros, so that no image of it lies in flash.
    slots: [AtomicU32; STREAM_LEN],
    /// Position behind the last sample that came; the session's to write.
    end: AtomicU32,
    /// Position of the sample that the player takes next; the tick's to write.
    next: AtomicU32,
}

impl StreamBuffer {
    /// An empty buffer.
    #[allow(clippy::new_without_default, reason = "it belongs in a static, not into a value made in passing")]
    pub const fn new() -> Self {
        Self { slots: [const { AtomicU32::new(0) }; STREAM_LEN], end: AtomicU32::new(0), next: AtomicU32::new(0) }
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

/// The round of a position, in the high half. The first one is 1, since a slot that was never filled says 0.
#[inline]
fn round(position: u32) -> u32 {
    (position / LEN + 1) << 16
}

/// Samples from `from` to `to`; none when `to` is behind.
#[inline]
fn count(from: u32, to: u32) -> u32 {
    (to.wrapping_sub(from) as i32).max(0) as u32
}

/// A stream that is to begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StreamStart {
    /// Position of its first sample.
    pub(crate) first: u32,
    /// Part of a sample that a tick goes on by, in 2^-31.
    pub(crate) step: u32,
    /// Samples that have to be there before it plays.
    pub(crate) start_level: u32,
}

/// Where the session puts the samples that the host sends.
pub struct StreamIntake<'a> {
    buffer: &'a StreamBuffer,
    /// Position of the stream's first sample, while one is under way.
    first: Option<u32>,
}

impl<'a> StreamIntake<'a> {
    /// An intake into `buffer`, without a stream.
    pub fn new(buffer: &'a StreamBuffer) -> Self {
        Self { buffer, first: None }
    }

    /// Begins a stream of so many samples a second, at most the ticks a second, and at least 1.
    pub fn start(&mut self, sample_hz: u32, tick_hz: u32, start_level: u16) -> StreamStart {
        let first = self.buffer.end.load(Ordering::Relaxed);
        self.first = Some(first);
        let step = (u64::from(ONE) * u64::from(sample_hz) / u64::from(tick_hz)) as u32;
        StreamStart { first, step, start_level: u32::from(start_level) }
    }

    /// Ends the stream: no more samples are taken. Returns the position behind the last one; `None` without a stream.
    pub fn end(&mut self) -> Option<u32> {
        self.first.take().map(|_| self.buffer.end.load(Ordering::Relaxed))
    }

    /// Takes samples, little-endian, from an index on. What was due before, what there is no room for, and what comes
    /// without a stream is dropped.
    pub fn take(&mut self, first_index: u32, samples: &[[u8; 2]]) {
        let Some(first) = self.first else { return };
        let due = self.due(first);
        let mut end = self.buffer.end.load(Ordering::Relaxed);
        let mut position = first.wrapping_add(first_index);
        for sample in samples {
            if position.wrapping_sub(due) < LEN {
                self.buffer.put(position, u16::from_le_bytes(*sample));
                if count(end, position.wrapping_add(1)) > 0 {
                    end = position.wrapping_add(1);
                }
            }
            position = position.wrapping_add(1);
        }
        self.buffer.end.store(end, Ordering::Release);
    }

    /// Index behind the last sample that came, and for how many from there on there is room; `None` without a stream.
    pub fn progress(&self) -> Option<(u32, u16)> {
        let first = self.first?;
        let end = self.buffer.end.load(Ordering::Relaxed);
        let room = LEN.saturating_sub(count(self.due(first), end));
        Some((end.wrapping_sub(first), room as u16))
    }

    /// Position that is due next: the stream's first one until the player has begun with it.
    fn due(&self, first: u32) -> u32 {
        let next = self.buffer.next.load(Ordering::Relaxed);
        if count(first, next) > 0 { next } else { first }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// There is no stream, or it is over.
    Over,
    /// Waits until enough samples are there.
    Filling,
    Playing,
}

/// Plays a stream, one tick at a time.
pub(crate) struct Player<'a> {
    buffer: &'a StreamBuffer,
    phase: Phase,
    start: StreamStart,
    /// Position behind the last sample, once that is known.
    last: Option<u32>,
    /// Position of the sample behind `to`.
    next: u32,
    /// The samples on either side of now, and how far it is from the first to the second.
    from: f32,
    to: f32,
    fraction: u32,
    /// The sample that is due is not there: `to` is the one before.
    missing: bool,
    weight: f32,
    fade_step: f32,
    underruns: u32,
    gaps: u32,
}

impl<'a> Player<'a> {
    pub(crate) fn new(buffer: &'a StreamBuffer, tick_period_s: f32) -> Self {
        Self {
            buffer,
            phase: Phase::Over,
            start: StreamStart { first: 0, step: 0, start_level: 0 },
            last: None,
            next: 0,
            from: 0.0,
            to: 0.0,
            fraction: 0,
            missing: false,
            weight: 0.0,
            fade_step: tick_period_s / FADE_S,
            underruns: 0,
            gaps: 0,
        }
    }

    /// Begins another stream; what plays fades out meanwhile.
    pub(crate) fn start(&mut self, start: StreamStart) {
        let held = self.now().value;
        (self.from, self.to, self.fraction) = (held, held, 0);
        self.start = start;
        self.last = None;
        self.phase = Phase::Filling;
        self.missing = false;
        self.go_to(start.first);
    }

    /// No sample comes from position `last` on.
    pub(crate) fn end(&mut self, last: u32) {
        self.last = Some(last);
    }

    /// Forgets the stream at once.
    pub(crate) fn stop(&mut self) {
        self.phase = Phase::Over;
        self.weight = 0.0;
    }

    /// The stream waits for samples, or misses the one that is due.
    pub(crate) fn is_dry(&self) -> bool {
        match self.phase {
            Phase::Over => false,
            Phase::Filling => true,
            Phase::Playing => self.missing,
        }
    }

    /// Nothing plays, and nothing fades.
    pub(crate) fn is_over(&self) -> bool {
        self.phase == Phase::Over && self.weight <= 0.0
    }

    /// Times that the stream ran dry, and runs of samples that never came, since power-on.
    pub(crate) fn counts(&self) -> (u32, u32) {
        (self.underruns, self.gaps)
    }

    /// What the stream is worth now.
    #[inline]
    pub(crate) fn now(&self) -> StreamSample {
        let part = self.fraction as f32 * (1.0 / ONE as f32);
        StreamSample { value: self.from + part * (self.to - self.from), weight: self.weight }
    }

    /// Goes on by a tick.
    #[inline]
    pub(crate) fn advance(&mut self) {
        if !self.is_over() {
            self.go_on();
        }
    }

    #[inline(never)]
    fn go_on(&mut self) {
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
        let end = self.buffer.end.load(Ordering::Acquire);
        let there = count(self.next, end);
        if there >= self.start.start_level || (there > 0 && self.last == Some(end)) {
            self.phase = Phase::Playing;
            self.take_next();
            if self.weight <= 0.0 {
                // The first sample is reached with it: the next tick takes the second.
                self.fraction = ONE - self.start.step;
            }
        } else if there == 0 && self.last == Some(self.next) {
            self.phase = Phase::Over;
        }
    }

    /// Takes the next sample into `to`, and begins the way there.
    fn take_next(&mut self) {
        if let Some(sample) = self.buffer.get(self.next).filter(|_| self.last != Some(self.next)) {
            self.to = f32::from(sample) * VALUE_PER_SAMPLE;
            self.missing = false;
            if self.weight <= 0.0 {
                // What was held has faded: it is nothing to go on from.
                self.from = self.to;
            }
        } else if self.last == Some(self.next) {
            return self.end_here(Phase::Over);
        } else if count(self.next, self.buffer.end.load(Ordering::Acquire)) == 0 {
            self.underruns = self.underruns.wrapping_add(1);
            return self.end_here(Phase::Filling);
        } else {
            if !self.missing {
                self.gaps = self.gaps.wrapping_add(1);
            }
            self.missing = true;
        }
        self.go_to(self.next.wrapping_add(1));
    }

    /// Holds the last sample while it fades.
    fn end_here(&mut self, phase: Phase) {
        self.phase = phase;
        self.missing = false;
        self.fraction = 0;
    }

    fn go_to(&mut self, next: u32) {
        self.next = next;
        self.buffer.next.store(next, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests;
