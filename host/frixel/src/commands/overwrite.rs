//! Output files that would replace a file of the scene.

use std::path::PathBuf;

use frixel::scene_file::SceneFiles;

use super::error::CommandError;

/// Rejects output paths that lead to a file that the scene was read from. `advice` says what to do.
pub(super) fn check_outputs(files: &SceneFiles, outputs: &[PathBuf], advice: &'static str) -> Result<(), CommandError> {
    match outputs.iter().find_map(|output| files.find(output)) {
        Some(file) => Err(CommandError::WouldReplace { path: file.to_owned(), advice }),
        None => Ok(()),
    }
}
