//! The host's end of the line to a rig: it damages bytes, causes the scenario's faults at their ticks, and passes every
//! tick to the checks.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::time::Duration;

use frixel_driver::{ByteStream, LinkClosed};
use frixel_hil_sim::{BoardRig, RigError};
use frixel_play::Recorded;
use frixel_scene::{At, Cause, Scenario};

use super::checks::Checks;
use super::direction::Direction;
use super::host::Failure;
use super::told::Told;
use super::{ScenarioError, ScenarioOutcome, TimelineEntry};

/// The line to a rig. Clones are the same line: a host that connects again has another one.
pub(super) struct ScenarioLine<'r>(Rc<RefCell<Inner<'r>>>, ());

impl Clone for ScenarioLine<'_> {
    fn clone(&self) -> Self {
        Self(Rc::clone(&self.0), ())
    }
}

struct Inner<'r> {
    rig: &'r mut dyn BoardRig,
    tick_hz: u32,
    /// The tick at which the scenario starts.
    first_tick: u64,
    to_board: Direction,
    to_host: Direction,
    faults: VecDeque<PlannedFault>,
    /// Faults of the line that are there.
    present: Vec<PlannedFault>,
    /// Bytes that have arrived at the host and were not read.
    inbox: Vec<u8>,
    /// Whether nobody sends: the host was killed.
    is_dead: bool,
    checks: Checks,
    told: Told,
    timeline: Vec<TimelineEntry>,
    /// Why the rig has ended, with the line of the fault that it could not cause.
    error: Option<(Option<usize>, RigError)>,
}

#[derive(Clone, Debug)]
struct PlannedFault {
    start: u64,
    end: u64,
    line: usize,
    name: Option<String>,
    cause: Cause,
}

impl<'r> ScenarioLine<'r> {
    pub(super) fn new(scenario: &Scenario, rig: &'r mut dyn BoardRig) -> Self {
        let (tick_hz, first_tick) = (rig.board().tick_hz, rig.tick());
        let ticks = |ms: f64| At::Ms(ms).tick(tick_hz);
        let mut faults: Vec<_> = scenario
            .faults
            .iter()
            .map(|fault| {
                let start = first_tick + fault.at.tick(tick_hz);
                let end = fault.for_ms.map_or(u64::MAX, |ms| start + ticks(ms));
                PlannedFault { start, end, line: fault.line, name: fault.name.clone(), cause: fault.cause }
            })
            .collect();
        faults.sort_by_key(|fault| fault.start);
        let end_tick = first_tick + ticks(1e3 * scenario.seconds);
        let checks = Checks::new(scenario, tick_hz, first_tick, end_tick, rig.lateness_ticks());
        let inner = Inner {
            rig,
            tick_hz,
            first_tick,
            to_board: Direction::new(scenario.seed),
            to_host: Direction::new(!scenario.seed),
            faults: faults.into(),
            present: Vec::new(),
            inbox: Vec::new(),
            is_dead: false,
            checks,
            told: Told::default(),
            timeline: Vec::new(),
            error: None,
        };
        Self(Rc::new(RefCell::new(inner)), ())
    }

    /// Ticks since the start.
    pub(super) fn ticks(&self) -> u64 {
        let inner = self.0.borrow();
        inner.rig.tick() - inner.first_tick
    }

    /// Ticks on the rig's clock.
    pub(super) fn rig_tick(&self) -> u64 {
        self.0.borrow().rig.tick()
    }

    pub(super) fn tick_hz(&self) -> u32 {
        self.0.borrow().tick_hz
    }

    /// Whether the rig has ended.
    pub(super) fn has_ended(&self) -> bool {
        self.0.borrow().error.is_some()
    }

    /// Lets time pass up to this tick since the start, in which nobody reads.
    pub(super) fn pass_to(&self, ticks: u64) {
        let mut inner = self.0.borrow_mut();
        let until = inner.first_tick + ticks;
        // An error is kept, and ends the scenario.
        let _ = inner.advance(until, false);
    }

    /// Sends bytes of another program on this line.
    pub(super) fn inject(&self, bytes: &[u8]) {
        let mut inner = self.0.borrow_mut();
        let tick = inner.rig.tick();
        inner.to_board.take(bytes, tick);
    }

    /// Lets the person press the arm switch anew, if the board has been armed since the start.
    pub(super) fn press_switch(&self) {
        let mut inner = self.0.borrow_mut();
        if inner.told.was_armed() {
            let until = inner.rig.press_switch() + inner.rig.tick();
            // An error is kept, and ends the scenario.
            let _ = inner.advance(until, false);
        }
    }

    /// The host is killed, or another one starts.
    pub(super) fn set_dead(&self, is_dead: bool) {
        self.0.borrow_mut().is_dead = is_dead;
    }

    /// Writes into the timeline, now.
    pub(super) fn note(&self, what: impl Into<String>) {
        self.0.borrow_mut().note(what);
    }

    /// A command has ended: expectations may count from now on.
    pub(super) fn named_event(&self, name: Option<&str>) {
        let mut inner = self.0.borrow_mut();
        let tick = inner.rig.tick();
        inner.checks.begin(name, tick);
    }

