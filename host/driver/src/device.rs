//! The [`Device`]: a board at the other end of a link, with one method for each command.

mod stream;

use std::ops::ControlFlow;
use std::time::Duration;

use frixel_layers::{Scene, feature_names, features_of};
use frixel_wire::fault::{Fault, Flags, State};
use frixel_wire::frame::Decoder;
use frixel_wire::hello::{Hello, feature};
use frixel_wire::message::{Accepted, Command, FAULT_TEXT_MAX_LEN, FAULT_TEXT_PIECE_LEN, Telemetry, TickTimes};

use super::command::name_of;
use super::error::DeviceError;
use super::exchange::{ANSWER_TIMEOUT, Exchange, Waiting};
use super::handshake::request_hello;
use super::link::Link;
use super::upload::{self, Progress, Upload, UploadCounts};
use stream::StreamProgress;

pub use stream::{StreamSettings, StreamStatus};

/// Longest time between pings when nothing else is sent: just under a quarter of the default host timeout of 250 ms.
const PING_PERIOD_MAX: Duration = Duration::from_millis(60);
/// Shortest time between pings: a quarter of the shortest host timeout, 20 ms. Safe for every scene.
const PING_PERIOD_MIN: Duration = Duration::from_millis(5);

/// A board that has answered the hello.
///
/// **Pings.** An armed board that receives nothing for the scene's host timeout disarms itself and sets its output to
/// zero. The link therefore pings the board. Its ping period suits the host timeout of the scene committed by this
/// value, or the shortest host timeout if it has committed none. Pings end
/// [`KEEP_ALIVE_TIMEOUT`](crate::KEEP_ALIVE_TIMEOUT) after the application's last call that sends or receives, so an
/// application that hangs does not keep a board playing. A call that waits keeps the pings going.
/// An application that plays one scene for a long time calls [`Self::wait`] or [`Self::keep_alive`] several times a
/// second. Make these calls in the loop that reacts to a request to stop, never in a thread or timer that would
/// continue without that loop. [`KeepAlive`](crate::KeepAlive) describes the pings to a board that does not answer.
///
/// Dropping a value that has armed the board stops and disarms the board if the link still works. Otherwise the board
/// sets its output to zero once the pings have stopped.
pub struct Device<L: Link> {
    exchange: Exchange<L>,
    hello: Hello,
    uploads: UploadCounts,
    /// CRC-32 of the scene uploaded last, and the ping period for its host timeout.
    uploaded: Option<(u32, Duration)>,
    /// Ping period of the scene committed by this value; `None` if it has committed none.
    committed: Option<Duration>,
    /// Whether this value may have armed the board.
    armed: bool,
    /// The stream that was started last.
    stream: Option<StreamProgress>,
}

/// A message that a board sends without a request.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// The board's output and state at one tick; see [`Device::subscribe`].
    Telemetry(Telemetry),
    /// The board changed its state without a command.
    StateChanged {
        /// The new state.
        state: State,
        /// The latched fault, if there is one.
        fault: Option<Fault>,
        /// The reason, if it is not a fault.
        flags: Flags,
    },
}

/// Counts of frames and bytes since the link was opened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Frames sent, pings included.
    pub frames_sent: u64,
    /// Damaged frames: received ones, and chunks that the board requested again.
    pub frames_rejected: u64,
    /// Uploaded bytes of scenes and bitmaps, each counted once.
    pub payload_bytes: u64,
    /// All bytes sent.
    pub wire_bytes: u64,
}

impl<L: Link> Device<L> {
    /// Exchanges the hello with the board, checks that both sides speak the same protocol, and starts the pings. Takes
    /// at most 0.75 s if no board answers.
    ///
    /// The hello disarms a board that another client has armed.
    pub fn connect(mut link: L) -> Result<Self, DeviceError> {
        let mut decoder = Decoder::new();
        let hello = request_hello(&mut link, &mut decoder)?;
        let mut exchange = Exchange::new(link, decoder, &hello);
        // The answer corrects the credit if one of several hello requests was lost.
        exchange.request(Command::Ping)?;
        let armed = matches!(hello.state, State::Armed | State::Active);
        let uploads = UploadCounts::default();
        let mut device = Self { exchange, hello, uploads, uploaded: None, committed: None, armed, stream: None };
        device.pace_pings();
        Ok(device)
    }

    /// Sets a function that is called about ten times a second while a call waits for an answer, or for the board to
    /// acknowledge an upload. It may end the call with [`DeviceError::BrokenOff`], for example at a user's request.
    ///
    /// A working board answers within milliseconds. A program that stops a board on request should therefore break off
    /// a wait only after a second or so.
    pub fn while_waiting(&mut self, watcher: impl FnMut(&Waiting) -> ControlFlow<()> + Send + 'static) {
        self.exchange.watcher = Some(Box::new(watcher));
    }

