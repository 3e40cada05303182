//! The file with the cost of each kind of layer, which compiler and board read. It is generated from measurements, and
//! checked against them.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;

use super::Figures;
use super::figures::CYCLES;
use crate::command::root;

const PATH: &str = "firmware/layers/src/measured.rs";

/// Numbers of curve points in the shorter and the longer of the two measured cases; the same for polygon vertices
/// below.
const SPEED_POINTS: (u64, u64) = (2, 8);
const POLYGON_POINTS: (u64, u64) = (4, 12);
/// Number of edges that are level with the finger in both polygons.
const POLYGON_EDGES_LEVEL: u64 = 2;
/// Vertices of the polygon whose edges are all level with the finger.
const LEVEL_POLYGON_POINTS: u64 = 6;

/// Core cycles by which a tick with several rare events exceeds the longest measured case: a report of a fast touch
/// source, an edge of the carrier, an active limit. `cargo xtask soak` plays thousands of random scenes to find one
/// that takes more.
const RARE: u64 = 40;

/// Name, description and core cycles of a cost.
type Cost = (&'static str, &'static str, u64);

/// Regenerates the file.
pub(crate) fn bless(figures: &Figures) -> Result<(), String> {
    let path = root().join(PATH);
    fs::write(&path, text(&costs(figures)?)).map_err(|error| format!("{}: {error}", path.display()))
}

/// Fails if a cost in the file differs from the measurement. The error lists the differences.
pub(crate) fn check(figures: &Figures) -> Result<(), String> {
    let path = root().join(PATH);
    let found = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    if found == text(&costs(figures)?) {
        return Ok(());
    }
    let drifted: Vec<String> = costs(figures)?
        .into_iter()
        .filter(|cost| !found.contains(&line(cost)))
        .map(|(name, _, core_cycles)| format!("{name} is {core_cycles}"))
        .collect();
    Err(format!(
        "{PATH} is not what was measured; `FRIXEL_BLESS=1 cargo xtask bench` writes it anew: {}",
        drifted.join(", ")
    ))
}

/// Prefix of the names of ticks.
const TICK: &str = "m4f.tick_";
/// Suffix of the names of ticks that are counted only to find the cost of a layer.
const ALONE: &str = "_alone";

/// Computes the costs from measured ticks with one constant layer, two constant layers, or one layer of another kind.
/// Fails if no cost uses a tick with one layer: a new kind of layer needs a line here.
fn costs(figures: &Figures) -> Result<Vec<Cost>, String> {
    let used = RefCell::new(BTreeSet::new());
    let costs = costs_of_ticks(|name| {
        let name = format!("{TICK}{name}{CYCLES}");
        let tick = figures.get(&name).ok_or_else(|| format!("{name} was not measured"));
        used.borrow_mut().insert(name);
        tick
    })?;
    let end = format!("{ALONE}{CYCLES}");
    let mut alone = figures.names().filter(|name| name.starts_with(TICK) && name.ends_with(&end));
    match alone.find(|name| !used.borrow().contains(*name)) {
        Some(name) => Err(format!("{name} was measured, and no cost uses it: add a line to `costs_of_ticks`")),
        None => Ok(costs),
    }
}

