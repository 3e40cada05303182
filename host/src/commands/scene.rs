//! `frixel scene`: a scene before it is played.

mod preview;

use clap::Subcommand;

use super::error::CommandError;

#[derive(Debug, Subcommand)]
pub(super) enum SceneCommand {
    /// Draw the friction map of a scene: a PNG with rulers, and a colour scale in newtons.
    Preview(preview::PreviewArgs),
}

pub(super) fn run(command: &SceneCommand) -> Result<(), CommandError> {
    match command {
        SceneCommand::Preview(args) => preview::run(args),
    }
}
