//! The results of a run, for programs and for people.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Serialize, Serializer};

use frixel_driver::{Counters, StreamStatus};

use frixel_felt::judge::LayerVerdict;
use frixel_felt::metrics::MetricsSummary;
use frixel_lab::hash::sha256;
use frixel_scene::{LayerTitle, Origin, Reach, TouchSource};

use crate::input;

/// The results of a run; the field names are the keys of `--json`. Unknown values are `null` there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Report {
    /// The rig that played the scene: `sim`, `qemu`, `pico` or `board`.
    pub rig: String,
    /// Whether the scene is a draft, which a board refuses.
    pub draft: bool,
    /// Reasons for which a board refuses the scene: one sentence each, with line and column in the scene's file.
    pub board_refuses: Vec<String>,
    /// Whether finger or board is simulated.
    pub simulated: bool,
    /// The simulated world, `realistic`, `without-leakage` or `ideal`, with the suffix `-mean-square` if friction
    /// follows the mean squared voltage.
    pub world: Option<Effects>,
    /// The simulated touch source.
    pub touch_source: Option<TouchSource>,
    /// Seed of the simulated person, if the finger is not the scene's.
    pub finger_seed: Option<u64>,
    /// Number of ticks played.
    pub ticks: u64,
    /// Ticks with the finger on the screen before the first touch report, which have no friction error.
    pub unreported_ticks: u64,
    /// Felt minus reference friction, averaged over a carrier period: root mean square, N.
    pub friction_error_rms_n: Option<f64>,
    /// Felt minus reference friction, averaged over a carrier period: largest magnitude, N.
    pub friction_error_max_n: Option<f64>,
    /// Friction that the model computes for the commanded voltage, minus the commanded friction: root mean square, N.
    pub inversion_error_rms_n: Option<f64>,
    /// Friction that the model computes for the commanded voltage, minus the commanded friction: largest magnitude, N.
    pub inversion_error_max_n: Option<f64>,
    /// Ticks in which the envelope was at its slew limit, which have no inversion error.
    pub slewing_ticks: Option<u64>,
    /// Friction caused by a normal load other than the profile's: root mean square, N. The reference has it too.
    pub load_mismatch_rms_n: Option<f64>,
    /// Friction caused by a normal load other than the profile's: largest magnitude, N.
    pub load_mismatch_max_n: Option<f64>,
    /// Felt friction minus its mean over a carrier period: root mean square, N.
    pub carrier_ripple_rms_n: Option<f64>,
    /// Origin of the finger's numbers: `assumed`, `perceptual`, `measured` or `empirical`.
    pub finger_origin: &'static str,
    /// Total friction at zero voltage, N.
    pub reachable_min_n: f64,
    /// Total friction at the largest voltage, N.
    pub reachable_max_n: f64,
    /// Smallest total reference friction, except in the micrometres after the finger lands or turns, N.
    pub reference_min_n: Option<f64>,
    /// Largest total reference friction, with the same exception, N.
    pub reference_max_n: Option<f64>,
    /// Ticks in which the board clamped its command.
    pub saturated_ticks: Option<u64>,
    /// Number of frames that the host sent.
    pub frames_sent: u64,
    /// Number of frames that host or board rejected because their checksum did not match.
    pub frames_rejected: u64,
    /// Payload bytes of all frames.
    pub payload_bytes: u64,
    /// Bytes on the line, framing included.
    pub wire_bytes: u64,
    /// Simulated seconds per second of wall time, without the time for writing files.
    pub realtime_factor: Option<f64>,
    /// Number of streamed samples; this and the two fields below are `null` without a stream.
    pub stream_samples: Option<u64>,
    /// Number of times that the board ran out of samples.
    pub stream_underruns: Option<u32>,
    /// Runs of samples that were lost on the line.
    pub stream_gaps: Option<u32>,
    /// Verdict on each layer on which the finger slid in the first minute of this play while the board drove; `null` if
    /// the scene changed while it played, and on a board at a port.
    pub in_this_play: Option<Vec<LayerVerdict>>,
    /// Reason for which there are no verdicts.
    #[serde(skip)]
    pub no_verdict: Option<&'static str>,
    /// The layers that start off, if any, and what switches them on.
    #[serde(skip)]
    pub starts_off: Option<String>,
    /// Whether the play lasted longer than its judged part.
    #[serde(skip)]
    pub is_judged_in_part: bool,
    /// The layers of the last scene that the finger never touched.
    pub untouched_layers: Vec<LayerTitle>,
    /// Time at which that scene replaced the previous one, s; `null` if the first scene played to the end.
    pub replaced_at_s: Option<f64>,
    /// SHA-256 of each other file of the play, by its name; only in `summary.json`.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub files: BTreeMap<String, String>,
}

/// Whether a file of a play does not match its hash in the summary beside it.
pub(crate) fn is_of_interrupted_play(file: &Path, bytes: &[u8]) -> bool {
    let summary = input::read(&file.with_file_name("summary.json"), input::TOML_MAX_BYTES).unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap_or_default();
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    summary["files"][&*name].as_str().is_some_and(|hash| hash != sha256(bytes))
}

