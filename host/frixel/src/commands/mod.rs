//! The command line: one module per command.

mod argument;
mod board;
mod check;
mod completions;
mod demo;
mod error;
mod finger;
mod interrupt;
mod jobs;
mod model;
mod new;
mod parquet;
mod play;
mod port;
mod preview;
mod profiles;
mod real_board;
mod report;
mod scenario;
mod schema;
mod score;
#[cfg(unix)]
mod sim;
mod stroke;
mod studio;
mod sweep;
mod target;
mod terminal;
mod waiting;

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::error::{ContextKind, ContextValue};
use clap::{Args, CommandFactory, Parser, Subcommand};
use frixel_scene::FileKind;

use crate::input;
use stroke::StrokeArgs;

const EXIT_CODES: &str = "Exit codes: 0 on success, 1 on failure (the last line on standard error gives the reason), \
                          2 if the command line is invalid. Results go to standard output; notes and progress go to \
                          standard error, progress only if that is a terminal. Nothing is coloured.";

/// Friction textures on an electrovibration screen, in newtons.
///
/// Without a command, plays the demo.
#[derive(Debug, Parser)]
#[command(name = "frixel", version, about, after_help = EXIT_CODES)]
pub(crate) struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Play the bundled brick texture on the simulated board, under a simulated finger.
    Demo(demo::DemoArgs),
    /// Write a first scene, with comments.
    New(new::NewArgs),
    /// Play a scene on a board or on the simulator.
    Play(play::PlayArgs),
    /// Report every mistake in a scene, or else what is felt, which friction it reaches, and whether it fits a board.
    Check(check::CheckArgs),
    /// Draw the friction map of a scene: a PNG with rulers, and a colour scale in millinewtons.
    Preview(preview::PreviewArgs),
    /// Print the JSON schema of the scene file, for editors.
    Schema,
    /// Report which layers simulated fingers notice.
    Score(score::ScoreArgs),
    /// Play every combination of scenes, people, screens and values, and draw which simulated fingers feel what.
    Sweep(sweep::SweepArgs),
    /// Serve a virtual board on a pseudo-terminal, for other programs to play to; or run a scenario of faults.
    Sim(SimArgs),
    /// Open the studio, a page in which scenes are made, seen and heard.
    Studio(studio::StudioArgs),
    /// Play a simulated recording again, and check that the result is the same to the bit.
    Replay(play::replay::ReplayArgs),
    /// Find, check and record from a board at a serial port.
    #[command(subcommand)]
    Board(board::BoardCommand),
    /// Measure a finger, and fit its profile.
    #[command(subcommand)]
    Finger(finger::FingerCommand),
    /// Print completions of commands and options for a shell.
    Completions(completions::CompletionsArgs),
    /// Evaluate or invert the contact model over rows of CSV.
    #[command(subcommand)]
    Model(model::ModelCommand),
    /// Draw the contact model, its error and its cost on one page.
    Report(report::ReportArgs),
}

