//! The host of a board: plays scenes on it and changes their layers, over any byte stream.

use std::time::Duration;

use frixel_driver::{
    Bitmap, ByteStream, ControlError, ControlLine, Device, DeviceError, Event, Link as _, PollingLink, Upload,
};
use frixel_hil_sim::{StrokeError, WorldError};
use frixel_scene::{LayerChange, LiveError, LiveLayers, Program};
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
    Live(#[from] LiveError),
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

impl HostError {
    /// Whether the board can no longer be talked to over this line: it is silent, gone or restarted.
    pub(crate) fn is_link_lost(&self) -> bool {
        let Self::Device(error) = self else { return false };
        matches!(
            error,
            DeviceError::NoHello { .. }
                | DeviceError::Silent { .. }
                | DeviceError::Vanished { .. }
                | DeviceError::Restarted { .. }
                | DeviceError::TelemetryBackwards { .. }
        )
    }
}

/// Longer than any host is connected: pings with this period are never sent.
const NEVER: Duration = Duration::from_hours(1);

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
    /// On the link's clock.
    layers: LiveLayers,
}

impl Playing {
    /// A program whose layers are as its scene sets them.
    fn new(program: Program) -> Self {
        Self { layers: LiveLayers::new(&program), program }
    }
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
            loaded => loaded.map_err(refused)?,
        }
        Ok(self.set_playing(program))
    }

    /// Loads a scene whose pictures do not fit on the board beside those of the one before: an empty scene plays until
    /// the new one is there. If the board refuses it, the one before is put back. After any other error the empty scene
    /// stays.
    fn load_alone(&mut self, program: &Program) -> Result<(), HostError> {
        let empty = program.without_layers();
        upload(&mut self.device, &empty).map_err(refused)?;
        self.stream_mut().scene_replaced(&empty);
        let before = self.playing.take();
        let loaded = upload(&mut self.device, program);
        if let (Err(DeviceError::Refused { .. }), Some(before)) = (&loaded, before) {
            upload(&mut self.device, &before.program)?;
            self.set_playing(before.program);
        }
        loaded.map_err(refused)
    }

    /// The board plays this program from now on, its layers as the scene sets them.
    fn set_playing(&mut self, program: Program) -> &Program {
        self.stream_mut().scene_replaced(&program);
        &self.playing.insert(Playing::new(program)).program
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
    ///
    /// Nothing but the command is sent until the board has answered, so a board that it does not reach falls silent by
    /// its host timeout.
    pub(crate) fn stop(&mut self) -> Result<(), DeviceError> {
        if self.state == State::Faulted {
            return Ok(());
        }
        self.device.link_mut().keep_alive(NEVER);
        (self.state, self.fault) = match self.device.disarm() {
            // The board has latched a fault that this host has not heard of.
            Err(DeviceError::Refused { refusal: Refusal::Faulted(fault), .. }) => (State::Faulted, Some(fault)),
            Err(DeviceError::Refused { refusal: Refusal::WrongState(State::Faulted), .. }) => (State::Faulted, None),
            disarmed => disarmed.map(|()| (State::Disarmed, None))?,
        };
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

    /// Carries out a control line: `layer` or `trigger`, in the words of [`ControlLine`]. Returns a sentence on what
    /// is clamped from now on.
    pub(crate) fn control(&mut self, line: &str) -> Result<Option<String>, HostError> {
        let Some(words) = ControlLine::parse(line)? else { return Ok(None) };
        let now = self.device.now();
        let Playing { program, layers } = self.playing.as_mut().ok_or(HostError::NothingPlays)?;
        let change = match words {
            ControlLine::Layer { layer, on, gain } => layers.change(program, &layer, on, gain)?,
            ControlLine::Trigger { layer, duration_s } => layers.trigger(program, &layer, now, duration_s)?,
            _ => return Err(HostError::NotInPage { line: line.to_owned() }),
        };
        self.set_layer(&change)?;
        Ok(change.notice())
    }

    fn set_layer(&mut self, change: &LayerChange) -> Result<(), DeviceError> {
        let LayerChange { record, setting, .. } = change;
        self.device.set_layer(*record, setting.on, setting.gain)?;
        self.stream_mut().layer_changed(*record, setting.on, setting.gain);
        Ok(())
    }

    /// Keeps the board alive for `duration` on the link's clock, and ends triggers whose time has come.
    pub(crate) fn wait(&mut self, duration: Duration) -> Result<(), DeviceError> {
        let end = self.device.now() + duration;
        loop {
            let now = self.device.now();
            while let Some(change) = self.playing.as_mut().and_then(|playing| playing.layers.end_trigger(now)) {
                self.set_layer(&change)?;
            }
            if now >= end {
                return Ok(());
            }
            let next_end = self.playing.as_ref().and_then(|playing| playing.layers.next_end());
            let wake_at = next_end.map_or(end, |next_end| next_end.min(end));
            self.listen(wake_at.saturating_sub(now))?;
        }
    }

    fn listen(&mut self, duration: Duration) -> Result<(), DeviceError> {
        let Self { device, state, fault, telemetry, .. } = self;
        device.wait(duration, &mut |event| match event {
            Event::Telemetry(message) => telemetry.push(message),
            Event::StateChanged { state: now, fault: latched, .. } => (*state, *fault) = (now, latched),
        })
    }
}

/// The error of a load: the board has reasons against the scene, or the line has failed.
fn refused(error: DeviceError) -> HostError {
    if matches!(error, DeviceError::Refused { .. }) { HostError::Refused(error) } else { HostError::Device(error) }
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

#[cfg(test)]
mod tests {
    use frixel_driver::LinkClosed;
    use frixel_hil_sim::{BoardMemory, RigConfig};

    use super::*;
    use crate::rig_stream::RigStream;

    const BRICK: &[u8] = include_bytes!("../../../scenes/brick.toml");
    const LEATHER: &[u8] = include_bytes!("../../../scenes/leather.toml");

    /// The rig at the end of a line that may be cut.
    struct Line<'a> {
        rig: RigStream<'a>,
        /// Bytes to the board until the line is dead, in both directions.
        left: usize,
        /// Times and lengths of what was written.
        written: Vec<(Duration, usize)>,
    }

    impl ByteStream for Line<'_> {
        fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
            self.written.push((self.now(), bytes.len()));
            let passed = bytes.len().min(self.left);
            self.left -= passed;
            self.rig.write(&bytes[..passed])
        }

        fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
            let end = self.now() + wait;
            let len = buffer.len();
            self.rig.read(buffer, wait)?;
            if self.left == 0 {
                buffer.truncate(len);
                while self.now() < end {
                    self.rig.step();
                }
            }
            Ok(())
        }

        fn now(&self) -> Duration {
            self.rig.now()
        }

        fn name(&self) -> &str {
            self.rig.name()
        }
    }

    impl SceneListener for Line<'_> {
        fn scene_replaced(&mut self, program: &Program) {
            self.rig.scene_replaced(program);
        }

        fn layer_changed(&mut self, layer: u8, is_on: bool, gain: f32) {
            self.rig.layer_changed(layer, is_on, gain);
        }
    }

    fn host(memory: &mut BoardMemory) -> Host<Line<'_>> {
        let rig = RigStream::new(memory, &RigConfig::default(), 1).unwrap();
        Host::connect(Line { rig, left: usize::MAX, written: Vec::new() }).unwrap()
    }

    fn request(scene: &[u8]) -> Request {
        let files = [
            ("a.toml".to_owned(), scene.to_owned()),
            ("textures/brick.png".to_owned(), include_bytes!("../../../scenes/textures/brick.png").to_vec()),
            ("textures/leather.png".to_owned(), include_bytes!("../../../scenes/textures/leather.png").to_vec()),
        ];
        Request { entry: "a.toml".to_owned(), files: files.into(), ..Request::default() }
    }

    fn written(host: &mut Host<Line<'_>>) -> usize {
        host.stream_mut().written.iter().map(|(_, len)| len).sum()
    }

    /// The pictures of both scenes do not fit on a board together that plays one of them.
    #[test]
    fn a_line_that_dies_while_pictures_are_replaced_is_a_lost_link() {
        let mut memory = BoardMemory::new();
        let mut whole = host(&mut memory);
        whole.load(&request(BRICK)).unwrap();
        whole.arm_and_play().unwrap();
        let before = written(&mut whole);
        whole.load(&request(LEATHER)).unwrap();
        let all = written(&mut whole) - before;
        for part in 1..10 {
            let mut memory = BoardMemory::new();
            let mut host = host(&mut memory);
            host.load(&request(BRICK)).unwrap();
            host.arm_and_play().unwrap();
            host.stream_mut().left = all * part / 10;
            let error = host.load(&request(LEATHER)).unwrap_err();
            assert!(error.is_link_lost(), "{part}: {error:?}");
        }
    }

    /// After the pictures are replaced in part, no layer of a scene that is gone can be changed.
    #[test]
    fn an_upload_that_ends_while_the_empty_scene_plays_leaves_no_scene() {
        let mut memory = BoardMemory::new();
        let mut host = host(&mut memory);
        host.load(&request(BRICK)).unwrap();
        host.arm_and_play().unwrap();
        host.stream_mut().left = 20_000;
        assert!(host.load(&request(LEATHER)).is_err());
        assert!(host.playing.is_none());
        assert!(matches!(host.control("layer 1 off"), Err(HostError::NothingPlays)));
    }

    /// The board refuses to be disarmed while a fault is latched: its output is zero already.
    #[test]
    fn a_stop_after_a_fault_that_was_not_heard_of_is_no_error() {
        let mut memory = BoardMemory::new();
        let mut host = host(&mut memory);
        host.load(&request(LEATHER)).unwrap();
        host.arm_and_play().unwrap();
        let rig = &mut host.stream_mut().rig;
        let now = rig.tick();
        rig.world_mut().schedule_amplifier_fault(now..now + 400);
        while rig.state().0 != State::Faulted {
            rig.step();
        }
        assert_eq!(host.state, State::Active);
        host.stop().unwrap();
        assert_eq!(host.state, State::Faulted);
        assert!(host.fault.is_some());
    }

    #[test]
    fn a_stop_that_does_not_arrive_ends_the_pings() {
        let mut memory = BoardMemory::new();
        let mut host = host(&mut memory);
        host.load(&request(LEATHER)).unwrap();
        host.arm_and_play().unwrap();
        host.wait(Duration::from_millis(100)).unwrap();
        host.stream_mut().left = 0;
        let begin = host.device.now();
        assert!(HostError::from(host.stop().unwrap_err()).is_link_lost());
        // Only the command and its repetitions, each 250 ms after the one before.
        let later = host.stream_mut().written.iter().filter(|(at, _)| *at >= begin);
        assert!(later.count() <= 3);
        assert_eq!(host.stream_mut().rig.state().0, State::Disarmed, "by the host timeout");
    }
}
