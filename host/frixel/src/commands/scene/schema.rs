//! `frixel scene schema`: the JSON schema of the scene file.

use super::super::error::CommandError;
use super::super::terminal::print;

pub(super) fn run() -> Result<(), CommandError> {
    print(frixel_scene::json_schema())
}
