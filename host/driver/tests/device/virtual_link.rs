//! A line to a fake board in virtual time: bytes take the time that the line rate gives them, and can be lost or
//! damaged.

use std::collections::VecDeque;
use std::ops::Range;
use std::time::Duration;

use frixel_driver::{ByteStream, Device, LinkClosed, PollingLink};

use crate::fake_board::{FakeBoard, WINDOW};

/// 2 Mbaud, ten bits a byte.
pub(crate) const BYTES_PER_S: u32 = 200_000;

/// What becomes of a frame on the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fate {
    Arrives,
    Lost,
    /// Only so many of its last bytes arrive.
    Tail(usize),
    /// This byte is changed.
    Damaged(usize),
}

/// Says what becomes of a frame, by its number from zero and its bytes.
pub(crate) type Weather = Box<dyn FnMut(u64, &[u8]) -> Fate>;

/// A link over the line, which pings as every link without a thread does.
pub(crate) type VirtualLink = PollingLink<VirtualLine>;

/// The line of a device.
pub(crate) fn line_of(device: &mut Device<VirtualLink>) -> &mut VirtualLine {
    device.link_mut().stream_mut()
}

pub(crate) struct VirtualLine {
    pub(crate) board: FakeBoard,
    pub(crate) to_board_weather: Weather,
    pub(crate) to_host_weather: Weather,
    /// The cable is pulled at this time.
    pub(crate) pulled_at: Option<Duration>,
    /// Time that the board takes before it looks at what has arrived.
    pub(crate) board_delay: Duration,
    /// Time that the board takes for each frame, one after the other.
    pub(crate) board_time_per_frame: Duration,
    /// From when to when the board looks at nothing, as while it erases flash.
    pub(crate) board_pause: Range<Duration>,
    /// Most bytes that were on the way to the board, or there and not looked at.
    pub(crate) most_under_way: usize,
    /// Bytes that the line takes in a second, in both directions.
    pub(crate) bytes_per_s: u32,
    board_free_at: Duration,
    now: Duration,
    to_board: Line,
    to_host: Line,
    frames_to_board: u64,
    frames_to_host: u64,
}

/// One direction.
#[derive(Default)]
struct Line {
    free_at: Duration,
    under_way: VecDeque<(Duration, Vec<u8>)>,
}

impl Line {
    /// Returns when the last byte arrives.
    fn time_to_send(&mut self, bytes: &[u8], now: Duration, bytes_per_s: u32) -> Duration {
        let takes = Duration::from_secs(bytes.len() as u64) / bytes_per_s;
        self.free_at = self.free_at.max(now) + takes;
        self.free_at
    }

    fn next_arrival(&self) -> Option<Duration> {
        self.under_way.front().map(|(at, _)| *at)
    }

    fn arrived(&mut self, now: Duration) -> Option<Vec<u8>> {
        let (_, bytes) = self.under_way.pop_front_if(|(at, _)| *at <= now)?;
        Some(bytes)
    }
}

impl VirtualLine {
    pub(crate) fn new(board: FakeBoard) -> Self {
        Self {
            board,
            to_board_weather: Box::new(|_, _| Fate::Arrives),
            to_host_weather: Box::new(|_, _| Fate::Arrives),
            pulled_at: None,
            board_delay: Duration::ZERO,
            board_time_per_frame: Duration::ZERO,
            board_free_at: Duration::ZERO,
            board_pause: Duration::ZERO..Duration::ZERO,
            most_under_way: 0,
            bytes_per_s: BYTES_PER_S,
            now: Duration::ZERO,
            to_board: Line::default(),
            to_host: Line::default(),
            frames_to_board: 0,
            frames_to_host: 0,
        }
    }

    fn send_to_host(&mut self, bytes: &[u8]) {
        for frame in bytes.split_inclusive(|byte| *byte == 0) {
            let fate = (self.to_host_weather)(self.frames_to_host, frame);
            self.frames_to_host += 1;
            let bytes = weathered(frame, fate);
            let arrives = self.to_host.time_to_send(&bytes, self.now, self.bytes_per_s);
            self.to_host.under_way.push_back((arrives, bytes));
        }
    }

    /// Does what is due now.
    fn step(&mut self) {
        while let Some(bytes) = self.to_board.arrived(self.now) {
            let answer = self.board.receive(&bytes, self.now);
            self.send_to_host(&answer);
        }
        let unasked = self.board.poll(self.now);
        self.send_to_host(&unasked);
    }

    fn next_event_at(&self) -> Option<Duration> {
        let arrivals = [self.to_board.next_arrival(), self.to_host.next_arrival()];
        arrivals.into_iter().chain([self.board.next_poll(), self.pulled_at]).flatten().min()
    }

    fn check_plugged(&self) -> Result<(), LinkClosed> {
        if self.pulled_at.is_some_and(|at| at <= self.now) {
            return Err(LinkClosed { port: self.name().into(), reason: "pulled".into() });
        }
        Ok(())
    }
}

impl ByteStream for VirtualLine {
    fn write(&mut self, frame: &[u8]) -> Result<(), LinkClosed> {
        self.check_plugged()?;
        let fate = (self.to_board_weather)(self.frames_to_board, frame);
        let bytes = weathered(frame, fate);
        let arrives = self.to_board.time_to_send(&bytes, self.now, self.bytes_per_s) + self.board_delay;
        let seen = if self.board_pause.contains(&arrives) { self.board_pause.end } else { arrives };
        self.board_free_at = self.board_free_at.max(seen) + self.board_time_per_frame;
        self.to_board.under_way.push_back((self.board_free_at, bytes));
        self.frames_to_board += 1;
        let under_way: usize = self.to_board.under_way.iter().map(|(_, bytes)| bytes.len()).sum();
        self.most_under_way = self.most_under_way.max(under_way);
        assert!(under_way <= usize::from(WINDOW), "the host sent {under_way} bytes beyond what the board acknowledged");
        Ok(())
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let end = self.now + wait;
        let len_before = buffer.len();
        loop {
            self.check_plugged()?;
            self.step();
            while let Some(bytes) = self.to_host.arrived(self.now) {
                buffer.extend(bytes);
            }
            if buffer.len() > len_before {
                return Ok(());
            }
            match self.next_event_at() {
                Some(at) if at <= end => self.now = self.now.max(at),
                _ => {
                    self.now = end;
                    return Ok(());
                }
            }
        }
    }

    fn now(&self) -> Duration {
        self.now
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
