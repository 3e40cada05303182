//! The answers of a session, which are kept while it lasts.

use std::io::Write;
use std::path::PathBuf;

use crate::output_file::{FileWriter, Recording};
use anyhow::Result;
use frixel_lab::table::{Column, Table, TableError};
use frixel_lab::threshold::Staircase;

use super::OtherSession;

/// The answer in a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Answer {
    /// Number of the trial, from one.
    pub(super) trial: usize,
    /// Highest voltage of the session, to which levels refer.
    pub(super) highest_v_rms: f64,
    pub(super) level_db: f64,
    pub(super) is_right: bool,
    /// Seed of the simulated observer who answers; `None` for a person.
    pub(super) observer: Option<u64>,
}

const HEADER: &str = "trial,highest_v_rms,level_db,is_right,observer\n";
/// The observer of a session with a person.
const PERSON: &str = "person";

/// Who answers, as a file and a message name it.
fn who(observer: Option<u64>) -> String {
    observer.map_or_else(|| PERSON.to_owned(), |seed| seed.to_string())
}

/// The answers so far, and the file that keeps them if there is one.
pub(super) struct Answers {
    partial: PathBuf,
    writer: Option<FileWriter>,
    earlier: Vec<Answer>,
}

impl Answers {
    /// Begins a session, or goes on with one that was cut off if it `resumes`.
    pub(super) fn open(recording: Option<&Recording>, resumes: bool) -> Result<Self> {
        // A stream has no other file for what is not whole yet.
        let Some(recording) = recording.filter(|recording| recording.output().is_file()) else {
            return Ok(Self { partial: PathBuf::new(), writer: None, earlier: Vec::new() });
        };
        let partial = recording.partial();
        if !resumes {
            return Ok(Self { partial, writer: Some(recording.start()?), earlier: Vec::new() });
        }
        let (writer, text) = recording.resume()?;
        let earlier = read(&text).map_err(|reason| OtherSession { partial: partial.clone(), reason })?;
        Ok(Self { partial, writer: Some(writer), earlier })
    }

    /// Gives the staircase the answers of the session that was cut off. Returns their levels, in decibels.
    /// Fails if they are those of another session, or of somebody else than `observer`.
    pub(super) fn repeat(
        &self,
        highest_v_rms: f64,
        observer: Option<u64>,
        staircase: &mut Staircase,
    ) -> Result<Vec<f64>> {
        let other = |reason| anyhow::Error::from(OtherSession { partial: self.partial.clone(), reason });
        for (answer, row) in self.earlier.iter().zip(2..) {
            let Answer { trial, highest_v_rms: found, level_db, is_right, observer: answered } = answer;
            if *answered != observer {
                let (found, expected) = (who(*answered), who(observer));
                return Err(other(format!("row {row}, column observer: expected {expected}, found {found}")));
            }
            let expected = (staircase.progress().0, highest_v_rms, staircase.next_level_db());
            if (*trial, *found, Some(*level_db)) != expected {
                let reason = format!(
                    "row {row} is trial {trial} at {level_db:.2} dB below {found} V rms, which this one would not ask"
                );
                return Err(other(reason));
            }
            staircase.answer(*level_db, *is_right);
        }
        Ok(self.earlier.iter().map(|answer| answer.level_db).collect())
    }

    /// Keeps an answer.
    pub(super) fn add(&mut self, answer: Answer) -> Result<()> {
        let Answer { trial, highest_v_rms, level_db, is_right, observer } = answer;
        let header = if trial == 1 { HEADER } else { "" };
        self.write(&format!("{header}{trial},{highest_v_rms},{level_db},{is_right},{}\n", who(observer)))
    }

    fn write(&mut self, line: &str) -> Result<()> {
        let Some(writer) = &mut self.writer else { return Ok(()) };
        let written = writer.write_all(line.as_bytes()).and_then(|()| writer.flush());
        written.map_err(|source| writer.error(source))
    }
}

/// Reads the answers of a session; the error says where it is none.
fn read(text: &str) -> Result<Vec<Answer>, String> {
    let found = |error: TableError| error.found();
    let mut table = Table::new(text.as_bytes()).map_err(found)?;
    let mut need = |name, unit| table.need(Column::new(name, unit)).map_err(found);
    let (trial, highest) = (need("trial", "")?, need("highest_v_rms", "volts rms")?);
    let (level, right) = (need("level_db", "decibels")?, need("is_right", "")?);
    let observer = need("observer", "")?;
    let mut answers = Vec::new();
    while let Some(row) = table.next_row().map_err(found)? {
        row.check_length().map_err(found)?;
        let is_right = row.text(right).parse().map_err(|_| {
            format!("row {}, column is_right: expected true or false, found {:?}", row.number(), row.quoted(right))
        })?;
        let observer = match row.text(observer) {
            person if person == PERSON => None,
            seed => Some(seed.parse().map_err(|_| {
                format!(
                    "row {}, column observer: expected {PERSON} or a seed, found {:?}",
                    row.number(),
                    row.quoted(observer)
                )
            })?),
        };
        answers.push(Answer {
            trial: row.real(trial).map_err(found)? as usize,
            highest_v_rms: row.real(highest).map_err(found)?,
            level_db: row.real(level).map_err(found)?,
            is_right,
            observer,
        });
    }
    Ok(answers)
}
