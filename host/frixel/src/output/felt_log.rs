//! The log of a virtual board: what its finger felt, by the board's own time.

use std::path::{Path, PathBuf};

use frixel_felt::recorder::FeltRow;
use frixel_lab::table::{Column, Table, TableError, whole_rows};
use thiserror::Error;

use crate::input;

/// Why a log cannot be read.
#[derive(Debug, Error)]
#[error("{}: {reason}: give the felt.csv that `frixel sim` writes", path.display())]
pub(crate) struct FeltLogError {
    path: PathBuf,
    reason: String,
}

/// The rows of a `felt.csv`, in order of time.
#[derive(Clone, Debug)]
pub(crate) struct FeltLog(Vec<LogRow>);

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
    /// Reads the file that `frixel sim` writes. A last row that is not complete is left out.
    pub(crate) fn read(path: &Path) -> Result<Self, FeltLogError> {
        let error = |reason: String| FeltLogError { path: path.to_owned(), reason };
        let bytes = input::read(path, input::CSV_MAX_BYTES).map_err(|source| error(source.to_string()))?;
        Ok(Self(rows(whole_rows(&bytes)).map_err(|source| error(source.found()))?))
    }

    /// Time of the last row since the power-on of the board, s.
    pub(crate) fn end_s(&self) -> f64 {
        self.0.last().map_or(0.0, |row| row.t_s)
    }

    /// Adds to a row of a client what the log has at the same time: the felt friction, and the true place and speed of
    /// the finger. `start_s` is the time between the power-on of the board and the client's time zero.
    pub(crate) fn join(&self, row: &FeltRow, start_s: f64) -> FeltRow {
        let t_s = start_s + row.t_s;
        let after = self.0.partition_point(|logged| logged.t_s < t_s);
        let nearest = [after.checked_sub(1), Some(after)].into_iter().flatten().filter_map(|index| self.0.get(index));
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

/// Longest time between a client's row and the row of the log that belongs to it, s. The log has a row a millisecond.
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
