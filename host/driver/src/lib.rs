//! Talking to a board: open a port, say hello, upload a scene, play it, hear what the board does.
//!
//! - [`Device`] runs the protocol. Each of its calls has a deadline in the link's time and ends with an answer or an error; an absent, silent
//!   or unplugged board is known within a second.
//! - [`Link`] is what carries the bytes: [`SerialLink`] for a real port, or a simulated board with virtual time.
//! - [`ports`] lists the serial ports of this machine.
//!
//! ```no_run
//! use std::time::Duration;
//! use frixel_driver::{DEFAULT_BAUD, Device, Event, SerialLink, Upload};
//!
//! # fn play(scene: &[u8]) -> Result<(), frixel_driver::DeviceError> {
//! let mut board = Device::connect(SerialLink::open("/dev/ttyACM0", DEFAULT_BAUD)?)?;
//! let upload = Upload { scene, bitmaps: Vec::new() };
//! board.upload(&upload, &mut |progress| println!("{} of {} bytes", progress.done_bytes, progress.total_bytes))?;
//! board.commit(upload.scene_crc32())?;
//! board.arm()?;
//! board.play()?;
//! board.subscribe(400)?;
//! board.wait(Duration::from_secs(10), &mut |event| {
//!     if let Event::Telemetry(telemetry) = event {
//!         println!("{} V", telemetry.voltage_v_rms);
//!     }
//! })?;
//! board.stop()
//! # }
//! ```
#![forbid(unsafe_code)]

mod command;
mod credit;
mod error;
mod exchange;
mod hello;
mod link;
mod ports;
mod serial;
mod stream;
mod upload;

use std::time::Duration;

use frixel_layers::Scene;
use frixel_wire::fault::{Fault, Flags, State};
use frixel_wire::frame::Decoder;
use frixel_wire::hello::Hello;
use frixel_wire::message::{Command, Telemetry};

use command::name_of;
use exchange::{ANSWER_TIMEOUT, Exchange};
use upload::UploadCounts;

pub use error::{DeviceError, LinkClosed, PortError};
pub use link::{LEASH, Link, Written};
pub use ports::{PortInfo, UsbDevice, ports};
pub use serial::{DEFAULT_BAUD, SerialLink};
pub use stream::{StreamSettings, StreamStatus};
pub use upload::{Bitmap, Progress, Upload};

/// Longest time between pings when nothing else is sent: a quarter of the host timeout that a scene has when it names none.
const PING_PERIOD_MAX: Duration = Duration::from_millis(60);
/// Shortest time between pings: a quarter of the shortest host timeout, 20 ms. Safe for any scene that a board may hold.
const PING_PERIOD_MIN: Duration = Duration::from_millis(5);

/// A board that has said hello.
///
/// **Pings.** A board that is armed goes to Disarmed, output zero, when it has not heard of its host for the scene's host timeout. Pings go out by
/// themselves, often enough for any host timeout, or for that of the scene that this value has committed; but only for an application that is
/// there: [`LEASH`] after the last call that says something to the board or listens to it they end, and the board goes to Disarmed. So an
/// application that hangs, or that has forgotten the board, does not keep it playing. A call that waits counts for as long as it waits. An application
/// that plays one thing for long and has nothing to say calls [`Self::wait`], or in a loop of its own [`Self::still_here`], several times a second:
/// from the loop that would notice that it is to stop, never from a thread or a timer that would go on without it.
///
/// Dropping a value that has armed or played stops and disarms the board, as far as the link still carries anything; the board puts
/// its output to zero in any case once the pings have stopped.
pub struct Device<L: Link> {
    exchange: Exchange<L>,
    hello: Hello,
    uploads: UploadCounts,
    /// CRC-32 of the scene that was uploaded last, and the time between pings that suits it.
    uploaded: Option<(u32, Duration)>,
    /// Time between pings that suits the board's scene, if that was committed here.
    committed: Option<Duration>,
    /// The board may be armed or active, by this value or by a scene that goes on without a host.
    armed: bool,
    /// The stream under way.
    stream: Option<stream::Sent>,
}

