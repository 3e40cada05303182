//! `frixel scene migrate`: a scene of version 1 as version 2.

use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use frixel::scene_file;

use super::super::error::CommandError;

#[derive(Debug, Args)]
pub(in super::super) struct MigrateArgs {
    /// The scene of version 1, a TOML file (docs/scene.md).
    scene: PathBuf,
    /// Write this file in place of standard output.
    #[arg(short, long, value_name = "FILE.toml")]
    output: Option<PathBuf>,
}

pub(super) fn run(args: &MigrateArgs) -> Result<(), CommandError> {
    let text = scene_file::migrate(&args.scene)?;
    if let Some(path) = &args.output {
        return std::fs::write(path, text).map_err(CommandError::writing(path));
    }
    match io::stdout().lock().write_all(text.as_bytes()) {
        // Ignore a closed standard output.
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(CommandError::writing(Path::new("standard output"))(error))
        }
        _ => Ok(()),
    }
}
