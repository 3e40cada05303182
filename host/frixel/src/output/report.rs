//! The numbers of a run, for programs and for people.

use std::fmt::Write;

use serde::Serialize;

use frixel_driver::{Counters, StreamStatus};
use frixel_scene::Reach;
use frixel_scene::metrics::{ErrorSize, MetricsSummary};

/// The numbers of a run; its fields are the keys of `--json`. What is not known is `null` there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// What played: `sim`, `qemu` or `board`.
    pub rig: String,
    /// Ticks that were played.
    pub ticks: u64,
    /// Felt minus wanted, as means over a carrier period: root mean square, N.
    pub friction_error_rms_n: Option<f64>,
    /// The same, largest magnitude, N.
    pub friction_error_max_n: Option<f64>,
    /// What the model gives for the commanded voltage minus the command: root mean square, N.
    pub inversion_error_rms_n: Option<f64>,
    /// The same, largest magnitude, N.
    pub inversion_error_max_n: Option<f64>,
    /// Root mean square of felt minus its carrier-period mean, N.
    pub carrier_ripple_rms_n: Option<f64>,
    /// Friction at no voltage, in total, N.
    pub reachable_min_n: f64,
    /// Friction at the largest voltage, in total, N.
    pub reachable_max_n: f64,
    /// Least friction that was wanted, in total, N.
    pub wanted_min_n: Option<f64>,
    /// Largest friction that was wanted, in total, N.
    pub wanted_max_n: Option<f64>,
    /// Ticks in which the board clamped its command.
    pub saturated_ticks: Option<u64>,
    /// Frames that the host sent.
    pub frames_sent: u64,
    /// Frames that either side refused because their check failed.
    pub frames_rejected: u64,
    /// Bytes that were meant: payloads of frames.
    pub payload_bytes: u64,
    /// Bytes that went over the line.
    pub wire_bytes: u64,
    /// Seconds simulated in a second of wall time, file writing apart.
    pub realtime_factor: Option<f64>,
    /// Samples that were streamed; `null` without a stream, as the two below.
    pub stream_samples: Option<u64>,
    /// Times that the board ran out of samples.
    pub stream_underruns: Option<u32>,
    /// Runs of samples that the line lost.
    pub stream_gaps: Option<u32>,
}

impl Report {
    /// Puts together what was gathered.
    pub fn new(
        rig: &str,
        metrics: &MetricsSummary,
        reach: &Reach,
        link: &Counters,
        realtime_factor: Option<f64>,
    ) -> Self {
        Self {
            rig: rig.to_owned(),
            ticks: metrics.ticks,
            friction_error_rms_n: metrics.friction_error.map(|error| error.rms_n),
            friction_error_max_n: metrics.friction_error.map(|error| error.max_n),
            inversion_error_rms_n: metrics.inversion_error.map(|error| error.rms_n),
            inversion_error_max_n: metrics.inversion_error.map(|error| error.max_n),
            carrier_ripple_rms_n: metrics.carrier_ripple_rms_n,
            reachable_min_n: reach.friction_min_n(),
            reachable_max_n: reach.friction_max_n(),
            wanted_min_n: metrics.wanted_range_n.map(|(least_n, _)| least_n),
            wanted_max_n: metrics.wanted_range_n.map(|(_, largest_n)| largest_n),
            saturated_ticks: metrics.saturated_ticks,
            frames_sent: link.frames_sent,
            frames_rejected: link.frames_rejected,
            payload_bytes: link.payload_bytes,
            wire_bytes: link.wire_bytes,
            realtime_factor,
            stream_samples: None,
            stream_underruns: None,
            stream_gaps: None,
        }
    }

    /// Adds how the stream did, if there was one.
    #[must_use]
    pub fn with_stream(mut self, stream: Option<StreamStatus>) -> Self {
        self.stream_samples = stream.map(|stream| stream.sent);
        self.stream_underruns = stream.map(|stream| stream.underruns);
        self.stream_gaps = stream.map(|stream| stream.gaps);
        self
    }

    /// One JSON object on one line.
    pub fn to_json(&self) -> String {
        // Plain numbers and texts always have a JSON form; one that is not finite becomes `null`.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// A few lines for a person, each ending in a line feed. Errors stand beside the reachable electric range.
    pub fn summary(&self) -> String {
        let mut text = String::new();
        let mut line = |name: &str, value: String| {
            // Writing to a string does not fail.
            let _ = writeln!(text, "  {name:<16} {value}");
        };
        let range = |least: f64, most: f64| format!("{:.2} to {:.2} mN", 1e3 * least, 1e3 * most);
        line("reachable", range(self.reachable_min_n, self.reachable_max_n));
        if let Some((least, most)) = self.wanted_min_n.zip(self.wanted_max_n) {
            line("wanted", range(least, most));
        }
        let electric_n = self.reachable_max_n - self.reachable_min_n;
        for (name, error) in [
            ("friction error", size(self.friction_error_rms_n, self.friction_error_max_n)),
            ("inversion error", size(self.inversion_error_rms_n, self.inversion_error_max_n)),
        ] {
            if let Some(ErrorSize { rms_n, max_n }) = error {
                let part = |newtons: f64| 100.0 * newtons / electric_n;
                let in_mn = format!("{:.4} mN rms, {:.4} mN at most", 1e3 * rms_n, 1e3 * max_n);
                line(name, format!("{in_mn} ({:.3} % and {:.3} % of the range)", part(rms_n), part(max_n)));
            }
        }
        if let Some(ripple_n) = self.carrier_ripple_rms_n {
            line("carrier ripple", format!("{:.4} mN rms", 1e3 * ripple_n));
        }
        let saturated = self.saturated_ticks.map(|ticks| format!(", of which saturated {ticks}"));
        line("ticks", format!("{}{}", self.ticks, saturated.unwrap_or_default()));
        line(
            "link",
            format!(
                "{} frames sent, {} rejected, {} payload bytes in {}",
                self.frames_sent, self.frames_rejected, self.payload_bytes, self.wire_bytes
            ),
        );
        if let (Some(samples), Some(underruns), Some(gaps)) =
            (self.stream_samples, self.stream_underruns, self.stream_gaps)
        {
            line("stream", format!("{samples} samples, {underruns} underruns, {gaps} gaps"));
        }
        if let Some(factor) = self.realtime_factor {
            let decimals = if factor < 10.0 { 2 } else { 0 };
            line("speed", format!("{factor:.decimals$} times real time"));
        }
        text
    }
}

fn size(rms_n: Option<f64>, max_n: Option<f64>) -> Option<ErrorSize> {
    rms_n.zip(max_n).map(|(rms_n, max_n)| ErrorSize { rms_n, max_n })
}