/// [`costs`] from a function that finds the core cycles of a tick by its name.
fn costs_of_ticks(tick: impl Fn(&str) -> Result<u64, String>) -> Result<Vec<Cost>, String> {
    let two = tick("two_constants")?;
    let constant = two.saturating_sub(tick("constant_alone")?);
    let base = two.saturating_sub(2 * constant);
    let alone = |name: &str| tick(&format!("{name}{ALONE}")).map(|core_cycles| core_cycles.saturating_sub(base));
    // Ticks with the envelope at its slew limit, and ticks whose target exceeds the reachable friction, are longer
    // than others: take the longest.
    let longest =
        base.max(tick("1_of_64")?.saturating_sub(constant)).max(tick("out_of_reach_alone")?.saturating_sub(constant));
    // In any of them, the amplifier may be switching on.
    let switching = tick("disturbed_alone")?.saturating_sub(tick("constant_alone")?);
    let empty = longest + switching + RARE;
    let stream_elsewhere = tick("stream_elsewhere")?.saturating_sub(tick("constant_alone")?);
    let (speed, speed_point) = line_through(SPEED_POINTS, alone("speed_2")?, alone("speed_8")?);
    let (polygon, polygon_edge) = line_through(POLYGON_POINTS, alone("polygon_4")?, alone("polygon_12")?);
    let more_level = LEVEL_POLYGON_POINTS - POLYGON_EDGES_LEVEL;
    let with_two_level = polygon + LEVEL_POLYGON_POINTS * polygon_edge;
    let polygon_edge_level = alone("polygon_6_level")?.saturating_sub(with_two_level).div_ceil(more_level);
    let polygon = polygon.saturating_sub(constant + POLYGON_EDGES_LEVEL * polygon_edge_level);
    Ok(vec![
        ("EMPTY", "A tick that looks at layers and finds none.", empty),
        ("SINE_CARRIER", "What a sine carrier adds.", tick("two_constants_sine_carrier")?.saturating_sub(two)),
        ("CONSTANT", "Layers, in a rectangle.", constant),
        ("SINE", "", alone("sine")?),
        ("SQUARE", "", alone("square")?),
        ("TRIANGLE", "", alone("triangle")?),
        ("SAW", "", alone("saw")?),
        ("RINGS", "", alone("rings")?.saturating_sub(alone("sine")?)),
        ("BITMAP", "", alone("bitmap")?),
        ("BITMAP_TILED", "", alone("bitmap_tiled")?),
        ("NOISE", "", alone("noise")?),
        ("EDGE", "", alone("edge")?),
        ("BUTTON", "", alone("button")?),
        ("VIBRATION_SINE", "", alone("vibration_sine")?),
        ("VIBRATION_SQUARE", "", alone("vibration_square")?),
        ("SPEED", "A curve, and each of its points.", speed),
        ("SPEED_POINT", "", speed_point),
        ("STREAM", "", alone("stream")?.saturating_sub(stream_elsewhere)),
        ("STREAM_ELSEWHERE", "The stream's own work, wherever the finger is.", stream_elsewhere),
        ("ELLIPSE", "What other regions add to a rectangle.", alone("ellipse")?.saturating_sub(constant)),
        (
            "POLYGON",
            "A polygon, each of its edges, and what each of those adds that are level with the finger.",
            polygon,
        ),
        ("POLYGON_EDGE", "", polygon_edge),
        ("POLYGON_EDGE_LEVEL", "", polygon_edge_level),
    ])
}

/// Cost without points and cost per point, chosen so that neither of the two measured cases exceeds the line.
fn line_through((few, many): (u64, u64), at_few: u64, at_many: u64) -> (u64, u64) {
    let each = at_many.saturating_sub(at_few).div_ceil(many - few);
    (at_few.saturating_sub(few * each).max(at_many.saturating_sub(many * each)), each)
}

fn line((name, _, core_cycles): &Cost) -> String {
    format!("pub(crate) const {name}: u32 = {core_cycles};")
}

fn text(costs: &[Cost]) -> String {
    let mut text = String::from(
        "//! Core cycles on a Cortex-M4F at the worst input, estimated. Written by `FRIXEL_BLESS=1 cargo xtask bench`;\n\
         //! `cargo xtask test` measures again and fails when it finds others.\n\
         #![allow(dead_code, reason = \"a kind whose feature is off costs nothing\")]\n",
    );
    for cost in costs {
        let (_, comment, _) = cost;
        // Writing to a string cannot fail.
        let _ = match *comment {
            "" => writeln!(text, "{}", line(cost)),
            comment => writeln!(text, "\n// {comment}\n{}", line(cost)),
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neither_case_takes_more_than_the_line_through_both() {
        for (at_few, at_many) in [(100, 160), (100, 163), (7, 100), (100, 100)] {
            let (alone, each) = line_through((2, 8), at_few, at_many);
            assert!(alone + 2 * each >= at_few && alone + 8 * each >= at_many, "{alone} + n {each}");
        }
    }

    /// Figures with which all costs can be computed.
    fn complete() -> Figures {
        let mut figures = Figures::default();
        while let Err(missing) = costs(&figures) {
            let name = missing.strip_suffix(" was not measured").expect("a figure is missing");
            figures.put(name.to_owned(), 1_000);
        }
        figures
    }

    #[test]
    fn a_kind_that_was_counted_must_have_a_cost() {
        let mut figures = complete();
        figures.put("m4f.tick_dots_alone_cycles".to_owned(), 1_000);
        let message = costs(&figures).unwrap_err();
        assert!(message.contains("m4f.tick_dots_alone_cycles") && message.contains("add a line"), "{message}");
    }
}
