//! The friction map of a program before it is played, as a PNG file.

use std::fs;
use std::path::Path;

use super::OutputError;
use super::map::chart;
use frixel_scene::{Preview, Program};

/// Draws the friction that a program targets everywhere on the screen. The colours span the reachable range; targets
/// beyond it have the colour of the nearer end, and are hatched. The caption is the map's.
pub fn write_preview_png(path: &Path, title: &str, program: &Program, preview: &Preview) -> Result<(), OutputError> {
    let bytes = chart(title, program, preview).png().map_err(OutputError::drawing(path))?;
    fs::write(path, bytes).map_err(|source| OutputError::File { path: path.to_owned(), source })
}
