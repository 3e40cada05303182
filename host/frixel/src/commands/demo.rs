//! `frixel demo`: the bundled brick texture on the simulator.

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;

use frixel_files::{Inputs, OutputFile, create_folder};

use super::play::{self, PlayArgs};
use super::terminal::print_line;

/// The scene and its picture are embedded in the executable, so that the demo needs no files.
pub(super) const SCENE: &str = include_str!("../../scenes/brick.toml");
pub(super) const PICTURE_NAME: &str = "textures/brick.png";
pub(super) const PICTURE: &[u8] = include_bytes!("../../scenes/brick.png");

/// Folder of the results of commands that are given none.
pub(super) const FOLDER: &str = "frixel-out";

#[derive(Debug, Args)]
pub(super) struct DemoArgs {
    /// Output folder.
    #[arg(long, default_value = FOLDER)]
    out: PathBuf,
}

impl Default for DemoArgs {
    fn default() -> Self {
        Self { out: FOLDER.into() }
    }
}

pub(super) fn run(args: &DemoArgs) -> Result<()> {
    let scene = args.out.join("brick.toml");
    create(&args.out.join(PICTURE_NAME), PICTURE)?;
    let place = scene.display();
    let slides = "a simulated finger slides over it for three seconds";
    if create(&scene, SCENE.as_bytes())? {
        print_line(format_args!("{place} is new: a wall of bricks, as a picture of friction"))?;
        print_line(format_args!(
            "{slides}; on mortar its friction rises by a quarter, more than two of the smallest steps that a finger \
             feels (assumed); faster fingers feel the strokes of mortar as a buzz"
        ))?;
    } else {
        print_line(format_args!("{place} plays as it is in this folder; remove it to get the bundled one back"))?;
        print_line(slides)?;
    }
    let out = args.out.display();
    print_line(format_args!("open {out}/scene.png for the path of the finger, {out}/felt.svg for what it felt"))?;
    play::run(&PlayArgs::ideal(&scene, &args.out)?)?;
    print_line(format_args!("change {place} and play it again: frixel play {place}"))
}

/// Writes a file unless there is one already, and returns whether it did.
fn create(path: &Path, bytes: &[u8]) -> Result<bool> {
    if let Some(folder) = path.parent() {
        create_folder(folder)?;
    }
    Ok(OutputFile::new(path, "--out", &Inputs::default())?.write_new(bytes)?)
}
