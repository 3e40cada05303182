//! A board that speaks the protocol and does nothing else, except to misbehave when told to.

use std::collections::BTreeMap;
use std::time::Duration;

use frixel_wire::fault::{Flags, State};
use frixel_wire::frame::{Decoder, FRAME_MAX_LEN, crc32};
use frixel_wire::hello::{BoardKind, BoardLimits, Hello, PROTOCOL_MAJOR, PROTOCOL_MINOR, ResetCause};
use frixel_wire::message::{Accepted, Answer, Command, FromBoard, Refusal, Request, Telemetry, TickTimes};
use frixel_wire::payload::{Payload, from_board_frame, hello_frame};

pub(crate) const TICK_HZ: u32 = 40_000;
pub(crate) const WINDOW: u16 = 4096;
/// Samples that the board has room for.
const STREAM_LEN: usize = 1024;
/// Chunks that go by until the board reports the one that it expects, as in the firmware.
const CHUNKS_PER_PROGRESS: u16 = 5;

pub(crate) type Refuse = Box<dyn FnMut(&Command) -> Option<Refusal> + Send>;

pub(crate) struct FakeBoard {
    pub(crate) hello: Hello,
    pub(crate) state: State,
    pub(crate) bitmaps: BTreeMap<u32, Vec<u8>>,
    pub(crate) scene: Option<Vec<u8>>,
    /// Commands in the order of their coming, pings left out.
    pub(crate) commands: Vec<Command>,
    /// Longest time without a good frame since the hello.
    pub(crate) longest_silence: Duration,
    pub(crate) pings: u32,
    pub(crate) hellos: u32,
    /// Chunks that go by until it says which one it expects next; `None` if it never does.
    pub(crate) chunks_per_progress: Option<u16>,
    /// Never says a word.
    pub(crate) mute: bool,
    /// Commands that it refuses, and why.
    pub(crate) refuse: Option<Refuse>,
    /// A state that every answer contains, whatever the state is.
    pub(crate) claims: Option<State>,
    /// Sent in front of the first hello.
    pub(crate) garbage: Vec<u8>,
    /// Somebody presses the reset button at this time.
    pub(crate) reset_at: Option<Duration>,
    /// The state changes at this time, as when the host was silent.
    pub(crate) falls_to: Option<(Duration, State)>,
    /// Unsolicited bytes, and when to send them.
    pub(crate) says_at: Option<(Duration, Vec<u8>)>,
    pub(crate) tick_times: TickTimes,
    /// Samples of the stream under way, and how many of them have been played: so many more at every ping.
    pub(crate) samples: Vec<u16>,
    pub(crate) plays_per_ping: usize,
    played: usize,
    streams: bool,
    decoder: Decoder,
    received_bytes: u32,
    last_heard: Duration,
    staged_scene: Option<Vec<u8>>,
    upload: Option<FakeUpload>,
    telemetry: Option<(Duration, Duration)>,
}

struct FakeUpload {
    bitmap: bool,
    len: usize,
    crc32: u32,
    next_chunk: u16,
    gap_reported: bool,
    bytes: Vec<u8>,
}

impl FakeBoard {
    pub(crate) fn new() -> Self {
        Self {
            hello: hello(),
            state: State::Disarmed,
            bitmaps: BTreeMap::new(),
            scene: None,
            commands: Vec::new(),
            longest_silence: Duration::ZERO,
            pings: 0,
            hellos: 0,
            chunks_per_progress: Some(CHUNKS_PER_PROGRESS),
            mute: false,
            refuse: None,
            claims: None,
            garbage: Vec::new(),
            reset_at: None,
            falls_to: None,
            says_at: None,
            tick_times: TickTimes::default(),
            samples: Vec::new(),
            plays_per_ping: 0,
            played: 0,
            streams: false,
            decoder: Decoder::new(),
            received_bytes: 0,
            last_heard: Duration::ZERO,
            staged_scene: None,
            upload: None,
            telemetry: None,
        }
    }

    /// Takes bytes from the line; returns those for the line.
    pub(crate) fn receive(&mut self, bytes: &[u8], now: Duration) -> Vec<u8> {
        let mut out = Vec::new();
        for &byte in bytes {
            self.received_bytes = self.received_bytes.wrapping_add(1);
            if let Some(payload) = self.decoder.push(byte).map(<[u8]>::to_vec) {
                self.take(&payload, now, &mut out);
            }
        }
        if self.mute { Vec::new() } else { out }
    }

