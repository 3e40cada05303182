//! The host of a board: plays scenes on it and changes their layers, over any byte stream.

use std::time::Duration;

use frixel_driver::{Bitmap, ByteStream, ControlError, ControlLine, Device, DeviceError, Event, PollingLink, Upload};
use frixel_hil_sim::{StrokeError, WorldError};
use frixel_scene::{LayerError, Program};
use frixel_wire::fault::{Fault, State};
use frixel_wire::hello::Hello;
use frixel_wire::message::{Refusal, Telemetry};
use thiserror::Error;

use crate::program::{ProgramError, compiled};
use crate::request::Request;

/// Why a request of the page was not carried out.
#[derive(Debug, Error)]
pub enum HostError {
    /// The scene has mistakes.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// The board, or the line to it, failed.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The board refuses a scene that the compiler accepts.
    #[error("the board does not take this scene: {0}")]
    Refused(DeviceError),
    /// The world of the simulator could not be built.
    #[error(transparent)]
    World(WorldError),
    /// The world's finger could not be built.
    #[error(transparent)]
    Stroke(StrokeError),
    /// A control line has a mistake.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// A control line that a page does not carry out.
    #[error("`{line}` is not carried out in a page: write layer or trigger")]
    NotInPage {
        /// The line.
        line: String,
    },
    /// The layer cannot be changed.
    #[error(transparent)]
    Layer(#[from] LayerError),
    /// No scene plays whose layers could be changed.
    #[error("no scene plays: play one, then change its layers")]
    NothingPlays,
    /// The scene extrapolates from a measured finger, which only a simulator plays.
    #[error("{warning}: only the simulator plays it like this")]
    Unmeasured {
        /// The compiler's warning.
        warning: String,
    },
    /// The scene would play on after the page is gone, which only a simulator may.
    #[error("this scene plays without its host, so a board would drive on without this page: leave `autonomous` out")]
    Autonomous,
    /// There is no board.
    #[error("no board is connected: connect one, or use the simulator")]
    NoBoard,
}

/// Is told what the board plays, to compare with it.
pub(crate) trait SceneListener {
    /// From now on the board plays this program.
    fn scene_replaced(&mut self, program: &Program);
    /// From now on the layer with this record number is on or off, with this gain.
    fn layer_changed(&mut self, layer: u8, is_on: bool, gain: f32);
}

/// A board, and the scene that plays on it.
pub(crate) struct Host<S: ByteStream> {
    device: Device<PollingLink<S>>,
    state: State,
    fault: Option<Fault>,
    playing: Option<Playing>,
    telemetry: Vec<Telemetry>,
}

/// The scene on the board.
struct Playing {
    program: Program,
    /// Whether each record is on, and its gain.
    settings: Vec<(bool, f32)>,
    /// Records to switch off, and when, on the link's clock.
    triggered: Vec<(u8, Duration)>,
}

impl<S: ByteStream + SceneListener> Host<S> {
    /// Connects to a board, and disarms it. A board with a latched fault drives nothing; it stays as it is.
    pub(crate) fn connect(stream: S) -> Result<Self, DeviceError> {
        let mut device = Device::connect(PollingLink::new(stream))?;
        let state = if device.hello().state == State::Faulted {
            State::Faulted
        } else {
            device.disarm()?;
            State::Disarmed
        };
        Ok(Self { device, state, fault: None, playing: None, telemetry: Vec::new() })
    }

    /// The board's hello.
    pub(crate) fn hello(&self) -> &Hello {
        self.device.hello()
    }

    /// The line to the board.
    pub(crate) fn stream_mut(&mut self) -> &mut S {
        self.device.link_mut().stream_mut()
    }

    /// State and latched fault, as the board reported them last.
    pub(crate) fn state(&self) -> (State, Option<Fault>) {
        (self.state, self.fault)
    }

    /// The telemetry since the last call.
    pub(crate) fn take_telemetry(&mut self) -> Vec<Telemetry> {
        std::mem::take(&mut self.telemetry)
    }

    /// Friction of the loaded scene's finger at no voltage, N; 0 without a scene.
    pub(crate) fn natural_friction_n(&self) -> f64 {
        self.playing.as_ref().map_or(0.0, |playing| playing.program.reach.natural_friction_n)
    }

    /// Compiles a scene for the board and puts it there. A scene that plays is replaced between two ticks. If the scene
    /// has mistakes or the board refuses it, the one before plays on.
    pub(crate) fn load(&mut self, request: &Request) -> Result<&Program, HostError> {
        let Hello { limits, tick_hz, board, .. } = *self.device.hello();
        let program = compiled(request, &limits, tick_hz)?;
        if program.header.autonomous && !board.is_simulated() {
            return Err(HostError::Autonomous);
        }
        if let Some(warning) = program.warnings.iter().find(|warning| warning.is_refused_by_boards())
            && !board.is_simulated()
        {
            return Err(HostError::Unmeasured { warning: warning.to_string() });
        }
        self.replace(program)
    }

    /// Puts a program on the board, as [`Self::load`] does.
    pub(crate) fn replace(&mut self, program: Program) -> Result<&Program, HostError> {
        match upload(&mut self.device, &program) {
            Err(DeviceError::Refused { refusal: Refusal::BitmapPoolFull { .. }, .. }) => self.load_alone(&program)?,
            Err(error @ DeviceError::Refused { .. }) => return Err(HostError::Refused(error)),
            loaded => loaded?,
        }
        self.stream_mut().scene_replaced(&program);
        let settings = program.records.iter().map(|record| (true, record.gain)).collect();
        Ok(&self.playing.insert(Playing { program, settings, triggered: Vec::new() }).program)
    }

