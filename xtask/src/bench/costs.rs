//! The file with the cost of each kind of layer, which compiler and board read. It is generated from measurements, and
//! checked against them.

use std::fmt::Write;

use super::Figures;
use super::figures::CYCLES;
use crate::command::{root, text, write};

const PATH: &str = "firmware/layers/src/measured.rs";

/// Numbers of curve points in the shorter and the longer of the two measured cases; the same for polygon vertices
/// below.
const SPEED_POINTS: (u64, u64) = (2, 8);
const POLYGON_POINTS: (u64, u64) = (4, 12);
/// Number of edges that are level with the finger in both polygons.
const POLYGON_EDGES_LEVEL: u64 = 2;
/// Vertices of the polygon whose edges are all level with the finger.
const LEVEL_POLYGON_POINTS: u64 = 6;

/// A core, as its costs are found in the figures.
struct Measured {
    /// Prefix of the names of ticks.
    tick: &'static str,
    /// Suffix of their core cycles, or of what [`Self::percent`] makes core cycles of.
    quantity: &'static str,
    /// Core cycles for 100 of the figure.
    percent: u64,
    /// Core cycles by which a tick with several rare events exceeds the longest measured case: a report of a fast touch
    /// source, an edge of the carrier, an active limit.
    rare: u64,
}

/// `cargo xtask soak` plays thousands of random scenes to find one whose rare events take more.
const M4F: Measured = Measured { tick: "m4f.tick_", quantity: CYCLES, percent: 100, rare: 60 };

/// Instructions, which are not followed one by one: a tick has ten times as many as on the M4F. An emulator of the
/// RP2040 that knows the cycles of each found 1.36 to 1.42 of them for an instruction, for a grating, a bitmap and
/// noise. Rare events take as many more as a tick does.
const M0_PLUS: Measured = Measured { tick: "m0plus.tick_", quantity: "", percent: 145, rare: 600 };

/// Core cycles, as in the file.
struct Costs {
    /// Name, description and core cycles of everything that is not a layer.
    parts: Vec<(&'static str, &'static str, u64)>,
    /// Name and core cycles of a layer, or of the part of it that another does not have.
    layers: Vec<(String, u64)>,
}

/// Regenerates the file.
pub(crate) fn bless(figures: &Figures) -> Result<(), String> {
    write(&root().join(PATH), measured(figures)?)
}

/// Fails if a cost in the file differs from the measurement. The error lists the differences.
pub(crate) fn check(figures: &Figures) -> Result<(), String> {
    let found = text(&root().join(PATH))?;
    let measured = measured(figures)?;
    if found == measured {
        return Ok(());
    }
    let drifted: Vec<&str> = measured.lines().filter(|line| !found.contains(line)).map(str::trim).collect();
    Err(format!(
        "{PATH} differs from the measurement: run `FRIXEL_BLESS=1 cargo xtask bench` to update it: {}",
        drifted.join(" ")
    ))
}

/// The file.
fn measured(figures: &Figures) -> Result<String, String> {
    Ok(file(&costs(figures, &M4F)?, &costs(figures, &M0_PLUS)?))
}

/// Suffix of the names of ticks that are counted only to find the cost of a layer.
const ALONE: &str = "_alone";
/// Between the names of two layers: the tick with the first costs as much as one with the second, and a part of its
/// own.
const OVER: &str = "_over_";
/// Ticks of one layer from which a part is computed.
const OF_PARTS: [&str; 8] =
    ["out_of_reach", "disturbed", "ellipse", "speed_2", "speed_8", "polygon_4", "polygon_12", "polygon_6_level"];
/// The layer whose work wherever the finger is counts once for all layers.
const STREAM: &str = "stream";

