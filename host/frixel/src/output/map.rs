//! What every map of a screen has around it: rulers in millimetres, and a colour scale in newtons.

use super::canvas::{Anchor, BLACK, Canvas, Colour};
use super::scale::{label, step, ticks};
use frixel_scene::{Program, Reach};

/// Space around the map, in pixels.
pub(super) const LEFT: usize = 84;
const RIGHT: usize = 150;
pub(super) const TOP: usize = 60;
const BOTTOM: usize = 72;
/// Place and width of the colour scale, from the map's right edge, in pixels.
const SCALE_GAP: usize = 30;
const SCALE_WIDTH: usize = 26;
/// Least distance of two numbers on the colour scale, and of two on a ruler, in pixels.
const SCALE_STEP: f64 = 40.0;
const RULER_STEP: f64 = 50.0;

pub(super) const TITLE_SIZE: f32 = 19.0;
pub(super) const LABEL_SIZE: f32 = 14.0;

/// Size of a map.
pub(super) struct Frame {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels_per_mm: f64,
    screen_mm: (f64, f64),
}

impl Frame {
    /// The largest map of a program's screen within so many pixels.
    pub(super) fn of(program: &Program, (width_max, height_max): (f64, f64)) -> Self {
        let mm = |metres: f32| (1e6 * f64::from(metres)).round() / 1e3;
        let screen_mm = (mm(program.header.screen_width_m), mm(program.header.screen_height_m));
        let pixels_per_mm = (width_max / screen_mm.0).min(height_max / screen_mm.1);
        let pixels = |mm: f64| (mm * pixels_per_mm).round().max(1.0) as usize;
        Self { width: pixels(screen_mm.0), height: pixels(screen_mm.1), pixels_per_mm, screen_mm }
    }

    pub(super) fn outer_width(&self) -> usize {
        LEFT + self.width + RIGHT
    }

    pub(super) fn outer_height(&self) -> usize {
        TOP + self.height + BOTTOM
    }

    /// Gives every pixel of the map a colour, from its column and row and from its place on the screen in metres.
    pub(super) fn draw_map(&self, canvas: &mut Canvas, mut colour: impl FnMut((usize, usize), (f64, f64)) -> Colour) {
        let metres = |pixel: usize| (pixel as f64 + 0.5) / self.pixels_per_mm * 1e-3;
        for row in 0..self.height {
            for column in 0..self.width {
                let colour = colour((column, row), (metres(column), metres(row)));
                canvas.fill((LEFT + column, TOP + row), (1, 1), colour);
            }
        }
        canvas.frame((LEFT, TOP), (self.width, self.height));
    }

    /// Millimetres along the bottom and the left.
    pub(super) fn draw_rulers(&self, canvas: &mut Canvas) {
        let step_mm = step(RULER_STEP / self.pixels_per_mm);
        let bottom = TOP + self.height;
        for (step_mm, length) in [(step_mm / 10.0, 4), (step_mm / 2.0, 6), (step_mm, 9)] {
            for mm in ticks(0.0, self.screen_mm.0, step_mm) {
                canvas.fill((LEFT + self.pixels(mm), bottom + 1), (1, length), BLACK);
            }
            for mm in ticks(0.0, self.screen_mm.1, step_mm) {
                canvas.fill((LEFT - 1 - length, TOP + self.pixels(mm)), (length, 1), BLACK);
            }
        }
        for mm in ticks(0.0, self.screen_mm.0, step_mm) {
            let x = (LEFT + self.pixels(mm)) as i64;
            canvas.text(&label(mm), LABEL_SIZE, (x, bottom as i64 + 22), Anchor::Middle);
        }
        for mm in ticks(0.0, self.screen_mm.1, step_mm) {
            let y = (TOP + self.pixels(mm)) as i64;
            canvas.text(&label(mm), LABEL_SIZE, (LEFT as i64 - 16, y), Anchor::End);
        }
        let middle = ((LEFT + self.width / 2) as i64, (TOP + self.height / 2) as i64);
        canvas.text("x, mm", LABEL_SIZE, (middle.0, bottom as i64 + 50), Anchor::Middle);
        canvas.text("y, mm", LABEL_SIZE, (20, middle.1), Anchor::Upright);
    }

    /// Friction in total, and the colour of each part of the reach, over what can be reached.
    pub(super) fn draw_scale(&self, canvas: &mut Canvas, reach: &Reach, colour: fn(f64) -> Colour) {
        let (left, top) = self.scale_corner();
        let height = self.height as f64;
        for row in 0..self.height {
            let part = 1.0 - (row as f64 + 0.5) / height;
            canvas.fill((left, top + row), (SCALE_WIDTH, 1), colour(part));
        }
        canvas.frame((left, top), (SCALE_WIDTH, self.height));
        let (least_n, most_n) = (reach.friction_min_n(), reach.friction_max_n());
        let span_n = most_n - least_n;
        let right = left + SCALE_WIDTH;
        for friction_n in ticks(least_n, most_n, step(span_n * SCALE_STEP / height)) {
            let row = top + ((most_n - friction_n) / span_n * height).round() as usize;
            canvas.fill((right + 1, row), (6, 1), BLACK);
            canvas.text(&label(friction_n), LABEL_SIZE, (right as i64 + 13, row as i64), Anchor::Start);
        }
        let middle = (top + self.height / 2) as i64;
        canvas.text("friction wanted, N", LABEL_SIZE, (right as i64 + 80, middle), Anchor::Upright);
    }

    /// The top left corner of the colour scale, in pixels.
    fn scale_corner(&self) -> (usize, usize) {
        (LEFT + self.width + SCALE_GAP, TOP)
    }

    /// A length in whole pixels.
    fn pixels(&self, mm: f64) -> usize {
        (mm * self.pixels_per_mm).round() as usize
    }
}
