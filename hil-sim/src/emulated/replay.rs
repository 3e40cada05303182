//! Compares the emulated board with the in-process board, bit for bit.

use std::thread;
use std::time::{Duration, Instant};

use frixel_exchange::{OUTPUT_WORDS_MAX, TickInput, TickOutput, layout};
use frixel_wire::fault::Fault;
use thiserror::Error;

use super::machine::Machine;
use super::{EmulatorError, Image};
use crate::Journal;

/// Wall time between two checks whether a batch is done.
const POLL_PERIOD: Duration = Duration::from_micros(200);
/// Wall time allowed for a batch, which takes well under a second.
const WALL_TIMEOUT: Duration = Duration::from_mins(2);

/// The first tick at which the boards differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// The output in the journal.
    pub expected: TickOutput,
    /// The output of the emulated board.
    pub found: TickOutput,
}

/// Why a journal could not be replayed.
#[derive(Debug, Error)]
pub enum ReplayError {
    /// There is no emulated board.
    #[error(transparent)]
    Emulator(#[from] EmulatorError),
    /// The outputs of the boards differ.
    #[error(
        "at tick {} the output of the emulated board differs: expected {:?}, found {:?}",
        .0.expected.tick, .0.expected, .0.found
    )]
    Mismatch(Box<Mismatch>),
}

/// Starts the image, sends it the inputs of the journal, and compares its outputs: drive, and bytes on the serial
/// line.
pub fn replay(image: &Image, journal: &Journal) -> Result<(), ReplayError> {
    let mut machine = Machine::start(image, layout::MODE_LOCKSTEP, &["-serial", "null"])?;
    for (batch, ticks) in (1..).zip(journal.chunks(layout::BATCH_TICKS_MAX)) {
        run(&mut machine, batch, ticks)?;
        compare(&machine, ticks)?;
    }
    Ok(())
}

/// Runs one batch on the board and waits until it is done.
fn run(machine: &mut Machine, batch: u32, ticks: &[(TickInput, TickOutput)]) -> Result<(), EmulatorError> {
    let mut words = Vec::new();
    for (input, _) in ticks {
        input.write(|word| words.push(word));
    }
    machine.memory.set_all(layout::INPUTS, &words)?;
    machine.memory.set(layout::BATCH_TICKS, ticks.len() as u32)?;
    machine.memory.set(layout::BATCH_GIVEN, batch)?;
    let begin = Instant::now();
    while machine.memory.get(layout::BATCH_DONE)? != batch {
        machine.check()?;
        check_starts(machine)?;
        if begin.elapsed() > WALL_TIMEOUT {
            return Err(EmulatorError::Silent { what: "a batch of ticks", seconds: WALL_TIMEOUT.as_secs() });
        }
        thread::sleep(POLL_PERIOD);
    }
    Ok(())
}

/// Returns an error if the firmware has restarted: it then waits for the first batch.
fn check_starts(machine: &Machine) -> Result<(), EmulatorError> {
    if machine.memory.get(layout::STARTS)? <= 1 {
        return Ok(());
    }
    let number = machine.memory.get(layout::LAST_FAULT)? as u8;
    let detail = machine.memory.get(layout::LAST_FAULT_DETAIL)?;
    Err(EmulatorError::Restarted { fault: Fault::try_from(number).unwrap_or(Fault::Other(number)), detail })
}

/// Compares one batch.
fn compare(machine: &Machine, ticks: &[(TickInput, TickOutput)]) -> Result<(), ReplayError> {
    let mut words = machine.memory.get_all(layout::OUTPUTS, ticks.len() * OUTPUT_WORDS_MAX)?.into_iter();
    for (_, expected) in ticks {
        let found = TickOutput::read(|| words.next().unwrap_or_default());
        if found != *expected {
            return Err(ReplayError::Mismatch(Box::new(Mismatch { expected: expected.clone(), found })));
        }
    }
    Ok(())
}
