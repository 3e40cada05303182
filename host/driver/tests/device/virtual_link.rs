//! A line to the simulated board in virtual time.
//!
//! The line loses, damages and delays frames. It also fakes answers that the simulated board never gives.

use std::collections::{BTreeMap, VecDeque};
use std::ops::Range;
use std::time::Duration;

use frixel_driver::{ByteStream, Device, LinkClosed, PollingLink};
use frixel_hil_sim::{Board, BoardMemory, Point, Rig, RigConfig, Stroke};
use frixel_wire::fault::State;
use frixel_wire::frame::{Decoder, FRAME_MAX_LEN};
use frixel_wire::hello::Hello;
use frixel_wire::message::{Answer, Command, FromBoard, Refusal, Request};
use frixel_wire::payload::{Payload, request_frame};

/// The simulator's board at the tick rate of the slowest board, so that minutes pass quickly.
pub(crate) const BOARD: Board = Board { tick_hz: 8_000, ..Board::SIMULATOR };
pub(crate) const WINDOW: u16 = BOARD.limits.receive_window_bytes;
/// 2 Mbaud, ten bits a byte.
const BYTES_PER_S: u32 = 200_000;

/// Outcome of a frame on the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fate {
    Arrives,
    Lost,
    /// Only this number of bytes at its end arrives.
    Tail(usize),
    /// The byte at this index is changed.
    Damaged(usize),
}

/// Chooses the outcome of a frame from its number, counted from zero, and its bytes.
pub(crate) type Weather = Box<dyn FnMut(u64, &[u8]) -> Fate>;

/// Returns the refusal of a command that is kept from the board; `None` passes the command on.
type Refuse = Box<dyn FnMut(&Command) -> Option<Refusal>>;

/// Modifies a message from the board.
type Change = Box<dyn Fn(&mut Payload)>;

/// A link over the line. It pings like every link without a thread.
pub(crate) type VirtualLink = PollingLink<VirtualLine>;

/// The line of a device.
pub(crate) fn line_of(device: &mut Device<VirtualLink>) -> &mut VirtualLine {
    device.link_mut().stream_mut()
}

pub(crate) struct VirtualLine {
    pub(crate) rig: Rig<'static>,
    /// The board's state after the last tick.
    pub(crate) state: State,
    pub(crate) to_board_weather: Weather,
    pub(crate) to_host_weather: Weather,
    /// Time at which the cable is pulled.
    pub(crate) pulled_at: Option<Duration>,
    /// Delay of a frame beyond the transfer time of its bytes.
    pub(crate) board_delay: Duration,
    /// Processing time of the board per frame. Frames are processed one at a time.
    pub(crate) board_time_per_frame: Duration,
    /// Interval in which the board reads nothing, as while it erases flash.
    pub(crate) board_pause: Range<Duration>,
    /// Largest number of bytes in flight to the board or unread there.
    pub(crate) most_under_way: usize,
    /// Commands that arrived at the board, without pings.
    pub(crate) commands: Vec<Command>,
    pub(crate) pings: u32,
    pub(crate) hellos: u32,
    /// Longest time without a good frame since the first hello.
    pub(crate) longest_silence: Duration,
    /// Chooses commands that are refused in the board's place. A ping replaces each of them on the line.
    pub(crate) refuse: Option<Refuse>,
    /// Modifies messages from the board.
    says: Option<Change>,
    /// Bytes that arrive before the board's first frame.
    pub(crate) garbage: Vec<u8>,
    refused: BTreeMap<u16, Refusal>,
    /// Frames that the board has not read yet, with the times at which it reads them.
    waiting: VecDeque<(Duration, Vec<u8>)>,
    board_free_at: Duration,
    last_heard: Duration,
    at_board: Decoder,
    /// The beginning of the board's next frame.
    from_board: Vec<u8>,
    at_host: Vec<u8>,
    frames_to_board: u64,
    frames_to_host: u64,
}

impl VirtualLine {
    pub(crate) fn new() -> Self {
        Self::to(BOARD, BYTES_PER_S)
    }

    /// Creates a line to a board that has just started, with `bytes_per_s` bytes per second in each direction.
    pub(crate) fn to(board: Board, bytes_per_s: u32) -> Self {
        let config = RigConfig { board, baud: 10 * bytes_per_s, ..RigConfig::of(board) };
        let nowhere = Stroke::still(Point { x_m: 0.0, y_m: 0.0 }, 1.0).unwrap();
        Self {
            rig: Rig::new(Box::leak(BoardMemory::new()), &config, nowhere, 1).unwrap(),
            state: State::Disarmed,
            to_board_weather: Box::new(|_, _| Fate::Arrives),
            to_host_weather: Box::new(|_, _| Fate::Arrives),
            pulled_at: None,
            board_delay: Duration::ZERO,
            board_time_per_frame: Duration::ZERO,
            board_pause: Duration::ZERO..Duration::ZERO,
            most_under_way: 0,
            commands: Vec::new(),
            pings: 0,
            hellos: 0,
            longest_silence: Duration::ZERO,
            refuse: None,
            says: None,
            garbage: Vec::new(),
            refused: BTreeMap::new(),
            waiting: VecDeque::new(),
            board_free_at: Duration::ZERO,
            last_heard: Duration::ZERO,
            at_board: Decoder::new(),
            from_board: Vec::new(),
            at_host: Vec::new(),
            frames_to_board: 0,
            frames_to_host: 0,
        }
    }

    /// Changes the board's hello.
    pub(crate) fn change_hello(&mut self, change: impl Fn(&mut Hello) + 'static) {
        self.says = Some(Box::new(move |payload| {
            if let Payload::Hello(hello) = payload {
                change(hello);
            }
        }));
    }

