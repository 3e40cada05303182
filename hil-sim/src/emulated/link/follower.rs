//! The world of a self-ticking board: it follows the board's output.

use std::fs::File;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};

use frixel_control::Drive;
use frixel_exchange::{BOARD, STAMPED_TOUCH_WORDS, StampedTouch, drive_of, layout};

use super::POLL_PERIOD;
use crate::emulated::EmulatorError;
use crate::emulated::memory::Memory;
use crate::{BoardView, RigTick, World, WorldFault};

/// A request from the board's owner to the world's thread.
#[derive(Debug)]
pub(super) enum Request {
    /// Starts the stroke.
    Stroke,
    /// Causes a fault of the world for a number of ticks.
    Fault(WorldFault, u64),
}

/// A world that follows the board's output.
pub(super) struct Follower {
    memory: Memory,
    /// The host's end of the serial port.
    serial: File,
    world: World,
    records: Sender<RigTick>,
    /// Number of drives that have been processed.
    seen: u32,
    /// Number of touch reports that have been written.
    reports: u32,
    /// Broken inputs of the board, each with its word and the end of the fault in ticks of the world.
    broken: Vec<(u64, usize)>,
    requests: Receiver<Request>,
}

impl Follower {
    pub(super) fn new(
        memory: Memory,
        serial: File,
        world: World,
        records: Sender<RigTick>,
        requests: Receiver<Request>,
    ) -> Self {
        Self { memory, serial, world, records, seen: 0, reports: 0, broken: Vec::new(), requests }
    }

    /// Follows the board until the owner drops its end of the requests.
    pub(super) fn run(mut self) -> Result<(), EmulatorError> {
        loop {
            match self.requests.recv_timeout(POLL_PERIOD) {
                Ok(Request::Stroke) => self.world.start_stroke(),
                Ok(Request::Fault(fault, ticks)) => self.begin_fault(fault, ticks)?,
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Ok(()),
            }
            self.follow()?;
            self.end_faults()?;
            // Ends exclusive mode, in which a host may have opened the port. It lasts as long as any process has the
            // port open.
            rustix::termios::ioctl_tiocnxcl(&self.serial)
                .map_err(|error| EmulatorError::system("freeing the emulator's serial port")(error.into()))?;
        }
    }

    /// Starts a fault, in the world and at the inputs simulated on the board.
    fn begin_fault(&mut self, fault: WorldFault, ticks: u64) -> Result<(), EmulatorError> {
        // `LinkBoard::cause` has checked the fault.
        let _ = self.world.cause(fault, ticks);
        if let Some((word, value)) = broken_input(fault) {
            self.memory.set(word, value)?;
            self.broken.push((self.world.tick().saturating_add(ticks), word));
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