    /// When [`Self::poll`] has something to send.
    pub(crate) fn next_poll(&self) -> Option<Duration> {
        let telemetry = self.telemetry.map(|(next, _)| next);
        let fall = self.falls_to.map(|(at, _)| at);
        let says = self.says_at.as_ref().map(|(at, _)| *at);
        [telemetry, fall, says, self.reset_at].into_iter().flatten().min()
    }

    /// What the board sends by itself.
    pub(crate) fn poll(&mut self, now: Duration) -> Vec<u8> {
        let mut out = Vec::new();
        if self.reset_at.take_if(|at| *at <= now).is_some() {
            *self = Self { commands: std::mem::take(&mut self.commands), ..Self::new() };
        }
        if let Some((_, state)) = self.falls_to.take_if(|(at, _)| *at <= now) {
            self.state = state;
            send(&mut out, &FromBoard::StateChanged { state, fault: None, flags: Flags::HOST_SILENT });
        }
        if let Some((_, bytes)) = self.says_at.take_if(|(at, _)| *at <= now) {
            out.extend(bytes);
        }
        while let Some((next, period)) = self.telemetry
            && next <= now
        {
            let tick = (next.as_secs_f64() * f64::from(TICK_HZ)).round() as u32;
            send(&mut out, &FromBoard::Telemetry(Telemetry { tick, state: self.state, ..Telemetry::default() }));
            self.telemetry = Some((next + period, period));
        }
        if self.mute { Vec::new() } else { out }
    }

    fn take(&mut self, payload: &[u8], now: Duration, out: &mut Vec<u8>) {
        if self.hellos > 0 {
            self.longest_silence = self.longest_silence.max(now.saturating_sub(self.last_heard));
        }
        self.last_heard = now;
        match Payload::parse_from_host(payload).expect("the host sends what the board reads") {
            Payload::HelloRequest { .. } => {
                self.hellos += 1;
                self.received_bytes = 0;
                self.upload = None;
                self.telemetry = None;
                if matches!(self.state, State::Armed | State::Active) {
                    self.state = State::Disarmed;
                }
                self.hello.state = self.state;
                out.append(&mut self.garbage);
                out.extend_from_slice(hello_frame(&self.hello, &mut [0; FRAME_MAX_LEN]).unwrap());
            }
            Payload::Request(request) => self.answer(request, now, out),
            Payload::Chunk { number, bytes } => self.take_chunk(number, bytes, out),
            Payload::Samples { first_index, samples } => {
                assert_eq!(first_index as usize, self.samples.len(), "samples come in order");
                self.samples.extend(samples.iter().map(|sample| u16::from_le_bytes(*sample)));
                assert!(self.samples.len() - self.played <= STREAM_LEN, "more samples than the board has room for");
            }
            other => panic!("a host does not send {other:?}"),
        }
    }

    fn answer(&mut self, Request { sequence, command }: Request, now: Duration, out: &mut Vec<u8>) {
        if command == Command::Ping {
            self.pings += 1;
        } else {
            self.commands.push(command);
        }
        let refused = self.refuse.as_mut().and_then(|refuse| refuse(&command));
        let outcome = match refused {
            Some(refusal) => Err(refusal),
            None => self.obey(command, now),
        };
        let state = self.claims.unwrap_or(self.state);
        let answer = Answer { sequence, received_bytes: self.received_bytes, state, outcome };
        send(out, &FromBoard::Answer(answer));
        match command {
            Command::StartStream { .. } => {
                (self.streams, self.played) = (true, 0);
                self.samples.clear();
                self.tell_of_stream(out);
            }
            Command::Ping if self.streams => {
                self.played = (self.played + self.plays_per_ping).min(self.samples.len());
                self.tell_of_stream(out);
            }
            _ => {}
        }
    }

    fn tell_of_stream(&self, out: &mut Vec<u8>) {
        let (next_index, buffered) = (self.samples.len(), self.samples.len() - self.played);
        send(
            out,
            &FromBoard::StreamProgress {
                next_index: next_index as u32,
                room: (STREAM_LEN - buffered) as u16,
                underruns: 7,
                gaps: 2,
                received_bytes: self.received_bytes,
            },
        );
    }

