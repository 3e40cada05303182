//! `frixel replay`: plays a simulated recording again, and compares it bit by bit.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use frixel_felt::recorder::MarkedEvent;
use frixel_hil_sim::{BoardMemory, Stroke, TouchConfig};
use frixel_lab::recording::{Metadata, PlayOptions, Recording, SourceFile};
use frixel_lab::stroke_file::StrokeFile;
use frixel_play::{PlayError, Player};
use frixel_scene::{FingerProfile, Program, Scene, Screen, parse_touch_source};

use crate::input;
use crate::rigs::RecordedLink;
use crate::scene_file::SceneFileError;

use super::super::profiles::TouchArgs;
use super::super::stroke::StrokeArgs;
use super::super::terminal::print_line;
use super::control::{Control, Next};
use super::follow::end_triggers;
use super::rigs::simulator;
use super::stream_args::{RecordedStream, StreamArgs};
use super::{CommandError, Interrupt, PlayArgs, note};

#[derive(Debug, Args)]
pub(in crate::commands) struct ReplayArgs {
    /// A recording of a play on the simulator, by `frixel play --record` or Python's `Recording.to_parquet`.
    recording: PathBuf,
}

/// Plays a recording again, and says whether its bits are the same.
pub(in crate::commands) fn run(args: &ReplayArgs) -> Result<(), CommandError> {
    let path = &args.recording;
    let bytes = input::read(path, input::CSV_MAX_BYTES).map_err(CommandError::reading(path))?;
    let recorded = Recording::read_parquet(bytes).map_err(CommandError::recording(path))?;
    if recorded.is_cut_off {
        note(format_args!("{}: it ends in a part of a row group, which is left out", path.display()));
    }
    let played = Replay::of(&recorded.metadata, path)?.play(&recorded)?;
    if let Some(difference) = recorded.first_difference(&played) {
        return Err(CommandError::ReplayDiffers { path: path.clone(), difference });
    }
    let (rows, columns) = (recorded.rows(), recorded.columns.len());
    print_line(format_args!("{}: the same bits, {rows} rows of {columns} columns", path.display()))
}

/// How the recording was made, or why it cannot be made again.
fn options(metadata: &Metadata) -> Result<PlayOptions, String> {
    let Metadata { frixel, rig, play, .. } = metadata;
    match rig.as_str() {
        "sim" => {}
        "qemu" => return Err("it is of the emulated board, and only --port sim is played again".into()),
        _ if metadata.is_simulated => return Err("it is of a virtual board at a port, which runs in real time".into()),
        _ => return Err("it is of a board at a port, under a person's finger".into()),
    }
    if frixel != Metadata::VERSION {
        return Err(format!("frixel {frixel} recorded it, and this is {}: use that version", Metadata::VERSION));
    }
    let Ok(options) = serde_json::from_value::<PlayOptions>(play.clone()) else {
        return Err("it does not say how it was played".into());
    };
    if options.control && options.lines.is_none() {
        return Err("lines on standard input changed it (--control), which the recording does not have".into());
    }
    Ok(options)
}

/// The bytes of files that are kept in the recording.
fn bytes(files: &BTreeMap<String, SourceFile>) -> Result<BTreeMap<String, Vec<u8>>, String> {
    let bytes = |(name, file): (&String, &SourceFile)| match file.bytes() {
        Some(bytes) => Ok((name.clone(), bytes)),
        None => Err(format!("it has only the hash of the file {name}, which is large")),
    };
    files.iter().map(bytes).collect()
}

/// What was streamed to the board, if anything was.
fn stream(
    metadata: &Metadata,
    options: &PlayOptions,
    files: &BTreeMap<String, Vec<u8>>,
) -> Result<Option<RecordedStream>, String> {
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
        return Err("samples were streamed into it (--stream), which the recording does not have".into());
    };
    let samples = bytes.chunks_exact(2).filter_map(|pair| Some(u16::from_le_bytes(pair.try_into().ok()?))).collect();
    Ok(Some(RecordedStream { sample_hz, samples, is_ended, file_s: options.stream_s }))
}

