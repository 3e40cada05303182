//! The friction map of a program before it is played, as a PNG file.

use std::fs;
use std::path::Path;

use super::OutputError;
use super::map::chart;
use crate::chart::{RGBColor, colour};
use frixel_scene::{FrictionMap, Preview, Program, ReachSide};

/// Distance of the lines of a hatching, and their width, in pixels.
const HATCH_PITCH: usize = 8;
const HATCH_WIDTH: usize = 2;
const BLACK: RGBColor = RGBColor(0, 0, 0);
const WHITE: RGBColor = RGBColor(255, 255, 255);

/// Writes the friction that a program wants all over the screen. The colours span the reach; what is beyond has the
/// colour of its end, and is hatched. The caption is the map's.
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

/// The colour of a part of the reach; beyond it, hatched along diagonals of the picture.
fn colour_of(part_of_reach: f64, diagonal: usize) -> RGBColor {
    let hatched = diagonal % HATCH_PITCH < HATCH_WIDTH;
    match ReachSide::of(part_of_reach) {
        ReachSide::Below if hatched => WHITE,
        ReachSide::Above if hatched => BLACK,
        _ => colour(part_of_reach),
    }
}
