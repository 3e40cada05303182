//! `frixel replay`: plays a simulated recording again, and compares it bit by bit.

use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::Args;
use frixel_lab::recording::Recording;
use frixel_play::TO_THE_END;

use crate::commands::error::{at, reading};
use crate::input;

use super::super::terminal::{note_interrupted, print_line};

#[derive(Debug, Args)]
pub(in crate::commands) struct ReplayArgs {
    /// A recording of a play on the simulator, by `frixel play --record` or Python's `Recording.to_parquet`.
    recording: PathBuf,
}

/// Plays a recording again, and fails if its bits differ.
pub(in crate::commands) fn run(args: &ReplayArgs) -> Result<()> {
    let path = &args.recording;
    let bytes = input::read(path, input::CSV_MAX_BYTES).map_err(reading(path))?;
    note_interrupted(path, &bytes);
    let recorded = Recording::read_parquet(bytes, TO_THE_END).map_err(at(path.display()))?;
    let played = recorded.replay(TO_THE_END);
    let played = played.map_err(at(format!("{} cannot be played again", path.display())))?;
    if let Some(difference) = recorded.first_difference(&played) {
        bail!(
            "{} does not play the same bits: {difference}; the file was changed, or this machine computes differently",
            path.display()
        );
    }
    let (rows, columns) = (recorded.rows(), recorded.columns.len());
    if recorded.is_cut_off {
        bail!(
            "{}: its first {rows} rows play the same bits, but the bytes after them are not rows: the file was \
             changed, or its last write was cut off",
            path.display()
        );
    }
    print_line(format_args!("{}: the same bits, {rows} rows of {columns} columns", path.display()))
}
