//! The command handler: dispatches the frames of the host, and answers them.

use frixel_wire::fault::State;
use frixel_wire::message::{
    Accepted, Answer, Command, FAULT_TEXT_MAX_LEN, FAULT_TEXT_PIECE_LEN, FromBoard, Refusal, Request,
    TELEMETRY_PERIOD_MIN_TICKS, TickTimes,
};
use frixel_wire::payload::{ParseError, Payload};
use heapless::{Deque, Vec};

use crate::link::credit::Credit;
use crate::link::transmit_queue::TransmitQueue;
use crate::motion::fingers::{Fingers, ONLY_FINGER};
use crate::motion::tracker::Tracker;
use crate::scene::bitmap_directory::Directory;
use crate::scene::commit::{BitmapNames, Commit};
use crate::scene::live::Playing;
#[cfg(feature = "stream")]
use crate::scene::live::Stream;
use crate::scene::upload::{Staging, Upload};
use crate::states::ORDERS_MAX;
use frixel_control::Status;
use frixel_control::{Active, Board, Order, TickMeter};
use frixel_layers::BitmapPool;

/// Requests that may wait for a commit to end; further ones are refused as busy. A host that waits for its answers has
/// one at most.
const WAITING_MAX: usize = 8;

/// The command handler: holds the state of the session, and of the scene and finger that it has passed to the ticker.
pub(crate) struct Commands<'a> {
    pub(crate) board: Board,
    pub(crate) pool: &'a BitmapPool,
    pub(crate) directory: Directory,
    pub(crate) upload: Option<Upload>,
    pub(crate) staging: Staging,
    /// How long the ticks have taken; `None` on a board that does not measure it.
    pub(crate) tick_meter: Option<&'a TickMeter>,
    /// The stored scene was not loaded at this start ([`Commands::skip_stored_scene`]).
    pub(crate) stored_scene_skipped: bool,
    /// CRC-32 of the ticker's scene; zero without a scene.
    pub(crate) committed_crc32: u32,
    /// Bitmaps of the ticker's scene.
    pub(crate) committed_bitmaps: BitmapNames,
    /// Bitmaps announced since the last commit: those of the next scene.
    pub(crate) announced_bitmaps: BitmapNames,
    /// Buffer for the coefficients of the next scene; `None` until the ticker has returned that of the previous scene.
    pub(crate) spare: Option<&'a mut Active>,
    pub(crate) orders: Deque<Order<'a>, ORDERS_MAX>,
    pub(crate) orders_sent: u32,
    pub(crate) host_heard: bool,
    /// An [`Order::HostHeard`] has already waited for one order of the finger.
    pub(crate) sign_of_life_waited: bool,
    /// State once the ticker has applied every order.
    pub(crate) state: State,
    /// The commit under way.
    pub(crate) commit: Option<Commit>,
    /// Requests that arrived during the commit and must be carried out after it, in the order of arrival.
    pub(crate) waiting: Deque<Request, WAITING_MAX>,
    pub(crate) credit: Credit,
    pub(crate) telemetry_period_ticks: u32,
    /// Facts about the committed scene that are still needed after the next upload has overwritten its bytes.
    pub(crate) playing: Playing,
    /// The host's stream; `None` on a board without a stream buffer.
    #[cfg(feature = "stream")]
    pub(crate) stream: Option<Stream<'a>>,
    /// Fingers that the host reported.
    pub(crate) fingers: Fingers,
    pub(crate) tracker: Tracker,
    /// The tick from which on the last report of the board's own touch source is too old to let an autonomous scene
    /// play; `None` without one.
    pub(crate) own_touch_until_tick: Option<u32>,
}

impl<'a> Commands<'a> {
    pub(crate) fn new(board: Board, pool: &'a BitmapPool, spare: &'a mut Active) -> Self {
        Self {
            board,
            pool,
            directory: Directory::default(),
            upload: None,
            staging: Staging::new(),
            tick_meter: None,
            stored_scene_skipped: false,
            committed_crc32: 0,
            committed_bitmaps: Vec::new(),
            announced_bitmaps: Vec::new(),
            spare: Some(spare),
            orders: Deque::new(),
            orders_sent: 0,
            host_heard: false,
            sign_of_life_waited: false,
            state: State::Disarmed,
            commit: None,
            waiting: Deque::new(),
            credit: Credit::new(board.limits.receive_window_bytes),
            telemetry_period_ticks: 0,
            playing: Playing::default(),
            #[cfg(feature = "stream")]
            stream: None,
            fingers: Fingers::new(),
            tracker: Tracker::new(&board),
            own_touch_until_tick: None,
        }
    }

