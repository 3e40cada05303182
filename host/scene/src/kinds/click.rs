//! The words for a click, and how it is lowered.

use frixel_layers::{CLICKS_MAX, Click as Record, range};

use crate::fields::{Fields, Range};
use crate::layer::{Amount, Layer, Names, Unit};
use crate::log::Log;
use crate::lower::{Lowering, MM};

const CLICK_MS: Range = Range::new(0.1, range::CLICK_S.max / MM, " ms");
/// How long a click takes where the file says nothing.
const CLICK_DEFAULT_MS: f64 = 20.0;

/// A short pulse when the finger crosses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Click {
    height: Amount,
    decay_ms: f64,
}

impl Click {
    /// Reads the click of a layer, if it has one.
    pub(super) fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self> {
        let decay_ms = fields.optional_number(log, "click_ms", CLICK_MS).unwrap_or(CLICK_DEFAULT_MS);
        Some(Self { height: Amount::optional(fields, Names::CLICK, unit, log)?, decay_ms })
    }

    /// A click is added, so that it counts from what it is added to. `None` when there are too many.
    pub(super) fn lower(click: Option<Self>, layer: &Layer, lowering: &mut Lowering) -> Option<Record> {
        let Some(Self { height, decay_ms }) = click else { return Some(Record::default()) };
        lowering.clicks += 1;
        lowering.limit(layer, "edges and buttons with a click", lowering.clicks, CLICKS_MAX)?;
        let height_n = match height {
            Amount::Newtons(friction_n) => friction_n as f32,
            other => lowering.amount(layer, other),
        };
        Some(Record { height_n, decay_s: (decay_ms * MM) as f32 })
    }
}