    /// What the scenario has shown, with the failures of the host.
    pub(super) fn outcome(self, scenario: &Scenario, failures: Vec<Failure>) -> Result<ScenarioOutcome, ScenarioError> {
        let mut inner = self.0.borrow_mut();
        if let Some((line, source)) = inner.error.take() {
            let file = line.map_or(scenario.file.clone(), |line| format!("{}:{line}", scenario.file));
            return Err(ScenarioError::Rig { file, source });
        }
        let unmet = inner.checks.unmet(&inner.told, failures);
        let mut timeline = std::mem::take(&mut inner.timeline);
        let first_tick = inner.first_tick;
        let of_board = inner.told.entries().map(|(tick, what)| {
            let t_ms = 1e3 * tick.saturating_sub(first_tick) as f64 / f64::from(inner.tick_hz);
            TimelineEntry { t_ms, what }
        });
        timeline.extend(of_board);
        timeline.sort_by(|one, other| one.t_ms.total_cmp(&other.t_ms));
        Ok(ScenarioOutcome { timeline, expectations: scenario.expectations.len(), unmet })
    }
}

impl Inner<'_> {
    fn note(&mut self, what: impl Into<String>) {
        let ticks = self.rig.tick() - self.first_tick;
        let t_ms = 1e3 * ticks as f64 / f64::from(self.tick_hz);
        self.timeline.push(TimelineEntry { t_ms, what: what.into() });
    }

    /// Lets time pass up to a tick, or until bytes are there for a host that reads.
    fn advance(&mut self, until: u64, reads: bool) -> Result<(), RigError> {
        loop {
            let tick = self.rig.tick();
            self.begin_and_end_faults(tick)?;
            self.deliver(tick)?;
            if tick >= until || reads && !self.inbox.is_empty() {
                return Ok(());
            }
            let next_due = [&self.to_board, &self.to_host].map(Direction::next_due);
            let next_fault = self.faults.front().map(|fault| fault.start);
            let next_end = self.present.iter().map(|fault| fault.end).min();
            let others = next_due.into_iter().chain([next_fault, next_end]).flatten();
            let until = others.fold(until, u64::min).max(tick + 1);
            let mut received = Vec::new();
            let checks = &mut self.checks;
            let ran = self.rig.run(until, &mut received, &mut |tick| checks.see(tick));
            self.keep(ran, None)?;
            let tick = self.rig.tick();
            self.to_host.take(&received, tick);
            let touches = self.rig.take_touch_frames();
            // A host that hangs or is gone does not pass them on.
            if reads {
                self.to_board.take(&touches, tick);
            }
        }
    }

    fn keep(&mut self, result: Result<(), RigError>, line: Option<usize>) -> Result<(), RigError> {
        if let Err(error) = &result {
            self.error.get_or_insert((line, error.clone()));
        }
        result
    }

    fn deliver(&mut self, tick: u64) -> Result<(), RigError> {
        while let Some(bytes) = self.to_board.due(tick) {
            let sent = self.rig.send(&bytes);
            self.keep(sent, None)?;
        }
        while let Some(bytes) = self.to_host.due(tick) {
            self.told.hear(&bytes, tick);
            self.inbox.extend(bytes);
        }
        Ok(())
    }

    fn begin_and_end_faults(&mut self, tick: u64) -> Result<(), RigError> {
        let mut line_changes = self.present.iter().any(|fault| fault.end <= tick);
        self.present.retain(|fault| fault.end > tick);
        while let Some(fault) = self.faults.pop_front_if(|fault| fault.start <= tick) {
            self.note(format!("fault of line {} begins", fault.line));
            self.checks.begin(fault.name.as_deref(), tick);
            match fault.cause {
                Cause::Rig(cause) => {
                    let caused = self.rig.cause(cause, fault.end.saturating_sub(tick));
                    self.keep(caused, Some(fault.line))?;
                }
                Cause::Line { .. } => {
                    self.present.push(fault);
                    line_changes = true;
                }
            }
        }
        if line_changes {
            self.set_line();
        }
        Ok(())
    }

    /// Sets what the faults that are there do to the line.
    fn set_line(&mut self) {
        let mut damages = [Vec::new(), Vec::new()];
        for fault in &self.present {
            let Cause::Line { directions, damage } = fault.cause else { continue };
            for (damages, is_meant) in damages.iter_mut().zip(directions) {
                if is_meant {
                    damages.push(damage);
                }
            }
        }
        let [to_board, to_host] = damages;
        self.to_board.set(&to_board, self.tick_hz);
        self.to_host.set(&to_host, self.tick_hz);
    }
}

fn closed(error: &RigError) -> LinkClosed {
    LinkClosed { port: "the rig".to_owned(), reason: error.to_string() }
}

impl ByteStream for ScenarioLine<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
        let mut inner = self.0.borrow_mut();
        if !inner.is_dead {
            let tick = inner.rig.tick();
            inner.to_board.take(bytes, tick);
            inner.deliver(tick).map_err(|error| closed(&error))?;
        }
        Ok(())
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let mut inner = self.0.borrow_mut();
        let ticks = (wait.as_secs_f64() * f64::from(inner.tick_hz) - 1e-6).ceil().max(0.0);
        let until = inner.rig.tick() + ticks as u64;
        inner.advance(until, true).map_err(|error| closed(&error))?;
        buffer.append(&mut inner.inbox);
        Ok(())
    }

    fn now(&self) -> Duration {
        self.0.borrow().rig.now()
    }

    fn name(&self) -> &'static str {
        "the rig"
    }
}

impl Recorded for ScenarioLine<'_> {
    type Recorder = ();

    fn recorder_mut(&mut self) -> &mut () {
        &mut self.1
    }

    fn begin(&mut self) -> Result<(), LinkClosed> {
        self.0.borrow_mut().rig.start_stroke();
        Ok(())
    }
}