    pub(crate) fn telemetry_period_ticks(&self) -> Option<u32> {
        (self.telemetry_period_ticks > 0).then_some(self.telemetry_period_ticks)
    }

    pub(crate) fn take_back(&mut self, spare: &'a mut Active) {
        self.spare = Some(spare);
    }

    pub(crate) fn scene(&self) -> Option<&[u8]> {
        let (bytes, crc32) = self.staging.scene()?;
        (crc32 == self.committed_crc32).then_some(bytes)
    }

    /// Takes one frame's payload.
    pub(crate) fn take(&mut self, payload: Result<Payload, ParseError>, status: &Status, queue: &mut TransmitQueue) {
        self.report_state(status, queue);
        match payload {
            Ok(Payload::HelloRequest { .. }) => self.handle_hello(status, queue),
            Ok(Payload::Request(request)) => {
                self.host_heard = true;
                self.take_request(request, status, queue);
            }
            Ok(Payload::Chunk { number, bytes }) => {
                self.host_heard = true;
                self.take_chunk(number, bytes, queue);
            }
            #[cfg(feature = "stream")]
            Ok(Payload::Samples { first_index, samples }) => {
                self.host_heard = true;
                // Samples behind a `StartStream` that waits for a commit belong to a stream that has not begun.
                let starts = |waiting: &Request| matches!(waiting.command, Command::StartStream { .. });
                if !self.waiting.iter().any(starts) {
                    self.take_samples(first_index, samples);
                }
                self.report_stream(status, queue);
            }
            // Without the feature, samples are ignored, but they restart the host timeout.
            #[cfg(not(feature = "stream"))]
            Ok(Payload::Samples { .. }) => self.host_heard = true,
            // A request with an unknown command is still answered under its sequence number.
            Err(ParseError::UnknownCommand { sequence }) => {
                self.host_heard = true;
                self.answer(sequence, Err(Refusal::UnknownCommand), queue);
            }
            // Ignore frames that only a board sends, and frames that cannot be parsed.
            Ok(Payload::Hello(_) | Payload::FromBoard(_)) | Err(_) => {}
        }
    }

    /// Carries a request out, or keeps it until the commit under way has ended. A Stop or a Disarm never waits, and
    /// refuses the requests that do: an Arm or a Play that was sent before it must not take effect after it.
    fn take_request(&mut self, request: Request, status: &Status, queue: &mut TransmitQueue) {
        if matches!(request.command, Command::Stop | Command::Disarm) {
            self.refuse_waiting(queue);
        }
        let must_keep_order = self.commit.is_some() || !self.waiting.is_empty();
        if !must_keep_order || may_overtake_a_commit(request.command) {
            self.carry_out(request, status, queue);
        } else if self.waiting.push_back(request).is_err() {
            self.answer(request.sequence, Err(Refusal::Busy), queue);
        }
    }

    /// Refuses the requests that wait for a commit.
    pub(crate) fn refuse_waiting(&mut self, queue: &mut TransmitQueue) {
        while let Some(waiting) = self.waiting.pop_front() {
            self.answer(waiting.sequence, Err(Refusal::Busy), queue);
        }
    }

    /// Carries a request out, and answers it. A commit is only begun.
    pub(crate) fn carry_out(
        &mut self,
        Request { sequence, command }: Request,
        status: &Status,
        queue: &mut TransmitQueue,
    ) {
        if let Command::Commit { crc32 } = command {
            self.commit = Some(Commit::new(sequence, crc32));
        } else {
            let outcome = self.dispatch(command, status);
            self.answer(sequence, outcome, queue);
        }
    }

    pub(crate) fn answer(&mut self, sequence: u16, outcome: Result<Accepted, Refusal>, queue: &mut TransmitQueue) {
        let answer = Answer { sequence, received_bytes: self.credit.received(), state: self.state, outcome };
        self.report(&FromBoard::Answer(answer), queue);
    }

