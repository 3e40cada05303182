//! What the recording of a play says about how it was made.

use std::collections::BTreeMap;
use std::path::Path;

use frixel_driver::{Device, Link};
use frixel_lab::recording::{Metadata, SourceFile};
use serde::{Deserialize, Serialize};

use crate::input;
use crate::scene_file::SceneFiles;

use super::super::parquet;
use super::super::stroke::RecordedStroke;
use super::plan::Plan;
use super::{CommandError, PlayArgs};

/// Names of the files of a recording beside the scene's own.
pub(super) const STROKE: &str = "stroke";
pub(super) const FINGER: &str = "finger";
pub(super) const SCREEN: &str = "screen";
pub(super) const TOUCH: &str = "touch";
/// Before the name of a file that the scene names.
pub(super) const OF_SCENE: &str = "scene/";

/// The options of a play, without the paths of files.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(clippy::struct_excessive_bools, reason = "each is an option of its own")]
pub(super) struct PlayOptions {
    pub(super) seconds: Option<f64>,
    pub(super) seed: u64,
    pub(super) ideal: bool,
    pub(super) no_leakage: bool,
    pub(super) finger_seed: Option<u64>,
    pub(super) rows_hz: u32,
    /// The finger in place of the scene's own: the name of a bundled one, or `file`.
    pub(super) finger: Option<String>,
    /// The screen in place of the scene's own, in the same way.
    pub(super) screen: Option<String>,
    /// The touch source, in the same way.
    pub(super) touch: Option<String>,
    pub(super) stroke: RecordedStroke,
    /// Whether lines on standard input changed the play.
    pub(super) control: bool,
    /// Whether samples were streamed, which the recording does not have.
    pub(super) stream: bool,
    /// Whether the play ended before its time.
    pub(super) interrupted: bool,
}

/// What a play is made from, apart from its options.
#[derive(Clone, Debug, Default)]
pub(super) struct Sources {
    scene: String,
    files: BTreeMap<String, SourceFile>,
    finger: Option<String>,
    screen: Option<String>,
}

impl Sources {
    /// Reads the files of profiles and stroke; those of the scene are as they were read.
    pub(super) fn new(args: &PlayArgs, scene: &SceneFiles) -> Result<Self, CommandError> {
        let names = args.profiles.names();
        let (finger, screen) = (names.finger_file(), names.screen_file());
        let profiles = [(FINGER, finger), (SCREEN, screen), (TOUCH, args.touch.file()), (STROKE, args.stroke.file())];
        let mut read = Vec::new();
        for (name, path) in profiles {
            if let Some(path) = path {
                let bytes = input::read(path, input::CSV_MAX_BYTES).map_err(CommandError::reading(path))?;
                read.push((name.to_owned(), bytes));
            }
        }
        let named = scene.named_bytes().iter().map(|(name, bytes)| (format!("{OF_SCENE}{name}"), bytes.as_slice()));
        let files = SourceFile::all(read.iter().map(|(name, bytes)| (name.clone(), bytes.as_slice())).chain(named));
        let name =
            |name: &Option<String>, file: Option<&Path>| file.map_or_else(|| name.clone(), |_| Some("file".into()));
        Ok(Self {
            scene: scene.scene_text(),
            files,
            finger: name(&names.finger, finger),
            screen: name(&names.screen, screen),
        })
    }

    fn options(&self, args: &PlayArgs) -> PlayOptions {
        let touch = args.touch.bundled_name().or(args.touch.file().map(|_| "file"));
        PlayOptions {
            seconds: args.seconds,
            seed: args.seed,
            ideal: args.ideal,
            no_leakage: args.no_leakage,
            finger_seed: args.finger_seed,
            rows_hz: args.csv_hz,
            finger: self.finger.clone(),
            screen: self.screen.clone(),
            touch: touch.map(str::to_owned),
            stroke: RecordedStroke::of(&args.stroke),
            control: args.control,
            stream: args.stream.is_some(),
            interrupted: false,
        }
    }
}

/// What is known of a play on a board before it begins.
pub(super) fn metadata<L: Link>(
    args: &PlayArgs,
    sources: &Sources,
    plan: &Plan,
    device: &Device<L>,
    is_simulated: bool,
) -> Metadata {
    Metadata {
        ticks_per_row: plan.ticks_per_row(),
        play: serde_json::to_value(sources.options(args)).unwrap_or_default(),
        scene: sources.scene.clone(),
        files: sources.files.clone(),
        ..parquet::metadata(plan.target.name(), Some(device.hello()), is_simulated, args.participant.as_deref())
    }
}
