//! Plays a compiled scene on any board through its [`Device`], and records the play.

use std::ops::ControlFlow;
use std::time::Duration;

use frixel_driver::{Bitmap, Counters, Device, DeviceError, Event, Link, Progress, StreamStatus, Upload};
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke, TickRecord, WorldError};
use frixel_model::{LoadedContact, ParameterError};
use frixel_scene::Program;
use frixel_wire::message::Telemetry;
use thiserror::Error;

use crate::rigs::{EventLog, RecordedLink, SimLink, StopReason};
use crate::stream::{Feed, FeedError};

/// Longest time between two steps of a play.
const STEP_MAX: Duration = Duration::from_millis(50);
/// Longest time between two steps while samples are streamed: a board's buffer lasts 25 ms or more.
const STREAM_STEP_MAX: Duration = Duration::from_millis(5);
/// Extra time beyond the last recorded tick, because the link's clock is rounded.
const MARGIN: Duration = Duration::from_millis(5);

/// Disarms a board, whatever state an earlier client left it in, then uploads the scene, arms the board and plays.
pub fn start<L: Link>(
    device: &mut Device<L>,
    program: &Program,
    progress: &mut dyn FnMut(Progress),
) -> Result<(), DeviceError> {
    load(device, program, &mut uninterrupted(progress))?;
    device.arm()?;
    device.play()
}

/// Continues an upload whatever its progress.
fn uninterrupted(progress: &mut dyn FnMut(Progress)) -> impl FnMut(Progress) -> ControlFlow<()> {
    |now| {
        progress(now);
        ControlFlow::Continue(())
    }
}

