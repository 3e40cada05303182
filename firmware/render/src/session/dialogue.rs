//! What the host's frames mean, and what the board answers.

use frixel_wire::fault::State;
use frixel_wire::message::{
    Accepted, Answer, Command, FAULT_TEXT_MAX_LEN, FAULT_TEXT_PIECE_LEN, FromBoard, Refusal, Request,
    TELEMETRY_PERIOD_MIN_TICKS,
};
use frixel_wire::payload::{ParseError, Payload};
use heapless::{Deque, Vec};

use super::commit::{BitmapNames, Commit};
use super::credit::Credit;
use super::fingers::{Fingers, ONLY_FINGER};
use super::live::Playing;
#[cfg(feature = "stream")]
use super::live::Stream;
use super::outbox::Outbox;
use super::states::ORDERS_MAX;
use super::upload::{Staging, Upload};
use crate::bitmap_directory::Directory;
use crate::order::Status;
use crate::tracker::Tracker;
use crate::{Active, Board, Order};
use frixel_layers::BitmapPool;

/// The board's side of what is said.
pub(super) struct Dialogue<'a> {
    pub(super) board: Board,
    pub(super) pool: &'a BitmapPool,
    pub(super) directory: Directory,
    pub(super) upload: Option<Upload>,
    pub(super) staging: Staging,
    /// CRC-32 of the scene that the ticker has, zero without one.
    pub(super) committed_crc32: u32,
    /// Bitmaps of the scene that the ticker has.
    pub(super) committed_bitmaps: BitmapNames,
    /// Bitmaps that were announced since the last commit: the next scene's.
    pub(super) announced_bitmaps: BitmapNames,
    /// Coefficients for the next scene; `None` while the ticker has not handed back those of the scene before.
    pub(super) spare: Option<&'a mut Active>,
    pub(super) orders: Deque<Order<'a>, ORDERS_MAX>,
    pub(super) orders_sent: u32,
    pub(super) host_heard: bool,
    /// A sign of life has waited for an order of the finger.
    pub(super) sign_of_life_waited: bool,
    /// State once the ticker has applied every order.
    pub(super) state: State,
    /// The commit under way.
    pub(super) commit: Option<Commit>,
    pub(super) credit: Credit,
    pub(super) telemetry_period_ticks: u32,
    /// What has to be known of the committed scene beside its bytes, which the next upload takes the place of.
    pub(super) playing: Playing,
    /// What the host streams; `None` on a board that has no buffer for it.
    #[cfg(feature = "stream")]
    pub(super) stream: Option<Stream<'a>>,
    /// Fingers that the host reported.
    pub(super) fingers: Fingers,
    pub(super) tracker: Tracker,
}

impl<'a> Dialogue<'a> {
    pub(super) fn new(board: Board, pool: &'a BitmapPool, spare: &'a mut Active) -> Self {
        Self {
            board,
            pool,
            directory: Directory::default(),
            upload: None,
            staging: Staging::new(),
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
            credit: Credit::new(board.limits.receive_window_bytes),
            telemetry_period_ticks: 0,
            playing: Playing::default(),
            #[cfg(feature = "stream")]
            stream: None,
            fingers: Fingers::new(),
            tracker: Tracker::new(&board),
        }
    }

    #[inline]
    pub(super) fn telemetry_period_ticks(&self) -> Option<u32> {
        (self.telemetry_period_ticks > 0).then_some(self.telemetry_period_ticks)
    }

    #[inline]
    pub(super) fn take_back(&mut self, spare: &'a mut Active) {
        self.spare = Some(spare);
    }

    #[inline]
    pub(super) fn scene(&self) -> Option<&[u8]> {
        let (bytes, crc32) = self.staging.scene()?;
        (crc32 == self.committed_crc32).then_some(bytes)
    }

    /// Takes one frame's payload.
    #[inline]
    pub(super) fn take(&mut self, payload: Result<Payload, ParseError>, status: &Status, outbox: &mut Outbox) {
        self.report_state(status, outbox);
        if !may_overtake_a_commit(&payload) {
            self.finish_commit(outbox);
        }
        match payload {
            Ok(Payload::HelloRequest { .. }) => self.greet(status, outbox),
            Ok(Payload::Request(request)) => {
                self.host_heard = true;
                if let Command::Commit { crc32 } = request.command {
                    self.commit = Some(Commit::new(request.sequence, crc32));
                } else {
                    self.serve(request, status, outbox);
                }
            }
            Ok(Payload::Chunk { number, bytes }) => {
                self.host_heard = true;
                self.take_chunk(number, bytes, outbox);
            }
            #[cfg(feature = "stream")]
            Ok(Payload::Samples { first_index, samples }) => {
                self.host_heard = true;
                self.take_samples(first_index, samples);
                self.report_stream(status, outbox);
            }
            // Without the feature, samples are not looked at, but a host is there.
            #[cfg(not(feature = "stream"))]
            Ok(Payload::Samples { .. }) => self.host_heard = true,
            // A request whose command is not known still says which answer it waits for.
            Err(ParseError::UnknownCommand { sequence }) => {
                self.host_heard = true;
                self.answer(sequence, Err(Refusal::UnknownCommand), outbox);
            }
            // What a board sends, and what cannot be read, is not for a board.
            Ok(Payload::Hello(_) | Payload::FromBoard(_)) | Err(_) => {}
        }
    }

    #[inline]
    fn serve(&mut self, Request { sequence, command }: Request, status: &Status, outbox: &mut Outbox) {
        let outcome = self.obey(command, status);
        self.answer(sequence, outcome, outbox);
    }

    #[inline]
    pub(super) fn answer(&mut self, sequence: u16, outcome: Result<Accepted, Refusal>, outbox: &mut Outbox) {
        let answer = Answer { sequence, received_bytes: self.credit.received(), state: self.state, outcome };
        self.report(&FromBoard::Answer(answer), outbox);
    }

    /// Sends a message that tells how many bytes were received.
    #[inline]
    pub(super) fn report(&mut self, message: &FromBoard, outbox: &mut Outbox) {
        if outbox.send(message) {
            self.credit.reported();
        }
    }

    #[inline]
    fn obey(&mut self, command: Command, status: &Status) -> Result<Accepted, Refusal> {
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
            // A commit begins where its request is taken, and not here.
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
            Command::ClearFault => self.change_state(Order::ClearFault, &[State::Faulted], State::Disarmed),
            Command::Arm | Command::Disarm | Command::Play | Command::Stop => self.drive(command, status),
        }
    }

    #[inline]
    fn subscribe(&mut self, period_ticks: u32) -> Result<Accepted, Refusal> {
        if period_ticks != 0 && period_ticks < TELEMETRY_PERIOD_MIN_TICKS {
            return Err(Refusal::TelemetryTooFast { period_min_ticks: TELEMETRY_PERIOD_MIN_TICKS });
        }
        self.telemetry_period_ticks = period_ticks;
        Ok(Accepted::Done)
    }
}

/// What may be done before a commit that came earlier: what neither asks for its outcome nor touches what it reads.
#[inline]
fn may_overtake_a_commit(payload: &Result<Payload, ParseError>) -> bool {
    match payload {
        Ok(Payload::Samples { .. }) => true,
        Ok(Payload::Request(request)) => matches!(
            request.command,
            Command::Ping
                | Command::Stop
                | Command::Disarm
                | Command::Touch { .. }
                | Command::Lift
                | Command::TouchFinger { .. }
                | Command::LiftFinger { .. }
        ),
        _ => false,
    }
}

/// The piece of a fault's text that begins at `offset`.
#[inline]
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
