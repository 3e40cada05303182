//! The thread that owns the board: opens it, and carries out one request after another.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender};
use std::time::Duration;

use frixel_driver::{DEFAULT_BAUD, Device, Link, PollingLink, SerialLink};
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, WorldOptions};
use frixel_lab::simulate::{BUNDLED_SCREEN_M, endless_sweep};
use frixel_play::{Feed, LiveError, Observed, PlayError, Player, Replaced, RigStream, break_if};
use frixel_scene::Program;
use frixel_wire::fault::State;
use frixel_wire::hello::Hello;
use frixel_wire::message::Telemetry;
use pyo3::PyErr;

use super::SIMULATOR;

/// Seed of the simulated world.
const SEED: u64 = 1;

/// A request of the program.
pub(super) enum Request {
    Play(Box<Program>),
    Replace(Box<Program>),
    SetLayer {
        layer: String,
        on: Option<bool>,
        gain: Option<f32>,
    },
    Trigger {
        layer: String,
        duration_s: Option<f64>,
    },
    Stream {
        samples: Vec<u16>,
        sample_hz: u32,
    },
    Subscribe {
        period_ticks: u32,
    },
    /// Lets this much time pass on the board.
    Listen(Duration),
    /// Requests a report only.
    Look,
    Stop,
}

/// State after a request.
pub(super) struct Report {
    pub(super) state: State,
    /// Time on the link's clock.
    pub(super) now: Duration,
    /// Whether samples of a stream are still to be played.
    pub(super) is_streaming: bool,
    /// Notes on the request.
    pub(super) sentences: Vec<String>,
    pub(super) telemetry: Vec<Telemetry>,
}

/// Why a request was not carried out.
pub(super) enum Trouble {
    /// The Python program was interrupted; the board is disarmed.
    Signal(PyErr),
    /// A value was refused; the board continues as before.
    Parameter(String),
    /// The board refuses, has stopped, or is gone.
    Play(String),
}

impl From<PlayError> for Trouble {
    fn from(error: PlayError) -> Self {
        match error {
            PlayError::Live(error) => Self::Parameter(live_sentence(error)),
            PlayError::NothingPlays => Self::Play("no scene plays: play one first with `play(scene)`".into()),
            error => Self::Play(error.to_string()),
        }
    }
}

/// The sentence of an error, with advice that names a call in Python in place of a control line.
fn live_sentence(error: LiveError) -> String {
    match error {
        LiveError::TriggerOn { layer } => format!(
            "layer {layer:?} is on, and a trigger plays a layer that is off: switch it off first with \
             `set_layer({layer:?}, on=False)`"
        ),
        LiveError::TriggerSilent { layer } => format!(
            "layer {layer:?} has a gain of 0, so a trigger would play nothing: set its gain first with \
             `set_layer({layer:?}, gain=1)`"
        ),
        LiveError::TriggerUnfed { layer } => format!(
            "layer {layer:?} plays a stream, and there is none, so a trigger would play nothing: stream samples first \
             with `stream(samples, sample_hz)`"
        ),
        error => error.to_string(),
    }
}

fn failed(error: impl std::error::Error) -> Trouble {
    Trouble::Play(error.to_string())
}

/// Whether the Python program was interrupted.
#[derive(Clone, Default)]
pub(super) struct Interrupted(Arc<AtomicBool>);

impl Interrupted {
    pub(super) fn set(&self, is_interrupted: bool) {
        self.0.store(is_interrupted, Ordering::Relaxed);
    }

    fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    fn flow(&self) -> ControlFlow<()> {
        break_if(self.is_set())
    }
}

/// The thread's ends of the channels to the program.
type Ends<'a> = (&'a Receiver<Request>, &'a Sender<Result<Report, Trouble>>);

/// Opens the board at a port, and serves requests until the program releases it.
///
/// The outcome of the opening is reported through `opened`. A board that is not simulated is opened only with `arm`.
pub(super) fn run(
    port: &str,
    arm: bool,
    opened: &Sender<Result<Hello, Trouble>>,
    ends: Ends<'_>,
    interrupted: &Interrupted,
) {
    let served = if port == SIMULATOR {
        simulated(opened, ends, interrupted)
    } else {
        real(port, arm, opened, ends, interrupted)
    };
    if let Err(trouble) = served {
        // There is no receiver if the program has ended.
        let _ = opened.send(Err(trouble));
    }
}

/// Serves the simulated board, in virtual time, under a realistic finger that repeats its stroke.
fn simulated(
    opened: &Sender<Result<Hello, Trouble>>,
    ends: Ends<'_>,
    interrupted: &Interrupted,
) -> Result<(), Trouble> {
    let stroke = endless_sweep(BUNDLED_SCREEN_M);
    let config = RigConfig::default().for_drafts().with(&WorldOptions::default());
    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &config, stroke.map_err(failed)?, SEED).map_err(failed)?;
    serve(
        Device::connect(observed(PollingLink::new(RigStream::new(Box::new(rig))))).map_err(failed)?,
        opened,
        ends,
        interrupted,
    );
    Ok(())
}

