//! Colours, lines and marks.

use plotters::prelude::*;
use plotters::style::ShapeStyle;

use super::FINE;
use crate::output::scale;

/// Colours that people with any sight tell apart (Okabe and Ito).
pub(in crate::report) const PALETTE: [RGBColor; 7] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0x33, 0x33, 0x33),
];

/// The colour of member `index` of a family of `count` curves whose order means something.
pub(in crate::report) fn graded(index: usize, count: usize) -> RGBColor {
    // The bright end of the scale is too pale for a line on white.
    let part = 0.85 * index as f64 / (count.max(2) - 1) as f64;
    let [red, green, blue] = scale::colour(part);
    RGBColor(red, green, blue)
}

/// The colour of a value between minus one and one: orange below zero, blue above it, stronger the farther.
pub(in crate::report) fn signed(part: f64) -> RGBColor {
    let (RGBColor(red, green, blue), strength) = match part {
        part if part < 0.0 => (PALETTE[1], -part),
        part if part > 0.0 => (PALETTE[0], part),
        _ => return BLACK,
    };
    let mixed = |channel: u8| (255.0 + (f64::from(channel) - 255.0) * (0.45 + 0.55 * strength.min(1.0))).round() as u8;
    RGBColor(mixed(red), mixed(green), mixed(blue))
}

/// How a series looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::report) struct Look {
    pub(in crate::report) colour: RGBColor,
    pub(in crate::report) line: Line,
    pub(in crate::report) mark: Mark,
}

/// The line through the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::report) enum Line {
    None,
    Solid,
    Thin,
    Dashed,
}

/// What stands at the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::report) enum Mark {
    None,
    Disc,
    Ring,
    Square,
    Triangle,
    Diamond,
    Cross,
}

impl Look {
    /// A line without marks.
    pub(in crate::report) const fn line(colour: RGBColor, line: Line) -> Self {
        Self { colour, line, mark: Mark::None }
    }

    /// Marks without a line.
    pub(in crate::report) const fn mark(colour: RGBColor, mark: Mark) -> Self {
        Self { colour, line: Line::None, mark }
    }

    pub(super) fn stroke(&self) -> ShapeStyle {
        let width = match self.line {
            Line::Thin => FINE,
            Line::None | Line::Solid | Line::Dashed => 2 * FINE,
        };
        self.colour.stroke_width(width)
    }

    /// Corners of the mark, in units of its size; none for what is no polygon.
    pub(super) fn corners(&self) -> Option<&'static [(f64, f64)]> {
        match self.mark {
            Mark::Square => Some(&[(-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85)]),
            Mark::Triangle => Some(&[(0.0, -1.15), (1.05, 0.75), (-1.05, 0.75)]),
            Mark::Diamond => Some(&[(0.0, -1.2), (1.2, 0.0), (0.0, 1.2), (-1.2, 0.0)]),
            Mark::None | Mark::Disc | Mark::Ring | Mark::Cross => None,
        }
    }
}
