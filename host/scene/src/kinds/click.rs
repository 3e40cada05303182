//! The fields of a click, and its compilation.

use frixel_layers::{CLICKS_MAX, Click as Record};

use super::*;

const CLICK_MS: FieldSpec = number(
    "click_ms",
    Range::new(0.1, range::CLICK_S.max / MM, " ms"),
    Number(20.0),
    "decay time of a click: `(1 - t / click_ms)^2` of it is left after `t`",
);

/// A short friction pulse when the finger crosses a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Click {
    height: Amount,
    decay_ms: f64,
}

impl Click {
    /// Reads the click of a layer, if it has one.
    pub(super) fn read(fields: &mut Fields, height: &AmountFields, unit: Unit, log: &mut Log) -> Option<Self> {
        let decay_ms = fields.number_or_default(log, &CLICK_MS);
        Some(Self { height: Amount::read(fields, height, unit, log)?, decay_ms })
    }

    /// Compiles a click, with friction relative to its base. Returns `None` if there are too many.
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
