//! `scene.png`: the friction map of a program, with the stroke over it.

use super::map::chart;
use super::trace::Trace;
use super::{DrawingError, Subject};
use frixel_chart::{Line, Look, Mark, RGBColor};
use frixel_felt::Preview;
use frixel_layers::Layer;
use frixel_scene::Program;

const STROKE: RGBColor = RGBColor(255, 59, 48);
const CASING: RGBColor = RGBColor(255, 255, 255);

/// Draws the friction that a program targets everywhere on the screen, and the stroke of a run over it. The colours
/// span the reachable range; targets beyond it have the colour of the nearer end, and are hatched.
///
/// Friction that depends on the finger's speed is drawn at the stroke's median speed, and vibrations and streams at
/// their largest; the caption says so.
pub(crate) fn draw_scene_png(subject: &Subject, program: &Program, trace: &Trace) -> Result<Vec<u8>, DrawingError> {
    let default = Preview::default();
    let median_m_per_s = trace.median_speed_mm_s().map(|speed_mm_s| 1e-3 * speed_mm_s);
    let preview = Preview { speed_m_per_s: median_m_per_s.unwrap_or(default.speed_m_per_s), ..default };
    let mut chart = chart(&subject.title(), program, &preview);
    let depends_on_speed = program.records.iter().any(|record| matches!(record.layer, Layer::Speed(_)));
    if median_m_per_s.is_some() && depends_on_speed {
        chart.caption.push("That is the stroke's median speed.".to_owned());
    }
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
    Ok(chart.png()?)
}
