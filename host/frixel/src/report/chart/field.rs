//! Coloured fields: a value over a plane.

use std::ops::Range;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{Area, Axis, Drawn, FAMILY, FINE, px};
use crate::output::scale;

/// By how much a cell reaches under its neighbours.
const OVERLAP: i32 = FINE as i32;
/// Steps of a colour bar.
const BAR_STEPS: i32 = 64;

/// A value above zero over a plane, its logarithm as a colour.
#[derive(Clone, Debug)]
pub(in crate::report) struct Field {
    pub(in crate::report) cells: Vec<Cell>,
    /// What the colours mean.
    pub(in crate::report) colours: Axis,
}

/// A rectangle of one value.
#[derive(Clone, Debug)]
pub(in crate::report) struct Cell {
    pub(in crate::report) x: Range<f64>,
    pub(in crate::report) y: Range<f64>,
    pub(in crate::report) value: f64,
}

fn colour(axis: &Axis, value: f64) -> RGBColor {
    let Range { start, end } = axis.places();
    // What has no logarithm is zero: the lowest colour.
    let part = axis.place(value).map_or(0.0, |place| (place - start) / (end - start));
    let [red, green, blue] = scale::colour(part);
    RGBColor(red, green, blue)
}

pub(super) fn draw(canvas: &Area, field: &Field, x: &Axis, y: &Axis, at: impl Fn(&(f64, f64)) -> (i32, i32)) -> Drawn {
    let (width, height) = canvas.dim_in_pixel();
    let (width, height) = (width as i32, height as i32);
    for cell in &field.cells {
        let corner = |across: f64, up: f64| x.place(across).zip(y.place(up));
        if let (Some(low), Some(high)) = (corner(cell.x.start, cell.y.start), corner(cell.x.end, cell.y.end)) {
            let ((left, bottom), (right, top)) = (at(&low), at(&high));
            // A little more to the right and down, where the next cell covers it, so that no background shows between them.
            let (right, bottom) = ((right + OVERLAP).min(width), (bottom + OVERLAP).min(height));
            let corners = [(left, top), (right, bottom)];
            canvas.draw(&Rectangle::new(corners, colour(&field.colours, cell.value).filled()))?;
        }
    }
    Ok(())
}

/// The colour bar to the right of a plot that ends at `right` and begins at `top`.
pub(super) fn draw_bar(area: &Area, field: &Field, (right, top): (i32, i32), height: u32) -> Drawn {
    let left = right + px(14) as i32;
    let end = left + px(12) as i32;
    let places = field.colours.places();
    let level = |part: f64| top + ((1.0 - part) * f64::from(height)).round() as i32;
    for step in 0..BAR_STEPS {
        let part = |step: i32| f64::from(step) / f64::from(BAR_STEPS);
        let [red, green, blue] = scale::colour(part(step) + 0.5 / f64::from(BAR_STEPS));
        let corners = [(left, level(part(step + 1))), (end, (level(part(step)) + OVERLAP).min(level(0.0)))];
        area.draw(&Rectangle::new(corners, RGBColor(red, green, blue).filled()))?;
    }
    let style = (FAMILY, px(14)).into_font().color(&BLACK).pos(Pos::new(HPos::Left, VPos::Center));
    for tick in field.colours.ticks() {
        let y = level((tick - places.start) / (places.end - places.start));
        area.draw(&PathElement::new([(end, y), (end + px(4) as i32, y)], BLACK.stroke_width(px(1))))?;
        area.draw(&Text::new(field.colours.tick_label(tick), (end + px(7) as i32, y), style.clone()))?;
    }
    let style = (FAMILY, px(14)).into_font().color(&BLACK).pos(Pos::new(HPos::Right, VPos::Center));
    let title = (right + px(92) as i32, top - px(12) as i32);
    area.draw(&Text::new(field.colours.label.clone(), title, style))?;
    Ok(())
}
