//! `scene.png`: the friction map of a program, with the stroke over it.

use std::fs;
use std::path::Path;

use super::map::chart;
use super::trace::Trace;
use super::{OutputError, Subject};
use crate::chart::{Line, Look, Mark, RGBColor, colour};
use frixel_scene::reference::Reference;
use frixel_scene::{MapGrid, Program};

/// Largest size of the map, in pixels.
const MAP_MAX: (u32, u32) = (1_000, 800);
const STROKE: RGBColor = RGBColor(255, 59, 48);
const CASING: RGBColor = RGBColor(255, 255, 255);

/// Draws the friction that a program targets everywhere on the screen, and the stroke of a run over it. The colours
/// span the reachable range; targets beyond it have the colour of the nearer end.
pub fn write_scene_png(path: &Path, subject: &Subject, program: &Program, trace: &Trace) -> Result<(), OutputError> {
    let grid = MapGrid::new(program, MAP_MAX);
    let reference = Reference::new(program);
    let colour_at =
        |(x_m, y_m)| colour(reference.electric_friction_n(x_m, y_m) / program.reach.electric_friction_max_n);
    let mut chart = chart(&grid, grid.places_m().map(colour_at).collect(), &program.reach);
    chart.title = subject.title();
    let strokes: Vec<Vec<(f64, f64)>> = trace.strokes().collect();
    let start = strokes.first().and_then(|stroke| stroke.first()).copied();
    for panel in &mut chart.panels {
        // A white outline makes the stroke visible on every colour.
        for (look, mark) in [
            (Look::line(CASING, Line::Thick), Look::mark(CASING, Mark::Casing)),
            (Look::line(STROKE, Line::Solid), Look::mark(STROKE, Mark::Disc)),
        ] {
            for stroke in &strokes {
                panel.add("", look, stroke.clone());
            }
            panel.add("", mark, start.into_iter().collect());
        }
        if start.is_some() {
            panel.add("stroke, from its dot", Look { line: Line::Solid, ..Look::mark(STROKE, Mark::Disc) }, Vec::new());
        }
    }
    let bytes = chart.png().map_err(OutputError::drawing(path))?;
    fs::write(path, bytes).map_err(|source| OutputError::File { path: path.to_owned(), source })
}
