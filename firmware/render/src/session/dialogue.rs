//! What the host's frames mean, and what the board answers.

use frixel_wire::fault::{Flags, State};
use frixel_wire::hello::{Hello, PROTOCOL_MAJOR, PROTOCOL_MINOR, feature};
use frixel_wire::message::{
    Accepted, Answer, Command, FAULT_TEXT_MAX_LEN, FAULT_TEXT_PIECE_LEN, FromBoard, Refusal, Request,
    TELEMETRY_PERIOD_MIN_TICKS,
};
use frixel_wire::payload::{ParseError, Payload};
use frixel_wire::scene::{
    HEADER_LEN, Layer, POINT_LEN, POINTS_MAX, RECORD_LEN, RECORDS_MAX, SCENE_MAX_LEN, Scene, SceneError,
};
use heapless::{Deque, Vec};

use super::fingers::{Fingers, ONLY_FINGER};
use super::live::Playing;
#[cfg(feature = "stream")]
use super::live::Stream;
use super::outbox::Outbox;
use super::upload::{Destination, Report, Staging, Upload};
use crate::bitmap_pool::{Bitmap, Directory};
use crate::order::Status;
use crate::{Active, BitmapPool, Board, Order, Touch};

/// Version of this firmware: major, minor, patch.
const FIRMWARE: (u8, u8, u8) = (
    part(env!("CARGO_PKG_VERSION_MAJOR")),
    part(env!("CARGO_PKG_VERSION_MINOR")),
    part(env!("CARGO_PKG_VERSION_PATCH")),
);

/// A part of the package's version, read when this is compiled.
const fn part(text: &str) -> u8 {
    match u8::from_str_radix(text, 10) {
        Ok(part) => part,
        Err(_) => u8::MAX,
    }
}

/// Orders that may wait for the ticker. A command is refused as busy when there is no room.
const ORDERS_MAX: usize = 8;
/// Of which these are kept for Stop and Disarm, so that what puts the output to zero is never refused for want of room.
const ORDERS_KEPT: usize = 2;

/// CRC-32 names of bitmaps.
pub(super) type BitmapNames = Vec<u32, RECORDS_MAX>;

/// The board's side of what is said.
pub(super) struct Dialogue<'a> {
    pub(super) board: Board,
    pub(super) pool: &'a BitmapPool,
    pub(super) directory: Directory,
    upload: Option<Upload>,
    pub(super) staging: Staging,
    /// CRC-32 of the scene that the ticker has, zero without one.
    pub(super) committed_crc32: u32,
    /// Bitmaps of the scene that the ticker has.
    pub(super) committed_bitmaps: BitmapNames,
    /// Bitmaps that were announced since the last commit: the next scene's.
    announced_bitmaps: BitmapNames,
    /// Coefficients for the next scene; `None` while the ticker has not handed back those of the scene before.
    spare: Option<&'a mut Active>,
    orders: Deque<Order<'a>, ORDERS_MAX>,
    orders_sent: u32,
    host_heard: bool,
    /// State once the ticker has applied every order.
    pub(super) state: State,
    pub(super) received_bytes: u32,
    telemetry_period_ticks: u32,
    /// What has to be known of the committed scene beside its bytes, which the next upload takes the place of.
    pub(super) playing: Playing,
    /// What the host streams; `None` on a board that has no buffer for it.
    #[cfg(feature = "stream")]
    pub(super) stream: Option<Stream<'a>>,
    /// Fingers that the host told of.
    pub(super) fingers: Fingers,
}

