//! Maps of a screen: a colour for every pixel, rulers in millimetres, and a colour scale in millinewtons.

use crate::chart::{Axis, Chart, Field, Margins, Panel, RGBColor, Raster};
use frixel_scene::{MapGrid, Reach};

/// Space around the map, below the title, in pixels.
const MARGINS: Margins = Margins { left: 84, right: 150, top: 26, bottom: 62 };
/// Least distance between two labels on a ruler, in pixels.
const LABEL_STEP: f64 = 50.0;

/// A chart of pixels whose colours stand for parts of the reachable range. Series over it are in millimetres.
pub(super) fn chart(grid: &MapGrid, pixels: Vec<RGBColor>, reach: &Reach) -> Chart {
    let labels = |pixels: usize| pixels as f64 / LABEL_STEP;
    let (width_mm, height_mm) = grid.screen_mm;
    let x = Axis::linear("x, mm", 0.0..width_mm).with_labels(labels(grid.width));
    let y = Axis::linear("y, mm", height_mm..0.0).with_labels(labels(grid.height));
    let friction_mn = 1e3 * reach.friction_min_n()..1e3 * reach.friction_max_n();
    let colours = Axis::linear("friction wanted, mN", friction_mn).with_labels(labels(grid.height));
    let raster = Raster { width: grid.width, height: grid.height, pixels };
    let mut panel = Panel::new("", x, y).with_field(Field::pixels(raster, colours));
    panel.margins = MARGINS;
    panel.height = MARGINS.top + grid.height as u32 + MARGINS.bottom;
    let mut chart = Chart::new(vec![panel], 1);
    chart.width = MARGINS.left + grid.width as u32 + MARGINS.right;
    chart
}
