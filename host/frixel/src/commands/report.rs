//! `frixel report`: the model's error, its cost, and what a scene leaves out, on one page.

use std::collections::BTreeMap;
use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use frixel_hil_sim::RigConfig;
use frixel_scene::{Scene, compile_draft};

use super::demo;
use super::profiles::ProfileArgs;
use super::terminal::print_line;
use crate::report::{Subject, write};
use frixel_files::Inputs;

#[derive(Debug, Args)]
pub(super) struct ReportArgs {
    /// The scene whose finger is measured, and whose use of the board is shown. Default: the bundled bricks.
    scene: Option<PathBuf>,
    #[command(flatten)]
    profiles: ProfileArgs,
    /// Folder for the page and its numbers.
    #[arg(long, default_value = "frixel-report")]
    out: PathBuf,
    /// Instruction counts of boards, as `cargo xtask bench` writes them to target/bench/bench.json. Default: the counts
    /// of this version.
    #[arg(long, value_name = "FILE.json")]
    bench: Option<PathBuf>,
}

pub(super) fn run(args: &ReportArgs) -> Result<()> {
    let names = args.profiles.names();
    let (name, scene, files) = if let Some(path) = &args.scene {
        let (scene, files) = names.load_with_files(path);
        (path.display().to_string(), scene?, files.paths().map(PathBuf::from).collect())
    } else {
        let files = BTreeMap::from([(demo::PICTURE_NAME.to_owned(), demo::PICTURE.to_vec())]);
        let scene = Scene::parse(demo::SCENE, "brick.toml", &files)?;
        ("the bundled scene of bricks".to_owned(), names.applied_to(scene)?, Vec::new())
    };
    let board = RigConfig::default().board;
    let program = compile_draft(&scene, &board.limits, board.tick_hz);
    let inputs = Inputs::new(files.iter().chain(&args.bench));
    let subject = Subject { name: &name, scene: &scene, program };
    for file in write(&args.out, &subject, args.bench.as_deref(), &inputs)? {
        print_line(format_args!("  {:<16} {}", "wrote", file.display()))?;
    }
    Ok(())
}
