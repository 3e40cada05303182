//! The firmware in an emulator, with its serial port and the world around it.

use std::cell::Cell;
use std::thread::sleep;
use std::time::{Duration, Instant};

use frixel_driver::{DEFAULT_BAUD, Link as _, LinkClosed, PortError, SerialLink};
use frixel_hil_sim::emulated::{BOARD, EmulatorError, InjectedFault, LinkBoard};
use frixel_hil_sim::{Board, BoardRig, RigError, RigFault, RigTick};

const NAME: &str = "the emulated board";
/// Wall time between two readings of the board's clock.
const POLL_PERIOD: Duration = Duration::from_millis(1);
/// Ticks that the board may run ahead of this host: 5 ms, so that a ping is in time for every host timeout.
const SLICE_TICKS: u32 = 200;
/// Wall time after which a clock that does not advance counts as stopped.
const STOPPED_AFTER: Duration = Duration::from_mins(2);
/// Tolerance of event times in ticks, 20 ms: the board runs 5 ms ahead of a host that answers, its world follows in
/// steps of a millisecond, and a busy machine takes longer for either.
const LATENESS_TICKS: u64 = 800;

/// An emulated board and the host's end of its serial port, on a clock that follows the board's ticks.
///
/// The clock stands still while bytes are on their way to the board, because the speed at which the emulator transfers
/// them depends on the load of the machine. The board's own clock stands still until this host has completed the
/// current slice of time: sent the pings that are due in it, and confirmed that everything sent has arrived. Otherwise
/// the board would run into the host timeout whenever a busy machine does not run the host. If the rig is dropped, or
/// the host hangs for 10 s, the board keeps running, and its host timeout fires.
pub struct EmulatedRig<'b> {
    serial: SerialLink,
    board: &'b LinkBoard,
    /// Bytes that the board had received before the port was opened.
    received_before: u32,
    /// Ticks of the board since power-on, when they were last read.
    ticks: Cell<u64>,
    /// Ticks that have passed on the host's clock.
    clock_ticks: Cell<u64>,
    /// Time at which the host's clock last advanced, or bytes were sent for which it stands still.
    advanced_at: Cell<Instant>,
}

impl<'b> EmulatedRig<'b> {
    /// Opens the board's serial port.
    pub fn open(board: &'b LinkBoard) -> Result<Self, PortError> {
        let serial = SerialLink::open(board.serial_path(), DEFAULT_BAUD)?;
        let counts = board.received_bytes().and_then(|received| Ok((received, board.ticks()?)));
        let not_opened = |error: EmulatorError| PortError::NotOpened {
            port: board.serial_path().to_owned(),
            reason: error.to_string(),
        };
        let (received_before, ticks) = counts.map_err(not_opened)?;
        let opened = board.host_answers_to(ticks.wrapping_add(SLICE_TICKS)).and_then(|()| board.set_host_open(true));
        opened.map_err(not_opened)?;
        Ok(Self {
            serial,
            board,
            received_before,
            ticks: Cell::new(u64::from(ticks)),
            clock_ticks: Cell::new(0),
            advanced_at: Cell::new(Instant::now()),
        })
    }

    /// Updates the clock from the board's count of ticks. Returns whether all bytes sent have arrived.
    fn follow(&self) -> Result<bool, EmulatorError> {
        let passed = self.board.ticks()?.wrapping_sub(self.ticks.get() as u32);
        self.ticks.update(|ticks| ticks + u64::from(passed));
        let received = self.board.received_bytes()?.wrapping_sub(self.received_before);
        // Both counts wrap at 2^32; their difference always fits in an `i32`.
        let has_arrived = (self.serial.written().bytes as u32).wrapping_sub(received) as i32 <= 0;
        if has_arrived && passed > 0 {
            self.clock_ticks.update(|clock| clock + u64::from(passed));
            self.advanced_at.set(Instant::now());
        }
        Ok(has_arrived)
    }

    /// Releases the next slice of the board's time if all bytes sent have arrived.
    fn answer(&self, has_arrived: bool) -> Result<(), EmulatorError> {
        if has_arrived {
            self.board.host_answers_to((self.ticks.get() as u32).wrapping_add(SLICE_TICKS))?;
        }
        if self.advanced_at.get().elapsed() > STOPPED_AFTER {
            return Err(EmulatorError::Silent { what: "a tick", seconds: STOPPED_AFTER.as_secs() });
        }
        Ok(())
    }

    /// Resets the board, and returns when it has started again. Waits first until all bytes sent have arrived: the
    /// emulator would lose them, and the clock would wait for them.
    fn reset(&self) -> Result<(), EmulatorError> {
        let starts = self.board.starts()?;
        wait_for("all bytes", || self.follow())?;
        self.board.inject(InjectedFault::Reset)?;
        wait_for("a start", || Ok(self.board.starts()? != starts))
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
        self.ticks.get()
    }

    fn now(&self) -> Duration {
        // If the emulator has exited, the clock stands still, and the next run returns the error.
        let _ = self.follow();
        Duration::from_secs(self.clock_ticks.get()) / BOARD.tick_hz
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), RigError> {
        self.advanced_at.set(Instant::now());
        self.serial.write(bytes).map(|_| ()).map_err(|error| closed(&error))
    }

    fn run(
        &mut self,
        until_tick: u64,
        received: &mut Vec<u8>,
        watch: &mut dyn FnMut(&RigTick),
    ) -> Result<(), RigError> {
        let before = received.len();
        loop {
            let has_arrived = self.follow().map_err(|error| ended(&error))?;
            for tick in self.board.records() {
                watch(&tick);
            }
            // When this returns, the caller may have a ping to send, for which the board waits.
            if self.ticks.get() >= until_tick || received.len() > before {
                return Ok(());
            }
            self.answer(has_arrived).map_err(|error| ended(&error))?;
            self.serial.read(received, POLL_PERIOD).map_err(|error| closed(&error))?;
        }
    }

    fn cause(&mut self, fault: RigFault, ticks: u64) -> Result<(), RigError> {
        let injected = match fault {
            RigFault::World(fault) => return Ok(self.board.cause(fault, ticks)?),
            RigFault::LateTick => InjectedFault::Overrun,
            RigFault::Reset => return self.reset().map_err(|error| ended(&error)),
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

impl Drop for EmulatedRig<'_> {
    fn drop(&mut self) {
        // If the emulator has exited, there is no clock to start.
        let _ = self.board.set_host_open(false);
    }
}

/// Waits until `is_done`.
fn wait_for(what: &'static str, is_done: impl Fn() -> Result<bool, EmulatorError>) -> Result<(), EmulatorError> {
    let begun = Instant::now();
    while !is_done()? {
        if begun.elapsed() > STOPPED_AFTER {
            return Err(EmulatorError::Silent { what, seconds: STOPPED_AFTER.as_secs() });
        }
        sleep(POLL_PERIOD);
    }
    Ok(())
}

fn ended(error: &EmulatorError) -> RigError {
    RigError::Ended { rig: NAME, reason: error.to_string() }
}

fn closed(closed: &LinkClosed) -> RigError {
    RigError::Ended { rig: NAME, reason: closed.reason.clone() }
}
