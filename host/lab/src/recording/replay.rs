//! Plays a recording again.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use frixel_hil_sim::{RigConfig, Stroke, TouchConfig};
use frixel_scene::{CompileError, FingerProfile, Scene, Screen, compile_draft, parse_touch_source};
use thiserror::Error;

use super::prepared_play::{PreparedPlay, PreparedPlayError};
use super::{Metadata, PlayOptions, Recording};
use crate::simulation::SimulationError;
use crate::stroke_file::{StrokeFile, StrokeFileError};

/// What messages call the scene.
const SCENE: &str = "the recorded scene";

/// Why a recording cannot be played again.
#[derive(Debug, Error)]
pub enum ReplayError {
    /// It is of the emulated board.
    #[error("it is of the emulated board, and only --port sim is played again")]
    Emulated,
    /// It is of a virtual board.
    #[error("it is of a virtual board at a port, which runs in real time")]
    Virtual,
    /// It is of a real board.
    #[error("it is of a board at a port, under a person's finger")]
    Board,
    /// Another version made it, and this one may play otherwise.
    #[error("frixel {found} recorded it, and this is {}: use that version", Metadata::VERSION)]
    OtherVersion {
        /// The version.
        found: String,
    },
    /// It has no options of a play.
    #[error("it does not say how it was played")]
    NoOptions,
    /// Layers were changed while it played.
    #[error("lines on standard input changed it (--control), which the recording does not have")]
    Controlled,
    /// Samples were streamed.
    #[error("samples were streamed into it (--stream), which the recording does not have")]
    Streamed,
    /// A file of it is too large to be kept.
    #[error("it has only the hash of the file {name}, which is large")]
    OnlyHash {
        /// What the file is.
        name: String,
    },
    /// A profile of another frixel.
    #[error("this frixel has no {what} called {name}: use the one that recorded it")]
    NotBundled {
        /// What it is.
        what: &'static str,
        /// Its name.
        name: String,
    },
    /// Its scene or a profile has mistakes.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// Its stroke has mistakes.
    #[error("its stroke cannot be read: {0}")]
    Stroke(#[from] StrokeFileError),
    /// Its options describe no play.
    #[error(transparent)]
    Options(#[from] PreparedPlayError),
    /// The play failed.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

impl Recording {
    /// Plays a simulated recording of this version again: as many rows as it has, if it was interrupted or is cut off.
    /// `goes_on` is asked many times a second of the play; when it breaks, the result ends there.
    pub fn replay(&self, goes_on: &mut dyn FnMut() -> ControlFlow<()>) -> Result<Self, ReplayError> {
        let options = options(&self.metadata)?;
        let files = files(&self.metadata)?;
        let scene = scene(&self.metadata, &options, &files)?;
        let board = RigConfig::default().board;
        let program = compile_draft(&scene, &board.limits, board.tick_hz)?;
        let stroke = stroke(&options, &files)?;
        let mut play = PreparedPlay::new(&options, &scene, &program, stroke, touch(&options, &files)?)?;
        if options.interrupted || self.is_cut_off {
            let rows_s = self.rows() as f64 * f64::from(play.simulation.ticks_per_row) / f64::from(board.tick_hz);
            play.simulation.seconds = play.simulation.seconds.min(rows_s);
        }
        let mut recorder = play.run(&program, goes_on)?.recorder;
        Ok(Self::of_rows(self.metadata.clone(), &recorder.take_rows()))
    }
}

/// How the recording was made, or why it cannot be made again.
fn options(metadata: &Metadata) -> Result<PlayOptions, ReplayError> {
    let Metadata { frixel, rig, play, .. } = metadata;
    match rig.as_str() {
        "sim" => {}
        "qemu" | "pico" => return Err(ReplayError::Emulated),
        _ if metadata.is_simulated => return Err(ReplayError::Virtual),
        _ => return Err(ReplayError::Board),
    }
    if frixel != Metadata::VERSION {
        return Err(ReplayError::OtherVersion { found: frixel.clone() });
    }
    match serde_json::from_value::<PlayOptions>(play.clone()) {
        Err(_) => Err(ReplayError::NoOptions),
        Ok(PlayOptions { control: true, .. }) => Err(ReplayError::Controlled),
        Ok(PlayOptions { stream: true, .. }) => Err(ReplayError::Streamed),
        Ok(options) => Ok(options),
    }
}

/// The files of the recording.
fn files(metadata: &Metadata) -> Result<BTreeMap<String, Vec<u8>>, ReplayError> {
    let bytes = |(name, file): (&String, &super::SourceFile)| match file.bytes() {
        Some(bytes) => Ok((name.clone(), bytes)),
        None => Err(ReplayError::OnlyHash { name: name.clone() }),
    };
    metadata.files.iter().map(bytes).collect()
}

/// The scene, with the finger and the screen that replaced its own.
fn scene(metadata: &Metadata, options: &PlayOptions, files: &BTreeMap<String, Vec<u8>>) -> Result<Scene, ReplayError> {
    let of_scene = |(name, bytes): (&String, &Vec<u8>)| {
        Some((name.strip_prefix(PlayOptions::OF_SCENE)?.to_owned(), bytes.clone()))
    };
    let named: BTreeMap<String, Vec<u8>> = files.iter().filter_map(of_scene).collect();
    let mut scene = Scene::parse(&metadata.scene, SCENE, &named)?;
    if let Some(name) = &options.screen {
        let screen = match files.get(PlayOptions::SCREEN) {
            Some(bytes) => Screen::parse(&String::from_utf8_lossy(bytes), PlayOptions::SCREEN)?,
            None => bundled(Screen::bundled(name), PlayOptions::SCREEN, name)?,
        };
        scene = scene.with_screen(screen, PlayOptions::SCREEN)?;
    }
    if let Some(name) = &options.finger {
        let finger = match files.get(PlayOptions::FINGER) {
            Some(bytes) => FingerProfile::parse(&String::from_utf8_lossy(bytes), PlayOptions::FINGER)?,
            None => bundled(FingerProfile::bundled(name), PlayOptions::FINGER, name)?,
        };
        scene = scene.with_finger(finger, PlayOptions::FINGER)?;
    }
    Ok(scene)
}

/// The stroke of a file.
fn stroke(options: &PlayOptions, files: &BTreeMap<String, Vec<u8>>) -> Result<Option<Stroke>, ReplayError> {
    let bytes = files.get(PlayOptions::STROKE).filter(|_| options.stroke.is_from_file());
    Ok(bytes.map(|bytes| StrokeFile::read(bytes.as_slice())).transpose()?.map(|file| file.stroke))
}

fn touch(options: &PlayOptions, files: &BTreeMap<String, Vec<u8>>) -> Result<Option<TouchConfig>, ReplayError> {
    Ok(match (&options.touch, files.get(PlayOptions::TOUCH)) {
        (None, _) => None,
        (Some(_), Some(bytes)) => Some(parse_touch_source(&String::from_utf8_lossy(bytes), PlayOptions::TOUCH)?),
        (Some(name), None) => Some(bundled(TouchConfig::bundled(name), PlayOptions::TOUCH, name)?),
    })
}

/// A bundled profile, which the same version has.
fn bundled<T>(found: Option<T>, what: &'static str, name: &str) -> Result<T, ReplayError> {
    found.ok_or_else(|| ReplayError::NotBundled { what, name: name.to_owned() })
}
