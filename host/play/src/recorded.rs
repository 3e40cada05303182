//! The record of a play, beside the link to the board.

use frixel_driver::{ByteStream, LinkClosed, PollingLink};
use frixel_felt::recorder::Recorder;
use frixel_model::ParameterError;
use frixel_scene::{LayerSetting, Program};
use frixel_wire::hello::Hello;
use frixel_wire::message::Telemetry;

/// Is told what a board is made to play, to compare with what is felt.
pub trait PlayListener {
    /// From now on the board plays this program. Fails if the contact model refuses its finger, which does not happen
    /// for a compiled program.
    fn scene_replaced(&mut self, program: &Program, hello: &Hello) -> Result<(), ParameterError> {
        let _ = (program, hello);
        Ok(())
    }

    /// From now on the layer with this record number, from zero, has this setting.
    fn layer_changed(&mut self, record: u8, setting: LayerSetting) {
        let _ = (record, setting);
    }

    /// A stream of so many samples a second begins.
    fn stream_started(&mut self, sample_hz: u32) {
        let _ = sample_hz;
    }

    /// These samples of the stream follow the earlier ones.
    fn samples_sent(&mut self, samples: &[u16]) {
        let _ = samples;
    }

    /// The stream ends after its last sample.
    fn stream_ended(&mut self) {}

    /// The output goes to zero.
    fn stopped(&mut self) {}

    /// Ticks that remain to be recorded.
    fn ticks_left(&self) -> u64 {
        u64::MAX
    }
}

/// Records nothing.
impl PlayListener for () {}

impl PlayListener for Recorder {
    fn scene_replaced(&mut self, program: &Program, hello: &Hello) -> Result<(), ParameterError> {
        self.scene_replaced(program, &hello.limits)
    }

    fn layer_changed(&mut self, record: u8, setting: LayerSetting) {
        self.layer_changed(record, setting);
    }

    fn stream_started(&mut self, sample_hz: u32) {
        self.stream_started(sample_hz);
    }

    fn samples_sent(&mut self, samples: &[u16]) {
        self.samples_sent(samples);
    }

    fn stream_ended(&mut self) {
        self.stream_ended();
    }

    fn stopped(&mut self) {
        self.stopped();
    }

    fn ticks_left(&self) -> u64 {
        Self::ticks_left(self)
    }
}

/// A link, or a byte stream, with a record of what the board at its other end plays.
pub trait Recorded {
    /// What records the play.
    type Recorder: PlayListener;

    /// What records the play.
    fn recorder_mut(&mut self) -> &mut Self::Recorder;

    /// The scene begins to play: starts the record, and the stroke of a finger that is simulated beside the board.
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
