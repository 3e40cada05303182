//! A serial link to an emulated board that can be cut and that carries rubbish.

use std::sync::mpsc;
use std::time::Duration;

use frixel::rigs::EmulatedRig;
use frixel_driver::{Link, LinkClosed, PollingLink, Written};
use frixel_hil_sim::emulated::LinkBoard;
use frixel_play::RigStream;

/// A serial link to an emulated board. Dropped, it is cut: nothing is said to the board any more.
pub(crate) struct Cable<'b> {
    link: PollingLink<RigStream<'b, EmulatedRig<'b>>>,
    /// Sent in front of every frame, one after the other.
    rubbish: Vec<Vec<u8>>,
    frames: usize,
}

impl<'b> Cable<'b> {
    pub(crate) fn plug(board: &'b LinkBoard) -> Self {
        let rig = EmulatedRig::open(board, mpsc::channel().1).unwrap();
        Self { link: PollingLink::new(RigStream::new(rig)), rubbish: Vec::new(), frames: 0 }
    }

    /// With rubbish in front of every frame.
    pub(crate) fn with_rubbish(self, rubbish: Vec<Vec<u8>>) -> Self {
        Self { rubbish, ..self }
    }
}

impl Link for Cable<'_> {
    fn write(&mut self, frame: &[u8]) -> Result<u64, LinkClosed> {
        if !self.rubbish.is_empty() {
            self.link.write(&self.rubbish[self.frames % self.rubbish.len()])?;
            self.frames += 1;
        }
        self.link.write(frame)
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        self.link.read(buffer, wait)
    }

    fn now(&self) -> Duration {
        self.link.now()
    }

    fn keep_alive(&mut self, period: Duration) {
        self.link.keep_alive(period);
    }

    fn written(&self) -> Written {
        self.link.written()
    }

    fn name(&self) -> &str {
        self.link.name()
    }
}
