//! `frixel score`: how faithfully simulated fingers feel a scene.

use std::path::{Path, PathBuf};

use crate::output::draw_score_svg;
use crate::output_file::{Inputs, OutputFile, OutputFolder, commit_all};
use clap::Args;
use frixel_hil_sim::{Person, RigConfig, Stroke};
use frixel_lab::score::{Score, Trial, TrialFinger};
use frixel_lab::simulation::SimulationError;
use frixel_scene::{Program, Scene, compile};

use super::argument::number;
use super::error::CommandError;
use super::jobs::JobsArgs;
use super::profiles::{ProfileArgs, TouchArgs};
use super::stroke;
use super::terminal::print_line;

#[derive(Debug, Args)]
pub(super) struct ScoreArgs {
    /// The scene, a TOML file (docs/scene.md).
    scene: PathBuf,
    #[command(flatten)]
    profiles: ProfileArgs,
    /// Where the finger goes: `human` for randomly generated people with the accelerations of recorded ones after
    /// smoothing, `human-rough` for those before smoothing, `sweep` for an even sweep over the screen, or a CSV file
    /// with the columns `t_s,x_mm,y_mm`.
    #[arg(long, default_value = "human", value_name = "human|human-rough|sweep|FILE.csv")]
    stroke: String,
    /// Play under the fingers of so many people, drawn from an assumed population, whom the board does not know; each
    /// makes strokes of their own. Without it, the finger is the scene's.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1000))]
    people: Option<u64>,
    /// Number of human strokes, of each person.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u64).range(1..=1000))]
    strokes: u64,
    /// Repetitions of each stroke. Load, noise and lost reports are others in each, and on each stroke.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u64).range(1..=1000))]
    seeds: u64,
    /// Length of a generated stroke.
    #[arg(long, value_name = "S", default_value_t = 3.0, value_parser = super::argument::seconds, allow_negative_numbers = true)]
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
    #[arg(long, default_value = "frixel-out")]
    out: PathBuf,
    /// Print one JSON object in place of the table.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &ScoreArgs) -> Result<(), CommandError> {
    let rig = rig(args)?;
    let (scene, files) = args.profiles.names().load_with_files(&args.scene);
    let inputs = Inputs::new(files.paths().chain([Path::new(&args.stroke)]).chain(args.touch.file()));
    let file = |name: &str| OutputFile::new(&args.out.join(name), "--out", &inputs);
    let (csv, layers, svg) = (file("score.csv")?, file("score-layers.csv")?, file("score.svg")?);
    let scene = scene?;
    let program = compile(&scene, &rig.board.limits, rig.board.tick_hz)?;
    let trials = match args.people {
        None => trials(args, &program, None)?,
        Some(people) => {
            let of_person = |person: u64| trials(args, &program, Some(finger(args, &scene, person)?));
            (1..=people).map(of_person).collect::<Result<Vec<_>, CommandError>>()?.concat()
        }
    };
    let _folder = OutputFolder::open(&args.out)?;
    let score = args.jobs.run(|| Score::of(&program, &rig, &trials))?.map_err(|error| match error {
        SimulationError::Play(error) => CommandError::of_play("sim", error),
        SimulationError::World(error) => error.into(),
    })?;
    let scene = args.scene.file_name().unwrap_or_default().to_string_lossy();
    let drawn = draw_score_svg(&format!("{scene}, simulated: {} plays", trials.len()), &score)?;
    let filled = [(&csv, score.to_csv()), (&layers, score.layers_csv()), (&svg, drawn)]
        .map(|(file, text)| file.filled(text.as_bytes()));
    commit_all(filled.into_iter().collect::<Result<_, _>>()?, &[])?;
    if args.json {
        return print_line(format_args!("{}", score.to_json()));
    }
    for line in score.summary().lines() {
        print_line(format_args!("{line}"))?;
    }
    for file in [csv, layers, svg] {
        print_line(format_args!("  {:<30} {}", "wrote", file.path().display()))?;
    }
    Ok(())
}

/// The simulated board and its world.
fn rig(args: &ScoreArgs) -> Result<RigConfig, CommandError> {
    let mut rig = RigConfig::default();
    if !args.ideal {
        rig.world = rig.world.realistic();
    }
    rig.world = args.touch.applied_to(rig.world, args.ideal)?;
    // The board's limit for the time between two reports stays that of the slowest class, 10 ms: a fast source that
    // loses reports would otherwise turn the output off (docs/touch.md).
    Ok(rig)
}

/// The finger of a person on the screen of a scene. A scene of version 1 has none without its own finger's skin.
fn finger(args: &ScoreArgs, scene: &Scene, person: u64) -> Result<TrialFinger, CommandError> {
    let coating_gap_m = 1e-6 * scene.screen_without_skin()?.coating_gap_um();
    let drawn = Person::drawn(person);
    let contact = drawn.contact(coating_gap_m).map_err(CommandError::Finger)?;
    Ok(TrialFinger { person, contact, fingertip: (!args.ideal).then_some(drawn.fingertip) })
}

/// Every stroke as often as it is repeated, by one finger. Each person makes strokes of their own, and each play has a
/// world seed of its own.
fn trials(args: &ScoreArgs, program: &Program, finger: Option<TrialFinger>) -> Result<Vec<Trial>, CommandError> {
    let first_stroke = finger.map_or(1, |finger| 1 + (finger.person - 1) * args.strokes);
    let screen_m = (f64::from(program.header.screen_width_m), f64::from(program.header.screen_height_m));
    let strokes: Vec<(String, Stroke)> = match (args.stroke.as_str(), stroke::human(Path::new(&args.stroke))) {
        (_, Some(human)) => (first_stroke..first_stroke + args.strokes)
            .map(|seed| human_stroke(args, human, screen_m, seed))
            .collect::<Result<_, _>>()?,
        // The name that it had before.
        ("sweep" | "natural", None) => {
            let stroke = Stroke::sweep(screen_m.0, screen_m.1, args.seconds).map_err(CommandError::GeneratedStroke)?;
            vec![("sweep".to_owned(), stroke)]
        }
        (file, None) => vec![("file".to_owned(), stroke::from_file(Path::new(file))?)],
    };
    let trials = (first_stroke..).zip(strokes).flat_map(|(number, (stroke_name, stroke))| {
        let first_seed = 1 + (number - 1) * args.seeds;
        (first_seed..first_seed + args.seeds).map(move |seed| Trial {
            stroke_name: stroke_name.clone(),
            stroke: stroke.clone(),
            seed,
            finger,
        })
    });
    Ok(trials.collect())
}

fn human_stroke(
    args: &ScoreArgs,
    human: stroke::Human,
    (width_m, height_m): (f64, f64),
    seed: u64,
) -> Result<(String, Stroke), CommandError> {
    let median_speed_m_per_s = args.median_speed_mm_per_s.map(|speed_mm_per_s| 1e-3 * speed_mm_per_s);
    let stroke = human(width_m, height_m, args.seconds, median_speed_m_per_s, seed);
    Ok((format!("{} {seed}", args.stroke), stroke.map_err(CommandError::GeneratedStroke)?))
}

/// Parses the median speed of a stroke.
fn median_speed(text: &str) -> Result<f64, String> {
    number(text, 1.0..=1000.0, "a speed from 1 to 1000 mm/s")
}
