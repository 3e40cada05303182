//! Charts in SVG: panels of lines, marks and coloured fields on axes with units, each with its legend.
//!
//! One look with [`felt.svg`](crate::output::write_felt_svg).

mod axis;
mod clip;
mod field;
mod look;
mod plot;

use plotters::coord::Shift;
use plotters::prelude::*;

pub(super) use axis::Axis;
pub(super) use field::{Cell, Field};
pub(super) use look::{Line, Look, Mark, PALETTE, graded, signed};

/// The library places everything on whole units, so it draws on a canvas this many times as large.
const FINE: u32 = 8;
/// What drawings call the font; the viewer takes its own.
const FAMILY: &str = "sans-serif";
/// Width of a chart as it is shown, whatever its panels.
const WIDTH: u32 = 1_000;
/// Height of a panel's plot with its title and axes.
const PLOT_HEIGHT: u32 = 360;
/// Height of a line of a legend.
const LEGEND_LINE: u32 = 20;
/// What a legend's entry takes: about so much for each character, and for what stands before the name.
const CHARACTER: u32 = 7;
const BEFORE_NAME: u32 = 58;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Panels side by side, and in several rows.
#[derive(Clone, Debug)]
pub(super) struct Chart {
    pub(super) panels: Vec<Panel>,
    /// Panels in a row.
    pub(super) columns: u32,
}

/// A plot with its axes and legend.
#[derive(Clone, Debug)]
pub(super) struct Panel {
    pub(super) title: String,
    pub(super) x: Axis,
    pub(super) y: Axis,
    pub(super) series: Vec<Series>,
    pub(super) field: Option<Field>,
    /// Short texts, each to the right of a place.
    pub(super) notes: Vec<(f64, f64, String)>,
}

/// What is drawn in one look. Without a name, it is not in the legend.
#[derive(Clone, Debug)]
pub(super) struct Series {
    pub(super) name: String,
    /// Values; a line is cut where one is not a number.
    pub(super) points: Vec<(f64, f64)>,
    pub(super) look: Look,
}

impl Panel {
    /// An empty plot.
    pub(super) fn new(title: &str, x: Axis, y: Axis) -> Self {
        Self { title: title.to_owned(), x, y, series: Vec::new(), field: None, notes: Vec::new() }
    }

    /// Adds a series.
    pub(super) fn add(&mut self, name: &str, look: Look, points: Vec<(f64, f64)>) {
        self.series.push(Series { name: name.to_owned(), points, look });
    }

    /// Columns and lines of the legend in a panel of this width.
    fn legend(&self, width: u32) -> (u32, u32) {
        let lengths = self.series.iter().map(|series| series.name.chars().count() as u32).filter(|length| *length > 0);
        let (entries, longest) = (lengths.clone().count() as u32, lengths.max().unwrap_or(0));
        let columns = (width / (BEFORE_NAME + CHARACTER * longest)).clamp(1, entries.max(1));
        (columns, entries.div_ceil(columns))
    }
}

impl Chart {
    /// The picture.
    pub(super) fn svg(&self) -> Result<String, Box<dyn std::error::Error>> {
        let columns = self.columns.max(1);
        let panel_width = WIDTH / columns;
        let rows: Vec<&[Panel]> = self.panels.chunks(columns as usize).collect();
        let lines = |row: &[Panel]| row.iter().map(|panel| panel.legend(panel_width).1).max().unwrap_or(0);
        let height = |row: &[Panel]| PLOT_HEIGHT + lines(row) * LEGEND_LINE + 12;
        let total: u32 = rows.iter().map(|row| height(row)).sum();
        let mut text = String::new();
        {
            let root = SVGBackend::with_string(&mut text, (px(WIDTH), px(total))).into_drawing_area();
            root.fill(&WHITE)?;
            let mut top = 0;
            for row in rows {
                for (place, panel) in (0..).zip(row) {
                    let area =
                        root.clone().shrink((px(place * panel_width), px(top)), (px(panel_width), px(height(row))));
                    plot::draw(&area, panel, panel_width)?;
                }
                top += height(row);
            }
            root.present()?;
        }
        let large = format!("width=\"{}\" height=\"{}\"", px(WIDTH), px(total));
        Ok(text.replacen(&large, &format!("width=\"{WIDTH}\" height=\"{total}\""), 1))
    }
}

fn px(shown: u32) -> u32 {
    shown * FINE
}
