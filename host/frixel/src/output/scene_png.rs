//! `scene.png`: the friction map of a program, with colour scale, rulers and the stroke over it.

use std::path::Path;

use super::OutputError;
use super::canvas::{Anchor, Canvas, Colour, WHITE};
use super::map::{Frame, LABEL_SIZE, LEFT, TITLE_SIZE, TOP};
use super::scale::colour;
use super::trace::Trace;
use frixel_scene::Program;
use frixel_scene::reference::Reference;

/// Largest size of the map, in pixels.
const MAP_MAX: (f64, f64) = (1_000.0, 800.0);
const STROKE: Colour = [255, 59, 48];

/// Writes the friction that a program wants all over the screen, and the stroke of a run. The colours span the reach;
/// what is beyond has the colour of its end.
pub fn write_scene_png(path: &Path, title: &str, program: &Program, trace: &Trace) -> Result<(), OutputError> {
    let frame = Frame::of(program, MAP_MAX);
    let mut canvas = Canvas::new(frame.outer_width(), frame.outer_height()).map_err(OutputError::drawing(path))?;
    draw_map(&mut canvas, &frame, program);
    draw_stroke(&mut canvas, &frame, trace);
    frame.draw_rulers(&mut canvas);
    frame.draw_scale(&mut canvas, &program.reach, colour);
    canvas.text(title, TITLE_SIZE, (LEFT as i64, 26), Anchor::Start);
    canvas.write_png(path).map_err(OutputError::encoding(path))
}

fn draw_map(canvas: &mut Canvas, frame: &Frame, program: &Program) {
    let reference = Reference::new(program);
    frame.draw_map(canvas, |_, (x_m, y_m)| {
        colour(reference.electric_friction_n(x_m, y_m) / program.reach.electric_friction_max_n)
    });
}

/// The stroke, cased in white, with a dot where it starts.
fn draw_stroke(canvas: &mut Canvas, frame: &Frame, trace: &Trace) {
    let place =
        |(x_mm, y_mm): (f64, f64)| (LEFT as f64 + x_mm * frame.pixels_per_mm, TOP as f64 + y_mm * frame.pixels_per_mm);
    let mut lines: Vec<Vec<(f64, f64)>> =
        trace.strokes().map(|stroke| stroke.into_iter().map(place).collect()).collect();
    let Some(start) = lines.first().and_then(|line| line.first()).copied() else { return };
    // The key above the map, drawn like the stroke.
    let key = ((LEFT + frame.width) as f64 - 110.0, 38.0);
    lines.push(vec![key, (key.0 + 36.0, key.1)]);
    let starts = [vec![start], vec![key]];
    for (colour, casing) in [(WHITE, 3.0), (STROKE, 0.0)] {
        canvas.stroke(&lines, 2.6 + casing, colour);
        canvas.stroke(&starts, 12.0 + casing, colour);
    }
    canvas.text("stroke", LABEL_SIZE, (key.0 as i64 + 46, key.1 as i64), Anchor::Start);
}
