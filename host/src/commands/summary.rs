//! How a play went, for a person and for a program.

use std::fmt::Write;
use std::path::PathBuf;

use frixel::device::Counters;
use frixel::player::Simulated;
use frixel::scene::Program;
use serde::Serialize;

/// One play. Frictions are totals in newtons; what only a simulated finger knows is empty on a board.
#[derive(Debug, Serialize)]
pub(super) struct Summary {
    rig: &'static str,
    ticks: u64,
    friction_error_rms_n: Option<f64>,
    friction_error_max_n: Option<f64>,
    inversion_error_rms_n: Option<f64>,
    inversion_error_max_n: Option<f64>,
    carrier_ripple_rms_n: Option<f64>,
    reachable_min_n: f64,
    reachable_max_n: f64,
    wanted_min_n: Option<f64>,
    wanted_max_n: Option<f64>,
    saturated_ticks: u64,
    frames_sent: u64,
    frames_rejected: u64,
    payload_bytes: u64,
    wire_bytes: u64,
    realtime_factor: Option<f64>,
    files: Vec<PathBuf>,
}

impl Summary {
    pub(super) fn of_simulator(program: &Program, simulated: &Simulated, files: Vec<PathBuf>) -> Self {
        let errors = simulated.recorder.metrics().summary();
        Self {
            rig: "sim",
            ticks: errors.ticks,
            friction_error_rms_n: errors.friction_error.map(|error| error.rms_n),
            friction_error_max_n: errors.friction_error.map(|error| error.max_n),
            inversion_error_rms_n: errors.inversion_error.map(|error| error.rms_n),
            inversion_error_max_n: errors.inversion_error.map(|error| error.max_n),
            carrier_ripple_rms_n: errors.carrier_ripple_rms_n,
            wanted_min_n: errors.wanted_range_n.map(|(min_n, _)| min_n),
            wanted_max_n: errors.wanted_range_n.map(|(_, max_n)| max_n),
            saturated_ticks: errors.saturated_ticks,
            realtime_factor: Some(simulated.realtime_factor),
            ..Self::of_board(program, 0, 0, simulated.counters, files)
        }
    }

    pub(super) fn of_board(
        program: &Program,
        ticks: u64,
        saturated_ticks: u64,
        counters: Counters,
        files: Vec<PathBuf>,
    ) -> Self {
        Self {
            rig: "board",
            ticks,
            friction_error_rms_n: None,
            friction_error_max_n: None,
            inversion_error_rms_n: None,
            inversion_error_max_n: None,
            carrier_ripple_rms_n: None,
            reachable_min_n: program.reach.friction_min_n(),
            reachable_max_n: program.reach.friction_max_n(),
            wanted_min_n: None,
            wanted_max_n: None,
            saturated_ticks,
            frames_sent: counters.frames_sent,
            frames_rejected: counters.frames_rejected,
            payload_bytes: counters.payload_bytes,
            wire_bytes: counters.wire_bytes,
            realtime_factor: None,
            files,
        }
    }

    pub(super) fn to_json(&self) -> String {
        // Numbers, strings and paths of this process: there is nothing that JSON cannot say.
        serde_json::to_string(self).unwrap_or_default()
    }

    pub(super) fn to_text(&self) -> String {
        let mut text = String::new();
        let mut line = |name: &str, value: String| {
            let _ = writeln!(text, "{name:16} {value}");
        };
        let range_n = self.reachable_max_n - self.reachable_min_n;
        let error = |error_n: Option<f64>| {
            error_n.map(|n| format!("{:.3} mN, {:.2} % of the range", 1e3 * n, 100.0 * n / range_n))
        };
        line("played on", format!("{}, {} ticks", self.rig, self.ticks));
        line("reachable", format!("{:.1} to {:.1} mN", 1e3 * self.reachable_min_n, 1e3 * self.reachable_max_n));
        if let (Some(min_n), Some(max_n)) = (self.wanted_min_n, self.wanted_max_n) {
            line("wanted", format!("{:.1} to {:.1} mN", 1e3 * min_n, 1e3 * max_n));
        }
        for (name, value) in [
            ("friction error", error(self.friction_error_rms_n)),
            ("  at most", error(self.friction_error_max_n)),
            ("inversion error", error(self.inversion_error_rms_n)),
            ("  at most", error(self.inversion_error_max_n)),
            ("carrier ripple", error(self.carrier_ripple_rms_n)),
        ] {
            if let Some(value) = value {
                line(name, value);
            }
        }
        line("out of reach", format!("{} ticks", self.saturated_ticks));
        line(
            "line",
            format!(
                "{} frames, {} of {} bytes payload, {} frames rejected",
                self.frames_sent, self.payload_bytes, self.wire_bytes, self.frames_rejected
            ),
        );
        if let Some(factor) = self.realtime_factor {
            line("speed", format!("{factor:.0} times real time"));
        }
        for file in &self.files {
            line("wrote", file.display().to_string());
        }
        text
    }
}
