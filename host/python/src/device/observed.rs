//! A link that keeps the telemetry of its board.

use std::time::Duration;

use frixel_driver::{Link, LinkClosed, Written};
use frixel_play::Recorded;
use frixel_wire::message::Telemetry;

/// A link to a board, with the telemetry that was received and not yet passed on.
pub(super) struct Observed<L> {
    link: L,
    telemetry: Vec<Telemetry>,
    /// Records nothing.
    recorder: (),
}

impl<L> Observed<L> {
    pub(super) fn new(link: L) -> Self {
        Self { link, telemetry: Vec::new(), recorder: () }
    }

    /// The telemetry since the last call.
    pub(super) fn take_telemetry(&mut self) -> Vec<Telemetry> {
        std::mem::take(&mut self.telemetry)
    }
}

impl<L> Recorded for Observed<L> {
    type Recorder = ();

    fn recorder_mut(&mut self) -> &mut () {
        &mut self.recorder
    }

    fn record(&mut self, telemetry: &[Telemetry]) {
        self.telemetry.extend_from_slice(telemetry);
    }
}

impl<L: Link> Link for Observed<L> {
    fn write(&mut self, frame: &[u8]) -> Result<u64, LinkClosed> {
        self.link.write(frame)
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        self.link.read(buffer, wait)
    }

    fn now(&self) -> Duration {
        self.link.now()
    }

    fn keep_alive(&mut self, period: Duration) {
        self.link.keep_alive(period);
    }

    fn set_shutdown_frames(&mut self, frames: Vec<u8>) {
        self.link.set_shutdown_frames(frames);
    }

    fn written(&self) -> Written {
        self.link.written()
    }

    fn name(&self) -> &str {
        self.link.name()
    }
}
