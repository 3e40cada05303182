//! Plays a recording again.

use frixel_felt::recorder::MarkedEvent;
use frixel_hil_sim::RigConfig;
use frixel_play::{Feed, GoesOn, SimulationError, simulate_by};
use frixel_scene::{CompileError, Program, Scene, brief, compile_draft};
use thiserror::Error;

use super::replayed_changes::ReplayedChanges;
use super::source::bytes_of;
use super::{LaterScene, Metadata, PlaySource, Recording, SourceFile};
use crate::simulate::{PlayOptions, PlayOptionsError};
use crate::stroke_file::StrokeFileError;

/// Name of the scene in messages.
const SCENE: &str = "the recorded scene";

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
        let source = PlaySource::of(&self.metadata, &options)?;
        let scene = source.scene(SCENE)?;
        let program = compile(&scene)?;
        let feed = feed(&self.metadata, &options)?;
        let mut simulation = options.simulation(&scene, &program, source.inputs()?, &RigConfig::default())?;
        let is_short = options.interrupted || self.is_cut_off;
        let stopped_at_tick = stopped_at_tick(&self.metadata).filter(|_| is_short);
        let tick_hz = simulation.rig.board.tick_hz;
        // Never more than a row beyond those of the file, which may ask for any duration.
        let rows = self.rows() + usize::from(!is_short || stopped_at_tick.is_some());
        let rows_s = rows as f64 * f64::from(simulation.ticks_per_row) / f64::from(tick_hz);
        simulation.seconds = simulation.seconds.min(rows_s);
        let later = later_programs(&self.metadata, &source)?;
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

/// The scenes that were put on the board after the first.
fn later_programs(metadata: &Metadata, source: &PlaySource) -> Result<Vec<Program>, ReplayError> {
    let of = |later: &LaterScene| {
        let (scene, files) = (later.scene.clone(), bytes_of(&later.files)?);
        compile(&PlaySource { scene, files, ..source.clone() }.scene(SCENE)?)
    };
    metadata.later_scenes.iter().map(of).collect()
}

fn compile(scene: &Scene) -> Result<Program, ReplayError> {
    let board = RigConfig::default().board;
    Ok(compile_draft(scene, &board.limits, board.tick_hz)?)
}

/// The samples that were streamed, if any were, as fast as the board takes them. Behind the last one comes the end of
/// the stream, or, if the play ended before it, nothing.
fn feed(metadata: &Metadata, options: &PlayOptions) -> Result<Option<Feed>, ReplayError> {
    if !options.stream {
        return Ok(None);
    }
    let mut events = metadata.markers.iter().map(|marker| &marker.event);
    let sample_hz = events.find_map(|event| match event {
        MarkedEvent::StreamStarted { sample_hz } => Some(*sample_hz),
        _ => None,
    });
    let is_ended = events.any(|event| *event == MarkedEvent::StreamEnded);
    let (Some(sample_hz), Some(bytes)) =
        (sample_hz, metadata.files.get(PlayOptions::STREAM).and_then(SourceFile::bytes))
    else {
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

pub(super) fn refused(sentence: impl Into<String>) -> ReplayError {
    ReplayError::Refused(sentence.into())
}
