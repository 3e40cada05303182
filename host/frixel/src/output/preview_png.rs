//! The friction map of a program before it is played, as a PNG file.

use std::fs;
use std::path::Path;

use super::map::chart;
use super::{OutputError, Subject};
use frixel_scene::{Preview, Program};

/// Draws the friction that a program targets everywhere on the screen. The colours span the reachable range; targets
/// beyond it have the colour of the nearer end, and are hatched. The caption is the map's. The title of a draft says
/// so.
pub fn write_preview_png(path: &Path, name: &str, program: &Program, preview: &Preview) -> Result<(), OutputError> {
    let subject = Subject { name: name.to_owned(), simulated: false, draft: program.is_draft() };
    let bytes = chart(&subject.title(), program, preview).png().map_err(OutputError::drawing(path))?;
    fs::write(path, bytes).map_err(|source| OutputError::File { path: path.to_owned(), source })
}
