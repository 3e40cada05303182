//! A link whose telemetry is kept.

use std::time::Duration;

use frixel_driver::{Link, LinkClosed, Written};
use frixel_felt::recorder::PlayListener;
use frixel_wire::message::Telemetry;

use crate::Recorded;

/// A link to a board that is observed through telemetry only.
pub struct Observed<L, R> {
    link: L,
    recorder: R,
    keep: fn(&mut R, &Telemetry),
}

impl<L, R> Observed<L, R> {
    /// Creates a link that passes each message of the board to `keep`, with `recorder`.
    pub fn new(link: L, recorder: R, keep: fn(&mut R, &Telemetry)) -> Self {
        Self { link, recorder, keep }
    }
}

impl<L, R: PlayListener> Recorded for Observed<L, R> {
    type Recorder = R;

    fn recorder_mut(&mut self) -> &mut R {
        &mut self.recorder
    }

    fn record(&mut self, telemetry: &[Telemetry]) {
        for message in telemetry {
            (self.keep)(&mut self.recorder, message);
        }
    }
}

impl<L: Link, R> Link for Observed<L, R> {
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
