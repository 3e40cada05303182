//! `frixel score`: which layers simulated fingers notice, and how faithfully they feel a scene.

use std::path::{Path, PathBuf};

use super::error::of_simulation;
use crate::output::draw_score_svg;
use anyhow::{Result, bail};
use clap::Args;
use frixel_files::{Inputs, OutputFile, OutputFolder, commit_all};
use frixel_hil_sim::Board;
use frixel_lab::GeneratedStroke;
use frixel_lab::score::{Score, TrialPlan, TrialStroke};
use frixel_play::TO_THE_END;
use frixel_scene::compile;

use super::argument::{number, whole};
use super::demo::FOLDER;
use super::jobs::JobsArgs;
use super::profiles::{ProfileArgs, TouchArgs};
use super::stroke;
use super::terminal::print_line;

#[derive(Debug, Args)]
pub(super) struct ScoreArgs {
    /// The scene, a TOML file (docs/design/scenes.md).
    scene: PathBuf,
    #[command(flatten)]
    profiles: ProfileArgs,
    /// Strokes: `human`, `human-rough` (rough accelerations), `sweep`, or a CSV file (`t_s,x_mm,y_mm`).
    #[arg(long, default_value = "human", value_name = "NAME|FILE")]
    stroke: String,
    /// Play under N people of an assumed population, each with strokes of their own, not under the scene's finger.
    #[arg(long, value_name = "N", value_parser = whole(1..=TrialPlan::COUNT_MAX))]
    #[arg(allow_negative_numbers = true)]
    people: Option<u64>,
    #[arg(help = format!("Number of human strokes, of each person [default: {}]", TrialPlan::STROKES))]
    #[arg(long, value_name = "N", value_parser = whole(1..=TrialPlan::COUNT_MAX), allow_negative_numbers = true)]
    strokes: Option<u64>,
    /// Repetitions of each stroke, each with other loads, noise and lost reports.
    #[arg(long, value_name = "N", default_value_t = TrialPlan::SEEDS, value_parser = whole(1..=TrialPlan::COUNT_MAX))]
    #[arg(allow_negative_numbers = true)]
    seeds: u64,
    /// Length of a generated stroke.
    #[arg(long, value_name = "S", default_value_t = TrialPlan::SECONDS)]
    #[arg(value_parser = super::argument::seconds, allow_negative_numbers = true)]
    seconds: f64,
    /// Median speed of human strokes. Without it, each person has their own.
    #[arg(long, value_name = "MM_PER_S", value_parser = median_speed, allow_negative_numbers = true)]
    median_speed_mm_per_s: Option<f64>,
    #[command(flatten)]
    touch: TouchArgs,
    #[command(flatten)]
    jobs: JobsArgs,
    /// Simulate a world without noise, load changes, losses and offsets.
    #[arg(long)]
    ideal: bool,
    /// Folder for score.csv, score-layers.csv and score.svg.
    #[arg(long, default_value = FOLDER)]
    out: PathBuf,
    /// Also print how faithfully friction was felt, with the goals of a display.
    #[arg(long)]
    fidelity: bool,
    /// Print one JSON object in place of the table.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &ScoreArgs) -> Result<()> {
    // The board's limit for the time between two reports stays that of the slowest class, 10 ms: a fast source that
    // loses reports would otherwise turn the output off (docs/design/touch.md).
    let (board, world) = (Board::SIMULATOR, args.touch.world(args.ideal)?);
    let (scene, files) = args.profiles.names().load_with_files(&args.scene);
    let inputs = Inputs::new(files.paths().chain([Path::new(&args.stroke)]).chain(args.touch.file()));
    let file = |name: &str| OutputFile::new(&args.out.join(name), "--out", &inputs);
    let (csv, layers, svg) = (file("score.csv")?, file("score-layers.csv")?, file("score.svg")?);
    let scene = scene?;
    let program = compile(&scene, &board.limits, board.tick_hz)?;
    let trials = trial_plan(args)?.of_people(args.people, &scene, &program, TO_THE_END)?;
    let _folder = OutputFolder::open(&args.out)?;
    let score = args.jobs.run(|| Score::of(&program, &world, &trials, TO_THE_END))?.map_err(of_simulation)?;
    let scene = args.scene.file_name().unwrap_or_default().to_string_lossy();
    let drawn = draw_score_svg(&format!("{scene}, simulated: {} plays", trials.len()), &score)?;
    let filled = [(&csv, score.to_csv()), (&layers, score.layers_csv()), (&svg, drawn)]
        .map(|(file, text)| file.filled(text.as_bytes()));
    commit_all(filled.into_iter().collect::<Result<_, _>>()?, &[])?;
    if args.json {
        return print_line(format_args!("{}", score.to_json()));
    }
    for line in score.summary(args.fidelity).lines() {
        print_line(format_args!("{line}"))?;
    }
    for file in [csv, layers, svg] {
        print_line(format_args!("  {:<30} {}", "wrote", file.path().display()))?;
    }
    Ok(())
}

/// The trials of each finger.
fn trial_plan(args: &ScoreArgs) -> Result<TrialPlan> {
    let stroke = match GeneratedStroke::named(&args.stroke) {
        Some(generated) => generated.into(),
        None => TrialStroke::Own(stroke::from_file(Path::new(&args.stroke))?),
    };
    if let (Some(found), false) = (args.strokes, stroke.is_of_people()) {
        bail!("--strokes {found} is for human strokes, and there is only one of {}: leave --strokes out", args.stroke);
    }
    Ok(TrialPlan {
        stroke,
        strokes: args.strokes.unwrap_or(TrialPlan::STROKES),
        seeds: args.seeds,
        seconds: args.seconds,
        median_speed_m_per_s: args.median_speed_mm_per_s.map(|speed_mm_per_s| 1e-3 * speed_mm_per_s),
    })
}

/// Parses the median speed of a stroke.
fn median_speed(text: &str) -> Result<f64, String> {
    number(text, TrialPlan::MEDIAN_SPEEDS_MM_PER_S, "a speed from 1 to 1000 mm/s")
}