/// What this firmware was built with.
const fn features(board: &Board, has_stream: bool) -> u32 {
    const fn bit(present: bool, bit: u32) -> u32 {
        if present { bit } else { 0 }
    }
    bit(cfg!(feature = "grating"), feature::GRATING)
        | bit(cfg!(feature = "bitmap"), feature::BITMAP)
        | bit(cfg!(feature = "sine-carrier"), feature::SINE_CARRIER)
        | bit(cfg!(feature = "telemetry"), feature::TELEMETRY)
        | bit(board.touch_from_host, feature::HOST_TOUCH)
        | bit(cfg!(feature = "noise"), feature::NOISE)
        | bit(cfg!(feature = "edge"), feature::EDGE)
        | bit(cfg!(feature = "vibration"), feature::VIBRATION)
        | bit(cfg!(feature = "speed"), feature::SPEED)
        | bit(has_stream, feature::STREAM)
        | bit(cfg!(feature = "polygon"), feature::POLYGON)
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
            state: State::Disarmed,
            received_bytes: 0,
            telemetry_period_ticks: 0,
            playing: Playing::default(),
            #[cfg(feature = "stream")]
            stream: None,
            fingers: Fingers::new(),
        }
    }

    pub(super) fn count_received(&mut self, bytes: usize) {
        self.received_bytes = self.received_bytes.wrapping_add(bytes as u32);
    }

    pub(super) fn telemetry_period_ticks(&self) -> Option<u32> {
        (self.telemetry_period_ticks > 0).then_some(self.telemetry_period_ticks)
    }

    pub(super) fn next_order(&mut self) -> Option<Order<'a>> {
        if core::mem::take(&mut self.host_heard) { Some(Order::HostHeard) } else { self.orders.pop_front() }
    }

    pub(super) fn next_touch(&mut self) -> Option<Touch> {
        self.fingers.next()
    }

    pub(super) fn take_back(&mut self, spare: &'a mut Active) {
        self.spare = Some(spare);
    }

    pub(super) fn scene(&self) -> Option<&[u8]> {
        let (bytes, crc32) = self.staging.scene()?;
        (crc32 == self.committed_crc32).then_some(bytes)
    }

    /// Takes one frame's payload.
    pub(super) fn take(&mut self, payload: Result<Payload, ParseError>, status: &Status, outbox: &mut Outbox) {
        self.report_state(status, outbox);
        match payload {
            Ok(Payload::HelloRequest { .. }) => {
                self.host_heard = true;
                self.greet(status, outbox);
            }
            Ok(Payload::Request(Request { sequence, command })) => {
                self.host_heard = true;
                let outcome = self.obey(command, status);
                self.answer(sequence, outcome, outbox);
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

    /// Tells the host of a change of state that it did not ask for.
    pub(super) fn report_state(&mut self, status: &Status, outbox: &mut Outbox) {
        let before = self.state;
        self.follow_state(status);
        if self.state != before {
            let fault = status.fault.filter(|_| self.state == State::Faulted).map(|(fault, _)| fault);
            let flags = Flags(status.telemetry.flags.0 & Flags::HOST_SILENT.0);
            outbox.send(&FromBoard::StateChanged { state: self.state, fault, flags });
        }
    }

    /// The ticker's state holds once it has applied every order.
    fn follow_state(&mut self, status: &Status) {
        if self.is_settled(status) {
            self.set_state(status.telemetry.state);
        }
    }

    /// A stream lasts no longer than the state in which it plays.
    fn set_state(&mut self, state: State) {
        self.state = state;
        #[cfg(feature = "stream")]
        if state != State::Active {
            self.forget_stream();
        }
    }

    #[cfg(feature = "stream")]
    fn has_stream(&self) -> bool {
        self.stream.is_some()
    }

    #[cfg(not(feature = "stream"))]
    #[allow(clippy::unused_self, reason = "with the feature it is asked")]
    fn has_stream(&self) -> bool {
        false
    }

    fn is_settled(&self, status: &Status) -> bool {
        status.orders_applied == self.orders_sent
    }

    fn answer(&mut self, sequence: u16, outcome: Result<Accepted, Refusal>, outbox: &mut Outbox) {
        let answer = Answer { sequence, received_bytes: self.received_bytes, state: self.state, outcome };
        outbox.send(&FromBoard::Answer(answer));
    }

    /// A new client: credit starts anew, and nothing of an unfinished upload is left.
    fn greet(&mut self, status: &Status, outbox: &mut Outbox) {
        self.received_bytes = 0;
        self.telemetry_period_ticks = 0;
        self.drop_upload();
        self.announced_bitmaps.clear();
        self.fingers.forget();
        // Should there be no room for the order, the stream runs dry instead.
        #[cfg(feature = "stream")]
        let _ = self.end_stream();
        outbox.send_hello(&Hello {
            protocol: (PROTOCOL_MAJOR, PROTOCOL_MINOR),
            firmware: FIRMWARE,
            board: self.board.kind,
            id: self.board.id,
            tick_hz: self.board.tick_hz,
            frame_max_len: frixel_wire::frame::FRAME_MAX_LEN as u16,
            features: features(&self.board, self.has_stream()),
            scene_crc32: self.committed_crc32,
            reset_cause: self.board.reset_cause,
            last_fault: status.fault.map(|(fault, _)| fault),
            fault_detail: status.fault.map_or(0, |(_, detail)| detail),
            state: self.state,
            limits: self.board.limits,
        });
    }

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
            Command::Commit { crc32 } => self.commit(crc32),
            Command::Subscribe { period_ticks } if cfg!(feature = "telemetry") => self.subscribe(period_ticks),
            Command::Subscribe { .. } => Err(Refusal::UnknownCommand),
            Command::Touch { x_m, y_m, age_ticks } => self.touch(ONLY_FINGER, (x_m, y_m), age_ticks, status),
            Command::Lift => self.lift(ONLY_FINGER),
            Command::FaultText { offset } => Ok(fault_text(self.board.reset_text, offset)),
            Command::SetLayer { .. } => self.change_playing(command, status),
            #[cfg(feature = "stream")]
            Command::StartStream { .. } => self.change_playing(command, status),
            #[cfg(feature = "stream")]
            Command::EndStream => self.end_stream(),
            #[cfg(not(feature = "stream"))]
            Command::StartStream { .. } | Command::EndStream => Err(Refusal::UnknownCommand),
            Command::TouchFinger { finger, x_m, y_m, age_ticks } => self.touch(finger, (x_m, y_m), age_ticks, status),
            Command::LiftFinger { finger } => self.lift(finger),
            Command::ClearFault => self.change_state(Order::ClearFault, &[State::Faulted], State::Disarmed),
            Command::Arm | Command::Disarm | Command::Play | Command::Stop => self.drive(command, status),
        }
    }

    /// Commands that a latched fault stands in the way of.
    fn drive(&mut self, command: Command, status: &Status) -> Result<Accepted, Refusal> {
        if self.state == State::Faulted
            && let Some((fault, _)) = status.fault
        {
            return Err(Refusal::Faulted(fault));
        }
        match command {
            Command::Disarm if matches!(self.orders.back(), Some(Order::Disarm)) => Ok(Accepted::Done),
            Command::Arm if !status.arm_switch => Err(Refusal::ArmSwitch),
            Command::Arm => self.change_state(Order::Arm, &[State::Disarmed], State::Armed),
            Command::Play if self.committed_crc32 == 0 => Err(Refusal::NoScene),
            Command::Play => self.change_state(Order::Play, &[State::Armed], State::Active),
            Command::Stop => self.change_state(Order::Stop, &[State::Active], State::Armed),
            _ => self.change_state(Order::Disarm, &[State::Disarmed, State::Armed, State::Active], State::Disarmed),
        }
    }

    fn change_state(&mut self, order: Order<'a>, from: &[State], to: State) -> Result<Accepted, Refusal> {
        if !from.contains(&self.state) {
            return Err(Refusal::WrongState(self.state));
        }
        self.send_order(order)?;
        self.set_state(to);
        Ok(Accepted::Done)
    }

    /// Refuses when there is no room for another order, but for those that put the output to zero.
    pub(super) fn room_for_order(&self) -> Result<(), Refusal> {
        if self.orders.len() + ORDERS_KEPT >= ORDERS_MAX { Err(Refusal::Busy) } else { Ok(()) }
    }

    #[inline(never)]
    pub(super) fn send_order(&mut self, order: Order<'a>) -> Result<(), Refusal> {
        if !matches!(order, Order::Stop | Order::Disarm) {
            self.room_for_order()?;
        }
        self.orders.push_back(order).map_err(|_| Refusal::Busy)?;
        self.orders_sent = self.orders_sent.wrapping_add(1);
        Ok(())
    }

    fn subscribe(&mut self, period_ticks: u32) -> Result<Accepted, Refusal> {
        if period_ticks != 0 && period_ticks < TELEMETRY_PERIOD_MIN_TICKS {
            return Err(Refusal::TelemetryTooFast { period_min_ticks: TELEMETRY_PERIOD_MIN_TICKS });
        }
        self.telemetry_period_ticks = period_ticks;
        Ok(Accepted::Done)
    }

    fn begin_scene(&mut self, len: u32, crc32: u32) -> Result<Accepted, Refusal> {
        let records = usize::from(self.board.limits.records_max);
        let max = (HEADER_LEN + records * RECORD_LEN + POINTS_MAX * POINT_LEN).min(SCENE_MAX_LEN) as u32;
        if len > max {
            return Err(Refusal::SceneTooLarge { len, max });
        }
        self.drop_upload();
        self.staging.begin();
        self.upload = Some(Upload::of_scene(len, crc32));
        Ok(Accepted::Done)
    }

    fn begin_bitmap(&mut self, width: u16, height: u16, crc32: u32, settled: bool) -> Result<Accepted, Refusal> {
        self.drop_upload();
        if self.spare.is_none() {
            // The ticker may still read the bitmaps of the scene before.
            return Err(Refusal::Busy);
        }
        if !self.announced_bitmaps.contains(&crc32) {
            let full = Refusal::BitmapPoolFull { len: u32::from(width) * u32::from(height), free: 0 };
            self.announced_bitmaps.push(crc32).map_err(|_| full)?;
        }
        if self.directory.find(crc32).is_some() {
            return Ok(Accepted::AlreadyHeld);
        }
        let bitmap = match self.make_room(width, height, crc32, settled) {
            // The scene that these were for does not fit: they give way to another.
            Err(full @ Refusal::BitmapPoolFull { .. }) => {
                self.announced_bitmaps.clear();
                return Err(full);
            }
            found => found?,
        };
        self.upload = Some(Upload::of_bitmap(bitmap));
        Ok(Accepted::Done)
    }

    /// Finds room for a bitmap: beside all others, else in the place of those that no scene wants, else, when nothing
    /// plays, in the place of the committed scene, those that stay moved together.
    fn make_room(&mut self, width: u16, height: u16, crc32: u32, settled: bool) -> Result<Bitmap, Refusal> {
        let pool_len = self.board.limits.bitmap_pool_bytes;
        if let Ok(bitmap) = self.directory.allocate(width, height, crc32, pool_len) {
            return Ok(bitmap);
        }
        let (committed, announced) = (&self.committed_bitmaps, &self.announced_bitmaps);
        self.directory.retain(|bitmap| committed.contains(&bitmap.crc32) || announced.contains(&bitmap.crc32));
        let refused = match self.directory.allocate(width, height, crc32, pool_len) {
            Ok(bitmap) => return Ok(bitmap),
            Err(free) => Refusal::BitmapPoolFull { len: u32::from(width) * u32::from(height), free },
        };
        if self.state == State::Active {
            return Err(refused);
        }
        if !settled {
            // The ticker may not have stopped yet, and still read what would be overwritten.
            return Err(Refusal::Busy);
        }
        if self.committed_crc32 != 0 {
            self.send_order(Order::Unload)?;
            self.committed_crc32 = 0;
            self.playing = Playing::default();
            self.committed_bitmaps.clear();
            let announced = &self.announced_bitmaps;
            self.directory.retain(|bitmap| announced.contains(&bitmap.crc32));
        }
        self.directory.compact(self.pool);
        self.directory.allocate(width, height, crc32, pool_len).map_err(|_| refused)
    }

    fn take_chunk(&mut self, number: u16, bytes: &[u8], outbox: &mut Outbox) {
        if let Some(upload) = &mut self.upload
            && let Report::Progress { next_chunk } = upload.take(number, bytes, &mut self.staging, self.pool)
        {
            outbox.send(&FromBoard::Progress { next_chunk, received_bytes: self.received_bytes });
        }
    }

    fn end_upload(&mut self) -> Result<Accepted, Refusal> {
        let Some(upload) = &self.upload else {
            return Err(Refusal::UploadIncomplete { next_chunk: 0 });
        };
        match upload.check() {
            Ok(()) => {
                if upload.destination == Destination::Scene {
                    let (len, crc32) = upload.len_and_crc32();
                    self.staging.finish(len, crc32);
                }
                self.upload = None;
                Ok(Accepted::Done)
            }
            Err(refusal @ Refusal::UploadIncomplete { .. }) => Err(refusal),
            Err(refusal) => {
                self.drop_upload();
                Err(refusal)
            }
        }
    }

    /// Leaves no trace of an upload under way.
    fn drop_upload(&mut self) {
        if let Some(Upload { destination: Destination::Bitmap(unfinished), .. }) = self.upload.take()
            && cfg!(feature = "bitmap")
        {
            self.directory.retain(|bitmap| bitmap.crc32 != unfinished.crc32);
        }
    }

    pub(super) fn commit(&mut self, crc32: u32) -> Result<Accepted, Refusal> {
        if self.upload.is_some() {
            return self.end_upload_first();
        }
        let (bytes, found) = self.staging.scene().ok_or(Refusal::NoScene)?;
        if found != crc32 {
            return Err(Refusal::CrcMismatch { expected: crc32, found });
        }
        self.room_for_order()?;
        let scene = Scene::parse(bytes).map_err(not_a_scene)?;
        let spare = self.spare.take().ok_or(Refusal::Busy)?;
        if let Err(refusal) = spare.load(&scene, &self.board, &self.directory) {
            self.spare = Some(spare);
            self.announced_bitmaps.clear();
            return Err(refusal);
        }
        self.committed_bitmaps = bitmaps_of(&scene);
        self.playing = Playing::new(&scene);
        #[cfg(feature = "stream")]
        self.drop_stream_without_layer();
        self.committed_crc32 = crc32;
        self.announced_bitmaps.clear();
        self.send_order(Order::Load(spare))?;
        Ok(Accepted::Done)
    }

    /// A commit while an upload is under way says how far that has come.
    fn end_upload_first(&self) -> Result<Accepted, Refusal> {
        let check = self.upload.as_ref().map_or(Ok(()), Upload::check);
        Err(check.err().unwrap_or(Refusal::UploadIncomplete { next_chunk: 0 }))
    }
}

/// Tells what this firmware was built without from what nobody knows.
fn not_a_scene(error: SceneError) -> Refusal {
    error.left_out().map_or(Refusal::Scene(error), |layer| Refusal::LeftOut { layer })
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

fn bitmaps_of(scene: &Scene) -> BitmapNames {
    if !cfg!(feature = "bitmap") {
        return BitmapNames::new();
    }
    scene
        .records()
        .filter_map(|record| match record.layer {
            Layer::Bitmap { crc32, .. } => Some(crc32),
            _ => None,
        })
        .take(RECORDS_MAX)
        .collect()
}
