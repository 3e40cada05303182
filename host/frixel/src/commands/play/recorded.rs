//! Origin of a play, as its recording stores it: scene, files, profiles and options.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::Result;
use frixel_driver::{Device, Link};
use frixel_lab::recording::{Metadata, SourceFile};
use frixel_lab::simulate::PlayOptions;

use crate::commands::error::reading;
use crate::input;
use crate::scene_file::SceneFiles;

use super::PlayArgs;
use super::plan::Plan;

/// Inputs of a play, apart from its options.
#[derive(Clone, Debug, Default)]
pub(super) struct Sources {
    scene: String,
    files: BTreeMap<String, SourceFile>,
    finger: Option<String>,
    screen: Option<String>,
}

impl Sources {
    /// Reads the files of profiles and stroke; those of the scene have been read already.
    pub(super) fn new(args: &PlayArgs, scene: &SceneFiles) -> Result<Self> {
        let names = args.profiles.names();
        let (finger, screen) = (names.finger_file(), names.screen_file());
        let profiles = [
            (PlayOptions::FINGER, finger),
            (PlayOptions::SCREEN, screen),
            (PlayOptions::TOUCH, args.touch.file()),
            (PlayOptions::STROKE, args.stroke.file()),
        ];
        let mut read = Vec::new();
        for (name, path) in profiles {
            if let Some(path) = path {
                let bytes = input::read(path, input::CSV_MAX_BYTES).map_err(reading(path))?;
                read.push((name.to_owned(), bytes));
            }
        }
        let of_scene = |name: &String| format!("{}{name}", PlayOptions::OF_SCENE);
        let named = scene.named_bytes().iter().map(|(name, bytes)| (of_scene(name), bytes.as_slice()));
        let files = SourceFile::all(read.iter().map(|(name, bytes)| (name.clone(), bytes.as_slice())).chain(named));
        let name = |name: &Option<String>, file: Option<&Path>| {
            file.map_or_else(|| name.clone(), |_| Some(PlayOptions::FILE.into()))
        };
        Ok(Self {
            scene: scene.scene_text(),
            files,
            finger: name(&names.finger, finger),
            screen: name(&names.screen, screen),
        })
    }

    fn options(&self, args: &PlayArgs, stream_s: Option<f64>) -> PlayOptions {
        PlayOptions { finger: self.finger.clone(), screen: self.screen.clone(), ..args.options(stream_s) }
    }
}

/// Metadata of a play before it begins.
pub(super) fn metadata<L: Link>(
    args: &PlayArgs,
    sources: &Sources,
    plan: &Plan,
    device: &Device<L>,
    is_simulated: bool,
) -> Metadata {
    Metadata {
        ticks_per_row: plan.ticks_per_row(),
        play: serde_json::to_value(sources.options(args, plan.stream_s)).unwrap_or_default(),
        scene: sources.scene.clone(),
        files: sources.files.clone(),
        ..Metadata::new(plan.target.name(), Some(device.hello()), is_simulated, args.participant.as_deref())
    }
}
