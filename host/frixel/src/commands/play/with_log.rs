//! Joins the log of a virtual board to the rows of its client while both grow.

use std::collections::VecDeque;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::output::{FeltLog, TracedLayer};
use anyhow::{Result, anyhow};
use frixel_felt::recorder::FeltRow;

/// Longest wait at the end for the virtual board to write its last rows; it writes ten times a second.
const END_WAIT_MAX: Duration = Duration::from_secs(2);
const RETRY_AFTER: Duration = Duration::from_millis(50);
/// Length of the rows that wait before the log is read again, s.
const READ_AFTER_S: f64 = 0.1;
/// Longest time that the log may be behind, s. It bounds the rows that wait.
const BEHIND_MAX_S: f64 = 10.0;

/// A row, with the layer under the finger.
pub(super) type LayeredRow = (FeltRow, Option<TracedLayer>);

/// Rows that wait for the log to reach their time. After a failure they are passed on unjoined.
pub(super) struct LogJoin {
    log: FeltLog,
    /// Time from the power-on of the board to the client's time zero.
    start_s: f64,
    waiting: VecDeque<LayeredRow>,
    failure: Option<anyhow::Error>,
}

impl LogJoin {
    pub(super) fn new(path: &Path) -> Self {
        Self { log: FeltLog::new(path), start_s: 0.0, waiting: VecDeque::new(), failure: None }
    }

    /// Adds rows. Returns the rows that the log has reached, joined.
    pub(super) fn add(&mut self, rows: Vec<LayeredRow>, start_s: f64) -> Vec<LayeredRow> {
        self.start_s = start_s;
        self.waiting.extend(rows);
        if self.failure.is_none() && self.waits_s() < READ_AFTER_S {
            return Vec::new();
        }
        let joined = self.join();
        if self.waits_s() > BEHIND_MAX_S {
            self.failure = Some(self.too_short());
        }
        joined
    }

    /// Waits for the log to reach the last row. Returns the remaining rows, and an error if some are not joined.
    pub(super) fn finish(mut self) -> (Vec<LayeredRow>, Result<()>) {
        let started = Instant::now();
        let mut joined = self.join();
        while !self.waiting.is_empty() {
            if started.elapsed() > END_WAIT_MAX {
                self.failure = Some(self.too_short());
            } else {
                sleep(RETRY_AFTER);
            }
            joined.extend(self.join());
        }
        (joined, self.failure.map_or(Ok(()), Err))
    }

    /// Removes and returns the rows that the log has reached, joined; after a failure all of them, unjoined.
    fn join(&mut self) -> Vec<LayeredRow> {
        let Some((first, _)) = self.waiting.front() else { return Vec::new() };
        if self.failure.is_none() {
            self.failure = self.log.read_on(self.start_s + first.t_s).err().map(anyhow::Error::from);
        }
        if self.failure.is_some() {
            return self.waiting.drain(..).collect();
        }
        let (log, start_s) = (&self.log, self.start_s);
        let reached = self.waiting.partition_point(|(row, _)| start_s + row.t_s <= log.end_s());
        self.waiting.drain(..reached).map(|(row, layer)| (log.join(&row, start_s), layer)).collect()
    }

    /// Length of the rows that wait, s.
    fn waits_s(&self) -> f64 {
        let ends = self.waiting.back().zip(self.waiting.front());
        ends.map_or(0.0, |((last, _), (first, _))| last.t_s - first.t_s)
    }

    fn too_short(&self) -> anyhow::Error {
        let end_s = self.start_s + self.waiting.back().map_or(0.0, |(last, _)| last.t_s);
        anyhow!(
            "{} ends {:.1} s before the play did: give the felt.csv of the `frixel sim` that has this port",
            self.log.path().display(),
            end_s - self.log.end_s()
        )
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;
    use std::fs;

    use super::*;

    const ROWS_PER_S: u32 = 1_000;

    /// Rows from one time to another.
    fn rows(from_s: u32, to_s: u32) -> Vec<LayeredRow> {
        let row = |number: u32| FeltRow { t_s: f64::from(number) / f64::from(ROWS_PER_S), ..FeltRow::default() };
        (from_s * ROWS_PER_S..to_s * ROWS_PER_S).map(|number| (row(number), None)).collect()
    }

    /// A log that ends before the play: memory stays bounded, and the rows without a log are passed on.
    #[test]
    fn rows_wait_for_the_log_for_ten_seconds_at_most() {
        const LOGGED_S: u32 = 60;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let mut text = String::from("t_s,x_mm,y_mm,speed_mm_s,felt_n\n");
        for (row, _) in rows(0, LOGGED_S) {
            writeln!(text, "{:.3},60,40,50,0.25", 5.0 + row.t_s).unwrap();
        }
        fs::write(&path, text).unwrap();
        let mut join = LogJoin::new(&path);
        let mut joined = Vec::new();
        for second in 0..LOGGED_S {
            joined.extend(join.add(rows(second, second + 1), 5.0));
            assert!(join.waiting.len() <= 1, "{}", join.waiting.len());
        }
        assert!(joined.iter().all(|(row, _)| row.felt_n == Some(0.25)));
        for second in LOGGED_S..2 * LOGGED_S {
            joined.extend(join.add(rows(second, second + 1), 5.0));
            assert!(join.waiting.len() <= 11 * ROWS_PER_S as usize, "{}", join.waiting.len());
        }
        let (rest, outcome) = join.finish();
        joined.extend(rest);
        let times: Vec<f64> = joined.iter().map(|(row, _)| row.t_s).collect();
        assert_eq!(times, rows(0, 2 * LOGGED_S).iter().map(|(row, _)| row.t_s).collect::<Vec<_>>());
        assert!(joined[LOGGED_S as usize * ROWS_PER_S as usize..].iter().all(|(row, _)| row.felt_n.is_none()));
        assert!(outcome.unwrap_err().to_string().contains("s before the play did"));
    }
}
