//! Changes of a scene during a play: layers on or off, their gains, and the start and end of a stream.

use frixel_control::{Board, Order};
use frixel_layers::{range, within};
use frixel_wire::message::{Accepted, ConfigField, ConfigRefusal, Refusal, STREAM_START_LEVEL_MAX};

use super::Scenes;
use crate::states::Orders;

impl<'a> Scenes<'a> {
    pub(crate) fn set_layer(
        &mut self,
        layer: u8,
        on: bool,
        gain: f32,
        orders: &mut Orders<'a>,
    ) -> Result<Accepted, Refusal> {
        if self.header().is_some_and(|header| header.layers_fixed) {
            return Err(Refusal::LayersFixed);
        }
        let layers = self.committed.layers;
        if layer >= layers {
            return Err(Refusal::NoSuchLayer { layer, layers });
        }
        range::GAIN.check(gain, layer).map_err(Refusal::Config)?;
        orders.send(Order::SetLayer { layer, on, gain })?;
        Ok(Accepted::Done)
    }

    pub(crate) fn start_stream(
        &mut self,
        sample_hz: u32,
        start_level: u16,
        board: &Board,
        orders: &mut Orders<'a>,
    ) -> Result<Accepted, Refusal> {
        if !self.stream.is_attached() {
            return Err(Refusal::UnknownCommand);
        }
        if !self.committed.has_stream {
            return Err(Refusal::NoStreamLayer);
        }
        for (field, found, max) in [
            (ConfigField::SampleRate, sample_hz as f32, board.tick_hz as f32),
            (ConfigField::StartLevel, f32::from(start_level), f32::from(STREAM_START_LEVEL_MAX)),
        ] {
            within(field, found, 1.0, max, ConfigRefusal::WHOLE_SCENE).map_err(Refusal::Config)?;
        }
        orders.check_room()?;
        if let Some(order) = self.stream.start(sample_hz, board.tick_hz, start_level) {
            orders.send(order)?;
        }
        Ok(Accepted::Done)
    }

    /// Stops accepting samples. The ticker plays the samples that have arrived.
    pub(crate) fn end_stream(&mut self, orders: &mut Orders<'a>) -> Result<Accepted, Refusal> {
        if !self.stream.is_attached() {
            return Err(Refusal::UnknownCommand);
        }
        orders.check_room()?;
        if let Some(order) = self.stream.end() {
            orders.send(order)?;
        }
        Ok(Accepted::Done)
    }
}
