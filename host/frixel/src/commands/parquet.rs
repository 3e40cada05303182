//! What all commands that write a Parquet recording have in common.

use std::path::Path;

use frixel_lab::recording::{Field, Metadata, Recording};
use frixel_wire::hello::{Hello, PROTOCOL_MAJOR, PROTOCOL_MINOR};

use crate::output_file::OutputFile;

use super::error::CommandError;

/// The version that makes the recording, and that plays it again.
pub(super) const VERSION: &str = env!("CARGO_PKG_VERSION");
/// The commit, if whoever builds says it.
const REVISION: Option<&str> = option_env!("FRIXEL_REVISION");

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

/// What every recording says of the program and of the board, as far as that is known.
pub(super) fn metadata(rig: &str, board: Option<&Hello>, is_simulated: bool, participant: Option<&str>) -> Metadata {
    Metadata {
        frixel: VERSION.to_owned(),
        git_revision: REVISION.map(str::to_owned),
        protocol: format!("{PROTOCOL_MAJOR}.{PROTOCOL_MINOR}"),
        rig: rig.to_owned(),
        is_simulated,
        board: board.map(Into::into).unwrap_or_default(),
        tick_hz: board.map_or(0, |hello| hello.tick_hz),
        participant: participant.map(str::to_owned),
        ..Metadata::default()
    }
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
