//! The record of a play, beside the link to the board.

use frixel_driver::{ByteStream, LinkClosed, PollingLink};
use frixel_felt::recorder::PlayListener;
use frixel_wire::message::Telemetry;

/// A link, or a byte stream, with a record of what the board at its other end plays.
pub trait Recorded {
    /// The recorder of the play.
    type Recorder: PlayListener;

    /// The recorder of the play.
    fn recorder_mut(&mut self) -> &mut Self::Recorder;

    /// Called whenever the scene begins to play. The first call starts the recording and a simulated finger's stroke.
    fn begin(&mut self) -> Result<(), LinkClosed> {
        Ok(())
    }

    /// Records what has been observed of the board since the last call, and the telemetry received since then.
    fn record(&mut self, telemetry: &[Telemetry]) {
        let _ = telemetry;
    }

    /// Records the ticks that still wait for telemetry, after the last message.
    fn record_rest(&mut self) {}
}

impl<S: ByteStream + Recorded> Recorded for PollingLink<S> {
    type Recorder = S::Recorder;

    fn recorder_mut(&mut self) -> &mut S::Recorder {
        self.stream_mut().recorder_mut()
    }

    fn begin(&mut self) -> Result<(), LinkClosed> {
        self.stream_mut().begin()
    }

    fn record(&mut self, telemetry: &[Telemetry]) {
        self.stream_mut().record(telemetry);
    }

    fn record_rest(&mut self) {
        self.stream_mut().record_rest();
    }
}
