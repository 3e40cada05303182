//! The emulated board as a [`BoardRig`], for scenarios.

use std::sync::mpsc::{self, Receiver};
use std::time::Duration;

use frixel_driver::{ByteStream as _, LinkClosed, PortError};
use frixel_hil_sim::emulated::{BOARD, EmulatorError, InjectedFault, LinkBoard, LinkRecord};
use frixel_hil_sim::{Board, BoardRig, RigError, RigFault, RigTick};

use super::EmulatedStream;

const NAME: &str = "the emulated board";
/// Longest time between two readings of the board's ticks.
const READ_MAX: Duration = Duration::from_millis(1);
/// The board runs 5 ms ahead of a host that answers, its world follows it in steps of a millisecond, and a busy machine
/// takes longer for either: 20 ms.
const LATENESS_TICKS: u64 = 800;

/// The firmware in an emulator, with its serial line and its world.
pub(crate) struct EmulatedRig<'b> {
    board: &'b LinkBoard,
    stream: EmulatedStream<'b>,
    /// Each tick of the world, with its number since power-on.
    records: Receiver<(u32, LinkRecord)>,
    /// Ticks since power-on, of which the board tells the lowest 32 bits.
    tick: u64,
}

impl<'b> EmulatedRig<'b> {
    /// Opens the board's serial port. `records` receives the ticks that [`LinkBoard::start`] reports, numbered from 1.
    pub(crate) fn open(board: &'b LinkBoard, records: Receiver<(u32, LinkRecord)>) -> Result<Self, PortError> {
        // The stream's own record stays empty.
        let (_, unrecorded) = mpsc::channel();
        let stream = EmulatedStream::open(board, unrecorded)?;
        let mut rig = Self { board, stream, records, tick: 0 };
        // Ticks before the host connected are none of the scenario's.
        rig.follow().map_err(|error| PortError::NotOpened {
            port: board.serial_path().to_owned(),
            reason: error.to_string(),
        })?;
        Ok(rig)
    }

    /// Takes over the board's count of ticks.
    fn follow(&mut self) -> Result<(), RigError> {
        let ticks = self.board.ticks().map_err(|error| ended(&error))?;
        self.tick += u64::from(ticks.wrapping_sub(self.tick as u32));
        Ok(())
    }

    /// Passes the ticks that have been followed to `watch`.
    fn watch(&mut self, watch: &mut dyn FnMut(&RigTick)) {
        for (tick, LinkRecord { drive, felt, .. }) in self.records.try_iter() {
            // The number of a tick is close to the last one that was read.
            let ago = (self.tick as u32).wrapping_sub(tick) as i32;
            watch(&RigTick { tick: self.tick.saturating_add_signed(-i64::from(ago)), drive, felt });
        }
    }
}

impl BoardRig for EmulatedRig<'_> {
    fn name(&self) -> &'static str {
        NAME
    }

    fn board(&self) -> &Board {
        &BOARD
    }

    fn tick(&self) -> u64 {
        self.tick
    }

    fn now(&self) -> Duration {
        self.stream.now()
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), RigError> {
        self.stream.write(bytes).map_err(|error| closed(&error))
    }

    fn run(
        &mut self,
        until_tick: u64,
        received: &mut Vec<u8>,
        watch: &mut dyn FnMut(&RigTick),
    ) -> Result<(), RigError> {
        loop {
            self.follow()?;
            self.watch(watch);
            let left = until_tick.saturating_sub(self.tick);
            if left == 0 || !received.is_empty() {
                return Ok(());
            }
            let left = Duration::from_secs(left) / BOARD.tick_hz;
            self.stream.read(received, left.min(READ_MAX)).map_err(|error| closed(&error))?;
        }
    }

    fn cause(&mut self, fault: RigFault, ticks: u64) -> Result<(), RigError> {
        let injected = match fault {
            RigFault::World(fault) => return Ok(self.board.cause(fault, ticks)?),
            RigFault::LateTick => InjectedFault::Overrun,
            RigFault::Reset => return self.stream.reset_board().map_err(|error| ended(&error)),
            RigFault::OptionBytes | RigFault::WrapSoon { .. } => {
                return Err(RigError::FaultUnavailable { rig: NAME, reason: "its emulator has no input for it" });
            }
        };
        self.board.inject(injected).map_err(|error| ended(&error))
    }

    fn start_stroke(&mut self) {
        self.board.start_stroke();
    }

    fn lateness_ticks(&self) -> u64 {
        LATENESS_TICKS
    }
}

fn ended(error: &EmulatorError) -> RigError {
    RigError::Ended { rig: NAME, reason: error.to_string() }
}

fn closed(closed: &LinkClosed) -> RigError {
    RigError::Ended { rig: NAME, reason: closed.to_string() }
}
