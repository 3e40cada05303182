//! `frixel scene schema`: the JSON schema of the scene file.

use std::io::{self, ErrorKind, Write};
use std::path::Path;

use super::super::error::CommandError;

pub(super) fn run() -> Result<(), CommandError> {
    match io::stdout().lock().write_all(frixel_scene::json_schema().as_bytes()) {
        // Ignore a closed standard output.
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(CommandError::writing(Path::new("standard output"))(error))
        }
        _ => Ok(()),
    }
}
