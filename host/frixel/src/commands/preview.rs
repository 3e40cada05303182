//! `frixel preview`: draws the friction map of a scene, and prints what a person will feel.

use std::path::{Path, PathBuf};

use crate::output::{draft_line, draw_preview_png};
use anyhow::{Result, bail};
use clap::Args;
use frixel_felt::Preview;
use frixel_felt::check::feel;
use frixel_felt::judge::Advice;
use frixel_files::{Inputs, OutputFile, create_folder};
use frixel_hil_sim::{RigConfig, WorldOptions};
use frixel_play::{TO_THE_END, judge};
use frixel_scene::compile_draft;

use super::argument::{number, whole};
use super::demo::FOLDER;
use super::error::of_simulation;
use super::profiles::ProfileArgs;
use super::terminal::{note_refusals, print_line};

#[derive(Debug, Args)]
pub(super) struct PreviewArgs {
    /// The scene, a TOML file (docs/design/scenes.md).
    scene: PathBuf,
    #[command(flatten)]
    profiles: ProfileArgs,
    /// The picture, a PNG file. Default: frixel-out/map.png.
    #[arg(short, long, value_name = "FILE.png")]
    output: Option<PathBuf>,
    /// Sliding speed; it only affects `speed` layers.
    #[arg(long, value_name = "MM_PER_S", default_value_t = 100.0, value_parser = speed, allow_negative_numbers = true)]
    speed_mm_per_s: f64,
    /// Largest width of the map, in pixels.
    #[arg(long, value_name = "PIXELS", default_value_t = 1_000)]
    #[arg(value_parser = whole(100..=4_000_u32), allow_negative_numbers = true)]
    map_width: u32,
}

pub(super) fn run(args: &PreviewArgs) -> Result<()> {
    let path = args.output.clone().unwrap_or_else(|| Path::new(FOLDER).join("map.png"));
    if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
        let path = path.display();
        bail!("{path} is not the name of a PNG file: give the picture a name that ends in .png");
    }
    let rig = RigConfig::default();
    let (scene, files) = args.profiles.names().load_with_files(&args.scene);
    let output = OutputFile::new(&path, "-o", &Inputs::new(files.paths()))?;
    let program = compile_draft(&scene?, &rig.board.limits, rig.board.tick_hz)?;
    note_refusals(&args.scene, &program);
    let title = args.scene.file_name().unwrap_or_default().to_string_lossy();
    let map_max = (args.map_width, args.map_width * 4 / 5);
    let preview = Preview { speed_m_per_s: 1e-3 * args.speed_mm_per_s, map_max };
    if args.output.is_none() {
        create_folder(Path::new(FOLDER))?;
    }
    output.write(&draw_preview_png(&title, &program, &preview)?)?;
    if program.is_draft() {
        print_line(format_args!("  {:<16} {}", "draft", draft_line(program.refusals().count())))?;
    }
    let judgement = judge(&program, &rig, &WorldOptions::default(), Advice::Sought, TO_THE_END);
    for (name, text) in feel::lines(&judgement.map_err(of_simulation)?) {
        print_line(format_args!("  {name:<16} {text}"))?;
    }
    print_line(format_args!("  {:<16} {}", "wrote", path.display()))
}

/// Parses the speed of a finger.
fn speed(text: &str) -> Result<f64, String> {
    number(text, 0.0..=10_000.0, "a speed from 0 to 10000 mm/s")
}
