//! The report of a board's self-test, as JSON.

use std::collections::BTreeMap;

use chrono::Utc;
use frixel_board::self_test::{LineTest, Measurement, ScriptLine};
use serde::Serialize;

/// Name of the file's format, and its version.
const FORMAT: &str = "frixel self-test";
const VERSION: u32 = 1;

/// The report. Fields are only added; changing the meaning of a field changes the version.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    format: &'static str,
    version: u32,
    /// Version of the command.
    frixel: &'static str,
    /// Seconds since 1970, when the report was begun.
    begun_unix_s: i64,
    /// Kind of board, and version of its script.
    board: String,
    script_version: u32,
    /// Whether the script ran to its end with every measurement in its range.
    passed: bool,
    /// Why the script ended early.
    stopped: Option<String>,
    measurements: Vec<Found>,
    /// Ticks by eighths of their deadline, those beyond it last.
    ticks: BTreeMap<String, Vec<u32>>,
    /// Every line that the board sent.
    said: Vec<String>,
    #[serde(skip)]
    of_line: Vec<String>,
    #[serde(skip)]
    has_ended: bool,
}

/// A measurement, whose name ends in its unit.
#[derive(Debug, Serialize)]
struct Found {
    name: String,
    found: u32,
    least: Option<u32>,
    most: Option<u32>,
    passed: bool,
}

impl Report {
    /// An empty report.
    pub(super) fn new() -> Self {
        Self {
            format: FORMAT,
            version: VERSION,
            frixel: env!("CARGO_PKG_VERSION"),
            begun_unix_s: Utc::now().timestamp(),
            board: String::new(),
            script_version: 0,
            passed: false,
            stopped: None,
            measurements: Vec::new(),
            ticks: BTreeMap::new(),
            said: Vec::new(),
            of_line: Vec::new(),
            has_ended: false,
        }
    }

    /// Adds a line that the board sent.
    pub(super) fn take(&mut self, line: &str) {
        self.said.push(line.to_owned());
        match ScriptLine::parse(line) {
            None => {}
            Some(ScriptLine::Begin(version, board)) => {
                self.script_version = version;
                board.clone_into(&mut self.board);
            }
            Some(ScriptLine::Measured(measurement)) => self.measure(&measurement),
            Some(ScriptLine::Histogram(name, counts)) => _ = self.ticks.insert(name.to_owned(), counts.to_vec()),
            Some(ScriptLine::Stopped(reason)) => {
                self.stopped = Some(reason.to_owned());
                self.has_ended = true;
            }
            Some(ScriptLine::End { .. }) => {
                self.has_ended = true;
                self.passed = self.failed() == 0;
            }
        }
    }

    /// Adds the measurements of the line test on this side.
    pub(super) fn take_line(&mut self, line: &LineTest) {
        for measurement in [
            Measurement { name: "host_blocks_received", found: line.received(), range: Some((1, u32::MAX)) },
            Measurement { name: "host_blocks_missing", found: line.missing(), range: Some((0, 0)) },
            Measurement { name: "host_pieces_damaged", found: line.damaged(), range: Some((0, 0)) },
        ] {
            self.of_line.push(ScriptLine::Measured(measurement).to_string());
            self.measure(&measurement);
        }
    }

    /// Measurements of [`Self::take_line`], in the form of the board's own.
    pub(super) fn of_line(&self) -> &[String] {
        &self.of_line
    }

    fn measure(&mut self, measurement: &Measurement<'_>) {
        self.measurements.push(Found {
            name: measurement.name.to_owned(),
            found: measurement.found,
            least: measurement.range.map(|(least, _)| least),
            most: measurement.range.map(|(_, most)| most),
            passed: measurement.passes(),
        });
    }

    /// Measurements out of their range.
    pub(super) fn failed(&self) -> usize {
        self.measurements.iter().filter(|found| !found.passed).count()
    }

    /// Why the script ended early.
    pub(super) fn stopped(&self) -> Option<&str> {
        self.stopped.as_deref()
    }

    /// Whether the board has sent its last line.
    pub(super) fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// The file's bytes.
    pub(super) fn to_json(&self) -> Result<Vec<u8>, serde_json::Error> {
        let mut bytes = serde_json::to_vec_pretty(self)?;
        bytes.push(b'\n');
        Ok(bytes)
    }
}
