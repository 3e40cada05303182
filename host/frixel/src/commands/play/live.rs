//! What changes while a scene plays: the scene, when its file is saved, and the samples of a stream.

use std::io::stdin;
use std::panic::resume_unwind;
use std::path::Path;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use frixel::player;
use frixel::scene_file::{self, SceneFileError};
use frixel::stream::Feed;
use frixel_driver::{Device, DeviceError, Link};
use frixel_scene::{Program, compile};
use frixel_wire::hello::Hello;
use frixel_wire::message::Refusal;

use super::watch::Watch;
use super::{CommandError, PlayArgs, tell_notes};

/// Time between two looks at Ctrl-C, the board's state and the scene's file.
const STEP: Duration = Duration::from_millis(50);
/// The same while samples flow: a buffer of the board lasts 25 ms or more.
const STREAM_STEP: Duration = Duration::from_millis(5);

/// Opens what `--stream` names; `waits` for a board in virtual time, which has to wait for its host.
pub(super) fn open_feed(args: &PlayArgs, tick_hz: u32, waits: bool) -> Result<Option<Feed>, CommandError> {
    match (args.stream.as_deref(), args.stream_hz) {
        (None, None) => Ok(None),
        (None, Some(_)) => Err(CommandError::StreamRateAlone),
        (Some(path), Some(sample_hz)) if path == Path::new("-") => {
            Ok(Some(Feed::raw(stdin(), sample_hz, tick_hz, waits)?))
        }
        (Some(path), None) if path == Path::new("-") => Err(CommandError::StreamRateMissing),
        (Some(path), Some(_)) => Err(CommandError::StreamRateOfFile { path: path.to_owned() }),
        (Some(path), None) => Ok(Some(Feed::wav(path, tick_hz)?)),
    }
}

/// What is looked after while a board plays.
pub(super) struct Live<'a> {
    path: &'a Path,
    watch: Option<Watch>,
    /// The saved scene, which is compiled apart: the board wants to hear of its host meanwhile.
    compiling: Option<JoinHandle<Result<Program, SceneFileError>>>,
    feed: Option<Feed>,
}

impl<'a> Live<'a> {
    /// To be made before the scene is read.
    pub(super) fn new(args: &'a PlayArgs) -> Self {
        let watch = args.watch.then(|| Watch::new(&args.scene));
        Self { path: &args.scene, watch, compiling: None, feed: None }
    }

    /// Begins the stream, if there is to be one, on a board that plays.
    pub(super) fn stream<L: Link>(&mut self, feed: Option<Feed>, device: &mut Device<L>) -> Result<(), CommandError> {
        self.feed = feed;
        Ok(self.feed.as_mut().map_or(Ok(()), |feed| feed.start(device))?)
    }

    /// How long the board may be left alone.
    pub(super) fn step(&self) -> Duration {
        if self.feed.is_some() { STREAM_STEP } else { STEP }
    }

    /// Sends samples, and the scene when its file was saved; returns the program that plays from now on, if it is another.
    pub(super) fn go_on<L: Link>(&mut self, device: &mut Device<L>) -> Result<Option<Program>, CommandError> {
        if let Some(feed) = &mut self.feed {
            feed.pump(device)?;
        }
        if let Some(compiling) = self.compiling.take_if(|compiling| compiling.is_finished()) {
            let compiled = compiling.join().unwrap_or_else(|panic| resume_unwind(panic));
            return replace(self.path, compiled, device);
        }
        if self.compiling.is_none() && self.watch.as_mut().is_some_and(Watch::is_saved) {
            let (path, Hello { limits, tick_hz, .. }) = (self.path.to_owned(), *device.hello());
            let compile = move || scene_file::load(&path).and_then(|scene| Ok(compile(&scene, &limits, tick_hz)?));
            self.compiling = Some(thread::spawn(compile));
        }
        Ok(None)
    }
}

/// Plays what the file says now. What is wrong with it is told, and the scene before plays on.
fn replace<L: Link>(
    path: &Path,
    compiled: Result<Program, SceneFileError>,
    device: &mut Device<L>,
) -> Result<Option<Program>, CommandError> {
    let program = match compiled {
        Ok(program) => program,
        Err(error) => {
            eprintln!("{error}");
            eprintln!("frixel: {} has mistakes: the scene before plays on", path.display());
            return Ok(None);
        }
    };
    match player::replace(device, &program) {
        Ok(()) => {
            tell_notes(&program);
            eprintln!("frixel: {} plays as it was saved", path.display());
            Ok(Some(program))
        }
        Err(DeviceError::Refused { refusal: Refusal::BitmapPoolFull { len, free }, .. }) => {
            eprintln!(
                "frixel: the pictures of {} and of the scene that plays do not fit on the board together ({len} bytes, \
                 {free} free): the scene before plays on; play the file anew without --watch, or give its pictures a \
                 larger `pitch_mm`",
                path.display()
            );
            Ok(None)
        }
        Err(refused @ DeviceError::Refused { .. }) => {
            eprintln!("frixel: {refused}: the scene before plays on");
            Ok(None)
        }
        Err(error) => Err(error.into()),
    }
}