    fn obey(&mut self, command: Command, now: Duration) -> Result<Accepted, Refusal> {
        match command {
            Command::Ping
            | Command::Touch { .. }
            | Command::Lift
            | Command::SetLayer { .. }
            | Command::StartStream { .. }
            | Command::EndStream
            | Command::TouchFinger { .. }
            | Command::LiftFinger { .. } => {}
            Command::UploadScene { len, crc32 } => self.upload = Some(FakeUpload::new(false, len as usize, crc32)),
            Command::UploadBitmap { crc32, .. } if self.bitmaps.contains_key(&crc32) => {
                return Ok(Accepted::AlreadyHeld);
            }
            Command::UploadBitmap { width, height, crc32 } => {
                self.upload = Some(FakeUpload::new(true, usize::from(width) * usize::from(height), crc32));
            }
            Command::TickTimes => return Ok(Accepted::TickTimes(self.tick_times)),
            Command::FaultText { .. } => return Ok(Accepted::FaultText { len: 0, bytes: [0; 32] }),
            Command::UploadEnd => self.end_upload()?,
            Command::Commit { crc32: meant } if self.scene.as_ref().is_some_and(|scene| crc32(scene) == meant) => {}
            Command::Commit { crc32: meant } => {
                let staged = self.staged_scene.take_if(|scene| crc32(scene) == meant);
                self.scene = Some(staged.ok_or(Refusal::UploadIncomplete { next_chunk: 0 })?);
            }
            Command::Arm => self.step(State::Disarmed, State::Armed)?,
            Command::Disarm => self.state = State::Disarmed,
            Command::Play => self.step(State::Armed, State::Active)?,
            Command::Stop => self.step(State::Active, State::Armed)?,
            Command::ClearFault => self.step(State::Faulted, State::Disarmed)?,
            Command::Subscribe { period_ticks } => {
                let period = Duration::from_secs(u64::from(period_ticks)) / TICK_HZ;
                self.telemetry = (period_ticks > 0).then_some((now + period, period));
            }
        }
        Ok(Accepted::Done)
    }

    fn step(&mut self, from: State, to: State) -> Result<(), Refusal> {
        if self.state != from {
            return Err(Refusal::WrongState(self.state));
        }
        self.state = to;
        Ok(())
    }

    fn take_chunk(&mut self, number: u16, bytes: &[u8], out: &mut Vec<u8>) {
        let Some(upload) = &mut self.upload else { return };
        let Some(chunks_per_progress) = self.chunks_per_progress else { return upload.take(number, bytes) };
        // As the firmware: a chunk that was received before is ignored, and a gap is reported once.
        let early = number > upload.next_chunk && !upload.gap_reported;
        let fits = number == upload.next_chunk;
        upload.take(number, bytes);
        let due = upload.next_chunk.is_multiple_of(chunks_per_progress) || upload.bytes.len() == upload.len;
        upload.gap_reported = if fits { false } else { upload.gap_reported || early };
        if early || fits && due {
            let next_chunk = upload.next_chunk;
            send(out, &FromBoard::Progress { next_chunk, received_bytes: self.received_bytes });
        }
    }

    fn end_upload(&mut self) -> Result<(), Refusal> {
        let upload = self.upload.take_if(|upload| upload.bytes.len() >= upload.len);
        let Some(upload) = upload else {
            let next_chunk = self.upload.as_ref().map_or(0, |upload| upload.next_chunk);
            return Err(Refusal::UploadIncomplete { next_chunk });
        };
        let found = crc32(&upload.bytes);
        if found != upload.crc32 {
            return Err(Refusal::CrcMismatch { expected: upload.crc32, found });
        }
        if upload.bitmap {
            self.bitmaps.insert(found, upload.bytes);
        } else {
            self.staged_scene = Some(upload.bytes);
        }
        Ok(())
    }
}

impl FakeUpload {
    fn new(bitmap: bool, len: usize, crc32: u32) -> Self {
        Self { bitmap, len, crc32, next_chunk: 0, gap_reported: false, bytes: Vec::new() }
    }

    fn take(&mut self, number: u16, bytes: &[u8]) {
        if number == self.next_chunk {
            self.bytes.extend_from_slice(bytes);
            self.next_chunk += 1;
        }
    }
}

fn send(out: &mut Vec<u8>, message: &FromBoard) {
    out.extend_from_slice(from_board_frame(message, &mut [0; FRAME_MAX_LEN]).unwrap());
}

fn hello() -> Hello {
    Hello {
        protocol: (PROTOCOL_MAJOR, PROTOCOL_MINOR),
        firmware: (0, 1, 0),
        board: BoardKind::Simulator,
        id: *b"fake board 1",
        tick_hz: TICK_HZ,
        frame_max_len: FRAME_MAX_LEN as u16,
        features: 0,
        scene_crc32: 0,
        reset_cause: ResetCause::PowerOn,
        last_fault: None,
        fault_detail: 0,
        state: State::Disarmed,
        limits: BoardLimits {
            bitmap_pool_bytes: 80 * 1024,
            records_max: 64,
            receive_window_bytes: WINDOW,
            ..BoardLimits::UNSTATED
        },
        notices: 0,
    }
}
