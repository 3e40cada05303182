//! Charts in one consistent style, drawn with `plotters`.
//!
//! A [`Chart`] is a value made of panels with axes, series, coloured fields and legends. [`Chart::svg`] and
//! [`Chart::png`] draw it. Legends are beside or below the plots, never over them. Equal charts give byte-identical
//! files.
#![forbid(unsafe_code)]

mod axis;
mod clip;
mod field;
mod legend;
mod plot;
mod png;
mod strip;
mod style;

use plotters::coord::Shift;
use plotters::prelude::*;
pub use plotters::style::RGBColor;
use plotters::style::text_anchor::HPos;
use thiserror::Error;

pub use axis::Axis;
pub use field::{Cell, Field, Raster};
use legend::Legend;
pub use strip::{Strip, StripCell};
use style::{EDGE, NOTE, Scale, TITLE, WIDTH};
pub use style::{Line, Look, Mark, PALETTE, colour};

/// Default height of a panel, including its title and axes, in pixels.
const PANEL_HEIGHT: u32 = 360;
/// Height of the chart's title line, in pixels.
const TITLE_HEIGHT: u32 = 34;
/// Space below a row of panels, in pixels.
const SPACING: u32 = 12;
/// Height of a line of the caption, in pixels.
const CAPTION_LINE: u32 = 22;
/// Units per pixel in SVG files, whose coordinates are whole numbers of units.
const SVG_SCALE: Scale = Scale(8);

type Area<DB> = DrawingArea<DB, Shift>;
type Drawn = Result<(), DrawError>;

/// An error of the drawing library.
#[derive(Debug, Error)]
#[error("{0}")]
pub struct DrawError(String);

impl DrawError {
    fn new(reason: &impl ToString) -> Self {
        Self(reason.to_string())
    }
}

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for DrawError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        Self::new(&error)
    }
}

/// A picture of one or more panels, side by side and in several rows.
#[derive(Clone, Debug)]
pub struct Chart {
    /// Title above all panels; empty for no title.
    pub title: String,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
    /// Number of panels in a row.
    pub columns: u32,
    /// Sentences below the panels.
    pub caption: Vec<String>,
    /// Width of the picture, in pixels.
    pub width: u32,
}

/// A plot with its axes and legend.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Title above the plot; empty for no title.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The plotted series, from bottom to top.
    pub series: Vec<Series>,
    /// A coloured field below the series.
    pub field: Option<Field>,
    /// Short texts, each drawn to the right of its point.
    pub notes: Vec<(f64, f64, String)>,
    /// Further values along the axis, below its label.
    pub strips: Vec<Strip>,
    /// Height of plot, title and axes, in pixels.
    pub height: u32,
    /// Space around the plot.
    pub margins: Margins,
}

/// Space around a plot for title, labels and colour scale, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Margins {
    /// To the left.
    pub left: u32,
    /// To the right.
    pub right: u32,
    /// Above.
    pub top: u32,
    /// Below.
    pub bottom: u32,
}

/// Points drawn in one style. A series without a name does not appear in the legend.
#[derive(Clone, Debug)]
pub struct Series {
    /// Name in the legend; empty for none.
    pub name: String,
    /// Pairs of values; a NaN interrupts the line.
    pub points: Vec<(f64, f64)>,
    /// How the points are drawn.
    pub look: Look,
}

impl Panel {
    /// Creates a panel without series.
    pub fn new(title: &str, x: Axis, y: Axis) -> Self {
        let margins = Margins { left: 80, right: 20, top: 30, bottom: 44 };
        let (title, height) = (title.to_owned(), PANEL_HEIGHT);
        Self { title, x, y, series: Vec::new(), field: None, notes: Vec::new(), strips: Vec::new(), height, margins }
    }

    /// Adds a series.
    pub fn add(&mut self, name: &str, look: Look, points: Vec<(f64, f64)>) {
        self.series.push(Series { name: name.to_owned(), points, look });
    }

    /// Adds a strip below the axis, and makes room for it.
    pub fn add_strip(&mut self, strip: Strip) {
        self.strips.push(strip);
        self.height += strip::STRIP_HEIGHT;
    }

    /// Adds a coloured field, and makes room for its colour scale.
    #[must_use]
    pub fn with_field(mut self, field: Field) -> Self {
        self.field = Some(field);
        self.margins.right = 100;
        self
    }
}

impl Chart {
    /// Creates a chart without a title, with `columns` panels in a row.
    pub fn new(panels: Vec<Panel>, columns: u32) -> Self {
        Self { title: String::new(), panels, columns, caption: Vec::new(), width: WIDTH }
    }

