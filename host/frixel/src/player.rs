//! Playing a compiled scene: on any board through its [`Device`], or on the simulator from beginning to end.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke, WorldError};
use frixel_model::ParameterError;
use thiserror::Error;

use crate::output::FeltRow;
use crate::rigs::{Recorder, SimLink};
use crate::stream::{Feed, FeedError};
use frixel_driver::{Bitmap, Counters, Device, DeviceError, Link, Progress, StreamStatus, Upload};
use frixel_scene::Program;

/// What is simulated beyond the last recorded tick, so that the recorder has seen it.
const MARGIN: Duration = Duration::from_millis(5);
/// Time that passes between two reports of progress, and between two handings over of rows.
const STEP: Duration = Duration::from_millis(50);
/// The same while samples flow: a buffer of the board lasts 25 ms or more.
const STREAM_STEP: Duration = Duration::from_millis(5);

/// Takes a board from wherever another client left it to a scene that plays.
pub fn start<L: Link>(
    device: &mut Device<L>,
    program: &Program,
    progress: &mut dyn FnMut(Progress),
) -> Result<(), DeviceError> {
    load(device, program, progress)?;
    device.arm()?;
    device.play()
}

/// Puts another scene in the place of the one that plays, between two ticks.
pub fn replace<L: Link>(device: &mut Device<L>, program: &Program) -> Result<(), DeviceError> {
    upload(device, program, &mut |_| {})
}

/// Takes a board from wherever another client left it to a scene that could be played.
pub(crate) fn load<L: Link>(
    device: &mut Device<L>,
    program: &Program,
    progress: &mut dyn FnMut(Progress),
) -> Result<(), DeviceError> {
    device.disarm()?;
    upload(device, program, progress)
}

/// Uploads and commits.
fn upload<L: Link>(
    device: &mut Device<L>,
    program: &Program,
    progress: &mut dyn FnMut(Progress),
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
    device.upload(&upload, progress)?;
    device.commit(upload.scene_crc32())
}

/// How to play on the simulator.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// Board, world and line.
    pub rig: RigConfig,
    /// Where the finger goes.
    pub stroke: Stroke,
    /// For how long, in seconds from the beginning of the stroke.
    pub seconds: f64,
    /// Seed of all that is random.
    pub seed: u64,
    /// Ticks between two rows of the record.
    pub ticks_per_row: u32,
}

/// What came of a simulation.
pub struct Simulated {
    /// What was felt against what was wanted.
    pub recorder: Recorder,
    /// What went over the line.
    pub counters: Counters,
    /// How the stream did, if there was one.
    pub stream: Option<StreamStatus>,
    /// Virtual time over wall time, from the hello to the end; the time that a taker of rows took is left out.
    pub realtime_factor: f64,
}

/// Where a simulation has come to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stage {
    /// The scene goes over the line.
    Upload(Progress),
    /// The scene has been playing for this part, from 0 to 1.
    Play(f64),
}

/// Why a simulation did not come to its end.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// The simulated world cannot be made.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The contact model refuses the program's finger.
    #[error("the contact model refuses the scene's finger: {0:?}")]
    Finger(ParameterError),
    /// The board refused, or fell silent.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// There are no samples to stream, or no more of them.
    #[error(transparent)]
    Feed(#[from] FeedError),
}

/// Plays `program` on the simulated board under a simulated finger. The rows stay in [`Simulated::recorder`].
///
/// The program must have been compiled for the limits and the tick rate of the simulation's board.
pub fn simulate(
    program: &Program,
    simulation: &Simulation,
    on_stage: &mut dyn FnMut(Stage),
) -> Result<Simulated, SimulationError> {
    run(program, simulation, None, on_stage, None)
}

/// As [`simulate`], with samples for the scene's stream layers from when it begins to play, and hands the rows over while it plays and keeps none, so that a play of any length fits in memory.
///
/// `on_rows` takes the rows of every 50 ms of virtual time. When it breaks, the play ends there; what was played until
/// then is what came of it.
pub fn simulate_rows(
    program: &Program,
    simulation: &Simulation,
    feed: Option<&mut Feed>,
    on_stage: &mut dyn FnMut(Stage),
    on_rows: &mut RowTaker,
) -> Result<Simulated, SimulationError> {
    run(program, simulation, feed, on_stage, Some(on_rows))
}

/// Takes rows while a simulation plays, and says whether it is to go on.
pub type RowTaker<'a> = dyn FnMut(&[FeltRow]) -> ControlFlow<()> + 'a;

fn run(
    program: &Program,
    simulation: &Simulation,
    mut feed: Option<&mut Feed>,
    on_stage: &mut dyn FnMut(Stage),
    mut on_rows: Option<&mut RowTaker>,
) -> Result<Simulated, SimulationError> {
    let board = &simulation.rig.board;
    let ticks = (simulation.seconds * f64::from(board.tick_hz)).round() as u64;
    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &simulation.rig, simulation.stroke.clone(), simulation.seed)?;
    let recorder = Recorder::new(program, &board.limits, board.tick_hz, ticks, simulation.ticks_per_row)
        .map_err(SimulationError::Finger)?;

    let begin = Instant::now();
    let mut taking_rows = Duration::ZERO;
    let mut device = Device::connect(SimLink::new(rig, recorder))?;
    start(&mut device, program, &mut |progress| on_stage(Stage::Upload(progress)))?;
    if let Some(feed) = &mut feed {
        feed.start(&mut device)?;
    }
    let step = if feed.is_some() { STREAM_STEP } else { STEP };
    let total = Duration::from_secs_f64(simulation.seconds) + MARGIN;
    let mut passed = Duration::ZERO;
    while passed < total {
        let step = step.min(total.saturating_sub(passed));
        device.wait(step, &mut |_| {})?;
        if let Some(feed) = &mut feed {
            feed.pump(&mut device)?;
        }
        passed += step;
        on_stage(Stage::Play(passed.as_secs_f64() / total.as_secs_f64()));
        let Some(on_rows) = &mut on_rows else { continue };
        let recorder = device.link_mut().recorder_mut();
        let taking = Instant::now();
        let flow = on_rows(&recorder.take_rows());
        taking_rows += taking.elapsed();
        if flow.is_break() {
            recorder.end();
            break;
        }
    }
    device.stop()?;
    device.disarm()?;
    let wall_s = begin.elapsed().saturating_sub(taking_rows).as_secs_f64();

    let (counters, stream) = (device.counters(), device.stream_status());
    let link = device.into_link();
    let realtime_factor = link.now().as_secs_f64() / wall_s;
    Ok(Simulated { recorder: link.into_recorder(), counters, stream, realtime_factor })
}
