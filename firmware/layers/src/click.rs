//! Short pulses of friction when the finger crosses a line.
#![cfg_attr(not(feature = "edge"), allow(dead_code, reason = "only edges and buttons click"))]

use frixel_wire::message::{ConfigField, ConfigRefusal, Refusal};

use crate::clicks::{CLICKS_MAX, ClickCoefficients, ClickNumber, Slot};
use crate::context::Context;
use crate::interval::Interval;
use crate::layout::RecordBytes;
use crate::parameters::{Parameter, UnknownForm, range};
use crate::prepare::{Preparation, no_room, ticks};

/// A short friction pulse: `height (1 - t / decay)^2` until `decay` has passed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Click {
    /// Initial electric friction, N; 0 for no click.
    pub height_n: f32,
    /// Duration, s.
    pub decay_s: f32,
}

impl Parameter for Click {
    const LEN: usize = 2 * f32::LEN;

    fn read(record: &RecordBytes, offset: usize) -> Result<Self, UnknownForm> {
        Ok(Self { height_n: f32::read(record, offset)?, decay_s: f32::read(record, offset + f32::LEN)? })
    }

    fn write(&self, record: &mut RecordBytes, offset: usize) {
        self.height_n.write(record, offset);
        self.decay_s.write(record, offset + f32::LEN);
    }

    fn check(&self, layer: u8) -> Result<(), ConfigRefusal> {
        range::FRICTION_N.check(self.height_n, layer)?;
        range::CLICK_S.check(self.decay_s, layer)
    }
}

impl Click {
    /// Whether the click's height is not zero.
    pub fn is_felt(&self) -> bool {
        self.height_n.abs() > 0.0
    }

    /// Bounds of the friction added by the click.
    pub(crate) fn bounds(&self) -> Interval<f32> {
        Interval::of([0.0, self.height_n])
    }

    /// Bytes of the click in the scene's tables.
    pub(crate) fn table_bytes(&self) -> usize {
        if self.is_felt() { size_of::<ClickCoefficients>() } else { 0 }
    }

    /// Adds the click of layer `layer` to the scene's tables; `None` without a click.
    pub(crate) fn prepare(&self, layer: u8, preparation: &mut Preparation) -> Result<Option<ClickNumber>, Refusal> {
        if !self.is_felt() {
            return Ok(None);
        }
        let decay_ticks = ticks(self.decay_s, preparation.tick_hz).max(1);
        let click = ClickCoefficients { height_n: self.height_n, decay_ticks, per_tick: 1.0 / decay_ticks as f32 };
        let number = preparation.tables.add_click(click);
        number.map(Some).map_err(|_| no_room(ConfigField::ClickLayers, CLICKS_MAX, layer))
    }
}

impl ClickNumber {
    /// Electric friction of the click at a line; `beyond` is the side on which the finger is.
    #[inline]
    pub(crate) fn across(self, beyond: bool, context: &mut Context) -> f32 {
        let Some((click, slot)) = self.find(context) else { return 0.0 };
        let crossed = slot.evaluation == context.clicks.evaluation.wrapping_sub(1) && slot.beyond != beyond;
        let slot = Slot { beyond, ..slot };
        self.advance(&click, slot, crossed, context)
    }

    /// Electric friction of the click for a finger inside its region.
    #[inline]
    pub(crate) fn inside(self, context: &mut Context) -> f32 {
        let Some((click, slot)) = self.find(context) else { return 0.0 };
        let entered = slot.evaluation != context.clicks.evaluation.wrapping_sub(1);
        self.advance(&click, slot, entered, context)
    }

    #[inline]
    fn find(self, context: &Context) -> Option<(ClickCoefficients, Slot)> {
        let number = usize::from(self.0);
        Some((*context.tables.clicks().get(number)?, *context.clicks.slots.get(number)?))
    }

    #[inline]
    fn advance(self, click: &ClickCoefficients, mut slot: Slot, starts: bool, context: &mut Context) -> f32 {
        let (clicks, tick) = (&mut *context.clicks, context.inputs.tick);
        slot.evaluation = clicks.evaluation;
        if !clicks.unbroken {
            // A lift ends the clicks of the previous touch.
            slot.started_at_tick = None;
        }
        if starts && clicks.unbroken {
            slot.started_at_tick = Some(tick);
        }
        let ticks = slot.started_at_tick.map_or(click.decay_ticks, |start| tick.wrapping_sub(start));
        if ticks >= click.decay_ticks {
            slot.started_at_tick = None;
        }
        if let Some(stored) = clicks.slots.get_mut(usize::from(self.0)) {
            *stored = slot;
        }
        if slot.started_at_tick.is_none() {
            return 0.0;
        }
        let left = 1.0 - ticks as f32 * click.per_tick;
        click.height_n * left * left
    }
}
