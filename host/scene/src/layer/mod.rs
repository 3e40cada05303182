//! `[[layer]]`: what a person writes for one layer.

mod amount;
mod kind;
mod region;

use frixel_wire::scene::Blend;

pub(super) use amount::Amount;
use amount::Unit;
pub(super) use kind::{Bitmap, Burst, Click, Kind};
pub(super) use region::{Rectangle, Region};

use super::fields::Fields;
use super::log::Log;
use super::mistake::Mistake;
use super::source::Places;
use super::tables;
use kind::KindName;

/// One layer as written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layer {
    /// How messages call it: its number from one, and its name or kind.
    pub(super) title: String,
    pub(super) name: Option<String>,
    pub(super) region: Option<Region>,
    pub(super) blend: Blend,
    pub(super) gain: f64,
    pub(super) above: Above,
    /// The host changes it while it plays.
    pub(super) live: bool,
    pub(super) kind: Kind,
    pub(super) places: Places,
}

/// What a layer's frictions in newtons count from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Above {
    /// From the finger's friction at no voltage.
    Natural,
    /// From zero: they are totals.
    Zero,
}

impl Layer {
    /// Reads layer `number`, counted from one.
    pub(super) fn read(mut fields: Fields, number: usize, log: &mut Log) -> Option<Self> {
        fields.rename(format!("layer {number}"));
        let name = fields.text(log, &tables::layer::NAME);
        let kinds = KindName::ALL.map(|kind| (kind.word(), kind));
        let Some(kind_name) = fields.choice_or_nearest(log, &tables::layer::KIND, &kinds) else {
            // Nobody knows what else the layer should have; these every kind has.
            let _ = Common::read(&mut fields, KindName::Constant, log);
            fields.give_up_without(log, "kind");
            return None;
        };
        let title = name.as_ref().map_or_else(
            || format!("layer {number} ({})", kind_name.word()),
            |name| format!("layer {number} \"{name}\""),
        );
        fields.rename(title.clone());
        let Common { region, blend, gain, live, unit, above } = Common::read(&mut fields, kind_name, log);
        let kind = kind_name.read(&mut fields, unit, log);
        let places = fields.close(log);
        if blend == Blend::Add && above == Some(Above::Zero) {
            log.add(places.field("above"), Mistake::AddedTotal { layer: title.clone() });
        }
        let above = above.unwrap_or(match (kind_name, blend) {
            (KindName::Constant, Blend::Replace) => Above::Zero,
            _ => Above::Natural,
        });
        let region = region.ok()?;
        let kind = kind?;
        kind.check(&places, log);
        Some(Self { title, name, region, blend, gain, above, live, kind, places })
    }
}

/// What every kind of layer has.
struct Common {
    region: Result<Option<Region>, region::Misread>,
    blend: Blend,
    gain: f64,
    live: bool,
    unit: Unit,
    above: Option<Above>,
}

impl Common {
    fn read(fields: &mut Fields, kind: KindName, log: &mut Log) -> Self {
        let region = region::read(fields, kind, log);
        let blend = blend(fields, kind, log);
        let gain = fields.number_or_default(log, &tables::layer::GAIN);
        let live = fields.flag(log, &tables::layer::LIVE);
        let unit = if blend == Blend::Multiply { Unit::Factor } else { Unit::Friction };
        // What is multiplied counts from nothing.
        let above = match unit {
            Unit::Friction => {
                fields.choice(log, &tables::layer::ABOVE, &[("natural", Above::Natural), ("zero", Above::Zero)])
            }
            Unit::Factor => None,
        };
        Self { region, blend, gain, live, unit, above }
    }
}

/// A curve of speed is a factor on what lies below it, and an edge most often a ridge on it.
fn blend(fields: &mut Fields, kind: KindName, log: &mut Log) -> Blend {
    let all = [("replace", Blend::Replace), ("add", Blend::Add), ("multiply", Blend::Multiply), ("max", Blend::Max)];
    match kind {
        KindName::Speed => {
            fields.choice(log, &tables::layer::BLEND, &[("multiply", Blend::Multiply)]).unwrap_or(Blend::Multiply)
        }
        KindName::Edge => fields.choice(log, &tables::layer::BLEND, &all).unwrap_or(Blend::Add),
        _ => fields.choice(log, &tables::layer::BLEND, &all).unwrap_or_default(),
    }
}
