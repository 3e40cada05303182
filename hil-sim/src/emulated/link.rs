//! An emulated board that ticks by itself, with its serial port behind a pseudo-terminal.

mod follower;
mod serial;

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use frixel_control::Drive;
use frixel_exchange::{drive_of, layout};

use super::machine::Machine;
use super::{EmulatorError, Image};
use crate::{Felt, World};
use follower::{Follower, Wishes};
use serial::Serial;

/// An instruction takes 8 ns of virtual time, which resembles a Cortex-M4F near 170 MHz. Virtual time waits for wall
/// time when it is ahead.
const ARGUMENTS: [&str; 4] = ["-icount", "shift=3,align=on", "-serial", "pty"];

/// Wall time between two looks at what the board has driven.
const LOOK_EVERY: Duration = Duration::from_millis(1);
/// Wall time that the emulator may take to start, on a machine that is busy with other things.
const PATIENCE: Duration = Duration::from_mins(2);

/// What an emulated board can be made to suffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mishap {
    /// The firmware panics.
    Panic,
    /// The processor takes a hard fault.
    HardFault,
    /// A tick misses its deadline.
    Overrun,
    /// The stack overflows.
    StackOverflow,
}

/// What happened at one tick.
#[derive(Clone, Copy, Debug)]
pub struct LinkRecord {
    /// Ticks since the board's last reset, this one included.
    pub tick: u32,
    /// What the board drove.
    pub drive: Drive,
    /// What the finger felt.
    pub felt: Felt,
}

/// An emulated board with a host's end of its serial line, and its world.
///
/// The board ticks on its own timer in virtual time that is never ahead of wall time, and may fall behind it. The world
/// follows what the board drives and reports touch back within some milliseconds, with the age that it then has; the
/// amplifier's monitor is the board's own.
#[derive(Debug)]
pub struct LinkBoard {
    machine: Machine,
    serial_path: String,
    world: Option<JoinHandle<Result<(), EmulatorError>>>,
    wishes: Arc<Wishes>,
}

impl LinkBoard {
    /// Starts the board in a world whose finger is up until [`Self::start_stroke`]. Every tick is shown to `watch`, in
    /// the world's own thread.
    pub fn start(
        image: &Image,
        world: World,
        watch: impl FnMut(&LinkRecord) + Send + 'static,
    ) -> Result<Self, EmulatorError> {
        let mut machine = Machine::start(image, layout::MODE_LINK, &ARGUMENTS)?;
        wait_for(&mut machine, layout::TICK, "its first tick")?;
        let output = machine.output()?;
        let serial_path = output.split_whitespace().find(|word| word.starts_with("/dev/")).map(str::to_owned);
        let serial_path = serial_path.ok_or(EmulatorError::NoSerialPort { output })?;
        let serial = Serial::open(&serial_path)?;
        serial.write_zero()?;
        wait_for(&mut machine, layout::RECEIVED_BYTES, "to take a byte from its serial port")?;
        let wishes = Arc::new(Wishes::default());
        let memory = machine.memory.try_clone()?;
        let follower = Follower::new(memory, serial, world, watch, Arc::clone(&wishes));
        let world = thread::spawn(move || follower.run());
        Ok(Self { machine, serial_path, world: Some(world), wishes })
    }

    /// The pseudo-terminal that a host opens as its serial port.
    pub fn serial_path(&self) -> &str {
        &self.serial_path
    }

    /// Puts the finger on the screen: its stroke begins now.
    pub fn start_stroke(&self) {
        self.wishes.stroke.store(true, Ordering::Release);
    }

    /// What the board drives now.
    pub fn output(&self) -> Result<Drive, EmulatorError> {
        self.machine.memory.get(layout::OUTPUT).map(drive_of)
    }

    /// What the board drove when its firmware last started.
    pub fn output_at_start(&self) -> Result<Drive, EmulatorError> {
        self.machine.memory.get(layout::OUTPUT_AT_START).map(drive_of)
    }

    /// Ticks since power-on, modulo 2^32: the board's virtual time, resets left out.
    pub fn ticks(&self) -> Result<u32, EmulatorError> {
        self.machine.memory.get(layout::DRIVES_WRITTEN)
    }

    /// Ticks since the board's last reset.
    pub fn tick(&self) -> Result<u32, EmulatorError> {
        self.machine.memory.get(layout::TICK)
    }

    /// Tick at which the last byte came on the serial port.
    pub fn received_at_tick(&self) -> Result<u32, EmulatorError> {
        self.machine.memory.get(layout::RECEIVED_AT_TICK)
    }

    /// Bytes that have come on the serial port since power-on, modulo 2^32; the first one is the simulator's own.
    pub fn received_bytes(&self) -> Result<u32, EmulatorError> {
        self.machine.memory.get(layout::RECEIVED_BYTES)
    }

    /// Times that the firmware has started.
    pub fn starts(&self) -> Result<u32, EmulatorError> {
        self.machine.memory.get(layout::STARTS)
    }

    /// Raises or lowers the amplifier's fault line.
    pub fn set_amplifier_fault(&self, raised: bool) -> Result<(), EmulatorError> {
        self.machine.memory.set(layout::AMPLIFIER_FAULT, u32::from(raised))
    }

    /// Lets something happen to the firmware.
    pub fn provoke(&self, mishap: Mishap) -> Result<(), EmulatorError> {
        let number = match mishap {
            Mishap::Panic => layout::PROVOKE_PANIC,
            Mishap::HardFault => layout::PROVOKE_HARD_FAULT,
            Mishap::Overrun => layout::PROVOKE_OVERRUN,
            Mishap::StackOverflow => layout::PROVOKE_STACK_OVERFLOW,
        };
        self.machine.memory.set(layout::PROVOKE, number)
    }

    /// An error when the emulator or the world has ended.
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
        self.wishes.end.store(true, Ordering::Release);
        if let Some(world) = self.world.take() {
            // Nobody is left who could be told how it ended.
            let _ = world.join();
        }
    }
}

/// Waits until a word is not zero.
fn wait_for(machine: &mut Machine, word: usize, what: &'static str) -> Result<(), EmulatorError> {
    let begin = Instant::now();
    while machine.memory.get(word)? == 0 {
        machine.check()?;
        if begin.elapsed() > PATIENCE {
            return Err(EmulatorError::Silent { what, seconds: PATIENCE.as_secs() });
        }
        thread::sleep(LOOK_EVERY);
    }
    Ok(())
}