/// What a board tells unasked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// What the board did at one tick; see [`Device::subscribe`].
    Telemetry(Telemetry),
    /// The state changed without a command.
    StateChanged {
        /// The state now.
        state: State,
        /// The fault, if one is latched.
        fault: Option<Fault>,
        /// Why, where it is not a fault.
        flags: Flags,
    },
}

/// What went over the line since the link was opened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Frames that the host sent, pings included.
    pub frames_sent: u64,
    /// Frames that arrived damaged: those of the board, and chunks that it asked for again.
    pub frames_rejected: u64,
    /// Bytes of scenes and bitmaps that were uploaded, each counted once.
    pub payload_bytes: u64,
    /// All bytes that the host sent.
    pub wire_bytes: u64,
}

impl<L: Link> Device<L> {
    /// Says hello, checks that both sides speak the same protocol, and starts the pings. Takes at most 0.75 s when nobody answers.
    ///
    /// What another client had armed or played is disarmed by the hello; only a playing scene that goes on without a host plays on.
    pub fn connect(mut link: L) -> Result<Self, DeviceError> {
        let mut decoder = Decoder::new();
        let hello = hello::greet(&mut link, &mut decoder)?;
        let mut exchange = Exchange::new(link, decoder, &hello);
        // Its answer settles the credit, should one of several hello requests have been lost.
        exchange.request(Command::Ping)?;
        let armed = matches!(hello.state, State::Armed | State::Active);
        let uploads = UploadCounts::default();
        let mut device = Self { exchange, hello, uploads, uploaded: None, committed: None, armed, stream: None };
        device.pace_pings()?;
        Ok(device)
    }

    /// What the board said of itself when it was connected.
    pub fn hello(&self) -> &Hello {
        &self.hello
    }

    /// Uploads bitmaps, those that the board holds already left out, and the scene. What plays does not change before [`Self::commit`].
    pub fn upload(&mut self, upload: &Upload, progress: &mut dyn FnMut(Progress)) -> Result<(), DeviceError> {
        upload.check()?;
        // Bytes that are no scene are refused by the board, in its own words.
        let scene = Scene::parse(upload.scene).ok();
        self.uploaded = scene.map(|scene| (upload.scene_crc32(), ping_period(scene.header().host_timeout_s)));
        upload::send(&mut self.exchange, upload, &mut self.uploads, progress)
    }

    /// Makes the uploaded scene the one that plays. `scene_crc32` says which one is meant: [`Upload::scene_crc32`].
    ///
    /// From here on the pings follow its host timeout.
    pub fn commit(&mut self, scene_crc32: u32) -> Result<(), DeviceError> {
        // Until the board has answered, either scene's timeout may be the one that counts.
        self.committed = None;
        self.pace_pings()?;
        self.request(Command::Commit { crc32: scene_crc32 })?;
        self.committed = self.uploaded.filter(|(crc32, _)| *crc32 == scene_crc32).map(|(_, period)| period);
        self.pace_pings()
    }

    /// Disarmed to armed: ready to play, output zero.
    pub fn arm(&mut self) -> Result<(), DeviceError> {
        self.before_arming()?;
        self.request(Command::Arm)
    }

    /// Output to zero, from any state.
    pub fn disarm(&mut self) -> Result<(), DeviceError> {
        self.request(Command::Disarm)?;
        self.armed = false;
        self.pace_pings()
    }

    /// Armed to active: the committed scene plays.
    pub fn play(&mut self) -> Result<(), DeviceError> {
        self.before_arming()?;
        self.request(Command::Play)
    }

    /// Active to armed: output zero.
    pub fn stop(&mut self) -> Result<(), DeviceError> {
        self.request(Command::Stop)
    }

    /// While playing: switches a layer of the committed scene on or off, and sets the factor on its friction, -100 to 100, in place of its
    /// gain in the scene. It acts at the next tick, and holds until the next commit.
    ///
    /// `layer` is the number of the layer's record, from zero. A friction that gets out of reach is clamped, which telemetry's flags tell.
    pub fn set_layer(&mut self, layer: u8, on: bool, gain: f32) -> Result<(), DeviceError> {
        self.request(Command::SetLayer { layer, on, gain })
    }

