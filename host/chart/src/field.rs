//! Coloured fields: a value over a plane, with a colour scale.

use std::ops::Range;

use plotters::element::BitMapElement;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::plot::Plane;
use super::style::{NOTE, Scale, colour};
use super::{Area, Axis, DrawError, Drawn};

/// Number of steps in which a colour scale is drawn.
const SCALE_STEPS: u32 = 64;
/// Distance of the colour scale from the plot's right edge, its width, and the width of its labels, in pixels.
const SCALE_GAP: u32 = 20;
const SCALE_WIDTH: u32 = 18;
const SCALE_LABELS: u32 = 56;
/// Height of the scale's title above the plot's top edge, in pixels.
const SCALE_TITLE: u32 = 14;

/// A value over a plane, drawn as a colour.
#[derive(Clone, Debug)]
pub struct Field {
    /// The values and their positions.
    pub values: Values,
    /// The axis of the values, from the first to the last colour of the scale.
    pub colours: Axis,
}

/// The geometry of a field.
#[derive(Clone, Debug)]
pub enum Values {
    Cells(Vec<Cell>),
    Raster(Raster),
}

/// A rectangle with a single value.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Left and right end.
    pub x: Range<f64>,
    /// Lower and upper end.
    pub y: Range<f64>,
    /// The value; NaN is grey.
    pub value: f64,
}

/// A colour for every pixel of a plot, in rows from the top. Only PNG files support it.
#[derive(Clone, Debug)]
pub struct Raster {
    /// Pixels in a row.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// The colours.
    pub pixels: Vec<RGBColor>,
}

impl Field {
    /// Creates a field of rectangles.
    pub fn cells(cells: Vec<Cell>, colours: Axis) -> Self {
        Self { values: Values::Cells(cells), colours }
    }

    /// Creates a field of pixels.
    pub fn pixels(raster: Raster, colours: Axis) -> Self {
        Self { values: Values::Raster(raster), colours }
    }

    /// The pixels, if the field consists of pixels.
    pub(super) fn raster(&self) -> Option<&Raster> {
        match &self.values {
            Values::Raster(raster) => Some(raster),
            Values::Cells(_) => None,
        }
    }

    pub(super) fn draw<DB: DrawingBackend>(&self, canvas: &Area<DB>, plane: &Plane, scale: Scale) -> Drawn {
        match &self.values {
            Values::Raster(raster) => raster.draw(canvas, scale),
            Values::Cells(cells) => {
                let (right, bottom) = (plane.size.0 as i32, plane.size.1 as i32);
                for cell in cells {
                    let corners = [(cell.x.start, cell.y.end), (cell.x.end, cell.y.start)].map(|one| plane.unit(one));
                    let [Some(start), Some(end)] = corners else { continue };
                    // Cells overlap their right and lower neighbours, so that the background does not show between
                    // them.
                    let under = scale.px(1) as i32;
                    let end = ((end.0 + under).min(right), (end.1 + under).min(bottom));
                    // A value with an undefined logarithm is zero: use the lowest colour.
                    let colour = colour(self.colours.part(cell.value).unwrap_or(0.0));
                    canvas.draw(&Rectangle::new([start, end], colour.filled()))?;
                }
                Ok(())
            }
        }
    }

    /// Draws the colour scale to the right of a plot with this top right corner; all lengths are in units.
    pub(super) fn draw_scale<DB: DrawingBackend>(
        &self,
        area: &Area<DB>,
        (right, top): (i32, i32),
        height: u32,
        scale: Scale,
    ) -> Drawn {
        let px = |pixels| scale.px(pixels) as i32;
        let (left, end) = (right + px(SCALE_GAP), right + px(SCALE_GAP + SCALE_WIDTH));
        let level = |part: f64| top + ((1.0 - part) * f64::from(height)).round() as i32;
        for step in (0..SCALE_STEPS).rev() {
            let part = |step: f64| step / f64::from(SCALE_STEPS);
            let step = f64::from(step);
            // Steps overlap the next one below, so that the background does not show between them.
            let bottom = (level(part(step)) + px(1)).min(level(0.0));
            let corners = [(left, level(part(step + 1.0))), (end, bottom)];
            area.draw(&Rectangle::new(corners, colour(part(step + 0.5)).filled()))?;
        }
        for tick in self.colours.ticks() {
            let Some(part) = self.colours.part(tick) else { continue };
            let y = level(part);
            area.draw(&PathElement::new([(end, y), (end + px(4), y)], scale.stroke(1)))?;
            let label =
                Text::new(self.colours.tick_label(tick), (end + px(8), y), scale.letters_at(NOTE + 1, HPos::Left));
            area.draw(&label)?;
        }
        let title = (end + px(SCALE_LABELS), top - px(SCALE_TITLE));
        area.draw(&Text::new(self.colours.label.as_str(), title, scale.letters_at(NOTE + 1, HPos::Right)))?;
        Ok(())
    }
}

impl Raster {
    /// Draws every pixel as a square of units, and a frame around all.
    fn draw<DB: DrawingBackend>(&self, canvas: &Area<DB>, scale: Scale) -> Drawn {
        let fine = scale.px(1) as usize;
        let mut bytes = Vec::with_capacity(3 * self.pixels.len() * fine * fine);
        for row in self.pixels.chunks(self.width.max(1)) {
            let begin = bytes.len();
            for RGBColor(red, green, blue) in row {
                for _ in 0..fine {
                    bytes.extend([*red, *green, *blue]);
                }
            }
            let line = begin..bytes.len();
            for _ in 1..fine {
                bytes.extend_from_within(line.clone());
            }
        }
        let size = ((self.width * fine) as u32, (self.height * fine) as u32);
        let picture = BitMapElement::with_owned_buffer((0, 0), size, bytes);
        let picture: BitMapElement<(i32, i32)> = picture.ok_or_else(|| DrawError::new(&"a map lacks pixels"))?;
        canvas.draw(&picture)?;
        let (right, bottom) = (size.0 as i32 - 1, size.1 as i32 - 1);
        canvas.draw(&Rectangle::new([(0, 0), (right, bottom)], scale.stroke(1)))?;
        Ok(())
    }
}
