//! What a recorder is told of a play, by calls.

use frixel_model::ParameterError;
use frixel_scene::{LayerSetting, Program};
use frixel_wire::hello::BoardLimits;

/// Is told what a board is made to play, to compare with what is felt.
pub trait PlayListener {
    /// The board plays another program from now on.
    ///
    /// Returns an error if the contact model refuses the program's finger. This does not happen for a compiled program.
    fn scene_replaced(&mut self, program: &Program, limits: &BoardLimits) -> Result<(), ParameterError> {
        let _ = (program, limits);
        Ok(())
    }

    /// The layer with this record number, from zero, has this setting from now on.
    fn layer_changed(&mut self, record: u8, setting: LayerSetting) {
        let _ = (record, setting);
    }

    /// The layer with this record number, from zero, is triggered: it is switched on, and off again by itself.
    fn triggered(&mut self, record: u8) {
        let _ = record;
    }

    /// The host asks the board to play a stream of so many samples a second.
    fn stream_started(&mut self, sample_hz: u32) {
        let _ = sample_hz;
    }

    /// The host sends samples of the stream, which follow the earlier ones.
    fn samples_sent(&mut self, samples: &[u16]) {
        let _ = samples;
    }

    /// The stream ends after the samples sent so far.
    fn stream_ended(&mut self) {}

    /// The host switches the output off.
    fn stopped(&mut self) {}

    /// Ticks that remain to be recorded.
    fn ticks_left(&self) -> u64 {
        u64::MAX
    }
}

/// Records nothing.
impl PlayListener for () {}
