//! The host's side of an emulated board: its serial port with the board's clock, and the record of the felt friction.

use std::cell::Cell;
use std::sync::mpsc::Receiver;
use std::thread::sleep;
use std::time::{Duration, Instant};

use frixel_driver::{ByteStream, DEFAULT_BAUD, Link as _, LinkClosed, PortError, SerialLink};
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::emulated::{BOARD, EmulatorError, InjectedFault, LinkBoard, LinkRecord};
use frixel_play::Recorded;
use frixel_wire::message::Telemetry;

use super::held_ticks::HeldTicks;

/// Wall time between two readings of the board's clock.
const POLL_PERIOD: Duration = Duration::from_millis(1);
/// Ticks that the board may run ahead of this host: 5 ms, so that a ping is in time for every host timeout.
const SLICE_TICKS: u32 = 200;
/// Wall time after which a clock that does not advance counts as stopped.
const PATIENCE: Duration = Duration::from_mins(2);
/// Number of ticks that are held until their telemetry arrives: 0.2 s.
const HELD_TICKS: usize = 8_000;

/// The serial port of an emulated board, with a clock that follows the board's ticks.
///
/// The clock stands still while bytes are on their way to the board, because the speed at which the emulator transfers
/// them depends on the load of the machine. The board's own clock stands still while this host has not answered for its
/// slice of time: sent the pings that are due in it, and seen all that it has sent arrive. Without that, a busy machine
/// would let the board run into the host timeout while the host does not run. A link that is dropped lets the board
/// run on, and the host timeout acts; so does a host that hangs for 10 s.
///
/// The record has every tick of the world. The emulated serial port is too slow for telemetry in every row: values that
/// only the board knows are in those rows for which a telemetry message arrived.
pub struct EmulatedStream<'b> {
    serial: SerialLink,
    board: &'b LinkBoard,
    /// Bytes that the board had received before the link was opened.
    received_before: u32,
    /// Tick count of the board when it was last read.
    seen_ticks: Cell<u32>,
    /// Ticks that have passed on the link's clock.
    clock_ticks: Cell<u64>,
    records: Receiver<LinkRecord>,
    held: HeldTicks,
}

impl<'b> EmulatedStream<'b> {
    /// Opens the board's serial port. `records` receives the ticks that [`LinkBoard::start`] reports.
    pub fn open(board: &'b LinkBoard, records: Receiver<LinkRecord>) -> Result<Self, PortError> {
        let serial = SerialLink::open(board.serial_path(), DEFAULT_BAUD)?;
        let counts = board.received_bytes().and_then(|received| Ok((received, board.ticks()?)));
        let not_opened = |error: EmulatorError| PortError::NotOpened {
            port: board.serial_path().to_owned(),
            reason: error.to_string(),
        };
        let (received_before, ticks) = counts.map_err(not_opened)?;
        let link = Self {
            serial,
            board,
            received_before,
            seen_ticks: Cell::new(ticks),
            clock_ticks: Cell::new(0),
            records,
            held: HeldTicks::default(),
        };
        let opened = board.host_answers_to(ticks.wrapping_add(SLICE_TICKS)).and_then(|()| board.set_host_open(true));
        opened.map(|()| link).map_err(not_opened)
    }

    /// Advances the clock with the board's. Returns whether all that was sent has arrived.
    fn follow(&self) -> Result<bool, EmulatorError> {
        let ticks = self.board.ticks()?;
        let passed = ticks.wrapping_sub(self.seen_ticks.replace(ticks));
        let received = self.board.received_bytes()?.wrapping_sub(self.received_before);
        // Both counts wrap at 2^32; their difference always fits in an `i32`.
        let has_arrived = (self.serial.written().bytes as u32).wrapping_sub(received) as i32 <= 0;
        if has_arrived {
            self.clock_ticks.update(|clock| clock + u64::from(passed));
        }
        Ok(has_arrived)
    }

    /// Answers for the next slice of the board's time once all that was sent has arrived.
    fn answer(&self) -> Result<(), EmulatorError> {
        if self.follow()? {
            self.board.host_answers_to(self.seen_ticks.get().wrapping_add(SLICE_TICKS))?;
        }
        Ok(())
    }

    /// Resets the board, and returns when it has started again. Nothing is on its way to the board meanwhile: the
    /// emulator would lose it, and the clock would wait for it.
    pub(super) fn reset_board(&self) -> Result<(), EmulatorError> {
        let starts = self.board.starts()?;
        wait_for("all bytes", || self.follow())?;
        self.board.inject(InjectedFault::Reset)?;
        wait_for("a start", || Ok(self.board.starts()? != starts))
    }

    /// Records all ticks so far except the last `held`.
    fn record_ticks(&mut self, held: usize) {
        self.held.hold(self.records.try_iter());
        self.held.record(held);
    }
}

impl Recorded for EmulatedStream<'_> {
    type Recorder = Recorder;

    fn recorder_mut(&mut self) -> &mut Recorder {
        &mut self.held.recorder
    }

    fn begin(&mut self) -> Result<(), LinkClosed> {
        self.board.start_stroke();
        self.held.recorder.start(self.board.tick().map_err(|error| closed(self.board, &error))?);
        Ok(())
    }

    fn record(&mut self, telemetry: &[Telemetry]) {
        self.held.hear(telemetry.iter().copied());
        self.record_ticks(HELD_TICKS);
    }

    fn record_rest(&mut self) {
        self.record_ticks(0);
    }
}

impl ByteStream for EmulatedStream<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
        self.serial.write(bytes).map(|_| ())
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let end = self.now() + wait;
        let before = buffer.len();
        let (mut moved_at, mut seen) = (Instant::now(), self.now());
        // At its end the caller may have a ping to send, and the board waits for it.
        while buffer.len() == before && self.now() < end {
            self.answer().map_err(|error| closed(self.board, &error))?;
            self.serial.read(buffer, POLL_PERIOD)?;
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
        // If the emulator has exited, the clock stands still, and the next read returns the error.
        let _ = self.follow();
        Duration::from_secs(self.clock_ticks.get()) / BOARD.tick_hz
    }

    fn name(&self) -> &str {
        self.serial.name()
    }
}

impl Drop for EmulatedStream<'_> {
    fn drop(&mut self) {
        // If the emulator has exited, there is no clock to start.
        let _ = self.board.set_host_open(false);
    }
}

/// Waits for the board to do something.
fn wait_for(what: &'static str, is_done: impl Fn() -> Result<bool, EmulatorError>) -> Result<(), EmulatorError> {
    let begun = Instant::now();
    while !is_done()? {
        if begun.elapsed() > PATIENCE {
            return Err(EmulatorError::Silent { what, seconds: PATIENCE.as_secs() });
        }
        sleep(POLL_PERIOD);
    }
    Ok(())
}

fn closed(board: &LinkBoard, error: &EmulatorError) -> LinkClosed {
    LinkClosed { port: board.serial_path().to_owned(), reason: error.to_string() }
}
