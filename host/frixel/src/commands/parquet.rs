//! Shared by all commands that write a Parquet recording.

use std::path::Path;

use anyhow::{Result, bail};
use frixel_lab::recording::{Field, Metadata, Recording};

use super::error::at;
use frixel_files::OutputFile;

/// Whether a file's name ends in `.parquet`.
pub(super) fn is_parquet(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("parquet"))
}

/// Rejects a recording whose name is neither of a CSV nor of a Parquet file, and a participant's code for CSV, which
/// has no place for it.
pub(super) fn check_output(output: &Path, participant: Option<&str>) -> Result<()> {
    let is_another = output.extension().is_some_and(|extension| !extension.eq_ignore_ascii_case("csv"));
    if is_another && !is_parquet(output) {
        bail!("{} is not the name of a CSV or Parquet file: end it in .csv or .parquet", output.display());
    }
    if participant.is_some() && !is_parquet(output) {
        bail!(
            "--participant goes into a Parquet file, and {} is not the name of one: give one that ends in .parquet",
            output.display()
        );
    }
    Ok(())
}

/// Writes the rows of a table in CSV as a recording with these columns.
pub(super) fn write(output: &OutputFile, csv: &[u8], fields: Vec<Field>, metadata: Metadata) -> Result<()> {
    let path = output.path().display();
    let recording = Recording::of_csv(metadata, csv, fields).map_err(at(&path))?;
    let mut bytes = Vec::new();
    recording.write_parquet(&mut bytes).map_err(at(&path))?;
    Ok(output.write(&bytes)?)
}
