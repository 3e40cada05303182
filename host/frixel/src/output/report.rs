//! The results of a run, for programs and for people.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Serialize, Serializer};

use frixel_driver::{Counters, StreamStatus};

use frixel_felt::judge::LayerVerdict;
use frixel_felt::metrics::MetricsSummary;
use frixel_felt::recorder::JUDGED_MAX_S;
use frixel_lab::hash::sha256;
use frixel_scene::{LayerTitle, Origin, Reach, TouchSource};

use crate::input;

/// The results of a run; the field names are the keys of `--json`. Unknown values are `null` there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Report {
    /// The rig that played the scene: `sim`, `qemu` or `board`.
    pub rig: String,
    /// Whether the scene is a draft, which a board refuses.
    pub draft: bool,
    /// Why a board refuses it, a sentence each with line and column in the scene's file.
    pub board_refuses: Vec<String>,
    /// Whether finger or board is simulated.
    pub simulated: bool,
    /// The simulated world, `realistic`, `without-leakage` or `ideal`.
    pub world: Option<Effects>,
    /// The simulated touch source.
    pub touch_source: Option<TouchSource>,
    /// Seed of the simulated person whose finger the board does not know.
    pub finger_seed: Option<u64>,
    /// Number of ticks played.
    pub ticks: u64,
    /// Ticks with the finger on the screen before the board knew of it, which have no friction error.
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
    /// What the newtons rest on: `assumed`, `perceptual` or `measured`.
    pub finger_origin: &'static str,
    /// Total friction at zero voltage, N.
    pub reachable_min_n: f64,
    /// Total friction at the largest voltage, N.
    pub reachable_max_n: f64,
    /// Smallest total reference friction, but for the micrometres after the finger lands or turns, N.
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
    /// How often the board ran out of samples.
    pub stream_underruns: Option<u32>,
    /// Runs of samples that were lost on the line.
    pub stream_gaps: Option<u32>,
    /// What the finger felt of each layer on which it slid in the first minute of this play while the board drove;
    /// `null` if something changed the scene while it played, and on a board at a port.
    pub in_this_play: Option<Vec<LayerVerdict>>,
    /// Why there are no verdicts.
    #[serde(skip)]
    pub no_verdict: Option<&'static str>,
    /// Which layers start off, and what switches them on, if some do.
    #[serde(skip)]
    pub starts_off: Option<String>,
    /// Whether the play went on after what was judged.
    #[serde(skip)]
    pub is_judged_in_part: bool,
    /// The layers of the last scene that the finger never touched.
    pub untouched_layers: Vec<LayerTitle>,
    /// When that scene replaced the one before, s; `null` if the first scene played to the end.
    pub replaced_at_s: Option<f64>,
    /// SHA-256 of each other file of the play, by its name; only in `summary.json`.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub files: BTreeMap<String, String>,
}

/// Whether a file of a play is another one than the summary beside it was written with.
pub(crate) fn is_of_interrupted_play(file: &Path, bytes: &[u8]) -> bool {
    let summary = input::read(&file.with_file_name("summary.json"), input::TOML_MAX_BYTES).unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap_or_default();
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    summary["files"][&*name].as_str().is_some_and(|hash| hash != sha256(bytes))
}

/// The world that was simulated beside a board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WorldReport {
    /// Which effects it had beside the contact model.
    pub effects: Effects,
    /// The touch source.
    pub touch_source: TouchSource,
    /// Seed of the random person; `None` if the finger was the scene's.
    pub finger_seed: Option<u64>,
}

/// Effects of the simulated world beside the contact model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effects {
    None,
    /// All but charge that leaks through the skin, about which measurements disagree.
    AllButLeakage,
    All,
}

impl Effects {
    /// The name of the world, for programs, and what is in it.
    pub(super) const fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::None => ("ideal", "no load changes, noise, pre-sliding, leakage, offsets or lost touch reports"),
            Self::AllButLeakage => (
                "without-leakage",
                "with load changes, noise, pre-sliding, offsets and lost touch reports; --no-leakage switches leakage off",
            ),
            Self::All => (
                "realistic",
                "with load changes, noise, pre-sliding, leakage, offsets and lost touch reports; --ideal switches them off",
            ),
        }
    }
}

impl Serialize for Effects {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.words().0)
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

    /// Says what the newtons rest on; without this, they are assumed.
    #[must_use]
    pub(crate) fn with_origin(self, origin: Origin) -> Self {
        Self { finger_origin: origin.word(), ..self }
    }

    /// Says whether finger or board is simulated; without this, they are.
    #[must_use]
    pub(crate) fn with_simulated(self, simulated: bool) -> Self {
        Self { simulated, ..self }
    }

    /// Says which world was simulated, if one was. The newtons of a random person are assumed, whatever those of the
    /// scene's finger rest on.
    #[must_use]
    pub(crate) fn with_world(self, world: Option<WorldReport>) -> Self {
        let finger_seed = world.and_then(|world| world.finger_seed);
        let finger_origin = if finger_seed.is_some() { Origin::Assumed.word() } else { self.finger_origin };
        let touch_source = world.map(|world| world.touch_source);
        Self { world: world.map(|world| world.effects), touch_source, finger_seed, finger_origin, ..self }
    }

    /// Says why a board refuses the scene. If there is a reason, it is a draft.
    #[must_use]
    pub(crate) fn with_refusals(self, board_refuses: Vec<String>) -> Self {
        Self { draft: !board_refuses.is_empty(), board_refuses, ..self }
    }

    /// Adds the status of the stream, if there was one.
    #[must_use]
    pub(crate) fn with_stream(mut self, stream: Option<StreamStatus>) -> Self {
        self.stream_samples = stream.map(|stream| stream.sent);
        self.stream_underruns = stream.map(|stream| stream.underruns);
        self.stream_gaps = stream.map(|stream| stream.gaps);
        self
    }

    /// Adds what the finger felt of each layer, if the play was judged, which lasted for so many seconds.
    #[must_use]
    pub(crate) fn with_verdicts(self, in_this_play: Option<Vec<LayerVerdict>>, seconds: f64) -> Self {
        Self { in_this_play, is_judged_in_part: seconds > JUDGED_MAX_S, ..self }
    }

    /// Adds why there are no verdicts, and which layers started off.
    #[must_use]
    pub(crate) fn with_notes(self, no_verdict: Option<&'static str>, starts_off: Option<String>) -> Self {
        Self { no_verdict, starts_off, ..self }
    }

    /// Adds the names of the layers of the last scene that the finger never touched, and when that scene replaced
    /// another one, if it did.
    #[must_use]
    pub(crate) fn with_untouched(self, untouched_layers: Vec<LayerTitle>, replaced_at_s: Option<f64>) -> Self {
        Self { untouched_layers, replaced_at_s, ..self }
    }

    /// The report as one JSON object on one line.
    pub(crate) fn to_json(&self) -> String {
        // Numbers and strings always serialise; a number that is not finite becomes `null`.
        serde_json::to_string(self).unwrap_or_default()
    }
}
