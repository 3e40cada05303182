//! `frixel scene schema`: the JSON schema of the scene file.

use super::super::error::CommandError;

pub(super) fn run() -> Result<(), CommandError> {
    print!("{}", frixel::scene::json_schema());
    Ok(())
}
