//! An emulated board that ticks by itself, with its serial port behind a pseudo-terminal.

mod follower;

use std::fs::OpenOptions;
use std::io::Write;
use std::os::unix::fs::OpenOptionsExt;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use frixel_control::Drive;
use frixel_exchange::{drive_of, layout};
use rustix::fs::OFlags;

use super::machine::Machine;
use super::{EmulatorError, Image};
use crate::{OutOfRange, RigTick, World, WorldFault};
use follower::{Follower, Request};

/// An instruction takes 8 ns of virtual time, similar to a Cortex-M4F at 170 MHz. Virtual time waits if it is ahead of
/// wall time.
const ARGUMENTS: [&str; 4] = ["-icount", "shift=3,align=on", "-serial", "pty"];

/// Wall time between two checks of the board's output.
const POLL_PERIOD: Duration = Duration::from_millis(1);
/// Wall time allowed for starting the emulator on a busy machine.
const WALL_TIMEOUT: Duration = Duration::from_mins(2);

/// Faults that can be injected into an emulated board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum InjectedFault {
    /// The firmware panics.
    Panic = layout::INJECT_PANIC,
    /// The processor takes a hard fault.
    HardFault = layout::INJECT_HARD_FAULT,
    /// A tick misses its deadline.
    Overrun = layout::INJECT_OVERRUN,
    /// The stack overflows.
    StackOverflow = layout::INJECT_STACK_OVERFLOW,
    /// The board is reset.
    Reset = layout::INJECT_RESET,
}

/// An emulated board with the host's end of its serial line, and its world.
///
/// The board ticks on its own timer in virtual time, which never runs ahead of wall time and may fall behind it. The
/// world follows the board's output, and sends touch reports within a few milliseconds, each with its current age. The
/// amplifier's monitor is simulated on the board itself.
#[derive(Debug)]
pub struct LinkBoard {
    machine: Machine,
    serial_path: String,
    world: Option<JoinHandle<Result<(), EmulatorError>>>,
    records: Receiver<RigTick>,
    /// `None` once the world is to end.
    requests: Option<Sender<Request>>,
}

impl LinkBoard {
    /// Starts the board in a world whose finger stays up until [`Self::start_stroke`].
    pub fn start(image: &Image, world: World) -> Result<Self, EmulatorError> {
        let mut machine = Machine::start(image, layout::MODE_LINK, &ARGUMENTS)?;
        wait_for(&mut machine, layout::TICK, "its first tick")?;
        let output = machine.output()?;
        let serial_path = output.split_whitespace().find(|word| word.starts_with("/dev/")).map(str::to_owned);
        let failure = "the emulator has not reported its serial port".into();
        let serial_path = serial_path.ok_or(EmulatorError::Failed { failure, output })?;
        // Held open, because the emulator checks only once a second whether a client has opened it.
        let mut serial = OpenOptions::new()
            .read(true)
            .write(true)
            .custom_flags(OFlags::NOCTTY.bits() as i32)
            .open(&serial_path)
            .map_err(EmulatorError::system("opening the emulator's serial port"))?;
        // A single zero byte, which the board ignores.
        serial.write_all(&[0]).map_err(EmulatorError::system("writing to the emulator's serial port"))?;
        wait_for(&mut machine, layout::RECEIVED_BYTES, "reading a byte from its serial port")?;
        let memory = machine.memory.try_clone()?;
        let (sender, records) = mpsc::channel();
        let (requests, receiver) = mpsc::channel();
        let follower = Follower::new(memory, serial, world, sender, receiver);
        let world = thread::spawn(move || follower.run());
        Ok(Self { machine, serial_path, world: Some(world), records, requests: Some(requests) })
    }

    /// The pseudo-terminal that a host opens as its serial port.
    pub fn serial_path(&self) -> &str {
        &self.serial_path
    }

    /// Takes the ticks processed by the world since the last call, oldest first. They queue without bound until then.
    pub fn records(&self) -> impl Iterator<Item = RigTick> {
        self.records.try_iter()
    }

    /// Starts the finger's stroke.
    pub fn start_stroke(&self) {
        self.request(Request::Stroke);
    }

    /// Sends a request to the world. If the world has ended, [`Self::check`] returns the reason.
    fn request(&self, request: Request) {
        let _ = self.requests.as_ref().map(|requests| requests.send(request));
    }

    /// Causes a fault within a few milliseconds, for this many ticks.
    pub fn cause(&self, fault: WorldFault, ticks: u64) -> Result<(), OutOfRange> {
        fault.check()?;
        self.request(Request::Fault(fault, ticks));
        Ok(())
    }

    /// Returns the board's current output.
    pub fn output(&self) -> Result<Drive, EmulatorError> {
        self.machine.memory.get(layout::OUTPUT).map(drive_of)
    }

    /// Returns the board's output at the last start of its firmware.
    pub fn output_at_start(&self) -> Result<Drive, EmulatorError> {
        self.machine.memory.get(layout::OUTPUT_AT_START).map(drive_of)
    }

    /// Returns the number of ticks since power-on, modulo 2^32. This is the board's virtual time, except for the time
    /// in reset.
    pub fn ticks(&self) -> Result<u32, EmulatorError> {
        self.machine.memory.get(layout::DRIVES_WRITTEN)
    }

    /// Opens or closes a host's connection. While it is open, the board's clock pauses at the tick of
    /// [`Self::host_answers_to`], for at most 10 s without another answer.
    pub fn set_host_open(&self, is_open: bool) -> Result<(), EmulatorError> {
        self.machine.memory.set(layout::HOST_OPEN, u32::from(is_open))
    }

    /// Lets the clock of a board with an open connection run up to this tick, in [`Self::ticks`].
    pub fn host_answers_to(&self, ticks: u32) -> Result<(), EmulatorError> {
        self.machine.memory.set(layout::HOST_ANSWERED_TO, ticks)
    }

    /// Returns the number of bytes that have arrived on the serial port since power-on, modulo 2^32. The first one
    /// comes from the simulator itself.
    pub fn received_bytes(&self) -> Result<u32, EmulatorError> {
        self.machine.memory.get(layout::RECEIVED_BYTES)
    }

    /// Returns the number of firmware starts.
    pub fn starts(&self) -> Result<u32, EmulatorError> {
        self.machine.memory.get(layout::STARTS)
    }

    /// Injects a fault into the firmware.
    pub fn inject(&self, fault: InjectedFault) -> Result<(), EmulatorError> {
        self.machine.memory.set(layout::INJECTED_FAULT, fault as u32)
    }

    /// Returns an error when the emulator or the world has ended.
    pub fn check(&mut self) -> Result<(), EmulatorError> {
        self.machine.check()?;
        match self.world.take_if(|world| world.is_finished()).map(JoinHandle::join) {
            Some(Ok(ended)) => ended,
            _ => Ok(()),
        }
    }
}

impl Drop for LinkBoard {
    fn drop(&mut self) {
        self.requests = None;
        if let Some(world) = self.world.take() {
            // The result cannot be returned from `drop`.
            let _ = world.join();
        }
    }
}

/// Waits until a word is non-zero.
fn wait_for(machine: &mut Machine, word: usize, what: &'static str) -> Result<(), EmulatorError> {
    let begin = Instant::now();
    while machine.memory.get(word)? == 0 {
        machine.check()?;
        if begin.elapsed() > WALL_TIMEOUT {
            return Err(EmulatorError::Silent { what, seconds: WALL_TIMEOUT.as_secs() });
        }
        thread::sleep(POLL_PERIOD);
    }
    Ok(())
}
