//! Joins the log of a virtual board to the rows of its client.

use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::output::FeltLog;
use frixel_felt::recorder::FeltRow;

use super::CommandError;

/// How long to wait for the virtual board to write its last rows; it writes ten times a second.
const PATIENCE: Duration = Duration::from_secs(2);
const RETRY_AFTER: Duration = Duration::from_millis(50);

/// Reads the log when it has the time of the last row, and joins it to the rows. `start_s` is the time from the
/// power-on of the board to the client's time zero.
pub(super) fn joined(path: &Path, rows: &[FeltRow], start_s: f64) -> Result<Vec<FeltRow>, CommandError> {
    let end_s = start_s + rows.last().map_or(0.0, |row| row.t_s);
    let started = Instant::now();
    let log = loop {
        let log = FeltLog::read(path)?;
        if log.end_s() >= end_s {
            break log;
        }
        if started.elapsed() > PATIENCE {
            return Err(CommandError::LogTooShort { path: path.to_owned(), behind_s: end_s - log.end_s() });
        }
        sleep(RETRY_AFTER);
    };
    Ok(rows.iter().map(|row| log.join(row, start_s)).collect())
}