/// Disarms a board, whatever state an earlier client left it in, then uploads the scene without playing it.
pub(crate) fn load<L: Link>(
    device: &mut Device<L>,
    program: &Program,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<(), DeviceError> {
    device.disarm()?;
    upload(device, program, progress)
}

/// Uploads the scene and commits it.
fn upload<L: Link>(
    device: &mut Device<L>,
    program: &Program,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<(), DeviceError> {
    let scene = program.scene_bytes_for(device.hello().protocol);
    let bitmaps = program
        .bitmaps
        .iter()
        .map(|bitmap| Bitmap {
            crc32: bitmap.crc32,
            width: bitmap.width,
            height: bitmap.height,
            samples: &bitmap.samples,
        })
        .collect();
    let upload = Upload { scene: &scene, bitmaps };
    device.upload_while(&upload, progress)?;
    device.commit(upload.scene_crc32())
}

/// Why a play ended early.
#[derive(Debug, Error)]
pub enum PlayError {
    /// The simulated world could not be built.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The contact model rejects the finger of the program.
    #[error("the contact model rejects the scene's finger: {0}")]
    Finger(ParameterError),
    /// The board rejected a request, or stopped answering.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The samples to stream are missing, or could not be read to their end.
    #[error(transparent)]
    Feed(#[from] FeedError),
    /// The board stopped without a stop command.
    #[error("the board {0}")]
    Stopped(StopReason),
}

/// A play: a scene on a board, its recorder, and the feed of streamed samples.
///
/// Call [`Self::start`], then [`Self::step`] until [`Recorder::ticks_left`] is zero or the play should end early, then
/// [`Self::stop`]. Dropping a player also stops the board.
pub struct Player<L: RecordedLink> {
    device: Device<L>,
    feed: Option<Feed>,
    events: EventLog,
    telemetry: Vec<Telemetry>,
}

impl<L: RecordedLink> Player<L> {
    /// Creates a player for `device` that records into `recorder` from the start of the play.
    pub fn new(mut device: Device<L>, recorder: Recorder) -> Self {
        *device.link_mut().recorder_mut() = recorder;
        let events = EventLog::new(device.hello().state);
        Self { device, feed: None, events, telemetry: Vec::new() }
    }

    /// Uploads the scene and plays it. The board sends a telemetry message every `telemetry_period_ticks` ticks; 0
    /// disables telemetry. `progress` may break the upload off.
    pub fn start(
        &mut self,
        program: &Program,
        telemetry_period_ticks: u32,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<(), PlayError> {
        load(&mut self.device, program, progress)?;
        self.device.arm()?;
        self.device.play()?;
        let begun = self.device.link_mut().begin();
        begun.map_err(|closed| DeviceError::Vanished { command: "play", closed })?;
        if telemetry_period_ticks > 0 {
            self.device.subscribe(telemetry_period_ticks)?;
        }
        Ok(())
    }

    /// Starts streaming the samples of `feed` to the scene that is playing.
    pub fn stream(&mut self, feed: Feed) -> Result<(), PlayError> {
        Ok(self.feed.insert(feed).start(&mut self.device)?)
    }

    /// Whether the stream of [`Self::stream`] has ended and was played.
    pub fn is_stream_over(&self) -> bool {
        self.feed.as_ref().is_some_and(|feed| feed.is_over(&self.device))
    }

    /// Replaces the scene that is playing between two ticks, and uses the new one as the reference of the record.
    pub fn replace(&mut self, program: &Program) -> Result<(), PlayError> {
        upload(&mut self.device, program, &mut |_| ControlFlow::Continue(()))?;
        let hello = *self.device.hello();
        self.recorder_mut().replace(program, &hello.limits, hello.tick_hz).map_err(PlayError::Finger)
    }

    /// Like [`Self::replace`], for a scene whose bitmaps do not fit on the board beside those of the scene that plays:
    /// an empty scene plays until the new one is there, so that the output fades out meanwhile.
    pub fn replace_alone(&mut self, program: &Program) -> Result<(), PlayError> {
        self.replace(&program.without_layers())?;
        self.replace(program)
    }

    /// Switches a layer of the playing scene on or off, and sets its gain; see [`Device::set_layer`].
    pub fn set_layer(&mut self, layer: u8, on: bool, gain: f32) -> Result<(), PlayError> {
        Ok(self.device.set_layer(layer, on, gain)?)
    }

    /// Lets at most `time_max` pass on the board; records the ticks, and sends samples.
    ///
    /// Returns how much time has passed. Fails when the connection is lost or when the board stopped without a stop
    /// command; what happened until then has been recorded.
    pub fn step(&mut self, time_max: Duration) -> Result<Duration, PlayError> {
        let step_max = if self.feed.is_some() { STREAM_STEP_MAX } else { STEP_MAX };
        let time = step_max.min(time_max).min(self.time_left());
        let waited = self.wait(time);
        self.events.stop_reason().map_or(Ok(()), |reason| Err(PlayError::Stopped(reason)))?;
        waited?;
        if let Some(feed) = &mut self.feed {
            feed.pump(&mut self.device)?;
        }
        Ok(time)
    }

    /// Ends the play and the record: sets the output to zero and disarms the board.
    pub fn stop(&mut self) -> Result<(), PlayError> {
        self.device.stop()?;
        Ok(self.device.disarm()?)
    }

    /// The board that the scene plays on.
    pub fn device(&self) -> &Device<L> {
        &self.device
    }

    /// The recorder of this play.
    pub fn recorder_mut(&mut self) -> &mut Recorder {
        self.device.link_mut().recorder_mut()
    }

    /// Ends the record with the data received so far, and returns the recorder. Stops the board first if
    /// [`Self::stop`] has not been called.
    pub fn into_recorder(mut self) -> Recorder {
        self.device.link_mut().record_rest();
        std::mem::replace(self.recorder_mut(), Recorder::idle())
    }

    /// Time to the end of the record, plus [`MARGIN`].
    fn time_left(&mut self) -> Duration {
        let tick_hz = self.device.hello().tick_hz;
        let ticks = self.recorder_mut().ticks_left();
        Duration::try_from_secs_f64(ticks as f64 / f64::from(tick_hz)).unwrap_or(Duration::MAX).saturating_add(MARGIN)
    }

    /// Waits for `time`, and handles the messages that the board sends meanwhile.
    fn wait(&mut self, time: Duration) -> Result<(), PlayError> {
        let Self { device, telemetry, events, .. } = self;
        let t_s = device.link_mut().recorder_mut().t_s();
        let waited = device.wait(time, &mut |event| match event {
            Event::Telemetry(message) => telemetry.push(message),
            Event::StateChanged { state, fault, flags } => events.observe(t_s, state, fault, flags),
        });
        device.link_mut().record(telemetry);
        telemetry.clear();
        Ok(waited?)
    }
}

/// Settings of a play on the simulator.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// The simulated board, world and serial line.
    pub rig: RigConfig,
    /// Path of the simulated finger.
    pub stroke: Stroke,
    /// Duration, in seconds from the beginning of the stroke.
    pub seconds: f64,
    /// Seed of every random process.
    pub seed: u64,
    /// Ticks between two rows of the record.
    pub ticks_per_row: u32,
}

/// Results of a simulation.
pub struct Simulated {
    /// Recorder with the felt friction and its reference.
    pub recorder: Recorder,
    /// Traffic counters of the serial line.
    pub counters: Counters,
    /// Final status of the stream; `None` without one.
    pub stream: Option<StreamStatus>,
}

/// Plays `program` on the simulated board under a simulated finger. `feed` supplies the samples of its stream layers.
///
/// The program must have been compiled for the limits and the tick rate of the simulation's board.
pub fn simulate(program: &Program, simulation: &Simulation, feed: Option<Feed>) -> Result<Simulated, PlayError> {
    simulate_observed(program, simulation, None, feed, |_| {})
}

/// As [`simulate`], under a finger that is not the program's if there is one, and calls `observer` with every tick of
/// the play.
pub(crate) fn simulate_observed(
    program: &Program,
    simulation: &Simulation,
    own_finger: Option<LoadedContact<f64>>,
    feed: Option<Feed>,
    observer: impl FnMut(&TickRecord),
) -> Result<Simulated, PlayError> {
    let board = &simulation.rig.board;
    let ticks = (simulation.seconds * f64::from(board.tick_hz)).round() as u64;
    let recorder = Recorder::new(program, &board.limits, board.tick_hz, ticks, simulation.ticks_per_row)
        .map_err(PlayError::Finger)?;
    let mut memory = BoardMemory::new();
    let mut rig = Rig::new(&mut memory, &simulation.rig, simulation.stroke.clone(), simulation.seed)?;
    if let Some(contact) = own_finger {
        rig.world_mut().set_own_finger(contact);
    }
    let mut player = Player::new(Device::connect(SimLink::new(rig, Recorder::idle()).observed(observer))?, recorder);
    player.start(program, 0, &mut |_| ControlFlow::Continue(()))?;
    if let Some(feed) = feed {
        player.stream(feed)?;
    }
    while player.recorder_mut().ticks_left() > 0 {
        player.step(Duration::MAX)?;
    }
    player.stop()?;
    let (counters, stream) = (player.device().counters(), player.device().stream_status());
    Ok(Simulated { recorder: player.into_recorder(), counters, stream })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use frixel_scene::compile;
    use frixel_wire::fault::Fault;

    use super::*;

    /// In virtual time as on a serial port, a fault ends the play, and the record holds everything up to the fault.
    #[test]
    fn a_board_that_stops_by_itself_ends_the_play() {
        let config = RigConfig::default();
        let board = &config.board;
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/constant.toml");
        let program = compile(&crate::scene_file::load(&path).unwrap(), &board.limits, board.tick_hz).unwrap();
        let mut memory = BoardMemory::new();
        let mut rig = Rig::new(&mut memory, &config, Stroke::sweep(0.12, 0.11, 1.0).unwrap(), 1).unwrap();
        rig.world_mut().schedule_amplifier_fault(20_000..u64::MAX);
        let recorder = Recorder::new(&program, &board.limits, board.tick_hz, 400_000, 40).unwrap();
        let mut player = Player::new(Device::connect(SimLink::new(rig, Recorder::idle())).unwrap(), recorder);
        player.start(&program, 0, &mut |_| ControlFlow::Continue(())).unwrap();
        let error = (0..100).find_map(|_| player.step(Duration::MAX).err()).unwrap();
        assert!(matches!(error, PlayError::Stopped(StopReason::Fault(Fault::Amplifier))), "{error}");
        let recorder = player.into_recorder();
        assert!((10_000..25_000).contains(&recorder.ticks()), "{} ticks", recorder.ticks());
        assert!(!recorder.rows().is_empty());
    }
}
