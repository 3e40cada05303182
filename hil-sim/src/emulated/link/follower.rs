//! The world of a self-ticking board: it follows the board's output.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use frixel_control::Drive;
use frixel_exchange::{BOARD, STAMPED_TOUCH_WORDS, StampedTouch, drive_of, layout};

use super::POLL_PERIOD;
use super::serial::Serial;
use crate::emulated::EmulatorError;
use crate::emulated::memory::Memory;
use crate::{BoardView, RigTick, World, WorldFault};

/// Requests from the board's owner to the world's thread.
#[derive(Debug, Default)]
pub(super) struct ControlFlags {
    pub(super) end: AtomicBool,
    pub(super) stroke: AtomicBool,
    /// Pending faults of the world, each with its duration in ticks.
    faults: Mutex<Vec<(WorldFault, u64)>>,
}

impl ControlFlags {
    pub(super) fn cause(&self, fault: WorldFault, ticks: u64) {
        self.faults.lock().unwrap_or_else(PoisonError::into_inner).push((fault, ticks));
    }

    fn take_faults(&self) -> Vec<(WorldFault, u64)> {
        std::mem::take(&mut *self.faults.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// A world that follows the board's output.
pub(super) struct Follower {
    memory: Memory,
    serial: Serial,
    world: World,
    records: Sender<RigTick>,
    /// Number of drives that have been processed.
    seen: u32,
    /// Number of touch reports that have been written.
    reports: u32,
    /// Broken inputs of the board, each with its word and the end of the fault in ticks of the world.
    broken: Vec<(u64, usize)>,
    flags: Arc<ControlFlags>,
}

impl Follower {
    pub(super) fn new(
        memory: Memory,
        serial: Serial,
        world: World,
        records: Sender<RigTick>,
        flags: Arc<ControlFlags>,
    ) -> Self {
        Self { memory, serial, world, records, seen: 0, reports: 0, broken: Vec::new(), flags }
    }

    /// Follows the board until the owner requests the end.
    pub(super) fn run(mut self) -> Result<(), EmulatorError> {
        while !self.flags.end.load(Ordering::Acquire) {
            if self.flags.stroke.swap(false, Ordering::AcqRel) {
                self.world.start_stroke();
            }
            self.begin_faults()?;
            self.follow()?;
            self.end_faults()?;
            self.serial.accept_next_host()?;
            thread::sleep(POLL_PERIOD);
        }
        Ok(())
    }

    /// Starts the requested faults, in the world and at the inputs simulated on the board.
    fn begin_faults(&mut self) -> Result<(), EmulatorError> {
        for (fault, ticks) in self.flags.take_faults() {
            // `LinkBoard::cause` has checked the fault.
            let _ = self.world.cause(fault, ticks);
            if let Some((word, value)) = broken_input(fault) {
                self.memory.set(word, value)?;
                self.broken.push((self.world.tick().saturating_add(ticks), word));
            }
        }
        Ok(())
    }

    fn end_faults(&mut self) -> Result<(), EmulatorError> {
        let now = self.world.tick();
        for (_, word) in self.broken.extract_if(.., |(end, _)| *end <= now) {
            self.memory.set(word, 0)?;
        }
        Ok(())
    }

    /// Advances the world to the board's current tick.
    fn follow(&mut self) -> Result<(), EmulatorError> {
        let mut waiting = self.memory.get(layout::DRIVES_WRITTEN)?.wrapping_sub(self.seen) as usize;
        if waiting > layout::DRIVES_LEN / 2 {
            return Err(EmulatorError::WorldBehind);
        }
        while waiting > 0 {
            let place = self.seen as usize % layout::DRIVES_LEN;
            let count = waiting.min(layout::DRIVES_LEN - place);
            let words = self.memory.get_all(layout::DRIVES + 2 * place, 2 * count)?;
            for [tick, word] in words.as_chunks().0 {
                self.tick(*tick, drive_of(*word))?;
            }
            self.seen = self.seen.wrapping_add(count as u32);
            waiting -= count;
        }
        Ok(())
    }

    /// Advances the world by one tick, and sends its touch report to the board.
    fn tick(&mut self, tick: u32, drive: Drive) -> Result<(), EmulatorError> {
        let felt = self.world.apply(drive);
        // Cannot fail: `LinkBoard` joins this thread before it drops the receiver.
        let _ = self.records.send(RigTick { tick: self.world.tick(), drive, felt, status: BoardView::Tick(tick) });
        match self.world.touch() {
            Some(touch) => self.report(StampedTouch { tick: tick.wrapping_add(1), touch }),
            None => Ok(()),
        }
    }

    /// Sends a report to the board. The report is lost when there is no room for it, as on a bus.
    fn report(&mut self, report: StampedTouch) -> Result<(), EmulatorError> {
        let waiting = self.reports.wrapping_sub(self.memory.get(layout::TOUCHES_READ)?);
        if waiting as usize >= layout::TOUCHES_LEN {
            return Ok(());
        }
        let mut words = Vec::with_capacity(STAMPED_TOUCH_WORDS);
        report.write(|word| words.push(word));
        let place = layout::TOUCHES + STAMPED_TOUCH_WORDS * (self.reports as usize % layout::TOUCHES_LEN);
        self.memory.set_all(place, &words)?;
        self.reports = self.reports.wrapping_add(1);
        self.memory.set(layout::TOUCHES_WRITTEN, self.reports)
    }
}

/// The word and value of the board's input broken by a fault; `None` for a fault of touch source or finger.
fn broken_input(fault: WorldFault) -> Option<(usize, u32)> {
    match fault {
        WorldFault::AmplifierNotReady => Some((layout::AMPLIFIER_FAULT, 1)),
        WorldFault::AmplifierStuckOn => Some((layout::OFF_DELAY_TICKS, u32::MAX)),
        WorldFault::AmplifierSlowOff { delay_s } => {
            Some((layout::OFF_DELAY_TICKS, (delay_s * f64::from(BOARD.tick_hz)).round() as u32))
        }
        WorldFault::AmplifierGain(gain) | WorldFault::MonitorGain(gain) => {
            Some((layout::MONITOR_LOSS, (1.0 - gain as f32).to_bits()))
        }
        WorldFault::DacStuck(code) => {
            Some((layout::DAC_HELD, layout::DAC_STUCK | u32::from(code.bits().cast_unsigned())))
        }
        WorldFault::SwitchOpen => Some((layout::ARM_SWITCH, layout::SWITCH_OPEN)),
        WorldFault::SwitchWelded => Some((layout::ARM_SWITCH, layout::SWITCH_WELDED)),
        WorldFault::TouchSilent | WorldFault::TouchStuck | WorldFault::TouchJumps { .. } | WorldFault::FingerLifted => {
            None
        }
    }
}
