//! The style of charts: sizes, colours, lines, marks and fonts.

use std::array;
use std::sync::{LazyLock, OnceLock};

use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, RGBAColor, ShapeStyle, TextStyle, register_font};

use super::{Area, DrawError, Drawn};

/// Default width of a chart, in pixels.
pub(super) const WIDTH: u32 = 1_000;
/// Space to the left of the label of an upright axis, in pixels.
pub(super) const EDGE: u32 = 14;
/// Font sizes, in pixels.
pub(super) const TITLE: u32 = 17;
pub(super) const AXIS_LABEL: u32 = 16;
pub(super) const LABEL: u32 = 15;
pub(super) const NOTE: u32 = 13;

/// Font family named in drawings: an SVG viewer uses its own font of this family, and PNG files use [`FONT`].
pub(super) const FAMILY: &str = "sans-serif";
/// A subset of `DejaVu` Sans; its licence is in the same folder.
static FONT: &[u8] = include_bytes!("../font/DejaVuSans-subset.ttf");

/// Half the size of a mark, in pixels.
const MARK: f64 = 4.2;
/// Lengths of a dash and of the gap after it, in pixels.
const DASH: (u32, u32) = (7, 5);
/// Number of colours in the colour scale; more would be indistinguishable, and would not fit into the
/// palette of a picture.
const COLOUR_STEPS: f64 = 30.0;

/// Colours that can be told apart with any kind of colour vision (Okabe and Ito, <https://jfly.uni-koeln.de/color/>).
pub const PALETTE: [RGBColor; 7] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0x33, 0x33, 0x33),
];
const UNKNOWN: RGBColor = RGBColor(128, 128, 128);
/// The colours of the colour scale.
static COLOURS: LazyLock<[RGBColor; COLOUR_STEPS as usize + 1]> =
    LazyLock::new(|| array::from_fn(|step| ViridisRGB.get_color(step as f64 / COLOUR_STEPS)));

/// The colour at `part` of the colour scale, from 0 to 1. Values outside take the colour of the nearer end, and
/// not-a-number is grey.
pub fn colour(part: f64) -> RGBColor {
    if part.is_nan() {
        return UNKNOWN;
    }
    let step = (part.clamp(0.0, 1.0) * COLOUR_STEPS).round() as usize;
    COLOURS.get(step).copied().unwrap_or(UNKNOWN)
}

/// The style of a series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Colour of line and marks.
    pub colour: RGBColor,
    /// How the points are connected.
    pub line: Line,
    /// How the points are marked.
    pub mark: Mark,
}

/// How to connect the points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Line {
    None,
    Solid,
    Thin,
    Thick,
    Dashed,
    /// The area that the points enclose, with this opacity from 0 to 1.
    Filled(f64),
}

/// How to mark the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Mark {
    None,
    Disc,
    /// A disc that is large enough to be visible around another mark.
    Casing,
    Ring,
    Square,
    Diamond,
}

impl Look {
    /// A line without marks.
    pub const fn line(colour: RGBColor, line: Line) -> Self {
        Self { colour, line, mark: Mark::None }
    }

    /// Marks without a line.
    pub const fn mark(colour: RGBColor, mark: Mark) -> Self {
        Self { colour, line: Line::None, mark }
    }

    /// Corners of a polygonal mark, in units of its size.
    fn corners(self) -> Option<&'static [(f64, f64)]> {
        match self.mark {
            Mark::Square => Some(&[(-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85)]),
            Mark::Diamond => Some(&[(0.0, -1.2), (1.2, 0.0), (0.0, 1.2), (-1.2, 0.0)]),
            Mark::None | Mark::Disc | Mark::Casing | Mark::Ring => None,
        }
    }
}

/// Drawing units per pixel. Plotters rounds positions to whole units, so more units draw finer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Scale(pub(super) u32);

impl Scale {
    /// Converts a length from pixels to units.
    pub(super) fn px(self, shown: u32) -> u32 {
        shown * self.0
    }

    /// A black line of this width in pixels.
    pub(super) fn stroke(self, width: u32) -> ShapeStyle {
        BLACK.stroke_width(self.px(width))
    }

    /// Black text of this size in pixels.
    pub(super) fn letters(self, size: u32) -> TextStyle<'static> {
        (FAMILY, self.px(size)).into_font().color(&BLACK)
    }

    /// Black text, vertically centred on its position, to its right or to its left.
    pub(super) fn letters_at(self, size: u32, side: HPos) -> TextStyle<'static> {
        self.letters(size).pos(Pos::new(side, VPos::Center))
    }

    /// Draws the line of a style through points in units.
    pub(super) fn draw_line<DB: DrawingBackend>(self, area: &Area<DB>, line: &[(i32, i32)], look: &Look) -> Drawn {
        let stroke = |width| look.colour.stroke_width(self.px(width));
        match look.line {
            Line::None => {}
            Line::Thin => area.draw(&PathElement::new(line, stroke(1)))?,
            Line::Solid => area.draw(&PathElement::new(line, stroke(2)))?,
            Line::Thick => area.draw(&PathElement::new(line, stroke(5)))?,
            Line::Dashed => {
                let (dash, gap) = (self.px(DASH.0) as i32, self.px(DASH.1) as i32);
                area.draw(&DashedPathElement::new(line.to_vec(), dash, gap, stroke(2)))?;
            }
            Line::Filled(opacity) => area.draw(&Polygon::new(line, look.colour.mix(opacity).filled()))?,
        }
        Ok(())
    }

    /// Draws the mark of a style at a point in units.
    pub(super) fn draw_mark<DB: DrawingBackend>(self, area: &Area<DB>, (x, y): (i32, i32), look: &Look) -> Drawn {
        let size = MARK * f64::from(self.0);
        let at = |(dx, dy): &(f64, f64)| (x + (size * dx).round() as i32, y + (size * dy).round() as i32);
        if let Some(corners) = look.corners() {
            let corners: Vec<_> = corners.iter().map(at).collect();
            area.draw(&Polygon::new(corners, look.colour.filled()))?;
        }
        let stroke = look.colour.stroke_width(self.px(2));
        match look.mark {
            Mark::Disc => area.draw(&Circle::new((x, y), size as i32, look.colour.filled()))?,
            Mark::Casing => area.draw(&Circle::new((x, y), (1.5 * size) as i32, look.colour.filled()))?,
            Mark::Ring => area.draw(&Circle::new((x, y), size as i32, stroke))?,
            _ => {}
        }
        Ok(())
    }
}

/// Colour of grid lines.
pub(super) fn grid() -> RGBAColor {
    BLACK.mix(0.13)
}

/// Registers the font with plotters, which needs it to measure text.
pub(super) fn load_font() -> Drawn {
    static LOADED: OnceLock<bool> = OnceLock::new();
    let loaded = *LOADED.get_or_init(|| register_font(FAMILY, FontStyle::Normal, FONT).is_ok());
    if loaded { Ok(()) } else { Err(DrawError::new(&"the font is broken")) }
}

/// Text is measured at a multiple of its size, because plotters rounds its width to whole units.
const FINE: u32 = 8;

/// Width of a text of this font size, in pixels.
pub(super) fn text_width(text: &str, size: u32) -> Result<u32, DrawError> {
    load_font()?;
    let ((left, _), (right, _)) =
        (FAMILY, FINE * size).into_font().layout_box(text).map_err(|error| DrawError::new(&error))?;
    Ok((right - left).unsigned_abs().div_ceil(FINE))
}
