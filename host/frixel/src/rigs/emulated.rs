//! The host's side of an emulated board: its serial port on the board's clock, and what its finger felt.

mod recorder;

use std::cell::Cell;
use std::time::{Duration, Instant};

use frixel_hil_sim::emulated::{BOARD, EmulatorError, LinkBoard};

use frixel_driver::{DEFAULT_BAUD, DeviceError, Link, LinkClosed, SerialLink, Written};

pub use recorder::EmulatedRecorder;

/// Wall time between two looks at the board's clock.
const LOOK_EVERY: Duration = Duration::from_millis(2);
/// Wall time after which a clock that does not move is taken to have stopped.
const PATIENCE: Duration = Duration::from_mins(2);

/// A real serial port to an emulated board, on the board's clock.
///
/// The clock stands still while bytes are on their way to the board: how fast the emulator moves them depends on what
/// else the machine does.
pub struct EmulatedLink<'b> {
    serial: SerialLink,
    board: &'b LinkBoard,
    /// Bytes that the board had received when the link was opened.
    received_before: u32,
    /// Ticks of the board when they were last looked at.
    seen_ticks: Cell<u32>,
    /// Ticks that have passed on the link's clock.
    clock_ticks: Cell<u64>,
}

impl<'b> EmulatedLink<'b> {
    /// Opens the board's serial port.
    pub fn open(board: &'b LinkBoard) -> Result<Self, DeviceError> {
        let serial = SerialLink::open(board.serial_path(), DEFAULT_BAUD)?;
        let counts = board.received_bytes().and_then(|received| Ok((received, board.ticks()?)));
        let (received_before, ticks) =
            counts.map_err(|error| DeviceError::Vanished { command: "open", closed: closed(board, &error) })?;
        Ok(Self { serial, board, received_before, seen_ticks: Cell::new(ticks), clock_ticks: Cell::new(0) })
    }

    /// Lets the clock follow the board's.
    fn follow(&self) -> Result<(), EmulatorError> {
        let ticks = self.board.ticks()?;
        let passed = ticks.wrapping_sub(self.seen_ticks.replace(ticks));
        let received = self.board.received_bytes()?.wrapping_sub(self.received_before);
        // Both counts come round; the difference is never near that.
        let under_way = (self.serial.written().bytes as u32).wrapping_sub(received) as i32;
        if under_way <= 0 {
            self.clock_ticks.update(|clock| clock + u64::from(passed));
        }
        Ok(())
    }
}

impl Link for EmulatedLink<'_> {
    fn write(&mut self, frame: &[u8]) -> Result<u64, LinkClosed> {
        self.serial.write(frame)
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let end = self.now() + wait;
        let before = buffer.len();
        let (mut moved_at, mut seen) = (Instant::now(), self.now());
        while buffer.len() == before && self.now() < end {
            self.serial.read(buffer, LOOK_EVERY)?;
            self.follow().map_err(|error| closed(self.board, &error))?;
            if self.now() != seen {
                (moved_at, seen) = (Instant::now(), self.now());
            } else if moved_at.elapsed() > PATIENCE {
                let silent = EmulatorError::Silent { what: "a tick", seconds: PATIENCE.as_secs() };
                return Err(closed(self.board, &silent));
            }
        }
        Ok(())
    }

    fn now(&self) -> Duration {
        // Should the emulator have ended, the clock stands still, and reading says so.
        let _ = self.follow();
        Duration::from_secs(self.clock_ticks.get()) / BOARD.tick_hz
    }

    fn keep_alive(&mut self, frame: Vec<u8>, period: Duration) {
        self.serial.keep_alive(frame, period);
    }

    fn farewell(&mut self, frames: Vec<u8>) {
        self.serial.farewell(frames);
    }

    fn written(&self) -> Written {
        self.serial.written()
    }

    fn name(&self) -> &str {
        self.serial.name()
    }
}

fn closed(board: &LinkBoard, error: &EmulatorError) -> LinkClosed {
    LinkClosed { port: board.serial_path().to_owned(), reason: error.to_string() }
}