    /// Sends a message that contains the count of received bytes.
    pub(crate) fn report(&mut self, message: &FromBoard, queue: &mut TransmitQueue) {
        if queue.send(message) {
            self.credit.reported();
        }
    }

    fn dispatch(&mut self, command: Command, status: &Status) -> Result<Accepted, Refusal> {
        match command {
            Command::Ping => Ok(Accepted::Done),
            Command::UploadScene { len, crc32 } => self.begin_scene(len, crc32),
            Command::UploadBitmap { width, height, crc32 } if cfg!(feature = "bitmap") => {
                self.begin_bitmap(width, height, crc32, self.is_settled(status))
            }
            Command::UploadBitmap { width, height, .. } => {
                Err(Refusal::BitmapPoolFull { len: u32::from(width) * u32::from(height), free: 0 })
            }
            Command::UploadEnd => self.end_upload(),
            // `carry_out` handles a commit; it does not get here.
            Command::Commit { .. } => Err(Refusal::Busy),
            Command::Subscribe { period_ticks } if cfg!(feature = "telemetry") => self.subscribe(period_ticks),
            Command::Subscribe { .. } => Err(Refusal::UnknownCommand),
            Command::Touch { x_m, y_m, age_ticks } => self.touch(ONLY_FINGER, (x_m, y_m), age_ticks, status),
            Command::Lift => self.lift(ONLY_FINGER, status),
            Command::FaultText { offset } => Ok(fault_text(self.board.reset_text, offset)),
            Command::SetLayer { .. } => self.change_playing(command, status),
            #[cfg(feature = "stream")]
            Command::StartStream { .. } => self.change_playing(command, status),
            #[cfg(feature = "stream")]
            Command::EndStream => self.end_stream(),
            #[cfg(not(feature = "stream"))]
            Command::StartStream { .. } | Command::EndStream => Err(Refusal::UnknownCommand),
            Command::TouchFinger { finger, x_m, y_m, age_ticks } => self.touch(finger, (x_m, y_m), age_ticks, status),
            Command::LiftFinger { finger } => self.lift(finger, status),
            Command::TickTimes if cfg!(feature = "telemetry") => Ok(Accepted::TickTimes(self.tick_times(status))),
            Command::TickTimes => Err(Refusal::UnknownCommand),
            Command::ClearFault => self.change_state(Order::ClearFault, &[State::Faulted], State::Disarmed),
            Command::Arm | Command::Disarm | Command::Play | Command::Stop => self.drive(command, status),
        }
    }

    fn tick_times(&self, status: &Status) -> TickTimes {
        let missed_deadlines = status.counters.missed_deadlines;
        match self.tick_meter {
            Some(meter) => meter.times(missed_deadlines),
            None => TickTimes { missed_deadlines, ..TickTimes::default() },
        }
    }

    fn subscribe(&mut self, period_ticks: u32) -> Result<Accepted, Refusal> {
        if period_ticks != 0 && period_ticks < TELEMETRY_PERIOD_MIN_TICKS {
            return Err(Refusal::TelemetryTooFast { period_min_ticks: TELEMETRY_PERIOD_MIN_TICKS });
        }
        self.telemetry_period_ticks = period_ticks;
        Ok(Accepted::Done)
    }
}

/// Whether a request may be carried out while an earlier commit is under way, or while requests wait behind one: its
/// effects do not depend on theirs, except that Stop and Disarm end what waits (see [`Commands::take_request`]).
fn may_overtake_a_commit(command: Command) -> bool {
    matches!(
        command,
        Command::Ping
            | Command::Stop
            | Command::Disarm
            | Command::Subscribe { .. }
            | Command::Touch { .. }
            | Command::Lift
            | Command::FaultText { .. }
            | Command::TouchFinger { .. }
            | Command::LiftFinger { .. }
            | Command::TickTimes
    )
}

/// The piece of a fault's text that begins at `offset`.
fn fault_text(text: &[u8], offset: u8) -> Accepted {
    let rest = text.get(..text.len().min(FAULT_TEXT_MAX_LEN)).and_then(|text| text.get(usize::from(offset)..));
    let mut bytes = [0; FAULT_TEXT_PIECE_LEN];
    let mut len = 0;
    for (to, from) in bytes.iter_mut().zip(rest.unwrap_or_default()) {
        *to = *from;
        len += 1;
    }
    Accepted::FaultText { len, bytes }
}
