//! `frixel scene migrate`: a scene of version 1 as version 2.

use std::path::{Path, PathBuf};

use crate::output_file::{Inputs, OutputFile};
use crate::scene_file;
use anyhow::Result;
use clap::Args;

#[derive(Debug, Args)]
pub(in super::super) struct MigrateArgs {
    /// The scene of version 1, a TOML file (docs/scene.md).
    scene: PathBuf,
    /// Write this file in place of standard output.
    #[arg(short, long, value_name = "FILE.toml")]
    output: Option<PathBuf>,
}

pub(super) fn run(args: &MigrateArgs) -> Result<()> {
    let (_, files) = scene_file::load_with_files(&args.scene);
    let output = args.output.as_deref().unwrap_or(Path::new("-"));
    let output = OutputFile::new(output, "-o", &Inputs::new(files.paths()))?;
    output.write(scene_file::migrate(&args.scene)?.as_bytes())
}