/// Parsed on every operating system: without pseudo-terminals, the command fails with a sentence.
#[derive(Debug, Args)]
struct SimArgs {
    #[command(flatten)]
    stroke: StrokeArgs,
    /// The finger on this board, whatever scene plays: a profile's file, or `example`, `dry`, `moist` or `light`.
    /// Default: the finger of the scene that plays.
    #[arg(long, value_name = "NAME|FILE", group = "own_finger")]
    finger: Option<String>,
    /// Seed of a simulated person, in place of --finger.
    #[arg(long, value_name = "N", group = "own_finger")]
    finger_seed: Option<u64>,
    /// The screen under the finger of --finger or --finger-seed: a screen's file or `example`. Default: `example`.
    #[arg(long, value_name = "NAME|FILE", requires = "own_finger")]
    screen: Option<String>,
    #[command(flatten)]
    touch: profiles::TouchArgs,
    /// Leave out load changes, noise, pre-sliding, leakage, offsets and lost touch reports.
    #[arg(long)]
    ideal: bool,
    /// Output folder.
    #[arg(long, default_value = "frixel-sim")]
    out: PathBuf,
    /// Seed of the simulator's random numbers.
    #[arg(long, default_value_t = 1, value_parser = argument::seed, allow_negative_numbers = true)]
    seed: u64,
    /// Run a scenario in place of serving a board, as fast as possible: a host's actions, faults, and expectations
    /// (docs/inside/scenarios.md). Prints what happened.
    #[arg(
        long,
        value_name = "FILE.toml",
        conflicts_with_all = ["finger", "finger_seed", "screen", "ideal", "seed", "out", "stroke", "from", "touch"]
    )]
    scenario: Option<PathBuf>,
    /// Fail, with exit code 1, unless every expectation of the scenario is met.
    #[arg(long, requires = "scenario")]
    expect: bool,
    /// Rig of the scenario: `sim` in this process, or an emulated `qemu` or `pico`.
    #[arg(long, value_enum, default_value_t, hide_possible_values = true, requires = "scenario")]
    rig: target::Target,
}

impl Cli {
    pub(crate) fn run(self) -> Result<()> {
        match self.command {
            None => demo::run(&demo::DemoArgs::default()),
            Some(Command::Demo(args)) => demo::run(&args),
            Some(Command::New(args)) => new::run(&args),
            Some(Command::Play(args)) => play::run(&args),
            Some(Command::Check(args)) => check::run(&args),
            Some(Command::Preview(args)) => preview::run(&args),
            Some(Command::Schema) => schema::run(),
            Some(Command::Score(args)) => score::run(&args),
            Some(Command::Sweep(args)) => sweep::run(&args),
            Some(Command::Sim(SimArgs { scenario: Some(file), expect, rig, .. })) => scenario::run(&file, expect, rig),
            #[cfg(unix)]
            Some(Command::Sim(args)) => sim::run(&args),
            #[cfg(not(unix))]
            Some(Command::Sim(_)) => Err(error::no_pseudo_terminal("frixel sim")),
            Some(Command::Studio(args)) => studio::run(&args),
            Some(Command::Replay(args)) => play::replay::run(&args),
            Some(Command::Board(command)) => board::run(&command),
            Some(Command::Finger(command)) => finger::run(&command),
            Some(Command::Completions(args)) => completions::run(&args),
            Some(Command::Model(command)) => model::run(&command),
            Some(Command::Report(args)) => report::run(&args),
        }
    }
}

/// Tips for likely words that are no commands, not even in a group, and for likely options that commands lack.
const TIPS: [(&str, &str); 4] = [
    (
        "--scene",
        "write the scene without an option: `frixel play SCENE`, and `--port PATH` for the board of `frixel sim`",
    ),
    ("scenario", "write `frixel sim --scenario FILE.toml`"),
    ("scene", "write `frixel check`, `frixel preview` or `frixel schema`"),
    ("threshold", "`python -m frixel.experiment FOLDER --port PATH` finds a threshold: pip install ./host/python"),
];

/// Adds a tip to the error of an unknown option or command: for `frixel info`, which lacks its group, `frixel board
/// info`; for a file, the command or the option that takes it.
pub(crate) fn with_tip(mut error: clap::Error) -> clap::Error {
    let command = error.get(ContextKind::InvalidSubcommand);
    let Some(ContextValue::String(found)) = command.or(error.get(ContextKind::InvalidArg)) else { return error };
    // A second scene is not a wrong command.
    let has_use = |kind: &FileKind| command.is_some() || *kind != FileKind::Scene;
    let cli = Cli::command();
    let has_command = |group: &&clap::Command| group.get_subcommands().any(|command| command.get_name() == found);
    let group = cli.get_subcommands().find(has_command);
    let tip = group.map(|group| format!("write `frixel {} {found}`", group.get_name())).or_else(|| {
        let tip = TIPS.into_iter().find(|(word, _)| word == found);
        let kind = || FileKind::of(&input::read_toml(Path::new(found)).ok()?);
        tip.map(|(_, tip)| tip).or_else(|| Some(kind().filter(has_use)?.use_of())).map(str::to_owned)
    });
    if let Some(tip) = tip {
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
        error.remove(ContextKind::SuggestedSubcommand);
        error.remove(ContextKind::SuggestedArg);
    }
    error
}

