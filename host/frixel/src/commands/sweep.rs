//! `frixel sweep`: studies of many simulated fingers.

use std::fmt::Display;
use std::io::{self, IsTerminal, stderr};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Result, anyhow, bail};
use clap::{Args, Subcommand};
use frixel_lab::sweep::{Cell, CellResult, KEYS_FILE, Keys, Plan, Study, json, result_file};
use frixel_play::TO_THE_END;
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde::Deserialize;

use super::argument::shard;
use super::error::at;
use super::jobs::JobsArgs;
use super::terminal::print_line;
use crate::input;
use crate::scene_file::gathered;
use frixel_files::{Error, Inputs, OutputFile, OutputFolder, commit_all, create_folder};

/// Time between tries to write a file that another process is writing.
const WAIT: Duration = Duration::from_millis(10);
/// Longest time for all tries.
const WAIT_MAX: Duration = Duration::from_secs(10);

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
    let text = input::read_text(plan_path, input::TOML_MAX_BYTES);
    let text = text.map_err(|error| unreadable(plan_path, "plan", &error, "check the path"))?;
    let plan = Plan::parse(&text, &plan_path.display().to_string())?;
    let folder = plan_path.parent().unwrap_or(Path::new(""));
    let cells = cells(&plan, folder)?;
    for cell in cells.iter().filter(|cell| cell.person == 1) {
        cell.check().map_err(at(cell.title()))?;
    }
    let files = plan.scenes.iter().chain(&plan.screens).chain(&plan.touch).map(|name| folder.join(name));
    let inputs = Inputs::new(files.chain([plan_path.to_owned()]));
    let keys = Keys { cells: cells.iter().map(Cell::key).collect() };
    let keys_file = out.join(KEYS_FILE);
    let folder = keys_file.parent().unwrap_or(out);
    create_folder(folder)?;
    write_shared(&OutputFile::new(&keys_file, "-o", &inputs)?, &json(&keys))?;

    let (part, parts) = args.shard.unwrap_or((1, 1));
    let own: Vec<(usize, &Cell)> = cells.iter().enumerate().filter(|(number, _)| number % parts == part - 1).collect();
    let path = |number: usize| out.join(result_file(keys.cells.get(number).map_or("", String::as_str)));
    let left: Vec<(usize, &Cell)> = own.iter().copied().filter(|(number, _)| !path(*number).exists()).collect();
    let bar = stderr().is_terminal().then(|| ProgressBar::new(left.len() as u64));
    args.jobs.run(|| {
        left.par_iter().try_for_each(|(number, cell)| {
            let result = cell.play(TO_THE_END).map_err(at(cell.title()))?;
            write_shared(&OutputFile::new(&path(*number), "-o", &inputs)?, &result.to_json())?;
            if let Some(bar) = &bar {
                bar.inc(1);
            }
            anyhow::Ok(())
        })
    })??;
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
    let had = own.len() - left.len();
    print_line(format_args!("  {:<30} {} played, {had} already there, of {}", "cells", left.len(), cells.len()))?;
    if parts == 1 { merge(out, &inputs) } else { Ok(()) }
}

/// Writes a file that other processes of the same sweep may write at the same moment, with the same content.
fn write_shared(file: &OutputFile, text: &str) -> Result<()> {
    let begin = Instant::now();
    loop {
        if input::read(file.path(), text.len() as u64).is_ok_and(|there| there == text.as_bytes()) {
            return Ok(());
        }
        match file.write(text.as_bytes()) {
            Err(Error::Busy(_)) if begin.elapsed() < WAIT_MAX => thread::sleep(WAIT),
            written => return Ok(written?),
        }
    }
}

/// The cells of a plan, whose files are named relative to its folder.
fn cells(plan: &Plan, folder: &Path) -> Result<Vec<Cell>> {
    let text = |what, name: &str| {
        let path = folder.join(name);
        let advice = "give its file, from the plan's folder, or a bundled one";
        let read = input::read_text(&path, input::TOML_MAX_BYTES);
        read.map_err(|error| unreadable(&path, what, &error, advice))
    };
    plan.cells(|name| Ok(gathered(&folder.join(name), name)?), text)
}

/// Puts the results of all cells together.
fn merge(out: &Path, inputs: &Inputs) -> Result<()> {
    let keys: Keys = read(&out.join(KEYS_FILE), "list of the cells of a sweep")?;
    let there: Vec<PathBuf> =
        keys.cells.iter().map(|key| out.join(result_file(key))).filter(|path| path.exists()).collect();
    if there.len() < keys.cells.len() {
        let (folder, found, of) = (out.display(), there.len(), keys.cells.len());
        bail!("{folder}: {found} of {of} cells are there: play the others with `frixel sweep PLAN.toml -o {folder}`");
    }
    let result = |(key, path): (&String, &PathBuf)| {
        let what = "result of a cell";
        let text = String::from_utf8_lossy(&read_bytes(path, what)?).into_owned();
        CellResult::from_json(&text, Some(key)).map_err(|error| no_sweep_file(path, what, &error))
    };
    let results: Vec<CellResult> = keys.cells.iter().zip(&there).map(result).collect::<Result<_, _>>()?;
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

fn read<T: for<'de> Deserialize<'de>>(path: &Path, what: &'static str) -> Result<T> {
    serde_json::from_slice(&read_bytes(path, what)?).map_err(|error| no_sweep_file(path, what, &error))
}

fn read_bytes(path: &Path, what: &'static str) -> Result<Vec<u8>> {
    let advice = "give the folder of a sweep, which `frixel sweep PLAN.toml -o OUT` makes";
    input::read(path, input::CSV_MAX_BYTES).map_err(|error| unreadable(path, what, &error, advice))
}

fn no_sweep_file(path: &Path, what: &'static str, error: &dyn Display) -> anyhow::Error {
    anyhow!("{} is not a {what} ({error}): delete it, and play the sweep again", path.display())
}

fn unreadable(path: &Path, what: &str, error: &io::Error, advice: &str) -> anyhow::Error {
    anyhow!("{}: this {what} cannot be read ({error}): {advice}", path.display())
}
