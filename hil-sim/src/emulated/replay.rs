//! Compares the emulated board with the in-process board, bit for bit.

use std::thread;
use std::time::{Duration, Instant};

use frixel_exchange::{OUTPUT_WORDS_MAX, TickOutput, layout};
use frixel_wire::fault::Fault;
use thiserror::Error;

use super::machine::Machine;
use super::{EmulatorError, Image};
use crate::Journal;

/// Number of ticks sent to the board at a time.
const BATCH_TICKS: usize = layout::BATCH_TICKS_MAX;
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
    let mut from_tick = 0;
    for batch in 1.. {
        let ticks = BATCH_TICKS.min(journal.ticks() - from_tick);
        if ticks == 0 {
            break;
        }
        run(&mut machine, batch, journal.input_words(from_tick, ticks), ticks)?;
        compare(&machine, journal, from_tick, ticks)?;
        from_tick += ticks;
    }
    Ok(())
}

/// Runs one batch on the board and waits until it is done.
fn run(machine: &mut Machine, batch: u32, inputs: &[u32], ticks: usize) -> Result<(), EmulatorError> {
    machine.memory.set_all(layout::INPUTS, inputs)?;
    machine.memory.set(layout::BATCH_TICKS, ticks as u32)?;
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
fn compare(machine: &Machine, journal: &Journal, from_tick: usize, ticks: usize) -> Result<(), ReplayError> {
    let expected = journal.output_words(from_tick, ticks);
    if machine.memory.get_all(layout::OUTPUTS, expected.len())? == expected {
        return Ok(());
    }
    let found = machine.memory.get_all(layout::OUTPUTS, ticks * OUTPUT_WORDS_MAX)?;
    let (mut expected, mut found) = (expected.iter().copied(), found.into_iter());
    for _ in 0..ticks {
        let expected = TickOutput::read(|| expected.next().unwrap_or_default());
        let found = TickOutput::read(|| found.next().unwrap_or_default());
        if expected != found {
            return Err(ReplayError::Mismatch(Box::new(Mismatch { expected, found })));
        }
    }
    Ok(())
}
