//! `[[layer]]`: the fields of one layer, as a person writes them.

mod amount;
mod region;
mod repeat;

use frixel_layers::Blend;

pub(crate) use amount::{Amount, LowHigh, UNITS, Unit};
pub(crate) use region::{Rectangle, Region};
use repeat::Repeat;

use super::fields::Fields;
use super::kinds::{Kind, KindName};
use super::log::Log;
use super::mistake::FieldMistake;
use super::source::Places;
use super::tables;
use super::titles::{LayerNumber, LayerTitle};

/// Largest number of durations in a pattern.
const PATTERN_MAX: usize = 64;

/// One layer as written.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layer {
    pub(crate) title: LayerTitle,
    pub(crate) name: Option<String>,
    /// The name of the layer with `repeat` that it is a copy of.
    pub(crate) family: Option<String>,
    /// Whether it is a copy made by `repeat`.
    pub(crate) is_copy: bool,
    pub(crate) region: Option<Region>,
    pub(crate) blend: Blend,
    pub(crate) gain: f64,
    pub(crate) above: Above,
    /// Whether the host may change the layer while it plays.
    pub(crate) live: bool,
    /// Whether the layer is on at the start of a play.
    pub(crate) starts_on: bool,
    /// Pattern of a trigger, alternating on and off times, ms; empty to stay on.
    pub(crate) pattern_ms: Vec<f64>,
    pub(crate) kind: Kind,
    pub(crate) places: Places,
}

/// The zero point of a layer's frictions in newtons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Above {
    /// The finger's friction at no voltage.
    Natural,
    /// No friction: the values are totals.
    Zero,
}

impl Layer {
    /// Reads layer `number`, counted from one, and returns its copies.
    pub(crate) fn read(mut fields: Fields, number: usize, log: &mut Log) -> Option<Vec<Self>> {
        fields.rename(format!("layer {number}"));
        let name = fields.text(log, &tables::layer::NAME);
        let Some(kind_name) = fields.choice_or_nearest(log, &tables::layer::KIND, KindName::ALL) else {
            // The other fields depend on the unknown kind. Read the common ones.
            let _ = Common::read(&mut fields, KindName::Constant, log);
            fields.give_up_without(log, "kind");
            return None;
        };
        let number = LayerNumber { table: number, copy: None };
        let title = LayerTitle::new(number, name.as_deref(), kind_name.word());
        fields.rename(title.to_string());
        let Common { region, repeat, blend, gain, live, starts_on, pattern_ms, unit, above } =
            Common::read(&mut fields, kind_name, log);
        let kind = kind_name.read(&mut fields, unit, log);
        let places = fields.close(log);
        if blend == Blend::Add && above == Some(Above::Zero) {
            log.add(places.field("above"), FieldMistake::AddedTotal { layer: title.to_string() });
        }
        let needs_live =
            [(!starts_on, "start", "is off at the start"), (!pattern_ms.is_empty(), "pattern_ms", "has a pattern")];
        for (_, field, what) in needs_live.into_iter().filter(|(is_asked, ..)| *is_asked && !live) {
            log.add(places.field(field), FieldMistake::NeedsLive { layer: title.to_string(), field, what });
        }
        let is_total = kind_name.has_totals() && blend == Blend::Replace;
        let above = above.unwrap_or(if is_total { Above::Zero } else { Above::Natural });
        let region = region.ok()?;
        let kind = kind?;
        let (family, is_copy) = (None, false);
        let layer = Self {
            title,
            name,
            family,
            is_copy,
            region,
            blend,
            gain,
            above,
            live,
            starts_on,
            pattern_ms,
            kind,
            places,
        };
        Some(repeat.of(&layer, kind_name))
    }

    pub(crate) fn number(&self) -> LayerNumber {
        self.title.number()
    }
}

/// Reads the fields of a layer of a kind and a unit, to log their mistakes.
pub(crate) fn read_fields(fields: &mut Fields, kind: KindName, unit: Unit, log: &mut Log) {
    let _ = Common::read(fields, kind, log);
    let _ = kind.read(fields, unit, log);
}

/// The fields that every kind of layer has.
struct Common {
    region: Result<Option<Region>, region::Misread>,
    repeat: Repeat,
    blend: Blend,
    gain: f64,
    live: bool,
    starts_on: bool,
    pattern_ms: Vec<f64>,
    unit: Unit,
    above: Option<Above>,
}

impl Common {
    fn read(fields: &mut Fields, kind: KindName, log: &mut Log) -> Self {
        let region = region::read(fields, kind, log);
        let repeat = Repeat::read(fields, log);
        let (blends, blend) = kind.blends();
        let blend = fields.choice(log, &tables::layer::BLEND, blends).unwrap_or(blend);
        let gain = fields.number_or_default(log, &tables::layer::GAIN);
        let live = fields.flag(log, &tables::layer::LIVE);
        let starts_on = fields.choice(log, &tables::layer::START, &[("on", true), ("off", false)]).unwrap_or(true);
        let pattern_ms = pattern_ms(fields, log);
        let unit = if blend == Blend::Multiply { Unit::Factor } else { Unit::Friction };
        // The zero point of a layer that multiplies is zero.
        let above = match unit {
            Unit::Friction => {
                fields.choice(log, &tables::layer::ABOVE, &[("natural", Above::Natural), ("zero", Above::Zero)])
            }
            Unit::Factor => None,
        };
        Self { region, repeat, blend, gain, live, starts_on, pattern_ms, unit, above }
    }
}

fn pattern_ms(fields: &mut Fields, log: &mut Log) -> Vec<f64> {
    let field = tables::layer::PATTERN_MS;
    let place = fields.place(field.name);
    let Some(pattern_ms) = fields.numbers(log, &field) else { return Vec::new() };
    let (found, min, max) = (pattern_ms.len(), 1, PATTERN_MAX);
    if !(min..=max).contains(&found) {
        log.add(place, FieldMistake::Count { field: field.name, found, min, max });
    }
    pattern_ms
}
