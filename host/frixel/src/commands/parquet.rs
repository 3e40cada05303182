//! What all commands that write a Parquet recording have in common.

use std::path::Path;

use frixel_lab::recording::{Field, Metadata, Recording};

use crate::output_file::OutputFile;

use super::error::CommandError;

/// Whether a file is to be Parquet, by its name.
pub(super) fn is_named_so(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("parquet"))
}

/// Rejects the code of a participant for an output that has no place for it.
pub(super) fn check_participant(output: &Path, participant: Option<&str>) -> Result<(), CommandError> {
    if participant.is_some() && !is_named_so(output) {
        return Err(CommandError::ParticipantInTable { path: output.to_owned() });
    }
    Ok(())
}

/// Writes the rows of a table in CSV as a recording with these columns.
pub(super) fn write(
    output: &OutputFile,
    csv: &[u8],
    fields: Vec<Field>,
    metadata: Metadata,
) -> Result<(), CommandError> {
    let failed = CommandError::recording;
    let recording = Recording::of_csv(metadata, csv, fields).map_err(failed(output.path()))?;
    let mut bytes = Vec::new();
    recording.write_parquet(&mut bytes).map_err(failed(output.path()))?;
    Ok(output.write(&bytes)?)
}
