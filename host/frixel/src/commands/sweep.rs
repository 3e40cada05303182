//! `frixel sweep`: studies of many simulated fingers.

use std::collections::BTreeSet;
use std::fs::{self, create_dir_all};
use std::io::{IsTerminal, stderr};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use clap::{Args, Subcommand};
use frixel_hil_sim::TouchConfig;
use frixel_lab::sweep::{Cell, CellResult, Plan, Profile, Source, Study};
use frixel_scene::Screen;
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::argument::shard;
use super::error::CommandError;
use super::jobs::JobsArgs;
use super::terminal::print_line;
use crate::input;
use crate::output::draw_sweep_svg;
use crate::output_file::{Inputs, OutputFile, OutputFileError, OutputFolder, commit_all};
use crate::scene_file::gathered;

/// The folder of the results of cells, each in a file of its key.
const CELLS: &str = "cells";
/// The file in that folder that names the cells of the plan that was played last.
const PLAN: &str = "plan.json";

/// Time between two tries to write a file that another process writes, and the longest time for all of them.
const WAIT: Duration = Duration::from_millis(10);
const WAIT_MAX: Duration = Duration::from_secs(10);

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(super) struct SweepArgs {
    #[command(subcommand)]
    command: Option<SweepCommand>,
    /// The plan, a TOML file (docs/scale.md).
    #[arg(required = true)]
    plan: Option<PathBuf>,
    /// Folder for the results. Cells that are there already are not played again.
    #[arg(short, long, value_name = "OUT", required = true)]
    out: Option<PathBuf>,
    /// Play the Kth of N parts of the cells, for several processes or machines; `frixel sweep merge` then puts them
    /// together.
    #[arg(long, value_name = "K/N", value_parser = shard)]
    shard: Option<(usize, usize)>,
    #[command(flatten)]
    jobs: JobsArgs,
}

#[derive(Debug, Subcommand)]
enum SweepCommand {
    /// Put the results of a sweep together.
    Merge(MergeArgs),
}

#[derive(Debug, Args)]
struct MergeArgs {
    /// The folder of the sweep.
    out: PathBuf,
}

/// The cells of a sweep, in the order of its plan.
#[derive(Debug, Serialize, Deserialize)]
struct Keys {
    cells: Vec<String>,
}

pub(super) fn run(args: &SweepArgs) -> Result<(), CommandError> {
    match (&args.command, &args.plan, &args.out) {
        (Some(SweepCommand::Merge(MergeArgs { out })), ..) => merge(out, &Inputs::default()),
        // Clap requires both.
        (None, Some(plan), Some(out)) => play(args, plan, out),
        (None, ..) => Ok(()),
    }
}

fn play(args: &SweepArgs, plan_path: &Path, out: &Path) -> Result<(), CommandError> {
    let reading = |source| CommandError::SweepInput {
        path: plan_path.to_owned(),
        what: "plan",
        source,
        advice: "check the path",
    };
    let text = input::read_text(plan_path, input::TOML_MAX_BYTES).map_err(reading)?;
    let plan = Plan::parse(&text, &plan_path.display().to_string())?;
    let folder = plan_path.parent().unwrap_or(Path::new(""));
    let cells = cells(&plan, folder)?;
    for cell in cells.iter().filter(|cell| cell.person == 1) {
        cell.check().map_err(|source| CommandError::Cell { cell: title(cell), source })?;
    }
    let files = plan.scenes.iter().chain(&plan.screens).chain(&plan.touch).map(|name| folder.join(name));
    let inputs = Inputs::new(files.chain([plan_path.to_owned()]));
    let keys = Keys { cells: cells.iter().map(Cell::key).collect() };
    let folder = out.join(CELLS);
    create_dir_all(&folder).map_err(CommandError::writing(&folder))?;
    write_shared(&OutputFile::new(&out.join(CELLS).join(PLAN), "-o", &inputs)?, &json(&keys))?;

    let (part, parts) = args.shard.unwrap_or((1, 1));
    let own: Vec<(usize, &Cell)> = cells.iter().enumerate().filter(|(number, _)| number % parts == part - 1).collect();
    let path = |number: usize| cell_path(out, keys.cells.get(number).map_or("", String::as_str));
    let left: Vec<(usize, &Cell)> = own.iter().copied().filter(|(number, _)| !path(*number).exists()).collect();
    let bar = stderr().is_terminal().then(|| ProgressBar::new(left.len() as u64));
    args.jobs.run(|| {
        left.par_iter().try_for_each(|(number, cell)| {
            let result = cell.play().map_err(|source| CommandError::Cell { cell: title(cell), source })?;
            write_shared(&OutputFile::new(&path(*number), "-o", &inputs)?, &json(&result))?;
            if let Some(bar) = &bar {
                bar.inc(1);
            }
            Ok::<(), CommandError>(())
        })
    })??;
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
    let had = own.len() - left.len();
    print_line(format_args!("  {:<30} {} played, {had} were there, of {}", "cells", left.len(), cells.len()))?;
    if parts == 1 { merge(out, &inputs) } else { Ok(()) }
}

