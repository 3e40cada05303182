//! Strips below the axis of a plot: further values along it, such as the place of a finger over time.

use std::ops::Range;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::style::{NOTE, Scale, text_width};
use super::{Area, Axis, Drawn, RGBColor};

/// Height of a strip, in pixels.
pub(super) const STRIP_HEIGHT: u32 = 20;
/// Space between a strip's name and the plot's left edge, and on both sides of a text, in pixels.
const GAP: u32 = 8;
/// Opacity of a cell's colour.
const OPACITY: f64 = 0.3;
/// Smallest width of a coloured cell, in pixels, so that a part of a few milliseconds stays visible.
const COLOUR_WIDTH_MIN: u32 = 2;

/// A row of texts below the axis of a plot.
#[derive(Clone, Debug)]
pub struct Strip {
    /// Name of the strip, to the left of the plot.
    pub label: String,
    /// The texts, from left to right.
    pub cells: Vec<StripCell>,
}

/// A text below a part of the axis. It is omitted if the part is too narrow for it; at a part of zero width, it is
/// centred.
#[derive(Clone, Debug)]
pub struct StripCell {
    /// The part of the axis.
    pub x: Range<f64>,
    /// The text.
    pub text: String,
    /// Colour behind the text; `None` for none.
    pub colour: Option<RGBColor>,
}

/// Draws strips, one below another. `plot` has the left and right edge of the plot, in units; `top` is in pixels.
pub(super) fn draw<DB: DrawingBackend>(
    area: &Area<DB>,
    strips: &[Strip],
    x: &Axis,
    plot: Range<i32>,
    top: u32,
    scale: Scale,
) -> Drawn {
    let width = f64::from(plot.end - plot.start);
    let place = |value: f64| plot.start + (x.part(value).unwrap_or(0.0).clamp(0.0, 1.0) * width).round() as i32;
    for (number, strip) in (0..).zip(strips) {
        let top = top + number * STRIP_HEIGHT;
        let middle = scale.px(top + STRIP_HEIGHT / 2) as i32;
        let name = (plot.start - scale.px(GAP) as i32, middle);
        area.draw(&Text::new(strip.label.as_str(), name, scale.letters_at(NOTE, HPos::Right)))?;
        for cell in &strip.cells {
            let (left, right) = (place(cell.x.start), place(cell.x.end));
            if let Some(colour) = cell.colour {
                let right = right.max(left + scale.px(COLOUR_WIDTH_MIN) as i32);
                let corners = [(left, scale.px(top + 2) as i32), (right, scale.px(top + STRIP_HEIGHT - 2) as i32)];
                area.draw(&Rectangle::new(corners, colour.mix(OPACITY).filled()))?;
            }
            let needed = scale.px(text_width(&cell.text, NOTE)? + 2 * GAP) as i32;
            if left == right || right - left >= needed {
                let centre = (left.midpoint(right), middle);
                area.draw(&Text::new(cell.text.as_str(), centre, scale.letters_at(NOTE, HPos::Center)))?;
            }
        }
    }
    Ok(())
}
