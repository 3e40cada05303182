//! The cost of a tick against the number of layers in the scene.

use super::{Figure, ReportError};
use crate::report::counts::Counts;
use crate::report::figure::Data;
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel, RGBColor};

const CORE: &str = "m4f";
/// Numbers of layers in the scene.
const LAYERS: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];
/// Range of the axis of layers, with room for a note beside the last point.
const LAYERS_SHOWN: (f64, f64) = (0.9, 80.0);
/// Numbers of layers under the finger, with their style and name.
const UNDER: [(usize, RGBColor, &str); 2] =
    [(1, PALETTE[0], "one under the finger"), (8, PALETTE[1], "eight under the finger")];

/// The counts of a tick with some layers under the finger and others elsewhere.
struct Counted {
    layers: f64,
    worst: f64,
    mean: Option<f64>,
}

fn counted(counts: &Counts, under: usize) -> Vec<Counted> {
    let of = |layers: usize| {
        let what = format!("tick_{under}_of_{layers}");
        let worst = counts.instructions(CORE, &what)?;
        Some(Counted { layers: layers as f64, worst, mean: counts.mean(CORE, &what) })
    };
    LAYERS.into_iter().filter_map(of).collect()
}

/// Mean number of instructions that layers away from the finger add to the tick with the fewest layers. The longest
/// ticks also differ by rare events, such as an early edge of the carrier.
fn added(curve: &[Counted]) -> Option<f64> {
    let (first, others) = curve.split_first()?;
    let fewest = first.mean?;
    others.iter().filter_map(|counted| Some(counted.mean? - fewest)).reduce(f64::max)
}

/// Returns `None` if `counts` has no such tick.
pub(super) fn figure(counts: &Counts) -> Result<Option<Figure>, ReportError> {
    let curves = UNDER.map(|(under, colour, name)| (under, colour, name, counted(counts, under)));
    let worst = curves.iter().flat_map(|(.., curve)| curve).map(|counted| counted.worst).reduce(f64::max);
    let Some(worst) = worst else { return Ok(None) };
    let mut data = Data::new(["core", "layers_under_the_finger", "layers", "instructions", "mean_instructions"]);
    let mut panel = Panel::new(
        "A tick on a Cortex-M4F",
        Axis::log("layers in the scene", LAYERS_SHOWN.0..LAYERS_SHOWN.1),
        Axis::linear("instructions of a tick", 0.0..1.12 * worst),
    );
    let mut additions = Vec::new();
    for (under, colour, name, curve) in &curves {
        for counted in curve {
            let (layers, mean) = (counted.layers.into(), counted.mean.into());
            data.row([CORE.into(), (*under).into(), layers, counted.worst.into(), mean]);
            panel.notes.push((counted.layers, counted.worst + 0.04 * worst, counted.worst.to_string()));
        }
        let worst = curve.iter().map(|counted| (counted.layers, counted.worst)).collect();
        let mean = curve.iter().filter_map(|counted| Some((counted.layers, counted.mean?))).collect();
        panel.add(&format!("{name}, worst"), Look { colour: *colour, line: Line::Solid, mark: Mark::Disc }, worst);
        panel.add(&format!("{name}, mean"), Look { colour: *colour, line: Line::Thin, mark: Mark::Ring }, mean);
        additions.extend(added(curve).map(|more| format!("with {name} they add {more} instructions on average")));
    }
    let elsewhere = if additions.is_empty() { String::new() } else { format!(": {}", additions.join("; ")) };
    Ok(Some(Figure {
        name: "tick-cost-against-layers",
        title: "Cost of a tick against the number of layers".to_owned(),
        caption: vec![
            format!(
                "Instructions of a tick while a finger comes down, slides, rests and slides on: the longest tick, and \
                 the mean of all. Each layer is a constant in a rectangle; those that are not under the finger lie \
                 elsewhere on the screen. A grid with a bit for each layer lets a tick look only at the layers near \
                 the finger, so that layers elsewhere hardly count{elsewhere}. The longest ticks differ by what else \
                 falls into them, such as an early edge of the carrier."
            ),
            format!(
                "A scene is refused when a tick at some place is estimated at more cycles than the board states in its \
                 hello; the estimate adds up cycles by class of instruction. Instructions were {}.",
                counts.origin()
            ),
        ],
        chart: Chart::new(vec![panel], 1),
        csv: data.csv()?,
    }))
}