/// Prints the error that ended a command.
pub(crate) fn report_error(error: &anyhow::Error) {
    terminal::note(format_args!("frixel: {error}"));
}

#[cfg(test)]
#[allow(dead_code, reason = "`tests/outputs` reads the rest")]
#[path = "../../tests/outputs/table.rs"]
mod table;

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use clap::builder::ValueParser;

    use super::*;

    /// Collects every argument that is a path, with its command.
    fn paths(command: &clap::Command, of: &str, found: &mut BTreeSet<String>) {
        let is_path =
            |argument: &&clap::Arg| argument.get_value_parser().type_id() == ValueParser::path_buf().type_id();
        for argument in command.get_arguments().filter(is_path) {
            assert!(found.insert(format!("{of}{}", argument.get_id())));
        }
        for nested in command.get_subcommands() {
            paths(nested, &format!("{of}{} ", nested.get_name()), found);
        }
    }

    /// Lines and columns of a terminal that shows a command's help without scrolling.
    const SCREEN: (usize, usize) = (40, 120);

    /// The words of every command, `frixel` alone first.
    fn names(command: &clap::Command, of: &[String]) -> Vec<Vec<String>> {
        let name = [of, &[command.get_name().to_owned()]].concat();
        let nested = command.get_subcommands().flat_map(|nested| names(nested, &name));
        std::iter::once(name.clone()).chain(nested).collect()
    }

    #[test]
    fn the_help_of_each_command_fits_a_screen() {
        for (name, option) in
            names(&Cli::command(), &[]).into_iter().flat_map(|name| [(name.clone(), "-h"), (name, "--help")])
        {
            let line = [&name[..], &[option.to_owned()]].concat();
            let text = Cli::try_parse_from(line).unwrap_err().to_string();
            assert!(text.contains("Usage: "), "{name:?} {option}: {text}");
            let lines = text.lines().map(|line| line.chars().count().div_ceil(SCREEN.1).max(1)).sum::<usize>();
            assert!(lines <= SCREEN.0, "{lines} lines of help of {name:?} {option}:\n{text}");
        }
    }

    /// The help is the only description of the model's columns and statuses.
    #[test]
    fn the_help_of_the_model_names_every_column_and_status() {
        let help = |name| {
            model::ModelCommand::augment_subcommands(clap::Command::new("model"))
                .find_subcommand_mut(name)
                .map(|command| command.render_long_help().to_string())
                .unwrap()
        };
        let eval = "variant radius_m stiffness_pa_per_m coating_m permittivity friction_coefficient voltage_v \
                    normal_force_n outer_radius_m modulus_pa stress_exponent shape_constant sigma0_pa contact_radius_m \
                    effective_stiffness_pa_per_m friction_n status no-contact invalid";
        let invert = "friction_n electric_friction_n voltage_v status below-natural unstable invalid";
        for (name, words) in [("eval", eval), ("invert", invert)] {
            let help = help(name);
            assert!(words.split(' ').all(|word| help.contains(word)), "{help}");
        }
    }

    /// A new output has to be added to the table that `tests/outputs` goes through.
    #[test]
    fn every_path_on_the_command_line_is_a_known_input_or_a_tested_output() {
        let mut found = BTreeSet::new();
        paths(&Cli::command(), "", &mut found);
        let outputs = table::OUTPUTS.iter().map(|output| output.argument);
        let known: BTreeSet<String> = table::INPUTS.into_iter().chain(outputs).map(str::to_owned).collect();
        assert_eq!(found, known);
    }
}
