//! Finds layers whose target friction is out of reach.

use frixel_layers::{Blend, Interval, Layer as RecordLayer, Record};

use super::cover::{Cell, PLACES_MAX, excesses, widened};
use super::digits::{digits, down, up};
use super::file::Scene;
use super::kinds::{Clicked, Kind};
use super::layer::{Above, Layer};
use super::log::Log;
use super::mistake::FitMistake;
use super::program::Program;
use super::reach::{ROUNDING, Reach};
use super::titles::{LayerTitle, listed};
use crate::reference::Reference;

/// Multiple of the reach from which on another unit was probably meant.
const UNIT_MISTAKE_FACTOR: f64 = 20.0;
/// Least number that a person writes who means mN.
const MILLINEWTONS_MIN: f64 = 1.0;

/// Computes the fields of [drive] to raise for an electric friction in newtons, and their values; empty if that is not
/// possible.
pub(super) type Raise<'r> = &'r dyn Fn(f64) -> Vec<(&'static str, f64)>;

/// Reports layers that exceed the reach as a mistake; with `saturate`, or if the excess is not certain, as a note.
///
/// `played` are the layers of the program's records.
pub(super) fn check(scene: &Scene, played: &[&Layer], raise: Raise, program: &Program, log: &mut Log) {
    let within = program.within_reach();
    let reference = Reference::new(program);
    let mut reported = Vec::new();
    for excess in excesses(&program.header, reference.pieces(), within, PLACES_MAX) {
        let layers = excess.layers.iter();
        let layers = layers.filter_map(|number| Some((*played.get(*number)?, program.records.get(*number)?))).collect();
        let largest_of = ridges_in_reach_as_largest(program, &reference, &excess.layers);
        let demand = Demand { layers, cell: excess.cell, within, reach: &program.reach, raise, largest_of };
        log.set_layer(match &demand.layers[..] {
            [(layer, _)] => Some(layer.number().table),
            _ => None,
        });
        let found = demand.sides(excess.found, log);
        if found.is_empty() {
            let possible = demand.sides(excess.bound, log);
            for side in possible {
                log.note(side.offset, note(&side, "; no place was found where they do"));
            }
        } else if scene.drive.saturate {
            for side in found {
                log.note(side.offset, note(&side, "; it is clamped there"));
            }
        } else {
            // Copies of a layer exceed the reach in the same way.
            let has_copy = demand.layers.iter().any(|(layer, _)| layer.is_copy);
            for Side { offset, mistake } in found {
                if !has_copy || !reported.contains(&offset) {
                    log.add(offset, mistake);
                    reported.push(offset);
                }
            }
        }
    }
    log.set_layer(None);
}

/// The layers of `numbers` that add a ridge to the layers below, if there are several, and if all of `numbers` stay in
/// reach once these have `blend = "max"`.
fn ridges_in_reach_as_largest(program: &Program, reference: &Reference, numbers: &[usize]) -> Option<String> {
    let is_added_ridge = |record: &Record| match record.layer {
        RecordLayer::Edge(edge) => record.blend == Blend::Add && record.gain * edge.ridge_n > 0.0,
        _ => false,
    };
    let ridges = numbers.iter().filter(|number| program.records.get(**number).is_some_and(is_added_ridge));
    let ridges: Vec<usize> = ridges.copied().collect();
    (ridges.len() > 1).then_some(())?;
    let pieces = numbers.iter().filter_map(|number| {
        let mut piece = reference.pieces().get(*number)?.clone();
        piece.blend = if ridges.contains(number) { Blend::Max } else { piece.blend };
        Some(piece)
    });
    let (within, pieces) = (program.within_reach(), pieces.collect::<Vec<_>>());
    let titles: Vec<&LayerTitle> = ridges.iter().filter_map(|number| program.titles.get(*number)).collect();
    (widened(within, &program.header, &pieces, PLACES_MAX).high <= within.high).then(|| listed(&titles))
}

impl Program {
    /// The reachable electric friction, N, with a margin for rounding errors.
    pub(super) fn within_reach(&self) -> Interval<f64> {
        let slack_n = ROUNDING * self.reach.electric_friction_max_n;
        Interval { low: -slack_n, high: self.reach.electric_friction_max_n + slack_n }
    }
}

/// Layers that exceed the reach together.
struct Demand<'a> {
    /// From bottom to top, with their records.
    layers: Vec<(&'a Layer, &'a Record)>,
    cell: Cell,
    within: Interval<f64>,
    reach: &'a Reach,
    raise: Raise<'a>,
    /// The ridges that stay in reach with `blend = "max"`.
    largest_of: Option<String>,
}