    /// Changes the board's answers.
    pub(crate) fn change_answers(&mut self, change: impl Fn(&mut Answer) + 'static) {
        self.says = Some(Box::new(move |payload| {
            if let Payload::FromBoard(FromBoard::Answer(answer)) = payload {
                change(answer);
            }
        }));
    }

    /// Number of bytes that the board has not read yet.
    pub(crate) fn under_way(&mut self) -> usize {
        self.waiting.iter().map(|(_, bytes)| bytes.len()).sum::<usize>() + self.rig.line_to_board_mut().queued()
    }

    /// Advances the board by one tick.
    pub(crate) fn step(&mut self) {
        let now = self.now();
        while let Some((_, bytes)) = self.waiting.pop_front_if(|(at, _)| *at <= now) {
            self.look_at(&bytes);
            self.rig.send(&bytes);
        }
        self.state = self.rig.step().status.telemetry.state;
        self.rig.receive(&mut self.from_board);
        while let Some(end) = self.from_board.iter().position(|byte| *byte == 0) {
            let frame: Vec<u8> = self.from_board.drain(..=end).collect();
            self.say(&frame);
        }
    }

    /// Records the frames that arrive at the board.
    fn look_at(&mut self, mut bytes: &[u8]) {
        let now = self.now();
        while let Some(payload) = self.at_board.next_frame(&mut bytes) {
            if self.hellos > 0 {
                self.longest_silence = self.longest_silence.max(now.saturating_sub(self.last_heard));
            }
            self.last_heard = now;
            match Payload::parse_from_host(payload).expect("the host sends what the board reads") {
                Payload::HelloRequest { .. } => self.hellos += 1,
                Payload::Request(Request { command: Command::Ping, .. }) => self.pings += 1,
                Payload::Request(Request { command, .. }) => self.commands.push(command),
                _ => {}
            }
        }
    }

    /// Sends a frame of the board to the host.
    fn say(&mut self, frame: &[u8]) {
        let mut decoder = Decoder::new();
        let mut said = frame.to_vec();
        if let Some(payload) = decoder.next_frame(&mut &*frame) {
            let mut payload = Payload::parse_from_board(payload).unwrap();
            if let Payload::FromBoard(FromBoard::Answer(answer)) = &mut payload
                && let Some(refusal) = self.refused.remove(&answer.sequence)
            {
                answer.outcome = Err(refusal);
            }
            if let Some(says) = &self.says {
                says(&mut payload);
            }
            said = payload.write_frame(&mut [0; FRAME_MAX_LEN]).unwrap().to_vec();
        }
        self.at_host.append(&mut self.garbage);
        let fate = (self.to_host_weather)(self.frames_to_host, &said);
        self.frames_to_host += 1;
        self.at_host.extend(weathered(&said, fate));
    }

    /// The ping in place of a request that is refused.
    fn refused_request(&mut self, mut frame: &[u8]) -> Option<Vec<u8>> {
        let mut decoder = Decoder::new();
        let Ok(Payload::Request(Request { sequence, command })) =
            Payload::parse_from_host(decoder.next_frame(&mut frame)?)
        else {
            return None;
        };
        let refusal = self.refuse.as_mut()?(&command)?;
        self.commands.push(command);
        self.refused.insert(sequence, refusal);
        let ping = Request { sequence, command: Command::Ping };
        Some(request_frame(&ping, &mut [0; FRAME_MAX_LEN]).unwrap().to_vec())
    }

    fn check_plugged(&self) -> Result<(), LinkClosed> {
        if self.pulled_at.is_some_and(|at| at <= self.now()) {
            return Err(LinkClosed { port: self.name().into(), reason: "pulled".into() });
        }
        Ok(())
    }
}

impl ByteStream for VirtualLine {
    fn write(&mut self, frame: &[u8]) -> Result<(), LinkClosed> {
        self.check_plugged()?;
        let frame = self.refused_request(frame).unwrap_or_else(|| frame.to_vec());
        let fate = (self.to_board_weather)(self.frames_to_board, &frame);
        self.frames_to_board += 1;
        let arrives = self.now() + self.board_delay;
        let seen = if self.board_pause.contains(&arrives) { self.board_pause.end } else { arrives };
        self.board_free_at = self.board_free_at.max(seen) + self.board_time_per_frame;
        self.waiting.push_back((self.board_free_at, weathered(&frame, fate)));
        let under_way = self.under_way();
        self.most_under_way = self.most_under_way.max(under_way);
        assert!(under_way <= usize::from(WINDOW), "the host sent {under_way} bytes beyond what the board acknowledged");
        Ok(())
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let end = self.now() + wait;
        loop {
            self.check_plugged()?;
            if !self.at_host.is_empty() || self.now() >= end {
                buffer.append(&mut self.at_host);
                return Ok(());
            }
            self.step();
        }
    }

    fn now(&self) -> Duration {
        Duration::from_secs(self.rig.tick()) / self.rig.tick_hz()
    }

    fn name(&self) -> &'static str {
        "the virtual line"
    }
}

fn weathered(frame: &[u8], fate: Fate) -> Vec<u8> {
    let mut bytes = frame.to_vec();
    match fate {
        Fate::Arrives => {}
        Fate::Lost => bytes.clear(),
        Fate::Tail(len) => {
            bytes.drain(..bytes.len().saturating_sub(len));
        }
        Fate::Damaged(at) => {
            let at = at % bytes.len();
            bytes[at] ^= 0x40;
        }
    }
    bytes
}