    /// Draws the chart as an SVG document. Texts must not contain control characters, which XML cannot represent.
    pub fn svg(&self) -> Result<String, DrawError> {
        let layout = Layout::of(self)?;
        let fine = |pixels| SVG_SCALE.px(pixels);
        let mut text = String::new();
        {
            let area = SVGBackend::with_string(&mut text, (fine(self.width), fine(layout.height))).into_drawing_area();
            self.draw(&area, &layout, SVG_SCALE)?;
        }
        let size = |width: u32, height: u32| format!("width=\"{width}\" height=\"{height}\"");
        let drawn = size(fine(self.width), fine(layout.height));
        Ok(text.replacen(&drawn, &size(self.width, layout.height), 1))
    }

    /// Draws the chart as a PNG file.
    pub fn png(&self) -> Result<Vec<u8>, DrawError> {
        let layout = Layout::of(self)?;
        png::encoded((self.width, layout.height), |area, scale| self.draw(area, &layout, scale))
    }

    fn draw<DB: DrawingBackend>(&self, area: &Area<DB>, layout: &Layout, scale: Scale) -> Drawn {
        let px = |pixels| scale.px(pixels);
        area.fill(&WHITE)?;
        let left = self.panels.first().map_or(EDGE, |panel| panel.margins.left);
        if !self.title.is_empty() {
            let place = (px(left) as i32, px(TITLE_HEIGHT / 2) as i32);
            area.draw(&Text::new(self.title.as_str(), place, scale.letters_at(TITLE + 2, HPos::Left)))?;
        }
        let panel_width = layout.panel_width;
        let mut top = layout.title_height;
        for row in &layout.rows {
            for (column, panel) in (0..).zip(row.panels) {
                let corner = (px(column * panel_width), px(top));
                let place = area.clone().shrink(corner, (px(panel_width), px(row.height)));
                plot::draw(&place, panel, scale)?;
                Legend::of(&panel.series).draw(&place, row.plot_height + SPACING / 2, panel_width, scale)?;
            }
            top += row.height;
        }
        top = layout.height - layout.caption.len() as u32 * CAPTION_LINE - SPACING;
        for line in &layout.caption {
            let place = (px(left) as i32, px(top + CAPTION_LINE / 2) as i32);
            area.draw(&Text::new(line.as_str(), place, scale.letters_at(NOTE, HPos::Left)))?;
            top += CAPTION_LINE;
        }
        area.present()?;
        Ok(())
    }
}

/// Positions of the parts of a chart, in pixels.
struct Layout<'c> {
    title_height: u32,
    panel_width: u32,
    rows: Vec<Row<'c>>,
    /// The caption, broken into lines.
    caption: Vec<String>,
    height: u32,
}

/// A row of panels, with their legends below the plots.
struct Row<'c> {
    panels: &'c [Panel],
    plot_height: u32,
    height: u32,
}

impl<'c> Layout<'c> {
    fn of(chart: &'c Chart) -> Result<Self, DrawError> {
        let columns = chart.columns.max(1);
        let panel_width = chart.width / columns;
        let mut rows = Vec::new();
        for panels in chart.panels.chunks(columns as usize) {
            let plot_height = panels.iter().map(|panel| panel.height).max().unwrap_or_default();
            let mut legend_height = 0;
            for panel in panels {
                legend_height = legend_height.max(Legend::of(&panel.series).height(panel_width)?);
            }
            rows.push(Row { panels, plot_height, height: plot_height + legend_height + SPACING });
        }
        let left = chart.panels.first().map_or(EDGE, |panel| panel.margins.left);
        let mut caption = Vec::new();
        for sentence in &chart.caption {
            caption.extend(wrapped(sentence, chart.width - left - EDGE)?);
        }
        let title_height = if chart.title.is_empty() { 0 } else { TITLE_HEIGHT };
        let caption_height = if caption.is_empty() { 0 } else { caption.len() as u32 * CAPTION_LINE + SPACING };
        let height = title_height + rows.iter().map(|row| row.height).sum::<u32>() + caption_height;
        Ok(Self { title_height, panel_width, rows, caption, height })
    }
}

/// Breaks a sentence between words into lines of at most `room` pixels; only a single word can be wider.
fn wrapped(sentence: &str, room: u32) -> Result<Vec<String>, DrawError> {
    let mut lines: Vec<String> = Vec::new();
    for word in sentence.split(' ') {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match (lines.last_mut(), longer) {
            (Some(line), Some(longer)) if style::text_width(&longer, NOTE)? <= room => *line = longer,
            _ => lines.push(word.to_owned()),
        }
    }
    Ok(lines)
}
