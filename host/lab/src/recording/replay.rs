//! Plays a recording again.

use std::collections::BTreeMap;

use frixel_felt::recorder::MarkedEvent;
use frixel_hil_sim::{RigConfig, Stroke};
use frixel_play::{Feed, GoesOn, SimulationError, simulate_by};
use frixel_scene::{CompileError, NamedProfile, Profile, ProfileError, Program, Scene, brief, compile_draft};
use thiserror::Error;

use super::replayed_changes::ReplayedChanges;
use super::{Metadata, Recording, SourceFile};
use crate::simulate::{PlayOptions, PlayOptionsError};
use crate::stroke_file::{StrokeFile, StrokeFileError};

/// Name of the scene in messages.
const SCENE: &str = "the recorded scene";

/// Bytes of files by their names.
type FileBytes = BTreeMap<String, Vec<u8>>;

/// Why a recording cannot be played again.
#[derive(Debug, Error)]
pub enum ReplayError {
    /// It is from another rig or version, or lacks a file that it was played with.
    #[error("{0}")]
    Refused(String),
    /// Its scene or a profile has mistakes.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// Its stroke has mistakes.
    #[error("its stroke cannot be read: {0}")]
    Stroke(#[from] StrokeFileError),
    /// Its options are invalid.
    #[error(transparent)]
    Options(#[from] PlayOptionsError),
    /// The play failed.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

impl Recording {
    /// Replays a simulated recording of this version with its own lines, scenes and samples, up to the tick at which it
    /// was interrupted, or to the last row of one that was cut off. `goes_on` is called many times a second of the
    /// play; when it breaks, the result ends there.
    pub fn replay(&self, goes_on: GoesOn<'_>) -> Result<Self, ReplayError> {
        let options = options(&self.metadata)?;
        let files = files(&self.metadata.files)?;
        let scene = scene(&self.metadata.scene, &of_scene(&files), &options, &files)?;
        let program = compile(&scene)?;
        let stroke = stroke(&options, &files)?;
        let feed = feed(&self.metadata, &options, &files)?;
        let inputs = (stroke, profile(options.touch.as_ref(), PlayOptions::TOUCH, &files)?);
        let mut simulation = options.simulation(&scene, &program, inputs, &RigConfig::default())?;
        let is_short = options.interrupted || self.is_cut_off;
        let stopped_at_tick = stopped_at_tick(&self.metadata).filter(|_| is_short);
        let tick_hz = simulation.rig.board.tick_hz;
        // Never more than a row beyond those of the file, which may ask for any duration.
        let rows = self.rows() + usize::from(!is_short || stopped_at_tick.is_some());
        let rows_s = rows as f64 * f64::from(simulation.ticks_per_row) / f64::from(tick_hz);
        simulation.seconds = simulation.seconds.min(rows_s);
        let later = later_programs(&self.metadata, &options, &files)?;
        let mut changes = ReplayedChanges::new(options.lines, later, stopped_at_tick, tick_hz);
        let played = simulate_by(&program, &simulation, feed, &mut |player| changes.play(player, goes_on));
        Ok(Self::of_rows(self.metadata.clone(), &played?.recorder.take_rows()))
    }
}

/// The options of the play, or the reason why it cannot be played again.
fn options(metadata: &Metadata) -> Result<PlayOptions, ReplayError> {
    let Metadata { frixel, rig, play, .. } = metadata;
    match rig.as_str() {
        "sim" => {}
        "qemu" | "pico" => {
            return Err(refused("it was made on the emulated board, and only plays of --port sim can be repeated"));
        }
        _ if metadata.is_simulated => {
            return Err(refused("it was made on a virtual board at a port, which runs in real time"));
        }
        _ => return Err(refused("it was made on a board at a port, under a person's finger")),
    }
    if frixel != Metadata::VERSION {
        let (found, own) = (brief(frixel), Metadata::VERSION);
        return Err(refused(format!("frixel {found} recorded it, and this is {own}: use that version")));
    }
    match serde_json::from_value::<PlayOptions>(play.clone()) {
        Err(_) => Err(refused("its metadata lacks the options of the play")),
        Ok(PlayOptions { control: true, lines: None, .. }) => {
            Err(refused("lines on standard input changed it (--control), which the recording does not have"))
        }
        Ok(options) => Ok(options),
    }
}

/// The tick of the record at which the host switched the output off.
fn stopped_at_tick(metadata: &Metadata) -> Option<u64> {
    let stopped = metadata.markers.iter().rfind(|marker| marker.event == MarkedEvent::Stopped);
    stopped.map(|stopped| stopped.ticks)
}

/// The bytes of files that are kept in the recording.
fn files(files: &BTreeMap<String, SourceFile>) -> Result<FileBytes, ReplayError> {
    let bytes = |(name, file): (&String, &SourceFile)| match (file.bytes(), file) {
        (Some(bytes), _) => Ok((name.clone(), bytes)),
        (None, SourceFile::Hash { .. }) => {
            Err(refused(format!("it holds only the hash of the large file {}", brief(name))))
        }
        (None, _) => Err(missing(name)),
    };
    files.iter().map(bytes).collect()
}

/// The files of the first scene, by the names that it gives them.
fn of_scene(files: &FileBytes) -> FileBytes {
    let of_scene = |(name, bytes): (&String, &Vec<u8>)| {
        Some((name.strip_prefix(PlayOptions::OF_SCENE)?.to_owned(), bytes.clone()))
    };
    files.iter().filter_map(of_scene).collect()
}

/// The scenes that were put on the board after the first.
fn later_programs(
    metadata: &Metadata,
    options: &PlayOptions,
    of_play: &FileBytes,
) -> Result<Vec<Program>, ReplayError> {
    let later = metadata.later_scenes.iter();
    later.map(|later| compile(&scene(&later.scene, &files(&later.files)?, options, of_play)?)).collect()
}

fn compile(scene: &Scene) -> Result<Program, ReplayError> {
    let board = RigConfig::default().board;
    Ok(compile_draft(scene, &board.limits, board.tick_hz)?)
}

/// The samples that were streamed, if any were, as fast as the board takes them. Behind the last one comes the end of
/// the stream, or, if the play ended before it, nothing.
fn feed(metadata: &Metadata, options: &PlayOptions, files: &FileBytes) -> Result<Option<Feed>, ReplayError> {
    if !options.stream {
        return Ok(None);
    }
    let mut events = metadata.markers.iter().map(|marker| &marker.event);
    let sample_hz = events.find_map(|event| match event {
        MarkedEvent::StreamStarted { sample_hz } => Some(*sample_hz),
        _ => None,
    });
    let is_ended = events.any(|event| *event == MarkedEvent::StreamEnded);
    let (Some(sample_hz), Some(bytes)) = (sample_hz, files.get(PlayOptions::STREAM)) else {
        return Err(refused("samples were streamed into it (--stream), which the recording does not have"));
    };
    let sample = |pair: &[u8]| Some(u16::from_le_bytes(pair.try_into().ok()?));
    let samples: Vec<u16> = bytes.chunks_exact(2).filter_map(sample).collect();
    let mut samples = samples.into_iter();
    Ok(Some(Feed::fetched(sample_hz, move |pending, len| {
        pending.extend(samples.by_ref().take(len.saturating_sub(pending.len())));
        Ok(!is_ended || samples.len() > 0)
    })))
}

/// A scene of the recording, which names the files `named`, with the finger and the screen that replaced its own.
fn scene(text: &str, named: &FileBytes, options: &PlayOptions, files: &FileBytes) -> Result<Scene, ReplayError> {
    let mut scene = Scene::parse(text, SCENE, named)?;
    if let Some(screen) = profile(options.screen.as_ref(), PlayOptions::SCREEN, files)? {
        scene = scene.with_screen(screen, PlayOptions::SCREEN);
    }
    if let Some(finger) = profile(options.finger.as_ref(), PlayOptions::FINGER, files)? {
        scene = scene.with_finger(finger, PlayOptions::FINGER);
    }
    Ok(scene)
}

/// The profile of an option, from the file `file` of the recording, or else the bundled one.
fn profile<P: Profile>(option: Option<&String>, file: &str, files: &FileBytes) -> Result<Option<P>, ReplayError> {
    let Some(name) = option else { return Ok(None) };
    let text = files.get(file).map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    let name = match &text {
        Some(_) => file.to_owned(),
        None if name == PlayOptions::FILE => return Err(missing(file)),
        None => name.clone(),
    };
    let read = NamedProfile { name, text }.read();
    read.map(Some).map_err(|error| match error {
        ProfileError::NotBundled { kind, name, .. } => {
            refused(format!("this frixel has no {kind} named {}: use the one that recorded it", brief(&name)))
        }
        ProfileError::Mistakes(mistakes) => mistakes.into(),
    })
}

/// The stroke of a file.
fn stroke(options: &PlayOptions, files: &FileBytes) -> Result<Option<Stroke>, ReplayError> {
    if !options.stroke.is_from_file() {
        return Ok(None);
    }
    let bytes = files.get(PlayOptions::STROKE).ok_or_else(|| missing(PlayOptions::STROKE))?;
    Ok(Some(StrokeFile::read(bytes.as_slice())?.stroke))
}

fn missing(name: &str) -> ReplayError {
    let name = brief(name);
    refused(format!(
        "it lacks {name}, a file that it was played with, or has a damaged one: use a copy of the recording"
    ))
}

fn refused(sentence: impl Into<String>) -> ReplayError {
    ReplayError::Refused(sentence.into())
}
