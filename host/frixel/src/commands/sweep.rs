//! `frixel sweep`: studies of many simulated fingers.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use anyhow::{Result, anyhow, bail};
use clap::{Args, Subcommand};
use frixel_lab::sweep::{CELLS, CellResult, Index, Plan, Study, Sweep, json};
use frixel_play::TO_THE_END;
use indicatif::ProgressBar;
use rayon::prelude::*;

use super::argument::shard;
use super::error::{at, reading, unreadable};
use super::jobs::JobsArgs;
use super::terminal::{note, print_line};
use crate::input;
use frixel_files::{Inputs, OutputFile, OutputFolder, commit_all, create_folder};

/// The file that names the cells of the plan that was played last, in the folder of a study.
const INDEX: &str = "cells/plan.json";
/// Extension of files of results, one on each line.
const LINES: &str = "jsonl";

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(super) struct SweepArgs {
    #[command(subcommand)]
    command: Option<SweepCommand>,
    /// The plan, a TOML file (docs/python/scale.md).
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

pub(super) fn run(args: &SweepArgs) -> Result<()> {
    match (&args.command, &args.plan, &args.out) {
        (Some(SweepCommand::Merge(MergeArgs { out })), ..) => merge(out, &Inputs::default()),
        // Clap requires both.
        (None, Some(plan), Some(out)) => play(args, plan, out),
        (None, ..) => Ok(()),
    }
}

fn play(args: &SweepArgs, plan_path: &Path, out: &Path) -> Result<()> {
    let text = input::read_toml(plan_path).map_err(reading(plan_path))?;
    let plan = Plan::parse(&text, &plan_path.display().to_string())?;
    let folder = plan_path.parent().unwrap_or(Path::new(""));
    let files = plan.scenes.iter().chain(&plan.screens).chain(&plan.touch).map(|name| folder.join(name));
    let inputs = Inputs::new(files.chain([plan_path.to_owned()]));
    let sweep = Sweep::in_folder(plan, folder, &BTreeMap::new())?;
    for number in sweep.samples() {
        let cell = sweep.cell(number)?;
        cell.check().map_err(|error| at(sweep.blame(&cell, &error))(error))?;
    }
    create_folder(&out.join(CELLS))?;
    OutputFile::new(&out.join(INDEX), "-o", &inputs)?.write_shared(json(sweep.index()).as_bytes())?;

    let (part, parts) = args.shard.unwrap_or((1, 1));
    let mut there = BTreeSet::new();
    for path in result_files(out)? {
        // On Windows, the file that another process appends to cannot be read. Its cells are played twice.
        let _ = read_results(&path, |result| _ = there.insert(result.cell));
    }
    let own = OutputFile::new(&out.join(format!("{CELLS}/{part}-of-{parts}.{LINES}")), "-o", &inputs)?;
    let path = own.path().display();
    let waits = || note(format_args!("frixel: another process is writing {path}: waiting until it ends"));
    let writer = own.append(|line| there.extend(result(line).map(|result| result.cell)), waits)?;
    let writer = Mutex::new(writer);
    let play = |number: usize| {
        let cell = sweep.cell(number)?;
        cell.play(TO_THE_END).map_err(|error| at(sweep.blame(&cell, &error))(error))
    };
    let numbers = part - 1..sweep.index().cells();
    let bar = ProgressBar::new(numbers.len().div_ceil(parts) as u64);
    // For each cell of this part, nothing if it was there, or whether it could be played.
    let outcomes: Vec<Option<Result<()>>> = args.jobs.run(|| {
        let outcome = |number| {
            let outcome = (!there.contains(&sweep.index().key(number))).then(|| play(number));
            if let Some(Ok(result)) = &outcome {
                let mut writer = writer.lock().unwrap_or_else(PoisonError::into_inner);
                writeln!(writer, "{}", result.to_json()).and_then(|()| writer.flush())?;
            }
            bar.inc(1);
            anyhow::Ok(outcome.map(|played| played.map(drop)))
        };
        numbers.into_par_iter().step_by(parts).map(outcome).collect::<Result<_>>()
    })??;
    writer.into_inner().unwrap_or_else(PoisonError::into_inner).commit()?;
    bar.finish_and_clear();
    let had = outcomes.iter().filter(|outcome| outcome.is_none()).count();
    let (played, refused): (Vec<_>, Vec<_>) = outcomes.into_iter().flatten().partition(Result::is_ok);
    let refusals = if refused.is_empty() { String::new() } else { format!("{} refused, ", refused.len()) };
    let (played, cells) = (played.len(), sweep.index().cells());
    print_line(format_args!("  {:<30} {played} played, {refusals}{had} already there, of {cells}", "cells"))?;
    refused.into_iter().collect::<Result<()>>()?;
    if parts == 1 { merge(out, &inputs) } else { Ok(()) }
}

/// The files of results in the folder of a study, one of each part.
fn result_files(out: &Path) -> Result<Vec<PathBuf>> {
    let folder = out.join(CELLS);
    let entries = fs::read_dir(&folder).and_then(Iterator::collect::<io::Result<Vec<_>>>).map_err(reading(&folder))?;
    let paths = entries.into_iter().map(|entry| entry.path());
    Ok(paths.filter(|path| path.extension().is_some_and(|end| end == LINES)).collect())
}

/// Reads the results in a file. A damaged line is skipped, so that its cell is played again.
fn read_results(path: &Path, mut each: impl FnMut(CellResult)) -> io::Result<()> {
    let lines = input::open(path, u64::MAX)?;
    input::whole_lines(lines, |line| result(line).into_iter().for_each(&mut each)).map(drop)
}

fn result(line: &[u8]) -> Option<CellResult> {
    CellResult::from_json(str::from_utf8(line).ok()?).ok()
}

/// Puts the results of all cells together.
fn merge(out: &Path, inputs: &Inputs) -> Result<()> {
    let path = out.join(INDEX);
    let advice = "give the folder of a sweep, which `frixel sweep PLAN.toml -o OUT` makes";
    let text = input::read(&path, input::CSV_MAX_BYTES).map_err(unreadable(&path, advice))?;
    let index: Index = serde_json::from_slice(&text).map_err(|error| {
        anyhow!("{} is not a list of the cells of a sweep ({error}): play the sweep again", path.display())
    })?;
    let mut there = BTreeMap::new();
    for path in result_files(out)? {
        let read = read_results(&path, |result| _ = there.insert(result.cell.clone(), result));
        read.map_err(reading(&path))?;
    }
    let results: Vec<CellResult> = (0..index.cells()).filter_map(|number| there.remove(&index.key(number))).collect();
    if results.len() < index.cells() {
        let (folder, found, of) = (out.display(), results.len(), index.cells());
        bail!("{folder}: {found} of {of} cells are there: play the others with `frixel sweep PLAN.toml -o {folder}`");
    }
    let study = Study::new(results);
    let _folder = OutputFolder::open(out)?;
    let files = study.files()?;
    let file = |(name, _): &(&str, Vec<u8>)| OutputFile::new(&out.join(name), "-o", inputs);
    let written: Vec<OutputFile> = files.iter().map(file).collect::<Result<_, _>>()?;
    let filled = written.iter().zip(&files).map(|(file, (_, bytes))| file.filled(bytes));
    commit_all(filled.collect::<Result<_, _>>()?, &[])?;
    for line in study.summary() {
        print_line(format_args!("{line}"))?;
    }
    for file in &written {
        print_line(format_args!("  {:<30} {}", "wrote", file.path().display()))?;
    }
    Ok(())
}
