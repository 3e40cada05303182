//! `scene.png`: the friction map of a program, with colour scale, rulers and the stroke over it.

use std::io;
use std::path::Path;

use super::OutputError;
use super::canvas::{Anchor, BLACK, Canvas, Colour, WHITE};
use super::scale::{colour, label, step, ticks};
use super::trace::Trace;
use crate::scene::Program;
use crate::wanted::Wanted;

/// Largest size of the map, in pixels.
const MAP_WIDTH_MAX: f64 = 1_000.0;
const MAP_HEIGHT_MAX: f64 = 800.0;
/// Space around the map, in pixels.
const LEFT: usize = 84;
const RIGHT: usize = 150;
const TOP: usize = 60;
const BOTTOM: usize = 72;
/// Place and width of the colour scale, from the map's right edge, in pixels.
const SCALE_GAP: usize = 30;
const SCALE_WIDTH: usize = 26;

const STROKE: Colour = [255, 59, 48];
const TITLE_SIZE: f32 = 19.0;
const LABEL_SIZE: f32 = 14.0;

/// Writes the friction that a program wants all over the screen, and the stroke of a run. The colours span the reach;
/// what is beyond has the colour of its end.
pub fn write_scene_png(path: &Path, title: &str, program: &Program, trace: &Trace) -> Result<(), OutputError> {
    let frame = Frame::of(program);
    let size = (LEFT + frame.width + RIGHT, TOP + frame.height + BOTTOM);
    let mut canvas = Canvas::new(size.0, size.1).map_err(|error| {
        let reason = error.to_string();
        OutputError::Drawing { path: path.to_owned(), reason }
    })?;
    draw_map(&mut canvas, &frame, program);
    draw_stroke(&mut canvas, &frame, trace);
    draw_rulers(&mut canvas, &frame);
    draw_scale(&mut canvas, &frame, program);
    canvas.text(title, TITLE_SIZE, (LEFT as i64, 26), Anchor::Start);
    canvas.write_png(path).map_err(|error| {
        let source = io::Error::other(error);
        OutputError::File { path: path.to_owned(), source }
    })
}

/// Size of the map.
struct Frame {
    width: usize,
    height: usize,
    pixels_per_mm: f64,
    screen_mm: (f64, f64),
}

impl Frame {
    fn of(program: &Program) -> Self {
        let mm = |metres: f32| (1e6 * f64::from(metres)).round() / 1e3;
        let screen_mm = (mm(program.header.screen_width_m), mm(program.header.screen_height_m));
        let pixels_per_mm = (MAP_WIDTH_MAX / screen_mm.0).min(MAP_HEIGHT_MAX / screen_mm.1);
        let pixels = |mm: f64| (mm * pixels_per_mm).round().max(1.0) as usize;
        Self { width: pixels(screen_mm.0), height: pixels(screen_mm.1), pixels_per_mm, screen_mm }
    }

    /// A length in whole pixels.
    fn pixels(&self, mm: f64) -> usize {
        (mm * self.pixels_per_mm).round() as usize
    }
}

fn draw_map(canvas: &mut Canvas, frame: &Frame, program: &Program) {
    let wanted = Wanted::new(program);
    let metres = |pixel: usize| (pixel as f64 + 0.5) / frame.pixels_per_mm * 1e-3;
    for row in 0..frame.height {
        for column in 0..frame.width {
            let friction_n = wanted.electric_friction_n(metres(column), metres(row));
            let part = friction_n / program.reach.electric_friction_max_n;
            canvas.fill((LEFT + column, TOP + row), (1, 1), colour(part));
        }
    }
    canvas.frame((LEFT, TOP), (frame.width, frame.height));
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

/// Millimetres along the bottom and the left.
fn draw_rulers(canvas: &mut Canvas, frame: &Frame) {
    let step_mm = step(50.0 / frame.pixels_per_mm);
    let bottom = TOP + frame.height;
    for (step_mm, length) in [(step_mm / 10.0, 4), (step_mm / 2.0, 6), (step_mm, 9)] {
        for mm in ticks(0.0, frame.screen_mm.0, step_mm) {
            canvas.fill((LEFT + frame.pixels(mm), bottom + 1), (1, length), BLACK);
        }
        for mm in ticks(0.0, frame.screen_mm.1, step_mm) {
            canvas.fill((LEFT - 1 - length, TOP + frame.pixels(mm)), (length, 1), BLACK);
        }
    }
    for mm in ticks(0.0, frame.screen_mm.0, step_mm) {
        let x = (LEFT + frame.pixels(mm)) as i64;
        canvas.text(&label(mm), LABEL_SIZE, (x, bottom as i64 + 22), Anchor::Middle);
    }
    for mm in ticks(0.0, frame.screen_mm.1, step_mm) {
        let y = (TOP + frame.pixels(mm)) as i64;
        canvas.text(&label(mm), LABEL_SIZE, (LEFT as i64 - 16, y), Anchor::End);
    }
    let middle = ((LEFT + frame.width / 2) as i64, (TOP + frame.height / 2) as i64);
    canvas.text("x, mm", LABEL_SIZE, (middle.0, bottom as i64 + 50), Anchor::Middle);
    canvas.text("y, mm", LABEL_SIZE, (20, middle.1), Anchor::Upright);
}

/// Friction in total, and its colours.
fn draw_scale(canvas: &mut Canvas, frame: &Frame, program: &Program) {
    let left = LEFT + frame.width + SCALE_GAP;
    let height = frame.height as f64;
    for row in 0..frame.height {
        let part = 1.0 - (row as f64 + 0.5) / height;
        canvas.fill((left, TOP + row), (SCALE_WIDTH, 1), colour(part));
    }
    canvas.frame((left, TOP), (SCALE_WIDTH, frame.height));
    let (least_mn, most_mn) = (1e3 * program.reach.friction_min_n(), 1e3 * program.reach.friction_max_n());
    let span_mn = most_mn - least_mn;
    let right = left + SCALE_WIDTH;
    for mn in ticks(least_mn, most_mn, step(span_mn * 40.0 / height)) {
        let row = TOP + ((most_mn - mn) / span_mn * height).round() as usize;
        canvas.fill((right + 1, row), (6, 1), BLACK);
        canvas.text(&label(mn), LABEL_SIZE, (right as i64 + 13, row as i64), Anchor::Start);
    }
    let middle = (TOP + frame.height / 2) as i64;
    canvas.text("friction wanted, mN", LABEL_SIZE, (right as i64 + 80, middle), Anchor::Upright);
}
