//! `frixel scene`: checks or draws a scene before it is played.

mod check;
mod preview;
mod schema;

use anyhow::Result;
use clap::Subcommand;

#[derive(Debug, Subcommand)]
pub(super) enum SceneCommand {
    /// Report a scene's cost, reach and what can be felt of it.
    ///
    /// Every mistake is reported, with line and column. A scene that no board can play is refused by the number that is
    /// exceeded.
    Check(check::CheckArgs),
    /// Draw the friction map of a scene: a PNG with rulers, and a colour scale in millinewtons.
    Preview(preview::PreviewArgs),
    /// Print the JSON schema of the scene file, for editors.
    Schema,
}

pub(super) fn run(command: &SceneCommand) -> Result<()> {
    match command {
        SceneCommand::Check(args) => check::run(args),
        SceneCommand::Preview(args) => preview::run(args),
        SceneCommand::Schema => schema::run(),
    }
}
