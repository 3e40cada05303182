//! A serial link whose clock is the board's, that can be cut and that carries rubbish.
//!
//! The clock stands still while bytes are on their way to the board: how fast the emulator moves them depends on what else
//! the machine does.

use std::cell::Cell;
use std::time::Duration;

use frixel::device::{DEFAULT_BAUD, Link, LinkClosed, SerialLink, Written};
use frixel_exchange::BOARD;
use frixel_hil_sim::emulated::LinkBoard;

/// Wall time between two looks at the board's clock.
const LOOK_EVERY: Duration = Duration::from_millis(2);

/// A serial link to an emulated board. Dropped, it is cut: nothing is said to the board any more.
pub(crate) struct Cable<'b> {
    serial: SerialLink,
    board: &'b LinkBoard,
    /// Bytes that the board had received when the cable was plugged in.
    received_before: u32,
    /// Ticks of the board when they were last looked at.
    seen_ticks: Cell<u32>,
    /// Ticks that have passed on the link's clock.
    clock_ticks: Cell<u64>,
    /// Sent in front of every frame, one after the other.
    rubbish: Vec<Vec<u8>>,
    frames: usize,
}

impl<'b> Cable<'b> {
    pub(crate) fn plug(board: &'b LinkBoard) -> Self {
        let serial = SerialLink::open(board.serial_path(), DEFAULT_BAUD).unwrap();
        Self {
            serial,
            board,
            received_before: board.received_bytes().unwrap(),
            seen_ticks: Cell::new(board.ticks().unwrap()),
            clock_ticks: Cell::new(0),
            rubbish: Vec::new(),
            frames: 0,
        }
    }

    /// Whether the board has received all that was sent.
    fn is_idle(&self) -> bool {
        let received = self.board.received_bytes().unwrap().wrapping_sub(self.received_before);
        received >= self.serial.written().bytes as u32
    }

    /// With rubbish in front of every frame.
    pub(crate) fn with_rubbish(self, rubbish: Vec<Vec<u8>>) -> Self {
        Self { rubbish, ..self }
    }
}

impl Link for Cable<'_> {
    fn write(&mut self, frame: &[u8]) -> Result<u64, LinkClosed> {
        if !self.rubbish.is_empty() {
            self.serial.write(&self.rubbish[self.frames % self.rubbish.len()])?;
            self.frames += 1;
        }
        self.serial.write(frame)
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let end = self.now() + wait;
        let before = buffer.len();
        while buffer.len() == before && self.now() < end {
            self.serial.read(buffer, LOOK_EVERY)?;
        }
        Ok(())
    }

    fn now(&self) -> Duration {
        let ticks = self.board.ticks().unwrap();
        let passed = ticks.wrapping_sub(self.seen_ticks.replace(ticks));
        if self.is_idle() {
            self.clock_ticks.update(|clock| clock + u64::from(passed));
        }
        Duration::from_secs(self.clock_ticks.get()) / BOARD.tick_hz
    }

    fn keep_alive(&mut self, frame: Vec<u8>, period: Duration) {
        self.serial.keep_alive(frame, period);
    }

    fn written(&self) -> Written {
        self.serial.written()
    }

    fn name(&self) -> &str {
        self.serial.name()
    }
}
