//! Recordings of people, which take a person's time and cannot be computed again.

use std::collections::BTreeSet;
use std::io::{self, Read, Seek, SeekFrom};

use super::claims::FOOTER_MAX_BYTES;
use super::parquet_reader::{MAGIC, is_footer_of_person};

/// Number of bytes at the beginning of a file that identify it.
const HEAD: u64 = 4096;
/// The columns of a recorded stroke, the one that a person's play adds to it, and those of a recording of friction.
const STROKE_COLUMNS: [&str; 3] = ["t_s", "x_mm", "y_mm"];
const PARTICIPANT: &str = "participant";
const FRICTION_COLUMNS: [&str; 3] = ["voltage_v_rms", "normal_force_n", "friction_n"];
/// The line of a profile that rests on what a person felt, and a part of the summary of a person's play.
const PERCEPTUAL: &str = "origin = \"perceptual\"";
const OF_A_PERSON: &str = "\"simulated\":false";

/// Whether a file is a recording of a person, by its content: a stroke of `frixel board record`, friction as `frixel
/// finger fit` reads it, a profile that rests on what a person felt, or `felt.csv`, `summary.json` or the Parquet file
/// of a play.
pub fn is_of_person(mut file: impl Read + Seek) -> io::Result<bool> {
    let mut head = Vec::new();
    file.by_ref().take(HEAD).read_to_end(&mut head)?;
    if head.starts_with(MAGIC) {
        return Ok(is_footer_of_person(&footer(&mut file)?));
    }
    let text = String::from_utf8_lossy(&head);
    // Spreadsheets begin a file with a byte order mark.
    let text = text.trim_start_matches('\u{feff}');
    let columns: BTreeSet<&str> =
        text.lines().next().unwrap_or_default().split([',', ';']).map(|cell| cell.trim_matches(['"', ' '])).collect();
    let has = |names: [&str; 3]| names.iter().all(|name| columns.contains(name));
    let is_stroke = || columns.iter().all(|name| STROKE_COLUMNS.contains(name) || *name == "force_n");
    let is_stroke_of_person = has(STROKE_COLUMNS) && (is_stroke() || columns.contains(PARTICIPANT));
    Ok(is_stroke_of_person
        || has(FRICTION_COLUMNS)
        || text.lines().any(|line| line.trim() == PERCEPTUAL)
        || (text.starts_with('{') && text.contains(OF_A_PERSON)))
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
