//! The friction map of a program before it is played, as a PNG file.

use super::map::chart;
use super::{DrawingError, Subject};
use frixel_felt::Preview;
use frixel_scene::Program;

/// Draws the friction that a program targets everywhere on the screen. The colours span the reachable range; targets
/// beyond it have the colour of the nearer end, and are hatched. The title marks a draft.
pub fn draw_preview_png(name: &str, program: &Program, preview: &Preview) -> Result<Vec<u8>, DrawingError> {
    let subject = Subject { name: name.to_owned(), simulated: false, draft: program.is_draft() };
    Ok(chart(&subject.title(), program, preview).png()?)
}