/// The world that was simulated around a board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WorldReport {
    /// Its effects beyond the contact model.
    pub effects: Effects,
    /// The touch source.
    pub touch_source: TouchSource,
    /// Seed of the random person; `None` if the finger was the scene's.
    pub finger_seed: Option<u64>,
}

/// Effects of the simulated world beyond the contact model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Effects {
    /// Whether the world is ideal, without the effects of amplifier, finger and touch source.
    pub is_ideal: bool,
    /// Whether charge leaks through the skin, on which measurements disagree.
    pub has_leakage: bool,
    /// Whether friction follows the mean squared voltage of the carrier, which is unmeasured.
    pub follows_mean_square: bool,
}

impl Effects {
    /// The name of the world, for programs, and its description.
    pub(super) fn description(self) -> (String, String) {
        let (name, description) = match (self.is_ideal, self.has_leakage) {
            (true, _) => ("ideal", "no load changes, noise, pre-sliding, leakage, offsets or lost touch reports"),
            (false, false) => (
                "without-leakage",
                "with load changes, noise, pre-sliding, offsets and lost touch reports; --skin no-leakage switches leakage \
                 off",
            ),
            (false, true) => (
                "realistic",
                "with load changes, noise, pre-sliding, leakage, offsets and lost touch reports; --ideal switches them \
                 off",
            ),
        };
        if self.follows_mean_square {
            let description = format!("{description}; friction follows the mean square of the carrier");
            (format!("{name}-mean-square"), description)
        } else {
            (name.to_owned(), description.to_owned())
        }
    }
}

impl Serialize for Effects {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.description().0)
    }
}

impl Report {
    /// Computes the report from the results of a play.
    pub(crate) fn new(
        rig: &str,
        metrics: &MetricsSummary,
        reach: &Reach,
        link: &Counters,
        realtime_factor: Option<f64>,
    ) -> Self {
        Self {
            rig: rig.to_owned(),
            draft: false,
            board_refuses: Vec::new(),
            simulated: true,
            world: None,
            touch_source: None,
            finger_seed: None,
            ticks: metrics.ticks,
            unreported_ticks: metrics.unreported_ticks,
            friction_error_rms_n: metrics.friction_error.map(|error| error.rms_n),
            friction_error_max_n: metrics.friction_error.map(|error| error.max_n),
            inversion_error_rms_n: metrics.inversion_error.map(|error| error.rms_n),
            inversion_error_max_n: metrics.inversion_error.map(|error| error.max_n),
            slewing_ticks: metrics.slewing_ticks,
            load_mismatch_rms_n: metrics.load_mismatch.map(|mismatch| mismatch.rms_n),
            load_mismatch_max_n: metrics.load_mismatch.map(|mismatch| mismatch.max_n),
            carrier_ripple_rms_n: metrics.carrier_ripple_rms_n,
            finger_origin: Origin::Assumed.word(),
            reachable_min_n: reach.friction_min_n(),
            reachable_max_n: reach.friction_max_n(),
            reference_min_n: metrics.reference_range_n.map(|(least_n, _)| least_n),
            reference_max_n: metrics.reference_range_n.map(|(_, largest_n)| largest_n),
            saturated_ticks: metrics.saturated_ticks,
            frames_sent: link.frames_sent,
            frames_rejected: link.frames_rejected,
            payload_bytes: link.payload_bytes,
            wire_bytes: link.wire_bytes,
            realtime_factor,
            stream_samples: None,
            stream_underruns: None,
            stream_gaps: None,
            in_this_play: None,
            is_judged_in_part: false,
            no_verdict: None,
            starts_off: None,
            untouched_layers: Vec::new(),
            replaced_at_s: None,
            files: BTreeMap::new(),
        }
    }

    /// Sets the simulated world, if there is one. The numbers of a random person are assumed, whatever the origin of
    /// the scene's finger.
    #[must_use]
    pub(crate) fn with_world(self, world: Option<WorldReport>) -> Self {
        let finger_seed = world.and_then(|world| world.finger_seed);
        let finger_origin = if finger_seed.is_some() { Origin::Assumed.word() } else { self.finger_origin };
        let touch_source = world.map(|world| world.touch_source);
        Self { world: world.map(|world| world.effects), touch_source, finger_seed, finger_origin, ..self }
    }

    /// Adds the status of the stream, if there was one.
    #[must_use]
    pub(crate) fn with_stream(mut self, stream: Option<StreamStatus>) -> Self {
        self.stream_samples = stream.map(|stream| stream.sent);
        self.stream_underruns = stream.map(|stream| stream.underruns);
        self.stream_gaps = stream.map(|stream| stream.gaps);
        self
    }

    /// The report as one JSON object on one line.
    pub(crate) fn to_json(&self) -> String {
        // Numbers and strings always serialise; a number that is not finite becomes `null`.
        serde_json::to_string(self).unwrap_or_default()
    }
}
