//! Maps of a screen: a colour for every pixel, rulers in millimetres, and a colour scale in millinewtons.

use frixel_chart::{Axis, Chart, Field, Margins, Panel, RGBColor, Raster, colour};
use frixel_felt::{FrictionMap, MapGrid, Preview, ReachSide, TO_THE_END};
use frixel_scene::{Program, Reach};

/// Space around the map, below the title, in pixels.
const MARGINS: Margins = Margins { left: 84, right: 150, top: 26, bottom: 62 };
/// Least width of the picture, so that the caption of a narrow screen has room, in pixels.
const WIDTH_MIN: u32 = 600;
/// Least distance between two labels on a ruler, in pixels.
const LABEL_STEP: f64 = 50.0;
/// Distance between the lines of a hatching, and their width, in pixels.
const HATCH_PITCH: usize = 8;
const HATCH_WIDTH: usize = 2;
const BLACK: RGBColor = RGBColor(0, 0, 0);
const WHITE: RGBColor = RGBColor(255, 255, 255);

/// The friction that a program targets everywhere on the screen. The colours span the reachable range; targets beyond
/// it have the colour of the nearer end, and are hatched. The caption is that of the [`FrictionMap`]. Series drawn over
/// the map are in millimetres.
pub(super) fn chart(title: &str, program: &Program, preview: &Preview) -> Chart {
    let FrictionMap { grid, parts_of_reach, caption } = FrictionMap::new(program, preview, TO_THE_END);
    let diagonal = |pixel: usize| pixel % grid.width + pixel / grid.width;
    let pixels = parts_of_reach.iter().enumerate().map(|(pixel, part)| colour_of(*part, diagonal(pixel)));
    let mut chart = chart_of(&grid, pixels.collect(), &program.reach);
    title.clone_into(&mut chart.title);
    chart.caption = caption;
    chart
}

fn chart_of(grid: &MapGrid, pixels: Vec<RGBColor>, reach: &Reach) -> Chart {
    let labels = |pixels: usize| pixels as f64 / LABEL_STEP;
    let (width_mm, height_mm) = grid.screen_mm;
    let x = Axis::linear("x, mm", 0.0..width_mm).with_labels(labels(grid.width));
    let y = Axis::linear("y, mm", height_mm..0.0).with_labels(labels(grid.height));
    let friction_mn = 1e3 * reach.friction_min_n()..1e3 * reach.friction_max_n();
    let colours = Axis::linear("target friction, mN", friction_mn).with_labels(labels(grid.height));
    let raster = Raster { width: grid.width, height: grid.height, pixels };
    let mut panel = Panel::new("", x, y).with_field(Field::pixels(raster, colours));
    let width = (MARGINS.left + grid.width as u32 + MARGINS.right).max(WIDTH_MIN);
    panel.margins = Margins { right: width - MARGINS.left - grid.width as u32, ..MARGINS };
    panel.height = MARGINS.top + grid.height as u32 + MARGINS.bottom;
    let mut chart = Chart::new(vec![panel], 1);
    chart.width = width;
    chart
}

/// The colour at a part of the reachable range, from 0 to 1. Beyond it, the colour is hatched along diagonals.
fn colour_of(part_of_reach: f64, diagonal: usize) -> RGBColor {
    let hatched = diagonal % HATCH_PITCH < HATCH_WIDTH;
    match ReachSide::of(part_of_reach) {
        ReachSide::Below if hatched => WHITE,
        ReachSide::Above if hatched => BLACK,
        _ => colour(part_of_reach),
    }
}
