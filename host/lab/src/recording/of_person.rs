//! Recordings of people, which take a person's time and cannot be computed again.

use std::io::{self, Read, Seek, SeekFrom};

use super::claims::FOOTER_MAX_BYTES;
use super::fields::PARTICIPANT;
use super::parquet_reader::{MAGIC, is_footer_of_person};
use crate::table::{Column, HEAD_BYTES, Table, TableError};
use crate::{fit, stroke_file};

/// A line, without blanks, of a profile based on a person's perception.
const PERCEPTUAL: &str = "origin=\"perceptual\"";
/// A part of the summary of a person's play.
const OF_A_PERSON: &str = "\"simulated\":false";

/// Whether a file is a recording of a person. The content decides:
///
/// - a stroke, as `--stroke` reads it,
/// - friction, as `frixel finger fit` reads it,
/// - a profile based on a person's perception,
/// - `felt.csv`, `summary.json` or the Parquet file of a person's play.
pub fn is_of_person(mut file: impl Read + Seek) -> io::Result<bool> {
    let mut head = Vec::new();
    file.by_ref().take(HEAD_BYTES).read_to_end(&mut head)?;
    if head.starts_with(MAGIC) {
        return Ok(is_footer_of_person(&footer(&mut file)?));
    }
    // A file that cannot be read as a table has no such columns.
    if is_table_of_person(&head).unwrap_or(false) {
        return Ok(true);
    }
    let text = String::from_utf8_lossy(&head);
    let is_perceptual = |line: &str| line.split_whitespace().collect::<String>() == PERCEPTUAL;
    Ok(text.lines().any(is_perceptual) || (text.starts_with('{') && text.contains(OF_A_PERSON)))
}

/// Whether the table has the columns of friction, unless its first row says that the finger is simulated, or those of a
/// stroke and at most the column of a person's play.
fn is_table_of_person(head: &[u8]) -> Result<bool, TableError> {
    let mut table = Table::new(head)?;
    if has_all(&mut table, fit::COLUMNS)? {
        let origin = table.find(fit::ORIGIN)?;
        let first = table.next_row().ok().flatten();
        return Ok(!first.is_some_and(|row| fit::is_simulated(&row, origin)));
    }
    let is_of_play = table.names().iter().any(|name| name == PARTICIPANT);
    let is_stroke = has_all(&mut table, stroke_file::COLUMNS)?;
    table.find(stroke_file::LOAD)?;
    Ok(is_stroke && (is_of_play || table.ignored().is_empty()))
}

fn has_all(table: &mut Table<&[u8]>, columns: [Column; 3]) -> Result<bool, TableError> {
    columns.into_iter().try_fold(true, |has, column| Ok(table.find(column)?.is_some() && has))
}

/// The footer of a Parquet file, its length and last bytes included.
fn footer(file: &mut (impl Read + Seek)) -> io::Result<Vec<u8>> {
    let end = tail(file, 8)?;
    let [a, b, c, d, ..] = end[..] else { return Ok(end) };
    tail(file, (u64::from(u32::from_le_bytes([a, b, c, d])) + 8).min(FOOTER_MAX_BYTES))
}

/// The last bytes of a file.
fn tail(file: &mut (impl Read + Seek), len: u64) -> io::Result<Vec<u8>> {
    let mut tail = Vec::new();
    file.seek(SeekFrom::End(-(len as i64)))?;
    file.read_to_end(&mut tail)?;
    Ok(tail)
}
