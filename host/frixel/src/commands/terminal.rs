//! Text for people, on standard output and standard error. A reader that has closed its end is not an error.
//!
//! Everything that a command prints goes through this module, which escapes the terminal's control characters.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write, stderr, stdout};
use std::path::Path;

use super::error::writing;
use crate::output::is_of_interrupted_play;
use anyhow::Result;
use frixel_files::OutputFile;
use frixel_scene::{Program, printable_lines};

/// Writes text to standard output. Does nothing once its reader has gone, for example `head` at its last line.
pub(super) fn print(text: impl Display) -> Result<()> {
    let mut output = stdout().lock();
    write!(output, "{}", printable_lines(&text.to_string())).and_then(|()| output.flush()).or_else(unless_closed)
}

/// Like [`print`], with a line feed at the end.
pub(super) fn print_line(text: impl Display) -> Result<()> {
    print(format_args!("{text}\n"))
}

/// Writes a line to standard output, or to standard error if `output` is standard output.
pub(super) fn say(output: &OutputFile, text: impl Display) -> Result<()> {
    if output.is_standard_output() {
        note(text);
        return Ok(());
    }
    print_line(text)
}

/// Writes a line to standard error. Ignores a failure, which could not be reported.
pub(super) fn note(text: impl Display) {
    let _ = writeln!(stderr().lock(), "{}", printable_lines(&text.to_string()));
}

/// Prints on standard error how a table was interpreted, if that needs a note.
pub(super) fn note_understood(table: &Path, understood: Option<&str>) {
    if let Some(understood) = understood {
        let name = if table == Path::new("-") { "standard input".into() } else { table.display().to_string() };
        note(format_args!("{name}: {understood}"));
    }
}

/// Prints a note on standard error if a file of a play does not belong to the play's summary.
pub(super) fn note_interrupted(file: &Path, bytes: &[u8]) {
    if is_of_interrupted_play(file, bytes) {
        let file = file.display();
        note(format_args!(
            "{file}: from an interrupted play, or changed since: it does not belong to the summary.json beside it"
        ));
    }
}

/// Prints on standard error why a board refuses a draft; nothing for other programs.
pub(super) fn note_refusals(scene: &Path, program: &Program) {
    if program.is_draft() {
        note(format_args!("draft: a board refuses {}:", scene.display()));
    }
    for refusal in program.refusals() {
        note(refusal);
    }
}

fn unless_closed(error: io::Error) -> Result<()> {
    match error.kind() {
        ErrorKind::BrokenPipe => Ok(()),
        _ => Err(writing(Path::new("standard output"))(error).into()),
    }
}
