//! Inputs of a play, as its recording keeps them.

use std::collections::BTreeMap;

use frixel_hil_sim::{Stroke, TouchConfig};
use frixel_scene::{NamedProfile, ProfileError, Scene, brief};

use super::replay::{ReplayError, refused};
use super::{Metadata, SourceFile};
use crate::simulate::PlayOptions;
use crate::stroke_file::StrokeFile;

/// Bytes of files by their names.
pub(super) type FileBytes = BTreeMap<String, Vec<u8>>;

/// Inputs of a play beside its options: the texts and the bytes of its files.
#[derive(Clone, Debug, Default)]
pub struct PlaySource {
    /// Text of the scene's file.
    pub scene: String,
    /// The files that the scene names, by these names.
    pub files: BTreeMap<String, Vec<u8>>,
    /// Finger in place of the scene's own.
    pub finger: Option<NamedProfile>,
    /// Screen in place of the scene's own.
    pub screen: Option<NamedProfile>,
    /// Touch source.
    pub touch: Option<NamedProfile>,
    /// The file of the stroke.
    pub stroke: Option<Vec<u8>>,
}

impl PlaySource {
    /// Metadata of a play that is made from this, with these options apart from the profiles.
    pub fn recorded(&self, options: PlayOptions, metadata: Metadata) -> Metadata {
        let Self { finger, screen, touch, .. } = self;
        let name = |profile: &Option<NamedProfile>| {
            profile.as_ref().map(|profile| match profile.text {
                Some(_) => PlayOptions::FILE.to_owned(),
                None => profile.name.clone(),
            })
        };
        let options = PlayOptions { finger: name(finger), screen: name(screen), touch: name(touch), ..options };
        let profiles = [(PlayOptions::FINGER, finger), (PlayOptions::SCREEN, screen), (PlayOptions::TOUCH, touch)];
        let texts = profiles.iter().filter_map(|(name, profile)| Some((*name, profile.as_ref()?.text.as_ref()?)));
        let own = texts.map(|(name, text)| (name, text.as_bytes()));
        let own = own.chain(self.stroke.iter().map(|stroke| (PlayOptions::STROKE, stroke.as_slice())));
        let named = self.files.iter().map(|(name, bytes)| (format!("{}{name}", PlayOptions::OF_SCENE), &bytes[..]));
        Metadata {
            play: serde_json::to_value(options).unwrap_or_default(),
            scene: self.scene.clone(),
            files: SourceFile::all(own.map(|(name, bytes)| (name.to_owned(), bytes)).chain(named)),
            ..metadata
        }
    }

    /// Inputs of a recorded play.
    pub(super) fn of(metadata: &Metadata, options: &PlayOptions) -> Result<Self, ReplayError> {
        let files = bytes_of(&metadata.files)?;
        let profile = |option: &Option<String>, file: &str| match (option, files.get(file)) {
            (None, _) => Ok(None),
            (Some(_), Some(bytes)) => {
                let text = Some(String::from_utf8_lossy(bytes).into_owned());
                Ok(Some(NamedProfile { name: file.to_owned(), text }))
            }
            (Some(name), None) if name == PlayOptions::FILE => Err(missing(file)),
            (Some(name), None) => Ok(Some(NamedProfile { name: name.clone(), text: None })),
        };
        let stroke = files.get(PlayOptions::STROKE).filter(|_| options.stroke.is_from_file()).cloned();
        if options.stroke.is_from_file() && stroke.is_none() {
            return Err(missing(PlayOptions::STROKE));
        }
        let (finger, screen) = (&options.finger, &options.screen);
        let (finger, screen) = (profile(finger, PlayOptions::FINGER)?, profile(screen, PlayOptions::SCREEN)?);
        let touch = profile(&options.touch, PlayOptions::TOUCH)?;
        let of_scene =
            |(name, bytes): (String, Vec<u8>)| Some((name.strip_prefix(PlayOptions::OF_SCENE)?.to_owned(), bytes));
        let scene = metadata.scene.clone();
        Ok(Self { scene, finger, screen, touch, stroke, files: files.into_iter().filter_map(of_scene).collect() })
    }

    /// The scene, which messages call `name`, with the finger and the screen in place of its own.
    pub(super) fn scene(&self, name: &str) -> Result<Scene, ReplayError> {
        let mut scene = Scene::parse(&self.scene, name, &self.files)?;
        if let Some(screen) = &self.screen {
            scene = scene.with_screen(screen.read().map_err(of_profile)?, &screen.name);
        }
        if let Some(finger) = &self.finger {
            scene = scene.with_finger(finger.read().map_err(of_profile)?, &finger.name);
        }
        Ok(scene)
    }

    /// The stroke of the file, and the touch source.
    pub(super) fn inputs(&self) -> Result<(Option<Stroke>, Option<TouchConfig>), ReplayError> {
        let stroke = self.stroke.as_deref().map(StrokeFile::read).transpose()?.map(|file| file.stroke);
        Ok((stroke, self.touch.as_ref().map(NamedProfile::read).transpose().map_err(of_profile)?))
    }
}

/// The bytes of files that are kept in a recording.
pub(super) fn bytes_of(files: &BTreeMap<String, SourceFile>) -> Result<FileBytes, ReplayError> {
    let bytes = |(name, file): (&String, &SourceFile)| match (file.bytes(), file) {
        (Some(bytes), _) => Ok((name.clone(), bytes)),
        (None, SourceFile::Hash { .. }) => {
            Err(refused(format!("it holds only the hash of the large file {}", brief(name))))
        }
        (None, _) => Err(missing(name)),
    };
    files.iter().map(bytes).collect()
}

fn missing(name: &str) -> ReplayError {
    let name = brief(name);
    refused(format!(
        "it lacks {name}, a file that it was played with, or has a damaged one: use a copy of the recording"
    ))
}

fn of_profile(error: ProfileError) -> ReplayError {
    match error {
        ProfileError::NotBundled { kind, name, .. } => {
            refused(format!("this frixel has no {kind} named {}: use the one that recorded it", brief(&name)))
        }
        ProfileError::Mistakes(mistakes) => mistakes.into(),
    }
}