/// A play that is made again.
struct Replay {
    options: PlayOptions,
    files: BTreeMap<String, Vec<u8>>,
    stream: Option<RecordedStream>,
    first: Scene,
    /// The scenes that were put on the board after the first.
    later: Vec<Scene>,
}

impl Replay {
    /// Reads what a recording says, or why it cannot be made again.
    fn of(metadata: &Metadata, path: &Path) -> Result<Self, CommandError> {
        let no_replay = |reason: String| CommandError::NoReplay { path: path.to_owned(), reason };
        let options = options(metadata).map_err(no_replay)?;
        let files = bytes(&metadata.files).map_err(no_replay)?;
        let stream = stream(metadata, &options, &files).map_err(no_replay)?;
        let of_first = |(name, bytes): (&String, &Vec<u8>)| {
            Some((name.strip_prefix(PlayOptions::OF_SCENE)?.to_owned(), bytes.clone()))
        };
        let named = files.iter().filter_map(of_first).collect();
        let first = scene(&metadata.scene, &named, &options, &files)?;
        let later = metadata.later_scenes.iter().map(|later| {
            let named = bytes(&later.files).map_err(no_replay)?;
            scene(&later.scene, &named, &options, &files)
        });
        Ok(Self { later: later.collect::<Result<_, _>>()?, options, files, stream, first })
    }

    /// Plays the same again, as long as the recording is if it was interrupted.
    fn play(self, recorded: &Recording) -> Result<Recording, CommandError> {
        let args = play_args(&self.options, &self.files, self.stream)?;
        let mut memory = BoardMemory::new();
        let (mut plan, device) = simulator(&args, &self.first, &mut memory)?;
        let is_short = self.options.interrupted || recorded.is_cut_off;
        let stopped_at = stopped_at(&recorded.metadata).filter(|_| is_short);
        if is_short && stopped_at.is_none() {
            plan.end_after_rows(recorded.rows());
        }
        let (limits, tick_hz) = plan.target.limits(device.hello());
        let later = self.later.iter().map(|scene| plan.target.compile(scene, &limits, tick_hz));
        let later = later.collect::<Result<Vec<_>, _>>()?;
        let control = self.options.lines.map(|lines| Control::of_recording(lines, &Interrupt::default()));
        let mut player = Player::recording(device, plan.recorder()?);
        let program = plan.program.clone();
        player
            .start(program, plan.telemetry_period_ticks, &mut |_| ControlFlow::Continue(()))
            .and_then(|()| plan.feed.take().map_or(Ok(()), |feed| player.stream(feed)))
            .and_then(|()| until_over(&mut player, control, &later, (stopped_at, tick_hz)))
            .map_err(|error| CommandError::of_play("sim", error))?;
        let mut recorder = player.into_recorder();
        Ok(Recording::of_rows(recorded.metadata.clone(), &recorder.take_rows()))
    }
}

/// The tick of the record at which the host switched the output off.
fn stopped_at(metadata: &Metadata) -> Option<u64> {
    let stopped = metadata.markers.iter().rfind(|marker| marker.event == MarkedEvent::Stopped);
    stopped.map(|stopped| stopped.ticks)
}