    /// The hello sent by the board.
    pub fn hello(&self) -> &Hello {
        &self.hello
    }

    /// Uploads the scene, and its bitmaps that the board does not hold. The playing scene does not change before
    /// [`Self::commit`]. `progress` is called several times a second, and may end the upload with
    /// [`DeviceError::Interrupted`].
    pub fn upload(
        &mut self,
        upload: &Upload,
        progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<(), DeviceError> {
        upload.check()?;
        // The board refuses bytes that are not a scene, and reports the reason.
        let scene = Scene::parse(upload.scene).ok();
        self.check_features(scene.map_or(0, |scene| features_of(scene.header(), scene.records())))?;
        self.uploaded = scene.map(|scene| (upload.scene_crc32(), ping_period(scene.header().host_timeout_s)));
        upload::send(&mut self.exchange, upload, &mut self.uploads, progress)
    }

    /// Refuses a scene that needs features missing on the board.
    fn check_features(&self, needed: u32) -> Result<(), DeviceError> {
        let Hello { features, firmware, protocol, .. } = self.hello;
        let missing = feature_names().filter(|(bit, _)| needed & !features & bit != 0);
        let missing: Vec<&str> = missing.map(|(_, name)| name).collect();
        if missing.is_empty() {
            return Ok(());
        }
        let port = self.exchange.link.name().into();
        Err(DeviceError::MissingFeatures { port, missing: missing.join(" and "), firmware, protocol })
    }

    /// Commits the uploaded scene, which plays from then on or at the next play. `scene_crc32` is
    /// [`Upload::scene_crc32`].
    ///
    /// Afterwards, the pings follow its host timeout.
    pub fn commit(&mut self, scene_crc32: u32) -> Result<(), DeviceError> {
        // Until the board has answered, the host timeout of either scene may apply.
        self.committed = None;
        self.pace_pings();
        self.request(Command::Commit { crc32: scene_crc32 })?;
        self.committed = self.uploaded.filter(|(crc32, _)| *crc32 == scene_crc32).map(|(_, period)| period);
        self.pace_pings();
        Ok(())
    }

    /// Whether a program may arm the board. A board with an electrode needs a person's consent, and a simulated one
    /// does not.
    pub fn may_arm(&self, has_consent: bool) -> bool {
        has_consent || self.hello.board.is_simulated()
    }

    /// Changes the state from disarmed to armed: ready to play, output zero.
    pub fn arm(&mut self) -> Result<(), DeviceError> {
        self.before_arming()?;
        self.request(Command::Arm)
    }

    /// Disarms the board, and sets its output to zero. Refused while a fault is latched: the output is zero then.
    pub fn disarm(&mut self) -> Result<(), DeviceError> {
        self.request(Command::Disarm)?;
        self.armed = false;
        self.pace_pings();
        Ok(())
    }

    /// Changes the state from armed to active: the committed scene plays.
    pub fn play(&mut self) -> Result<(), DeviceError> {
        self.before_arming()?;
        self.request(Command::Play)
    }

    /// Changes the state from active to armed, and sets the output to zero.
    pub fn stop(&mut self) -> Result<(), DeviceError> {
        self.request(Command::Stop)
    }

    /// Switches a layer of the committed scene on or off while it plays, and sets its gain, -100 to 100, in place of
    /// the scene's. The change takes effect at the next tick and holds until the next commit.
    ///
    /// `layer` is the number of the layer's record, from zero. The board clamps friction out of reach and sets a flag
    /// in its telemetry.
    pub fn set_layer(&mut self, layer: u8, on: bool, gain: f32) -> Result<(), DeviceError> {
        self.request(Command::SetLayer { layer, on, gain })
    }

    /// Changes the state from faulted to disarmed, if the cause of the fault is gone.
    pub fn clear_fault(&mut self) -> Result<(), DeviceError> {
        self.request(Command::ClearFault)
    }

    /// Text stored by the firmware about the fault that led to its last reset; empty if there was none.
    pub fn fault_text(&mut self) -> Result<String, DeviceError> {
        let mut text = Vec::new();
        while text.len() < FAULT_TEXT_MAX_LEN {
            let Accepted::FaultText { len, bytes } =
                self.exchange.request(Command::FaultText { offset: text.len() as u8 })?
            else {
                break;
            };
            text.extend(bytes.iter().take(len.into()));
            if usize::from(len) < FAULT_TEXT_PIECE_LEN {
                break;
            }
        }
        Ok(String::from_utf8_lossy(&text).into_owned())
    }

    /// Durations of the board's ticks; `None` if the board does not measure them.
    pub fn tick_times(&mut self) -> Result<Option<TickTimes>, DeviceError> {
        if self.hello.features & feature::TELEMETRY == 0 {
            return Ok(None);
        }
        match self.exchange.request(Command::TickTimes)? {
            Accepted::TickTimes(times) if times.deadline_cycles > 0 => Ok(Some(times)),
            _ => Ok(None),
        }
    }

    /// Checks that the board answers.
    pub fn ping(&mut self) -> Result<(), DeviceError> {
        self.request(Command::Ping)
    }

    /// Requests telemetry once every `period_ticks` ticks of the board; zero ends it. [`Self::wait`] passes it to the
    /// caller.
    pub fn subscribe(&mut self, period_ticks: u32) -> Result<(), DeviceError> {
        self.request(Command::Subscribe { period_ticks })
    }

    /// Waits for `duration` on the link's clock. Passes earlier and arriving events to `on_event`.
    ///
    /// Returns early with [`DeviceError::Silent`] if the board no longer answers pings.
    pub fn wait(&mut self, duration: Duration, on_event: &mut dyn FnMut(Event)) -> Result<(), DeviceError> {
        let end = self.exchange.link.now() + duration;
        loop {
            while let Some(event) = self.exchange.events.pop_front() {
                on_event(event);
            }
            let now = self.exchange.link.now();
            if now >= end {
                return Ok(());
            }
            self.exchange.listen(end.saturating_sub(now))?;
        }
    }

    /// Keeps the pings going for another [`KEEP_ALIVE_TIMEOUT`](crate::KEEP_ALIVE_TIMEOUT), and stores arrived events
    /// for the next [`Self::wait`]. Does not wait, and therefore does not detect a board that has stopped answering.
    ///
    /// Use this in a program that runs its own loop while a scene plays. With a simulated board whose clock advances
    /// only while the program waits, call [`Self::wait`] instead.
    ///
    /// ```no_run
    /// # use frixel_driver::{Device, DeviceError, Link};
    /// # fn draw_a_frame() -> bool { false }
    /// # fn run<L: Link>(board: &mut Device<L>) -> Result<(), DeviceError> {
    /// while draw_a_frame() {
    ///     board.keep_alive()?;
    /// }
    /// board.stop()
    /// # }
    /// ```
    pub fn keep_alive(&mut self) -> Result<(), DeviceError> {
        self.exchange.receive(Duration::ZERO, name_of(&Command::Ping))
    }

    /// Time on the link's clock.
    pub fn now(&self) -> Duration {
        self.exchange.link.now()
    }

    /// Counts of frames and bytes since the link was opened.
    pub fn counters(&self) -> Counters {
        let written = self.exchange.link.written();
        Counters {
            frames_sent: written.frames,
            frames_rejected: u64::from(self.exchange.frames_rejected()) + self.uploads.chunks_lost,
            payload_bytes: self.uploads.payload_bytes,
            wire_bytes: written.bytes,
        }
    }

    /// The underlying link, for methods of its own type. [`Device`] continues to use it.
    pub fn link_mut(&mut self) -> &mut L {
        &mut self.exchange.link
    }

    /// Returns the link without disarming the board. The link continues to ping until its keep-alive timeout. After
    /// [`Self::arm`] or [`Self::play`] it stops and disarms the board when it is dropped.
    pub fn into_link(self) -> L {
        self.exchange.link
    }

    /// Prepares the link to ping the board, and to stop and disarm it when dropped.
    fn before_arming(&mut self) -> Result<(), DeviceError> {
        self.exchange.set_shutdown_commands(&[Command::Stop, Command::Disarm])?;
        self.armed = true;
        self.pace_pings();
        Ok(())
    }

    /// Sets the ping period. The host timeout of an armed board is unknown during a commit, and if another client
    /// committed its scene; pings then suit the shortest timeout.
    fn pace_pings(&mut self) {
        let period = if self.armed { self.committed.unwrap_or(PING_PERIOD_MIN) } else { PING_PERIOD_MAX };
        self.exchange.link.keep_alive(period);
    }

    fn request(&mut self, command: Command) -> Result<(), DeviceError> {
        self.exchange.request(command).map(|_| ())
    }
}

/// A quarter of the host timeout, between the two limits.
fn ping_period(host_timeout_s: f32) -> Duration {
    let quarter = Duration::try_from_secs_f32(host_timeout_s / 4.0).unwrap_or(PING_PERIOD_MAX);
    quarter.clamp(PING_PERIOD_MIN, PING_PERIOD_MAX)
}

const _: () = assert!(ANSWER_TIMEOUT.as_millis() < 1000);