    /// Loads a scene whose pictures do not fit on the board beside those of the one before: an empty scene plays until
    /// the new one is there. If the board refuses it, the one before is put back.
    fn load_alone(&mut self, program: &Program) -> Result<(), HostError> {
        upload(&mut self.device, &program.without_layers())?;
        let loaded = upload(&mut self.device, program);
        if let (Err(DeviceError::Refused { .. }), Some(before)) = (&loaded, &self.playing) {
            upload(&mut self.device, &before.program)?;
        }
        loaded.map_err(HostError::Refused)
    }

    /// Arms the board if it is disarmed, and plays the loaded scene if it does not play.
    pub(crate) fn arm_and_play(&mut self) -> Result<(), DeviceError> {
        if self.state == State::Disarmed {
            self.device.arm()?;
            self.state = State::Armed;
        }
        if self.state == State::Armed {
            self.device.play()?;
            self.state = State::Active;
        }
        Ok(())
    }

    /// Sets the output to zero and disarms the board. With a latched fault the output is zero already.
    pub(crate) fn stop(&mut self) -> Result<(), DeviceError> {
        if self.state != State::Faulted {
            self.device.disarm()?;
            self.state = State::Disarmed;
        }
        Ok(())
    }

    /// Clears a latched fault whose cause is gone.
    pub(crate) fn clear_fault(&mut self) -> Result<(), DeviceError> {
        self.device.clear_fault()?;
        (self.state, self.fault) = (State::Disarmed, None);
        Ok(())
    }

    /// Requests telemetry once every so many ticks.
    pub(crate) fn subscribe(&mut self, period_ticks: u32) -> Result<(), DeviceError> {
        self.device.subscribe(period_ticks)
    }

    /// Carries out a control line: `layer` or `trigger`, in the words of [`ControlLine`].
    pub(crate) fn control(&mut self, line: &str) -> Result<(), HostError> {
        let (layer, on, gain, duration_s) = match ControlLine::parse(line)? {
            None => return Ok(()),
            Some(ControlLine::Layer { layer, on, gain }) => (layer, on, gain, None),
            Some(ControlLine::Trigger { layer, duration_s }) => (layer, Some(true), None, Some(duration_s)),
            Some(_) => return Err(HostError::NotInPage { line: line.to_owned() }),
        };
        let playing = self.playing.as_mut().ok_or(HostError::NothingPlays)?;
        let record = playing.program.layers.record(&layer)?;
        playing.triggered.retain(|(triggered, _)| *triggered != record);
        if let Some(duration_s) = duration_s {
            playing.triggered.push((record, self.device.now() + Duration::from_secs_f64(duration_s)));
        }
        Ok(self.set_layer(record, on, gain)?)
    }

    fn set_layer(&mut self, record: u8, on: Option<bool>, gain: Option<f32>) -> Result<(), DeviceError> {
        let settings = self.playing.as_mut().and_then(|playing| playing.settings.get_mut(usize::from(record)));
        let Some(setting) = settings else { return Ok(()) };
        let (is_on, gain) = (on.unwrap_or(setting.0), gain.unwrap_or(setting.1));
        self.device.set_layer(record, is_on, gain)?;
        *setting = (is_on, gain);
        self.stream_mut().layer_changed(record, is_on, gain);
        Ok(())
    }

    /// Keeps the board alive for `duration` on the link's clock, and ends triggers whose time has come.
    pub(crate) fn wait(&mut self, duration: Duration) -> Result<(), DeviceError> {
        let end = self.device.now() + duration;
        loop {
            let now = self.device.now();
            while let Some(record) = self.trigger_ended(now) {
                self.set_layer(record, Some(false), None)?;
            }
            if now >= end {
                return Ok(());
            }
            let triggered = self.playing.iter().flat_map(|playing| &playing.triggered);
            let wake_at = triggered.map(|(_, off_at)| *off_at).fold(end, Duration::min);
            self.listen(wake_at.saturating_sub(now))?;
        }
    }

    fn trigger_ended(&mut self, now: Duration) -> Option<u8> {
        let triggered = &mut self.playing.as_mut()?.triggered;
        let index = triggered.iter().position(|(_, off_at)| *off_at <= now)?;
        Some(triggered.swap_remove(index).0)
    }

    fn listen(&mut self, duration: Duration) -> Result<(), DeviceError> {
        let Self { device, state, fault, telemetry, .. } = self;
        device.wait(duration, &mut |event| match event {
            Event::Telemetry(message) => telemetry.push(message),
            Event::StateChanged { state: now, fault: latched, .. } => (*state, *fault) = (now, latched),
        })
    }
}

/// Uploads a program and commits it.
pub(crate) fn upload<S: ByteStream>(device: &mut Device<PollingLink<S>>, program: &Program) -> Result<(), DeviceError> {
    let scene = program.scene_bytes_for(device.hello().protocol);
    let bitmaps = program.bitmaps.iter().map(|bitmap| Bitmap {
        crc32: bitmap.crc32,
        width: bitmap.width,
        height: bitmap.height,
        samples: &bitmap.samples,
    });
    let upload = Upload { scene: &scene, bitmaps: bitmaps.collect() };
    device.upload(&upload, &mut |_| {})?;
    device.commit(upload.scene_crc32())
}
