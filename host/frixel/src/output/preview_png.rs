//! The friction map of a program before it is played, as a PNG file.

use std::fs;
use std::path::Path;

use super::OutputError;
use super::map::chart;
use crate::chart::{RGBColor, colour};
use frixel_scene::{FrictionMap, Preview, Program, ReachSide};

/// Distance between the lines of a hatching, and their width, in pixels.
const HATCH_PITCH: usize = 8;
const HATCH_WIDTH: usize = 2;
const BLACK: RGBColor = RGBColor(0, 0, 0);
const WHITE: RGBColor = RGBColor(255, 255, 255);

/// Draws the friction that a program targets everywhere on the screen. The colours span the reachable range; targets
/// beyond it have the colour of the nearer end, and are hatched. The caption is the map's.
pub fn write_preview_png(path: &Path, title: &str, program: &Program, preview: &Preview) -> Result<(), OutputError> {
    let FrictionMap { grid, parts_of_reach, caption } = FrictionMap::new(program, preview);
    let diagonal = |pixel: usize| pixel % grid.width + pixel / grid.width;
    let pixels = parts_of_reach.iter().enumerate().map(|(pixel, part)| colour_of(*part, diagonal(pixel)));
    let mut chart = chart(&grid, pixels.collect(), &program.reach);
    title.clone_into(&mut chart.title);
    chart.caption = caption;
    let bytes = chart.png().map_err(OutputError::drawing(path))?;
    fs::write(path, bytes).map_err(|source| OutputError::File { path: path.to_owned(), source })
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
