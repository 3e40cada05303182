//! Drawing of one panel.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::clip::clipped;
use super::strip::{self, STRIP_HEIGHT};
use super::style::{AXIS_LABEL, EDGE, LABEL, NOTE, Scale, TITLE, grid};
use super::{Area, Drawn, Line, Mark, Panel, Series};

/// Length of a tick mark on an axis, in pixels.
const TICK: u32 = 5;

/// Maps values to positions on the canvas of a plot.
pub(super) struct Plane<'p> {
    panel: &'p Panel,
    /// Width and height, in units of the drawing area.
    pub(super) size: (f64, f64),
}

impl Plane<'_> {
    /// Position of a pair of values, from the plot's top left corner; `None` if an axis has no position for its value.
    pub(super) fn place(&self, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        let (x, y) = self.panel.x.part(x).zip(self.panel.y.part(y))?;
        Some((x * self.size.0, (1.0 - y) * self.size.1))
    }

    /// Position of a pair of values, rounded to whole units.
    pub(super) fn unit(&self, values: (f64, f64)) -> Option<(i32, i32)> {
        self.place(values).map(rounded)
    }
}

fn rounded((x, y): (f64, f64)) -> (i32, i32) {
    (x.round() as i32, y.round() as i32)
}

/// Draws a panel at the top of an area.
pub(super) fn draw<DB: DrawingBackend>(area: &Area<DB>, panel: &Panel, scale: Scale) -> Drawn {
    let margins = panel.margins;
    let (area, _) = area.split_vertically(scale.px(panel.height));
    if !panel.title.is_empty() {
        let place = (scale.px(margins.left) as i32, scale.px(margins.top / 2 + 2) as i32);
        area.draw(&Text::new(panel.title.as_str(), place, scale.letters_at(TITLE, HPos::Left)))?;
    }
    let strips_height = panel.strips.len() as u32 * STRIP_HEIGHT;
    let mut chart = ChartBuilder::on(&area)
        .margin_top(scale.px(margins.top))
        .margin_left(scale.px(EDGE))
        .margin_right(scale.px(margins.right))
        .margin_bottom(scale.px(strips_height))
        .x_label_area_size(scale.px(margins.bottom))
        .y_label_area_size(scale.px(margins.left - EDGE))
        .build_cartesian_2d(panel.x.clone(), panel.y.clone())?;
    let grid = if panel.field.as_ref().is_some_and(|field| field.raster().is_some()) { TRANSPARENT } else { grid() };
    chart
        .configure_mesh()
        .x_desc(panel.x.label.as_str())
        .y_desc(panel.y.label.as_str())
        .label_style(scale.letters(LABEL))
        .axis_desc_style(scale.letters(AXIS_LABEL))
        .set_all_tick_mark_size(scale.px(TICK))
        .axis_style(scale.stroke(1))
        .bold_line_style(grid.stroke_width(scale.px(1)))
        .light_line_style(TRANSPARENT)
        .draw()?;
    let canvas = chart.plotting_area().strip_coord_spec();
    let (width, height) = canvas.dim_in_pixel();
    let plane = Plane { panel, size: (f64::from(width), f64::from(height)) };
    let (left, _) = canvas.get_base_pixel();
    let left = left - area.get_base_pixel().0;
    let plot = left..left + width as i32;
    strip::draw(&area, &panel.strips, &panel.x, plot, panel.height - strips_height, scale)?;
    if let Some(field) = &panel.field {
        field.draw(&canvas, &plane, scale)?;
        let (left, top) = canvas.get_base_pixel();
        let (area_left, area_top) = area.get_base_pixel();
        field.draw_scale(&area, (left - area_left + width as i32, top - area_top), height, scale)?;
    }
    for series in &panel.series {
        draw_series(&canvas, series, &plane, scale)?;
    }
    for (x, y, note) in &panel.notes {
        if let Some((x, y)) = plane.unit((*x, *y)) {
            let place = (x + scale.px(8) as i32, y);
            canvas.draw(&Text::new(note.as_str(), place, scale.letters_at(NOTE, HPos::Left)))?;
        }
    }
    Ok(())
}

fn draw_series<DB: DrawingBackend>(canvas: &Area<DB>, series: &Series, plane: &Plane, scale: Scale) -> Drawn {
    let places: Vec<_> = series.points.iter().map(|values| plane.place(*values)).collect();
    let (width, height) = plane.size;
    match series.look.line {
        Line::None => {}
        Line::Filled(_) => {
            let inside = |(x, y): &(f64, f64)| rounded((x.clamp(0.0, width), y.clamp(0.0, height)));
            let corners: Vec<_> = places.iter().flatten().map(inside).collect();
            scale.draw_line(canvas, &corners, &series.look)?;
        }
        _ => {
            for stretch in clipped(&places, &(0.0..width), &(0.0..height)) {
                let line: Vec<_> = stretch.into_iter().map(rounded).collect();
                scale.draw_line(canvas, &line, &series.look)?;
            }
        }
    }
    if series.look.mark != Mark::None {
        for (x, y) in places.iter().flatten() {
            if (0.0..=width).contains(x) && (0.0..=height).contains(y) {
                scale.draw_mark(canvas, rounded((*x, *y)), &series.look)?;
            }
        }
    }
    Ok(())
}
