//! Charts in SVG: panels of lines, marks and coloured fields on axes with units, each with its legend.
//!
//! One look with [`felt.svg`](crate::output::write_felt_svg).

mod axis;
mod clip;
mod field;
mod legend;
mod look;
mod plot;

use plotters::coord::Shift;
use plotters::prelude::*;

pub(super) use axis::Axis;
pub(super) use field::{Cell, Field};
use legend::Legend;
pub(super) use look::{Line, Look, Mark, PALETTE, graded, signed};

/// The library places everything on whole units, so it draws on a canvas this many times as large.
const FINE: u32 = 8;
/// What drawings call the font; the viewer takes its own.
const FAMILY: &str = "sans-serif";
/// Width of a chart as it is shown, whatever its panels.
const WIDTH: u32 = 1_000;
/// Height of a panel's plot with its title and axes.
const PLOT_HEIGHT: u32 = 360;
/// What is left free below a row of panels.
const SPACING: u32 = 12;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Panels side by side, and in several rows.
#[derive(Clone, Debug)]
pub(super) struct Chart {
    pub(super) panels: Vec<Panel>,
    /// Panels in a row.
    pub(super) columns: u32,
    /// All panels have the same series: one legend stands below them.
    pub(super) shared_legend: bool,
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
}

impl Chart {
    /// The picture.
    pub(super) fn svg(&self) -> Result<String, Box<dyn std::error::Error>> {
        let columns = self.columns.max(1);
        let panel_width = WIDTH / columns;
        let rows: Vec<&[Panel]> = self.panels.chunks(columns as usize).collect();
        let own = |panel: &Panel| if self.shared_legend { Legend::default() } else { Legend::of(&panel.series) };
        let shared = if self.shared_legend { Legend::of_all(&self.panels) } else { Legend::default() };
        let legend_height =
            |row: &[Panel]| row.iter().map(|panel| own(panel).height(panel_width)).max().unwrap_or_default();
        let height = |row: &[Panel]| PLOT_HEIGHT + legend_height(row) + SPACING;
        let plots: u32 = rows.iter().map(|row| height(row)).sum();
        let total = plots + shared.height(WIDTH);
        let mut text = String::new();
        {
            let root = SVGBackend::with_string(&mut text, (px(WIDTH), px(total))).into_drawing_area();
            root.fill(&WHITE)?;
            let mut top = 0;
            for row in rows {
                for (place, panel) in (0..).zip(row) {
                    let area =
                        root.clone().shrink((px(place * panel_width), px(top)), (px(panel_width), px(height(row))));
                    plot::draw(&area, panel)?;
                    legend::draw(&area, &own(panel), (0, PLOT_HEIGHT + SPACING / 2), panel_width)?;
                }
                top += height(row);
            }
            legend::draw(&root, &shared, (0, top), WIDTH)?;
            root.present()?;
        }
        let large = format!("width=\"{}\" height=\"{}\"", px(WIDTH), px(total));
        Ok(text.replacen(&large, &format!("width=\"{WIDTH}\" height=\"{total}\""), 1))
    }
}

fn px(shown: u32) -> u32 {
    shown * FINE
}
