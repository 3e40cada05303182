//! Finds layers whose target friction is out of reach.

use frixel_layers::Interval;

use super::cover::{Cell, Excess, excesses};
use super::file::Scene;
use super::kinds::Kind;
use super::layer::{Above, Layer};
use super::log::Log;
use super::mistake::Mistake;
use super::program::Program;
use super::reach::ROUNDING;
use crate::reference::Reference;

/// A friction so many times the reach may have been meant in another unit.
const MUCH: f64 = 20.0;

/// Reports a mistake for layers that exceed the reach. With `saturate`, or if the excess is not certain, adds a note
/// instead.
///
/// `played` are the layers of the program's records. `raised_n` is the largest electric friction if `voltage_max_v_rms`
/// were raised as far as the other limits of the voltage allow.
pub(super) fn check(scene: &Scene, played: &[&Layer], raised_n: f64, program: &mut Program, log: &mut Log) {
    let reach = program.reach;
    let slack_n = ROUNDING * reach.electric_friction_max_n;
    let within = Interval { low: -slack_n, high: reach.electric_friction_max_n + slack_n };
    let reference = Reference::new(program);
    let width_m = f64::from(program.header.screen_width_m);
    let height_m = f64::from(program.header.screen_height_m);
    let mut reported = Vec::new();
    for excess in excesses(reference.pieces(), width_m, height_m, within) {
        let layers: Vec<&Layer> = excess.layers.iter().filter_map(|number| played.get(*number).copied()).collect();
        let sides = |friction: Interval<f64>| sides(&layers, &excess, friction, within, raised_n, program);
        let found = sides(excess.found);
        if found.is_empty() {
            let possible = sides(excess.bound);
            program.notes.extend(possible.iter().map(|side| note(side, "; no place was found where they do")));
        } else if scene.drive.saturate {
            program.notes.extend(found.iter().map(|side| note(side, "; it is clamped there")));
        } else {
            // Copies of a layer exceed the reach in the same way.
            let is_copy = |offset: usize, reported: &[usize]| {
                layers.iter().any(|layer| layer.is_copy) && reported.contains(&offset)
            };
            for Side { offset, mistake } in found {
                if !is_copy(offset, &reported) {
                    log.add(offset, mistake);
                    reported.push(offset);
                }
            }
        }
    }
}

/// One side of the reach that layers exceed, and the place in the file to change.
struct Side {
    offset: usize,
    mistake: Mistake,
}

fn sides(
    layers: &[&Layer],
    excess: &Excess,
    asked: Interval<f64>,
    within: Interval<f64>,
    raised_n: f64,
    program: &Program,
) -> Vec<Side> {
    let reach = &program.reach;
    let above = match layers {
        [layer] => layer.above,
        _ => Above::Natural,
    };
    let (reference, offset_n) = match above {
        Above::Natural => ("above natural friction", 0.0),
        Above::Zero => ("in total", reach.natural_friction_n),
    };
    let clicks = excess.layers.iter().filter_map(|number| program.records.get(*number)?.layer.click());
    let has_click = asked.high > within.high && clicks.map(|click| click.height_n).any(|height_n| height_n > 0.0);
    let asking = asking(layers, excess.cell, has_click);
    let mut sides = Vec::new();
    if asked.high > within.high {
        let mistake = Mistake::AboveReach {
            asking: asking.clone(),
            asked_n: digits(asked.high + offset_n, up),
            reference,
            voltage_v_rms: digits(reach.voltage_max_v_rms, f64::round),
            reach_n: digits(reach.electric_friction_max_n + offset_n, f64::floor),
            voltage_helps: asked.high <= raised_n,
            may_be_millinewtons: asked.high + offset_n > MUCH * (reach.electric_friction_max_n + offset_n)
                && 1e-3 * (asked.high + offset_n) <= reach.electric_friction_max_n + offset_n,
        };
        sides.push(Side { offset: place(layers, true), mistake });
    }
    if asked.low < within.low {
        let mistake = Mistake::BelowNatural {
            asking,
            asked_n: digits(asked.low + offset_n, down),
            reference,
            natural_n: digits(reach.natural_friction_n, f64::round),
        };
        sides.push(Side { offset: place(layers, false), mistake });
    }
    sides
}

fn note(side: &Side, ending: &str) -> String {
    match &side.mistake {
        Mistake::AboveReach { asking, asked_n, reference, reach_n, .. } => {
            format!("{asking} up to {asked_n} N {reference}, and at most {reach_n} N can be reached{ending}")
        }
        Mistake::BelowNatural { asking, asked_n, reference, natural_n } => {
            format!("{asking} down to {asked_n} N {reference}, below the natural friction of {natural_n} N{ending}")
        }
        other => other.to_string(),
    }
}

/// The layers' names, and the place if there are several layers.
fn asking(layers: &[&Layer], cell: Cell, has_click: bool) -> String {
    if let [layer] = layers {
        let gained = layer.places.has("gain");
        let gain = if gained { format!(", with its gain of {},", layer.gain) } else { String::new() };
        if has_click {
            let ridge = if matches!(layer.kind, Kind::Button(_)) { "rim" } else { "ridge" };
            return format!("{}{gain}, its {ridge} and its click together, asks for", layer.title);
        }
        return format!("{}{gain} asks for", layer.title);
    }
    let titles: Vec<&str> = layers.iter().map(|layer| layer.title.as_str()).collect();
    let mm = |metres: f64| digits(metres * 1e3, f64::round);
    format!(
        "{} together (x {} to {} mm, y {} to {} mm) ask for",
        titles.join(" and "),
        mm(cell.left_m),
        mm(cell.right_m),
        mm(cell.top_m),
        mm(cell.bottom_m)
    )
}

/// Offset of the field that sets the largest or least friction; with several layers, of the topmost layer.
fn place(layers: &[&Layer], most: bool) -> usize {
    let Some(layer) = layers.last() else { return 0 };
    let most = most == (layer.gain >= 0.0);
    if layers.len() > 1 {
        return layer.places.table();
    }
    layer.places.field(layer.kind.extreme(most, &layer.places))
}

/// Four significant digits, rounded by `to_whole`.
pub(super) fn digits(value: f64, to_whole: fn(f64) -> f64) -> f64 {
    if !(value.abs() > 0.0) {
        return 0.0;
    }
    let digits = 3 - value.abs().log10().floor() as i32;
    // A power of ten with a whole exponent of zero or more is exact, so the result prints with few digits.
    let scale = 10f64.powi(digits.abs());
    if digits >= 0 { to_whole(value * scale) / scale } else { to_whole(value / scale) * scale }
}

/// Rounds up to a whole number, but ignores what rounding to `f32` may have added to the fourth digit.
fn up(value: f64) -> f64 {
    (value - 0.002).ceil()
}

/// Rounds down to a whole number, but ignores what rounding to `f32` may have taken from the fourth digit.
fn down(value: f64) -> f64 {
    (value + 0.002).floor()
}
