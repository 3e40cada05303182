//! Callbacks of a play for a recorder.

use frixel_model::ParameterError;
use frixel_scene::{LayerSetting, Program};
use frixel_wire::hello::BoardLimits;
use frixel_wire::message::Telemetry;

/// Receives the changes of a play, for the reference that felt friction is compared with.
pub trait PlayListener {
    /// The board switches to another program.
    ///
    /// Returns an error if the contact model refuses the program's finger. This does not happen for a compiled program.
    fn scene_replaced(&mut self, program: &Program, limits: &BoardLimits) -> Result<(), ParameterError> {
        let _ = (program, limits);
        Ok(())
    }

    /// The layer of a record, by its index from zero, gets this setting.
    fn layer_changed(&mut self, record: u8, setting: LayerSetting) {
        let _ = (record, setting);
    }

    /// The layer of a record, by its index from zero, is triggered: switched on, and later off by itself.
    fn triggered(&mut self, record: u8) {
        let _ = record;
    }

    /// The host asks the board to play a stream of `sample_hz` samples per second.
    fn stream_started(&mut self, sample_hz: u32) {
        let _ = sample_hz;
    }

    /// The host sends further samples of the stream.
    fn samples_sent(&mut self, samples: &[u16]) {
        let _ = samples;
    }

    /// The stream ends after the samples sent so far.
    fn stream_ended(&mut self) {}

    /// The host switches the output off.
    fn stopped(&mut self) {}

    /// Number of ticks that remain to be recorded.
    fn ticks_left(&self) -> u64 {
        u64::MAX
    }
}

/// Records nothing.
impl PlayListener for () {}

/// Records no changes: the link adds the board's messages.
impl PlayListener for Vec<Telemetry> {}
