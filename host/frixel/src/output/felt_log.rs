//! The log of a virtual board: what its finger felt, over the board's own time.

use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use frixel_felt::recorder::FeltRow;
use frixel_lab::table::{Column, Table, TableError, whole_rows};
use thiserror::Error;

use crate::input::{self, Bounded};

/// Why a log cannot be read.
#[derive(Debug, Error)]
#[error("{}: {reason}: give the felt.csv that `frixel sim` writes", path.display())]
pub(crate) struct FeltLogError {
    path: PathBuf,
    reason: String,
}

/// Bytes per read of a log.
const PIECE_LEN: usize = 1 << 20;

/// The latest rows of a `felt.csv` that grows, in order of time.
#[derive(Debug)]
pub(crate) struct FeltLog {
    path: PathBuf,
    /// The file, once opened.
    input: Option<Bounded<File>>,
    header: Vec<u8>,
    /// The last bytes read, which are not a whole row yet.
    rest: Vec<u8>,
    rows: VecDeque<LogRow>,
}

/// The columns that are joined.
#[derive(Clone, Copy, Debug)]
struct LogRow {
    t_s: f64,
    x_mm: Option<f64>,
    y_mm: Option<f64>,
    speed_mm_s: Option<f64>,
    felt_n: Option<f64>,
}

impl FeltLog {
    /// The file that `frixel sim` writes. Nothing is read yet.
    pub(crate) fn new(path: &Path) -> Self {
        let (header, rest, rows) = (Vec::new(), Vec::new(), VecDeque::new());
        Self { path: path.to_owned(), input: None, header, rest, rows }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Reads the rows written since the last call, and drops rows before `from_s`, in seconds since the power-on of the
    /// board. An incomplete last row waits for the next call.
    pub(crate) fn read_on(&mut self, from_s: f64) -> Result<(), FeltLogError> {
        let error = |reason: String| FeltLogError { path: self.path.clone(), reason };
        let read = |source: io::Error| error(source.to_string());
        let input = match &mut self.input {
            Some(input) => input,
            none => none.insert(input::open(&self.path, input::CSV_MAX_BYTES).map_err(read)?),
        };
        let mut piece = vec![0; PIECE_LEN];
        loop {
            let count = input.read(&mut piece).map_err(read)?;
            if count == 0 {
                return Ok(());
            }
            self.rest.extend(piece.iter().take(count));
            if self.header.is_empty()
                && let Some(end) = self.rest.iter().position(|byte| *byte == b'\n')
            {
                self.header = self.rest.drain(..=end).collect();
            }
            let mut table = self.header.clone();
            table.extend(self.rest.drain(..whole_rows(&self.rest).len()));
            self.rows.extend(rows(&table).map_err(|source| error(source.found().to_owned()))?);
            // The last row stays: it has the time of the end.
            let earlier = self.rows.partition_point(|row| row.t_s < from_s - APART_MAX_S);
            self.rows.drain(..earlier.min(self.rows.len().saturating_sub(1)));
        }
    }

    /// Time of the last row since the power-on of the board, s.
    pub(crate) fn end_s(&self) -> f64 {
        self.rows.back().map_or(0.0, |row| row.t_s)
    }

    /// Joins a client's row with the log's row at the same time: felt friction, and the true place and speed of the
    /// finger. `start_s` is the time from the power-on of the board to the client's time zero.
    pub(crate) fn join(&self, row: &FeltRow, start_s: f64) -> FeltRow {
        let t_s = start_s + row.t_s;
        let after = self.rows.partition_point(|logged| logged.t_s < t_s);
        let nearest =
            [after.checked_sub(1), Some(after)].into_iter().flatten().filter_map(|index| self.rows.get(index));
        let nearest = nearest.min_by(|one, other| (one.t_s - t_s).abs().total_cmp(&(other.t_s - t_s).abs()));
        match nearest.filter(|logged| (logged.t_s - t_s).abs() <= APART_MAX_S) {
            Some(logged) => FeltRow {
                x_mm: logged.x_mm,
                y_mm: logged.y_mm,
                speed_mm_s: logged.speed_mm_s,
                felt_n: logged.felt_n,
                ..*row
            },
            None => *row,
        }
    }
}

/// Longest time between a client's row and the log's row that belongs to it, s. The log has one row per millisecond.
const APART_MAX_S: f64 = 1e-3;

fn rows(bytes: &[u8]) -> Result<Vec<LogRow>, TableError> {
    let mut table = Table::new(bytes)?;
    let t = table.need(Column::new("t_s", "seconds"))?;
    let (x, y) = (table.need(Column::new("x_mm", "mm"))?, table.need(Column::new("y_mm", "mm"))?);
    let speed = table.need(Column::new("speed_mm_s", "mm/s"))?;
    let felt = table.need(Column::new("felt_n", "newtons"))?;
    let mut rows = Vec::new();
    while let Some(row) = table.next_row()? {
        row.check_length()?;
        rows.push(LogRow {
            t_s: row.real(t)?,
            x_mm: row.real_if_known(x)?,
            y_mm: row.real_if_known(y)?,
            speed_mm_s: row.real_if_known(speed)?,
            felt_n: row.real_if_known(felt)?,
        });
    }
    Ok(rows)
}
