//! `frixel schema`: the JSON schema of the scene file.

use super::terminal::print;
use anyhow::Result;

pub(super) fn run() -> Result<()> {
    print(frixel_scene::json_schema())
}
