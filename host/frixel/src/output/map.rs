//! Maps of a screen: a colour for every pixel, rulers in millimetres, and a colour scale in millinewtons.

use crate::chart::{Axis, Chart, Field, Margins, Panel, RGBColor, Raster};
use frixel_scene::{Program, Reach};

/// Space around the map, below the title, in pixels.
const MARGINS: Margins = Margins { left: 84, right: 150, top: 26, bottom: 62 };
/// Distance of two labels on a ruler, at least, in pixels.
const LABEL_STEP: f64 = 50.0;

/// Size of a map of a program's screen.
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

    /// Column, row and place in metres of every pixel, in rows from the top.
    pub(super) fn pixels(&self) -> impl Iterator<Item = ((usize, usize), (f64, f64))> {
        let metres = |pixel: usize| (pixel as f64 + 0.5) / self.pixels_per_mm * 1e-3;
        (0..self.height)
            .flat_map(move |row| (0..self.width).map(move |column| ((column, row), (metres(column), metres(row)))))
    }

    /// A chart of pixels whose colours mean a part of the reach. Series over it have millimetres on both axes.
    pub(super) fn chart(&self, pixels: Vec<RGBColor>, reach: &Reach) -> Chart {
        let labels = |pixels: usize| pixels as f64 / LABEL_STEP;
        let x = Axis::linear("x, mm", 0.0..self.screen_mm.0).with_labels(labels(self.width));
        let y = Axis::linear("y, mm", self.screen_mm.1..0.0).with_labels(labels(self.height));
        let friction_mn = 1e3 * reach.friction_min_n()..1e3 * reach.friction_max_n();
        let colours = Axis::linear("friction wanted, mN", friction_mn).with_labels(labels(self.height));
        let raster = Raster { width: self.width, height: self.height, pixels };
        let mut panel = Panel::new("", x, y).with_field(Field::pixels(raster, colours));
        panel.margins = MARGINS;
        panel.height = MARGINS.top + self.height as u32 + MARGINS.bottom;
        let mut chart = Chart::new(vec![panel], 1);
        chart.width = MARGINS.left + self.width as u32 + MARGINS.right;
        chart
    }
}