    /// Faulted to disarmed, when the cause is gone.
    pub fn clear_fault(&mut self) -> Result<(), DeviceError> {
        self.request(Command::ClearFault)
    }

    /// Asks whether the board is there.
    pub fn ping(&mut self) -> Result<(), DeviceError> {
        self.request(Command::Ping)
    }

    /// Asks for telemetry once every `period_ticks` ticks of the board; zero ends it. It comes through [`Self::wait`].
    pub fn subscribe(&mut self, period_ticks: u32) -> Result<(), DeviceError> {
        self.request(Command::Subscribe { period_ticks })
    }

    /// Lets `duration` of the link's time pass, and hands over what the board tells meanwhile and what it told before.
    ///
    /// Ends early with [`DeviceError::Silent`] when not even the pings are answered.
    pub fn wait(&mut self, duration: Duration, on_event: &mut dyn FnMut(Event)) -> Result<(), DeviceError> {
        let end = self.exchange.now() + duration;
        loop {
            while let Some(event) = self.exchange.next_event() {
                on_event(event);
            }
            let now = self.exchange.now();
            if now >= end {
                return Ok(());
            }
            self.exchange.listen(end.saturating_sub(now))?;
        }
    }

    /// Says that the application is there and means what plays: the pings go on for another [`LEASH`]. Takes what the board has told meanwhile, for the next
    /// [`Self::wait`] to hand over; does not wait itself, and so does not notice a board that has fallen silent.
    ///
    /// For a program with a loop of its own that holds a scene and has no other call to make.
    ///
    /// ```no_run
    /// # use frixel_driver::{Device, DeviceError, Link};
    /// # fn draw_a_frame() -> bool { false }
    /// # fn run<L: Link>(board: &mut Device<L>) -> Result<(), DeviceError> {
    /// while draw_a_frame() {
    ///     board.still_here()?;
    /// }
    /// board.stop()
    /// # }
    /// ```
    pub fn still_here(&mut self) -> Result<(), DeviceError> {
        self.exchange.receive(Duration::ZERO, name_of(&Command::Ping))
    }

    /// What went over the line so far.
    pub fn counters(&self) -> Counters {
        let written = self.exchange.link().written();
        Counters {
            frames_sent: written.frames,
            frames_rejected: u64::from(self.exchange.frames_rejected()) + self.uploads.chunks_lost,
            payload_bytes: self.uploads.payload_bytes,
            wire_bytes: written.bytes,
        }
    }

    /// The link, for what its own type can do: [`Device`] goes on using it.
    pub fn link_mut(&mut self) -> &mut L {
        self.exchange.link_mut()
    }

    /// Gives the link back, as it is: its pings go on to the end of their leash, and after [`Self::arm`] or [`Self::play`] it stops and disarms the board when it is
    /// dropped.
    pub fn into_link(self) -> L {
        self.exchange.into_link()
    }

    /// What this value sets going it also ends, and keeps company; what it only looked at it leaves as it is.
    fn before_arming(&mut self) -> Result<(), DeviceError> {
        self.exchange.say_farewell_with(&[Command::Stop, Command::Disarm])?;
        self.armed = true;
        self.pace_pings()
    }

    /// A board may hold a scene whose host timeout is not known here, as before a commit is answered.
    fn pace_pings(&mut self) -> Result<(), DeviceError> {
        let period = if self.armed { self.committed.unwrap_or(PING_PERIOD_MIN) } else { PING_PERIOD_MAX };
        self.exchange.ping_every(period)
    }

    fn request(&mut self, command: Command) -> Result<(), DeviceError> {
        self.exchange.request(command).map(|_| ())
    }
}

/// A quarter of the host timeout, within what makes sense for any timeout that a board takes.
fn ping_period(host_timeout_s: f32) -> Duration {
    let quarter = Duration::try_from_secs_f32(host_timeout_s / 4.0).unwrap_or(PING_PERIOD_MAX);
    quarter.clamp(PING_PERIOD_MIN, PING_PERIOD_MAX)
}

const _: () = assert!(ANSWER_TIMEOUT.as_millis() < 1000);