/// Plays until the record is full, or until the tick at which it was interrupted, and stops.
///
/// It does what [`follow`](super::follow) does on the simulator, without its files.
fn until_over<L: RecordedLink>(
    player: &mut Player<L>,
    mut control: Option<Control>,
    later: &[Program],
    (stopped_at, tick_hz): (Option<u64>, u32),
) -> Result<(), PlayError> {
    let unsaid = &mut |_| {};
    loop {
        let recorder = player.recorder_mut();
        let (t_s, ticks) = (recorder.t_s(), recorder.ticks());
        let ticks_left = stopped_at.map_or(u64::MAX, |stopped_at| stopped_at.saturating_sub(ticks));
        if recorder.ticks_left() == 0 || ticks_left == 0 {
            break;
        }
        let mut step_max = duration_within(ticks_left, tick_hz);
        if let Some(control) = &mut control {
            end_triggers(player, unsaid)?;
            match control.step(player, t_s, unsaid)? {
                Next::GoOn => step_max = step_max.min(control.time_max(t_s)),
                Next::Quit => break,
                Next::Replace(number) => {
                    replace(player, &number, later)?;
                    step_max = Duration::ZERO;
                }
            }
        }
        player.step(step_max)?;
    }
    Ok(player.stop()?)
}

/// A duration that is rounded up to so many ticks.
fn duration_within(ticks: u64, tick_hz: u32) -> Duration {
    Duration::try_from_secs_f64((ticks as f64 - 0.5) / f64::from(tick_hz)).unwrap_or(Duration::MAX)
}

/// Puts a later scene on the board by its number, from 1. The board refuses what it has refused before.
fn replace<L: RecordedLink>(player: &mut Player<L>, number: &Path, later: &[Program]) -> Result<(), PlayError> {
    let number: Option<usize> = number.to_str().and_then(|number| number.parse().ok());
    let Some(program) = number.and_then(|number| later.get(number.checked_sub(1)?)) else { return Ok(()) };
    match player.replace(program.clone()) {
        Err(error) if !error.is_refusal() => Err(error),
        _ => Ok(()),
    }
}

/// A scene of the recording, with the finger and the screen that replaced its own.
fn scene(
    text: &str,
    named: &BTreeMap<String, Vec<u8>>,
    options: &PlayOptions,
    files: &BTreeMap<String, Vec<u8>>,
) -> Result<Scene, CommandError> {
    let mut scene = Scene::parse(text, "the recorded scene", named)?;
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

fn play_args(
    options: &PlayOptions,
    files: &BTreeMap<String, Vec<u8>>,
    stream: Option<RecordedStream>,
) -> Result<PlayArgs, CommandError> {
    let stroke = match files.get(PlayOptions::STROKE).filter(|_| options.stroke.is_from_file()) {
        Some(bytes) => Some(stroke(bytes)?),
        None => None,
    };
    let touch = match (&options.touch, files.get(PlayOptions::TOUCH)) {
        (None, _) => None,
        (Some(_), Some(bytes)) => Some(parse_touch_source(&String::from_utf8_lossy(bytes), PlayOptions::TOUCH)?),
        (Some(name), None) => Some(bundled(TouchConfig::bundled(name), PlayOptions::TOUCH, name)?),
    };
    Ok(PlayArgs {
        seconds: options.seconds,
        seed: options.seed,
        ideal: options.ideal,
        no_leakage: options.no_leakage,
        finger_seed: options.finger_seed,
        csv_hz: options.rows_hz,
        stroke: StrokeArgs::of_recording(options.stroke.clone(), stroke),
        touch: TouchArgs::of_recording(touch),
        stream: StreamArgs::of_recording(stream),
        ..PlayArgs::ideal(Path::new("the recorded scene"), Path::new(""))
    })
}

fn stroke(bytes: &[u8]) -> Result<Stroke, CommandError> {
    let read = StrokeFile::read(bytes);
    Ok(read.map_err(|source| CommandError::Stroke { path: PlayOptions::STROKE.into(), source })?.stroke)
}

/// A bundled profile, which the same version has.
fn bundled<T>(found: Option<T>, what: &'static str, name: &str) -> Result<T, SceneFileError> {
    found.ok_or_else(|| SceneFileError::UnreadableProfile {
        what,
        file: name.to_owned(),
        nearest: frixel_scene::Nearest::new(name, std::iter::empty()),
        source: std::io::ErrorKind::NotFound.into(),
    })
}