/// One side of the reach that layers exceed, and the place to change in the file.
struct Side {
    offset: usize,
    mistake: FitMistake,
}

impl Demand<'_> {
    /// The sides of the reach that an electric friction exceeds.
    fn sides(&self, asked: Interval<f64>, log: &Log) -> Vec<Side> {
        let Self { within, reach, .. } = self;
        let above = match &self.layers[..] {
            [(layer, _)] => layer.above,
            _ => Above::Natural,
        };
        let (reference, offset_n) = match above {
            Above::Natural => ("above natural friction", 0.0),
            Above::Zero => ("in total", reach.natural_friction_n),
        };
        let mut sides = Vec::new();
        if asked.high > within.high {
            let clicked = self.clicked(log);
            let is_sum = clicked.is_some() || self.layers.len() > 1;
            // A larger voltage also raises the target of a fraction.
            let has_fraction = self.layers.iter().any(|(layer, _)| has_fraction(layer));
            let has_newtons = self.layers.iter().any(|(layer, _)| layer.places.has_unit("_n"));
            let is_added = self.layers.iter().any(|(layer, _)| layer.blend == Blend::Add);
            let is_amount = above == Above::Natural && !is_sum && !is_added && has_newtons && !has_fraction;
            let may_be_total = is_amount && (0.0..=within.high).contains(&(asked.high - reach.natural_friction_n));
            let (target_n, reach_n) = (asked.high + offset_n, reach.electric_friction_max_n + offset_n);
            let part_of_reach = asked.high / reach.electric_friction_max_n;
            let mistake = FitMistake::AboveReach {
                asking: self.asking(clicked),
                target_n: digits(target_n, up),
                reference,
                part_of_reach: (has_fraction && !has_newtons).then(|| digits(part_of_reach, up)),
                voltage_v_rms: digits(reach.voltage_max_v_rms, f64::round),
                reach_n: digits(reach_n, f64::floor),
                cure: self.cure_above(is_sum, Some(digits(asked.high, up)).filter(|_| may_be_total)),
                raise: if has_fraction { Vec::new() } else { (self.raise)(asked.high) },
                may_be_millinewtons: !has_fraction
                    && target_n >= MILLINEWTONS_MIN
                    && target_n > UNIT_MISTAKE_FACTOR * reach_n
                    && 1e-3 * target_n <= reach_n,
            };
            sides.push(Side { offset: self.place(true), mistake });
        }
        if asked.low < within.low {
            let mistake = FitMistake::BelowNatural {
                asking: self.asking(None),
                target_n: digits(asked.low + offset_n, down),
                reference,
                natural_n: digits(reach.natural_friction_n, f64::round),
                cure: self.cure_below(above),
            };
            sides.push(Side { offset: self.place(false), mistake });
        }
        sides
    }

    /// Advice for friction above the reach. It is within reach if it is meant in total as `total_n`.
    fn cure_above(&self, is_sum: bool, total_n: Option<f64>) -> Box<str> {
        let lower = if is_sum { "lower one of them" } else { "lower it" };
        match (&self.largest_of, total_n) {
            (Some(ridges), _) => format!("write `blend = \"max\"` in {ridges}, {lower}").into(),
            (None, Some(total_n)) => format!("{lower}, write `above = \"zero\"` if {total_n} N is the total").into(),
            (None, None) => lower.into(),
        }
    }

    /// Advice for friction below natural friction, which a lower load reduces.
    fn cure_below(&self, above: Above) -> &'static str {
        match &self.layers[..] {
            [_] if above == Above::Zero => "raise it, or lower `normal_load_n`",
            [(layer, _)] if layer.blend == Blend::Replace => "raise it",
            [_] => "raise it, or the ground beneath it, by a layer with more friction",
            _ => "raise one of them, or the ground beneath them",
        }
    }

    /// The fields of a single layer that exceed the reach together with its click, with their values; `None` for
    /// several layers, or for a layer without a click.
    fn clicked(&self, log: &Log) -> Option<String> {
        let [(layer, record)] = &self.layers[..] else { return None };
        let gain = f64::from(record.gain);
        let click_n = Some(gain * f64::from(record.layer.click()?.height_n)).filter(|click_n| *click_n > 0.0)?;
        let Clicked { bases, click } = layer.kind.clicked(&layer.places, &record.layer)?;
        let written = |field: &str| format!("`{field} = {}`", log.source().word_at(layer.places.field(field)));
        let above = bases.iter().filter(|(_, friction_n)| gain * friction_n + click_n > self.within.high);
        let above: Vec<String> = above.map(|(field, _)| written(field)).collect();
        match &above[..] {
            [] => None,
            [only] => Some(format!("with its {only} and its {} together", written(click))),
            all => Some(format!("each of its {} together with its {}", all.join(" and "), written(click))),
        }
    }

    /// The layers' names with the verb, followed by the place if there are several layers.
    fn asking(&self, clicked: Option<String>) -> String {
        if let [(layer, _)] = &self.layers[..] {
            let gain = layer.places.has("gain").then(|| format!("with its gain of {}", layer.gain));
            let insertions: Vec<String> = [gain, clicked].into_iter().flatten().collect();
            return if insertions.is_empty() {
                format!("{} asks for", layer.title)
            } else {
                format!("{}, {}, asks for", layer.title, insertions.join(", "))
            };
        }
        let titles: Vec<&LayerTitle> = self.layers.iter().map(|(layer, _)| &layer.title).collect();
        let mm = |metres: f64| digits(metres * 1e3, f64::round);
        format!(
            "{} together (x {} to {} mm, y {} to {} mm) ask for",
            listed(&titles),
            mm(self.cell.left_m),
            mm(self.cell.right_m),
            mm(self.cell.top_m),
            mm(self.cell.bottom_m)
        )
    }

    /// Offset of the field that sets the largest or least friction; of several layers, the topmost one's.
    fn place(&self, most: bool) -> usize {
        match &self.layers[..] {
            [] => 0,
            [(layer, record)] => {
                let most = most == (layer.gain >= 0.0);
                layer.places.field(layer.kind.extreme(most, &layer.places, &record.layer))
            }
            [.., (layer, _)] => layer.places.table(),
        }
    }
}

/// Whether an amount of a layer is a fraction of the reach.
fn has_fraction(layer: &Layer) -> bool {
    let is_by_default = matches!(layer.kind, Kind::Bitmap(_)) && layer.blend != Blend::Multiply;
    layer.places.has_unit("_fraction") || (is_by_default && !layer.places.has("white_n"))
}

fn note(side: &Side, ending: &str) -> String {
    match &side.mistake {
        FitMistake::AboveReach { asking, target_n, reference, reach_n, .. } => {
            format!("{asking} up to {target_n} N {reference}, but at most {reach_n} N can be reached{ending}")
        }
        FitMistake::BelowNatural { asking, target_n, reference, natural_n, .. } => {
            format!("{asking} down to {target_n} N {reference}, below the natural friction of {natural_n} N{ending}")
        }
        other => other.to_string(),
    }
}
