//! `frixel replay`: plays a simulated recording again, and compares it bit by bit.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use frixel_hil_sim::{BoardMemory, Stroke, TouchConfig};
use frixel_lab::recording::{Metadata, PlayOptions, Recording};
use frixel_lab::stroke_file::StrokeFile;
use frixel_play::Player;
use frixel_scene::{FingerProfile, Scene, Screen, parse_touch_source};

use crate::input;
use crate::scene_file::SceneFileError;

use super::super::profiles::TouchArgs;
use super::super::stroke::StrokeArgs;
use super::super::terminal::print_line;
use super::rigs::simulator;
use super::{CommandError, PlayArgs, note};

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
    let no_replay = |reason: String| CommandError::NoReplay { path: path.clone(), reason };
    let options = options(&recorded.metadata).map_err(no_replay)?;
    let files = files(&recorded.metadata).map_err(no_replay)?;
    let played = play(&recorded, &options, &files)?;
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
        "qemu" | "pico" => return Err("it is of an emulated board, and only --port sim is played again".into()),
        _ if metadata.is_simulated => return Err("it is of a virtual board at a port, which runs in real time".into()),
        _ => return Err("it is of a board at a port, under a person's finger".into()),
    }
    if frixel != Metadata::VERSION {
        return Err(format!("frixel {frixel} recorded it, and this is {}: use that version", Metadata::VERSION));
    }
    let Ok(options) = serde_json::from_value::<PlayOptions>(play.clone()) else {
        return Err("it does not say how it was played".into());
    };
    match (options.control, options.stream) {
        (true, _) => Err("lines on standard input changed it (--control), which the recording does not have".into()),
        (_, true) => Err("samples were streamed into it (--stream), which the recording does not have".into()),
        _ => Ok(options),
    }
}

/// The files of the recording.
fn files(metadata: &Metadata) -> Result<BTreeMap<String, Vec<u8>>, String> {
    let bytes = |(name, file): (&String, &frixel_lab::recording::SourceFile)| match file.bytes() {
        Some(bytes) => Ok((name.clone(), bytes)),
        None => Err(format!("it has only the hash of the file {name}, which is large")),
    };
    metadata.files.iter().map(bytes).collect()
}

/// Plays the same again, as many rows as the recording has if it was interrupted.
fn play(
    recorded: &Recording,
    options: &PlayOptions,
    files: &BTreeMap<String, Vec<u8>>,
) -> Result<Recording, CommandError> {
    let scene = scene(&recorded.metadata, options, files)?;
    let args = play_args(options, files)?;
    let mut memory = BoardMemory::new();
    let (mut plan, device) = simulator(&args, &scene, &mut memory)?;
    if options.interrupted || recorded.is_cut_off {
        plan.end_after_rows(recorded.rows());
    }
    let of_play = |error| CommandError::of_play("sim", error);
    let mut player = Player::recording(device, plan.recorder()?);
    let program = plan.program.clone();
    player.start(program, plan.telemetry_period_ticks, &mut |_| ControlFlow::Continue(())).map_err(of_play)?;
    while player.recorder_mut().ticks_left() > 0 {
        player.step(Duration::MAX).map_err(of_play)?;
    }
    let mut recorder = player.into_recorder();
    Ok(Recording::of_rows(recorded.metadata.clone(), &recorder.take_rows()))
}

/// The scene, with the finger and the screen that replaced its own.
fn scene(metadata: &Metadata, options: &PlayOptions, files: &BTreeMap<String, Vec<u8>>) -> Result<Scene, CommandError> {
    let of_scene = |(name, bytes): (&String, &Vec<u8>)| {
        Some((name.strip_prefix(PlayOptions::OF_SCENE)?.to_owned(), bytes.clone()))
    };
    let named: BTreeMap<String, Vec<u8>> = files.iter().filter_map(of_scene).collect();
    let mut scene = Scene::parse(&metadata.scene, "the recorded scene", &named)?;
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

fn play_args(options: &PlayOptions, files: &BTreeMap<String, Vec<u8>>) -> Result<PlayArgs, CommandError> {
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