/// Writes a file that other processes of the same sweep may write at the same moment, with the same content.
fn write_shared(file: &OutputFile, text: &str) -> Result<(), CommandError> {
    let begin = Instant::now();
    loop {
        if fs::read(file.path()).is_ok_and(|there| there == text.as_bytes()) {
            return Ok(());
        }
        match file.write(text.as_bytes()) {
            Err(OutputFileError::Busy { .. }) if begin.elapsed() < WAIT_MAX => thread::sleep(WAIT),
            written => return Ok(written?),
        }
    }
}

/// The cells of a plan, whose files are named from its folder.
fn cells(plan: &Plan, folder: &Path) -> Result<Vec<Cell>, CommandError> {
    let scene = |name: &String| gathered(&folder.join(name), name);
    let scenes: Vec<Source> = plan.scenes.iter().map(scene).collect::<Result<_, _>>()?;
    let profiles = |names: &[String], what, is_bundled: fn(&str) -> bool| {
        names.iter().map(|name| profile(name, folder, what, is_bundled)).collect::<Result<Vec<Profile>, _>>()
    };
    let screens = profiles(&plan.screens, "screen", |name| Screen::bundled(name).is_some())?;
    let touch = profiles(&plan.touch, "touch source", |name| TouchConfig::bundled(name).is_some())?;
    Ok(plan.cells(&scenes, &screens, &touch)?)
}

fn profile(
    name: &str,
    folder: &Path,
    what: &'static str,
    is_bundled: fn(&str) -> bool,
) -> Result<Profile, CommandError> {
    if is_bundled(name) {
        return Ok(Profile { name: name.to_owned(), text: None });
    }
    let path = folder.join(name);
    match input::read_text(&path, input::TOML_MAX_BYTES) {
        Ok(text) => Ok(Profile { name: name.to_owned(), text: Some(text) }),
        Err(source) => Err(CommandError::SweepInput {
            path,
            what,
            source,
            advice: "give its file, from the plan's folder, or a bundled one",
        }),
    }
}

/// Puts the results of all cells together.
fn merge(out: &Path, inputs: &Inputs) -> Result<(), CommandError> {
    let keys: Keys = read(&out.join(CELLS).join(PLAN), "list of the cells of a sweep")?;
    let there: Vec<PathBuf> = keys.cells.iter().map(|key| cell_path(out, key)).filter(|path| path.exists()).collect();
    if there.len() < keys.cells.len() {
        return Err(CommandError::CellsMissing { folder: out.to_owned(), found: there.len(), of: keys.cells.len() });
    }
    let results: Vec<CellResult> = there.iter().map(|path| read(path, "result of a cell")).collect::<Result<_, _>>()?;
    let study = Study::new(results);
    let _folder = OutputFolder::open(out)?;
    let file = |name: &str| OutputFile::new(&out.join(name), "-o", inputs);
    let written = [
        (file("layers.csv")?, study.layers_csv()),
        (file("fingers.csv")?, study.fingers_csv()),
        (file("numbers.csv")?, study.numbers_csv()),
        (file("sweep.svg")?, draw_sweep_svg(&study)?),
    ];
    let filled = written.iter().map(|(file, text)| file.filled(text.as_bytes()));
    commit_all(filled.collect::<Result<_, _>>()?, &[])?;
    for line in study.summary() {
        print_line(format_args!("{line}"))?;
    }
    for (file, _) in &written {
        print_line(format_args!("  {:<30} {}", "wrote", file.path().display()))?;
    }
    Ok(())
}

fn cell_path(out: &Path, key: &str) -> PathBuf {
    out.join(CELLS).join(format!("{key}.json"))
}

/// What a cell is called in messages.
fn title(cell: &Cell) -> String {
    let values: BTreeSet<String> = cell.parameters.iter().map(|(path, value)| format!("{path} = {value}")).collect();
    let values: Vec<String> = values.into_iter().collect();
    let with = if values.is_empty() { String::new() } else { format!(" with {}", values.join(", ")) };
    format!("{}{with}", cell.scene)
}

fn json(value: &impl Serialize) -> String {
    // Numbers, strings and maps with names always serialise.
    serde_json::to_string(value).unwrap_or_default()
}

fn read<T: for<'de> Deserialize<'de>>(path: &Path, what: &'static str) -> Result<T, CommandError> {
    let advice = "give the folder of a sweep, which `frixel sweep PLAN.toml -o OUT` makes";
    let reading = |source| CommandError::SweepInput { path: path.to_owned(), what, source, advice };
    let bytes = input::read(path, input::CSV_MAX_BYTES).map_err(reading)?;
    serde_json::from_slice(&bytes).map_err(|error| CommandError::NoSweepFile {
        path: path.to_owned(),
        what,
        reason: error.to_string(),
    })
}