/// A link that keeps the telemetry until it is taken.
fn observed<L>(link: L) -> Observed<L, Vec<Telemetry>> {
    Observed::new(link, Vec::new(), |kept, message| kept.push(*message))
}

fn real(
    port: &str,
    arm: bool,
    opened: &Sender<Result<Hello, Trouble>>,
    ends: Ends<'_>,
    interrupted: &Interrupted,
) -> Result<(), Trouble> {
    let serial = SerialLink::open(port, DEFAULT_BAUD).map_err(failed)?;
    let device = Device::connect(observed(serial)).map_err(failed)?;
    if !device.may_arm(arm) {
        return Err(Trouble::Play(format!(
            "{port} is a board with an electrode: give arm=True, and press and hold the board's arm switch before \
             `play`, to let it drive hundreds of volts"
        )));
    }
    serve(device, opened, ends, interrupted);
    Ok(())
}

/// Carries out requests until the program releases the board, then disarms it.
fn serve<L: Link>(
    mut device: Device<Observed<L, Vec<Telemetry>>>,
    opened: &Sender<Result<Hello, Trouble>>,
    (requests, replies): Ends<'_>,
    interrupted: &Interrupted,
) {
    let watched = interrupted.clone();
    device.while_waiting(move |waiting| break_if(waiting.may_break_off() && watched.is_set()));
    let hello = *device.hello();
    let mut player = Player::new(device);
    let mut is_listening = opened.send(Ok(hello)).is_ok();
    while is_listening && let Ok(request) = requests.recv() {
        let reply = carry_out(&mut player, request, interrupted).map_err(Trouble::from);
        is_listening = replies.send(reply.map(|sentences| report(&mut player, sentences))).is_ok();
    }
    // No caller is left to report an error to; the board's host timeout sets the output to zero.
    let _ = player.stop();
}

fn carry_out<L: Link>(
    player: &mut Player<Observed<L, Vec<Telemetry>>>,
    request: Request,
    interrupted: &Interrupted,
) -> Result<Vec<String>, PlayError> {
    if !matches!(request, Request::Stop | Request::Play(_)) {
        // Handles the messages that the board has sent: it may have stopped.
        player.device_mut().keep_alive()?;
        match player.step(Duration::ZERO) {
            Err(PlayError::Stopped(_)) if matches!(request, Request::Look) => {}
            stepped => stepped.map(|_| ())?,
        }
    }
    match request {
        Request::Look => {}
        Request::Play(program) => player.start(*program, 0, &mut |_| interrupted.flow())?,
        Request::Replace(program) => return Ok(replaced(player.replace(*program)?)),
        Request::SetLayer { layer, on, gain } => {
            return Ok(player.change_layer(&layer, on, gain)?.notice().into_iter().collect());
        }
        Request::Trigger { layer, duration_s } => {
            return Ok(player.trigger(&layer, duration_s)?.notice().into_iter().collect());
        }
        Request::Stream { samples, sample_hz } => player.stream(Feed::of(samples, sample_hz))?,
        Request::Subscribe { period_ticks } => player.device_mut().subscribe(period_ticks)?,
        Request::Listen(duration) => listen(player, duration)?,
        Request::Stop => player.stop()?,
    }
    Ok(Vec::new())
}

/// Lets `duration` pass on the board.
fn listen<L: Link>(player: &mut Player<Observed<L, Vec<Telemetry>>>, duration: Duration) -> Result<(), PlayError> {
    let end = player.device().now() + duration;
    loop {
        let left = end.saturating_sub(player.device().now());
        player.step(left)?;
        if left.is_zero() {
            return Ok(());
        }
    }
}

fn replaced(Replaced { faded_out, dropped_gains }: Replaced) -> Vec<String> {
    let faded_out = faded_out.then(|| {
        "the pictures of both scenes do not fit on the board together: the output faded out meanwhile".to_owned()
    });
    let dropped =
        dropped_gains.map(|clamped| format!("gains are reset to the scene's: with the gains that were set, {clamped}"));
    faded_out.into_iter().chain(dropped).collect()
}

fn report<L: Link>(player: &mut Player<Observed<L, Vec<Telemetry>>>, sentences: Vec<String>) -> Report {
    let telemetry = std::mem::take(player.recorder_mut());
    let (state, _) = player.state();
    let now = player.device().now();
    Report { state, now, is_streaming: player.is_streaming(), sentences, telemetry }
}
