//! A serial link whose clock is the board's, that can be cut and that carries rubbish.

use std::time::Duration;

use frixel::device::{DEFAULT_BAUD, Link, LinkClosed, SerialLink, Written};
use frixel_hil_sim::emulated::LinkBoard;

/// Wall time between two looks at the board's clock.
const LOOK_EVERY: Duration = Duration::from_millis(2);

/// A serial link to an emulated board. Dropped, it is cut: nothing is said to the board any more.
pub(crate) struct Cable<'b> {
    serial: SerialLink,
    board: &'b LinkBoard,
    /// Sent in front of every frame, one after the other.
    rubbish: Vec<Vec<u8>>,
    frames: usize,
}

impl<'b> Cable<'b> {
    pub(crate) fn plug(board: &'b LinkBoard) -> Self {
        let serial = SerialLink::open(board.serial_path(), DEFAULT_BAUD).unwrap();
        Self { serial, board, rubbish: Vec::new(), frames: 0 }
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
        Duration::from_secs(u64::from(self.board.ticks().unwrap())) / 40_000
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