/// Computes the costs from measured ticks with one constant layer, two constant layers, or one layer of another kind.
fn costs(figures: &Figures, core: &Measured) -> Result<Costs, String> {
    let tick = |name: &str| {
        let name = format!("{}{name}{}", core.tick, core.quantity);
        let figure = figures.get(&name).ok_or_else(|| format!("{name} was not measured"))?;
        Ok::<u64, String>((figure * core.percent).div_ceil(100))
    };
    let two = tick("two_constants")?;
    let constant = two.saturating_sub(tick("constant_alone")?);
    let base = two.saturating_sub(2 * constant);
    let alone = |name: &str| tick(&format!("{name}{ALONE}")).map(|core_cycles| core_cycles.saturating_sub(base));
    let stream_elsewhere = tick("stream_elsewhere")?.saturating_sub(tick("constant_alone")?);
    let end = format!("{ALONE}{}", core.quantity);
    let counted = figures.keys().filter_map(|name| name.strip_prefix(core.tick)?.strip_suffix(&end));
    let layer = |name: &str| {
        let cost = alone(name)?;
        Ok(match name.split_once(OVER) {
            _ if name == STREAM => (name.to_owned(), cost.saturating_sub(stream_elsewhere)),
            Some((own, other)) => (own.to_owned(), cost.saturating_sub(alone(other)?)),
            None => (name.to_owned(), cost),
        })
    };
    let layers: Result<_, String> = counted.filter(|name| !OF_PARTS.contains(name)).map(layer).collect();
    // Ticks with the envelope at its slew limit, and ticks whose target exceeds the reachable friction, are longer
    // than others: take the longest.
    let longest =
        base.max(tick("1_of_64")?.saturating_sub(constant)).max(tick("out_of_reach_alone")?.saturating_sub(constant));
    // In any of them, the amplifier may be switching on.
    let switching = tick("disturbed_alone")?.saturating_sub(tick("constant_alone")?);
    let empty = longest + switching + core.rare;
    let (speed, speed_point) = line_through(SPEED_POINTS, alone("speed_2")?, alone("speed_8")?);
    let (polygon, polygon_edge) = line_through(POLYGON_POINTS, alone("polygon_4")?, alone("polygon_12")?);
    let more_level = LEVEL_POLYGON_POINTS - POLYGON_EDGES_LEVEL;
    let with_two_level = polygon + LEVEL_POLYGON_POINTS * polygon_edge;
    let polygon_edge_level = alone("polygon_6_level")?.saturating_sub(with_two_level).div_ceil(more_level);
    let polygon = polygon.saturating_sub(constant + POLYGON_EDGES_LEVEL * polygon_edge_level);
    let parts = vec![
        ("EMPTY", "A tick that looks at layers and finds none.", empty),
        ("SINE_CARRIER", "Extra cost of a sine carrier.", tick("two_constants_sine_carrier")?.saturating_sub(two)),
        ("SPEED", "A curve, and each of its points.", speed),
        ("SPEED_POINT", "", speed_point),
        ("STREAM_ELSEWHERE", "The stream's own work, wherever the finger is.", stream_elsewhere),
        ("ELLIPSE", "Extra cost of regions other than a rectangle.", alone("ellipse")?.saturating_sub(constant)),
        (
            "POLYGON",
            "A polygon, each of its edges, and what each of those adds that are level with the finger.",
            polygon,
        ),
        ("POLYGON_EDGE", "", polygon_edge),
        ("POLYGON_EDGE_LEVEL", "", polygon_edge_level),
    ];
    Ok(Costs { parts, layers: layers? })
}

/// Cost without points and cost per point, chosen so that neither of the two measured cases exceeds the line.
fn line_through((few, many): (u64, u64), at_few: u64, at_many: u64) -> (u64, u64) {
    let each = at_many.saturating_sub(at_few).div_ceil(many - few);
    (at_few.saturating_sub(few * each).max(at_many.saturating_sub(many * each)), each)
}

fn file(m4f: &Costs, m0_plus: &Costs) -> String {
    let mut text = String::from(
        "//! Core cycles on a Cortex-M4F and on a Cortex-M0+ at the worst input, estimated. Written by\n\
         //! `FRIXEL_BLESS=1 cargo xtask bench`; `cargo xtask ci budgets` measures again and fails when it finds others.\n\
         #![allow(dead_code, reason = \"a kind whose feature is off costs nothing\")]\n\n\
         use crate::cost::Cost;\n",
    );
    for ((name, comment, on_m4f), (.., on_m0_plus)) in m4f.parts.iter().zip(&m0_plus.parts) {
        let comment = if comment.is_empty() { String::new() } else { format!("\n// {comment}\n") };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{comment}pub(crate) const {name}: Cost = Cost::new({on_m4f}, {on_m0_plus});");
    }
    text += "\n/// Layers, in a rectangle; `kind::measured_cost` finds one by its name.\n\
             pub(crate) const LAYERS: &[(&str, Cost)] = &[\n";
    for (name, on_m4f) in &m4f.layers {
        // A layer that was counted on one core alone fails the comparison with the file.
        let on_m0_plus = m0_plus.layers.iter().find(|(other, _)| other == name).map_or(0, |(_, cycles)| *cycles);
        let _ = writeln!(text, "    (\"{name}\", Cost::new({on_m4f}, {on_m0_plus})),");
    }
    text += "];\n";
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
        while let Err(missing) = costs(&figures, &M4F).and_then(|_| costs(&figures, &M0_PLUS)) {
            let name = missing.strip_suffix(" was not measured").expect("a figure is missing");
            figures.insert(name.to_owned(), 1_000);
        }
        figures
    }

    #[test]
    fn a_layer_that_was_counted_has_a_cost_and_a_part_is_no_layer() {
        let mut figures = complete();
        figures.insert("m4f.tick_dots_alone_cycles".to_owned(), 1_600);
        figures.insert("m4f.tick_stars_over_dots_alone_cycles".to_owned(), 1_650);
        let names = |costs: Costs| costs.layers.into_iter().map(|(name, _)| name).collect::<Vec<_>>();
        assert_eq!(names(costs(&figures, &M4F).unwrap()), ["constant", "dots", "stars"]);
        figures.insert("m0plus.tick_dots_alone".to_owned(), 6_000);
        let text = measured(&figures).unwrap();
        assert!(text.contains("(\"dots\", Cost::new(600, 7250))"), "{text}");
        assert!(text.contains("(\"stars\", Cost::new(50, 0))"), "{text}");
    }
}
