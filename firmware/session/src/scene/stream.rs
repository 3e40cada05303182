//! The stream sent by the host.

use frixel_control::{Order, StreamBuffer, StreamIntake};

/// Frames of samples per progress report: less than 1 KiB, as with uploads.
const PROGRESS_FRAMES: u32 = 4;
/// Longest time between progress reports, in s.
pub(crate) const PROGRESS_PERIOD_S: f32 = 0.02;

/// Takes the samples of streams, and determines when their progress is to be reported.
pub(crate) struct Stream<'a> {
    /// `None` on a board without a stream buffer.
    intake: Option<StreamIntake<'a>>,
    /// Frames of samples since the last progress report.
    frames: u32,
    reported_at_tick: u32,
    /// Whether to send a progress report as soon as there is room.
    report_due: bool,
}

impl<'a> Stream<'a> {
    pub(super) const fn new() -> Self {
        Self { intake: None, frames: 0, reported_at_tick: 0, report_due: false }
    }

    /// Stores samples in `buffer` from now on.
    pub(crate) fn attach(&mut self, buffer: &'a StreamBuffer) {
        self.intake = Some(StreamIntake::new(buffer));
    }

    pub(crate) fn is_attached(&self) -> bool {
        self.intake.is_some()
    }

    /// Begins a stream, and returns the order that plays it; `None` on a board without a stream buffer.
    pub(super) fn start(&mut self, sample_hz: u32, tick_hz: u32, start_level: u16) -> Option<Order<'a>> {
        let start = self.intake.as_mut()?.start(sample_hz, tick_hz, start_level);
        self.report_due = true;
        Some(Order::StartStream(start))
    }

    /// Stops taking samples, and returns the order that ends the stream after the last one; `None` without a stream.
    /// The order is not needed if the ticker stops the stream itself: when it leaves the Active state, or loads a scene
    /// without a stream.
    pub(crate) fn end(&mut self) -> Option<Order<'a>> {
        self.intake.as_mut()?.end().map(|end| Order::EndStream { end })
    }

    pub(crate) fn take(&mut self, first_index: u32, samples: &[[u8; 2]]) {
        if let Some(intake) = &mut self.intake {
            intake.take(first_index, samples);
            self.frames += 1;
            self.report_due |= self.frames >= PROGRESS_FRAMES;
        }
    }

    /// The progress to report: the index after the last received sample, and the room for further ones; `None` if no
    /// report is due.
    pub(crate) fn progress_due(&self, now_tick: u32, period_ticks: u32) -> Option<(u32, u16)> {
        let progress = self.intake.as_ref()?.progress()?;
        let period_over = now_tick.wrapping_sub(self.reported_at_tick) >= period_ticks;
        (self.report_due || period_over).then_some(progress)
    }

    /// Records that the progress was reported. Until then, [`Self::progress_due`] returns it again.
    pub(crate) fn reported(&mut self, now_tick: u32) {
        self.report_due = false;
        self.frames = 0;
        self.reported_at_tick = now_tick;
    }
}
