//! A rig behind its line to the host, which damages bytes, causes the scenario's faults at their ticks, and passes
//! every tick to the checks.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::time::Duration;

use frixel_hil_sim::{Board, BoardRig, RigError, RigFault, RigTick, WorldFault};
use frixel_scene::{Cause, Program, Scenario};
use frixel_wire::dac_code::DacCode;

use super::checks::Checks;
use super::direction::Direction;
use super::host::Failure;
use super::state_history::StateHistory;
use super::{ScenarioError, ScenarioOutcome, TimelineEntry, ticks_of};

/// A rig behind the line that a scenario damages. Clones are the same line: a host that connects again has another one.
#[derive(Clone)]
pub(super) struct ScenarioLine<'r> {
    inner: Rc<RefCell<Inner<'r>>>,
    board: Board,
}

struct Inner<'r> {
    rig: &'r mut dyn BoardRig,
    tick_hz: u32,
    /// Time zero, once the host has played the scene.
    first_tick: Option<u64>,
    /// The largest voltage that the scene may drive, V peak.
    voltage_max_v_peak: f32,
    to_board: Direction,
    to_host: Direction,
    /// Pending faults. Their ticks count from time zero.
    faults: VecDeque<PlannedFault>,
    /// Active faults of the line.
    present: Vec<PlannedFault>,
    /// Bytes that have arrived at the host and were not read.
    inbox: Vec<u8>,
    /// Whether the host was killed and sends nothing.
    is_dead: bool,
    checks: Checks,
    states: StateHistory,
    /// Events, with their ticks on the rig's clock.
    timeline: Vec<(u64, String)>,
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
    pub(super) fn new(scenario: &Scenario, program: &Program, rig: &'r mut dyn BoardRig) -> Self {
        let board = *rig.board();
        let tick_hz = board.tick_hz;
        let ticks = |ms: f64| ticks_of(ms, tick_hz);
        let mut faults: Vec<_> = scenario
            .faults
            .iter()
            .map(|fault| {
                let start = ticks(fault.at_ms);
                let end = fault.for_ms.map_or(u64::MAX, |ms| start.saturating_add(ticks(ms)));
                PlannedFault { start, end, line: fault.line, name: fault.name.clone(), cause: fault.cause }
            })
            .collect();
        faults.sort_by_key(|fault| fault.start);
        let checks = Checks::new(scenario, program, tick_hz, rig.lateness_ticks());
        let inner = Inner {
            rig,
            tick_hz,
            first_tick: None,
            voltage_max_v_peak: program.header.voltage_max_v_peak,
            to_board: Direction::new(scenario.seed),
            to_host: Direction::new(!scenario.seed),
            faults: faults.into(),
            present: Vec::new(),
            inbox: Vec::new(),
            is_dead: false,
            checks,
            states: StateHistory::default(),
            timeline: Vec::new(),
            error: None,
        };
        Self { inner: Rc::new(RefCell::new(inner)), board }
    }

    /// Makes this time zero: faults, and expectations without an `after`, count from now on.
    pub(super) fn begin_time(&self) {
        let mut inner = self.inner.borrow_mut();
        let tick = inner.rig.tick();
        inner.first_tick = Some(tick);
        inner.checks.begin_time(tick);
        for fault in &mut inner.faults {
            (fault.start, fault.end) = (tick + fault.start, fault.end.saturating_add(tick));
        }
    }

    /// Ticks since time zero.
    pub(super) fn ticks(&self) -> u64 {
        let inner = self.inner.borrow();
        inner.rig.tick() - inner.first_tick.unwrap_or(inner.rig.tick())
    }

    /// Whether the rig has ended.
    pub(super) fn has_ended(&self) -> bool {
        self.inner.borrow().error.is_some()
    }

    /// Advances to this tick since time zero, without reading.
    pub(super) fn pass_to(&self, ticks: u64) {
        let mut inner = self.inner.borrow_mut();
        let until = inner.first_tick.unwrap_or_default() + ticks;
        // An error is kept, and ends the scenario.
        let _ = inner.advance(until, false);
    }

    /// Sends bytes of another program on this line.
    pub(super) fn inject(&self, bytes: &[u8]) {
        let mut inner = self.inner.borrow_mut();
        let tick = inner.rig.tick();
        inner.to_board.take(bytes, tick);
    }

    /// Presses the arm switch again.
    pub(super) fn press_switch(&self) {
        let mut inner = self.inner.borrow_mut();
        let until = inner.rig.press_switch() + inner.rig.tick();
        // An error is kept, and ends the scenario.
        let _ = inner.advance(until, false);
    }

    /// Kills the host, or starts another one.
    pub(super) fn set_dead(&self, is_dead: bool) {
        self.inner.borrow_mut().is_dead = is_dead;
    }

    /// Adds an entry to the timeline, at the current tick.
    pub(super) fn note(&self, what: impl Into<String>) {
        self.inner.borrow_mut().note(what);
    }

    /// Records the end of a command, from which expectations may count.
    pub(super) fn named_event(&self, name: Option<&str>) {
        let mut inner = self.inner.borrow_mut();
        let tick = inner.rig.tick();
        inner.checks.begin(name, tick);
    }

    /// The results of the scenario, with the failures of the host.
    pub(super) fn outcome(self, scenario: &Scenario, failures: Vec<Failure>) -> Result<ScenarioOutcome, ScenarioError> {
        let mut inner = self.inner.borrow_mut();
        if let Some((line, source)) = inner.error.take() {
            let file = line.map_or(scenario.file.clone(), |line| format!("{}:{line}", scenario.file));
            return Err(ScenarioError::Rig { file, source });
        }
        let unmet = inner.checks.unmet(&inner.states, failures);
        let mut timeline = std::mem::take(&mut inner.timeline);
        timeline.extend(inner.states.entries());
        timeline.sort_by_key(|(tick, _)| *tick);
        let entry = |(tick, what)| TimelineEntry { t_ms: inner.checks.ms(tick), what };
        let timeline = timeline.into_iter().map(entry).collect();
        Ok(ScenarioOutcome { timeline, expectations: scenario.expectations.len(), unmet })
    }
}

impl Inner<'_> {
    fn note(&mut self, what: impl Into<String>) {
        self.timeline.push((self.rig.tick(), what.into()));
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
            let next_fault = self.first_tick.and(self.faults.front()).map(|fault| fault.start);
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
            self.states.hear(&bytes, tick);
            self.inbox.extend(bytes);
        }
        Ok(())
    }

    fn begin_and_end_faults(&mut self, tick: u64) -> Result<(), RigError> {
        let mut line_changes = self.present.iter().any(|fault| fault.end <= tick);
        self.present.retain(|fault| fault.end > tick);
        let has_begun = self.first_tick.is_some();
        while let Some(fault) = self.faults.pop_front_if(|fault| has_begun && fault.start <= tick) {
            self.note(format!("fault of line {} begins", fault.line));
            self.checks.begin(fault.name.as_deref(), tick);
            if let Some(cause) = rig_fault(fault.cause, self.rig.board(), self.voltage_max_v_peak) {
                let caused = self.rig.cause(cause, fault.end.saturating_sub(tick));
                self.keep(caused, Some(fault.line))?;
            } else {
                self.present.push(fault);
                line_changes = true;
            }
        }
        if line_changes {
            self.set_line();
        }
        Ok(())
    }

    /// Applies the active faults to the line.
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

/// The fault of a rig; `None` for one of the line.
fn rig_fault(cause: Cause, board: &Board, voltage_max_v_peak: f32) -> Option<RigFault> {
    match cause {
        Cause::Line { .. } => None,
        Cause::Rig(fault) => Some(fault),
        Cause::DacStuck { fraction } => {
            let of_full_scale = fraction * f64::from(voltage_max_v_peak / board.limits.full_scale_v_peak);
            let code = (of_full_scale.clamp(-1.0, 1.0) * f64::from(i16::MAX)).round() as i16;
            Some(RigFault::World(WorldFault::DacStuck(DacCode::from_bits(code))))
        }
        Cause::TickCountWraps { in_ms } => {
            Some(RigFault::WrapSoon { ticks: u32::try_from(ticks_of(in_ms, board.tick_hz)).unwrap_or(u32::MAX) })
        }
    }
}

impl BoardRig for ScenarioLine<'_> {
    fn name(&self) -> &'static str {
        "the rig"
    }

    fn board(&self) -> &Board {
        &self.board
    }

    fn tick(&self) -> u64 {
        self.inner.borrow().rig.tick()
    }

    fn now(&self) -> Duration {
        self.inner.borrow().rig.now()
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), RigError> {
        let mut inner = self.inner.borrow_mut();
        if inner.is_dead {
            return Ok(());
        }
        let tick = inner.rig.tick();
        inner.to_board.take(bytes, tick);
        inner.deliver(tick)
    }

    /// Passes each tick to the checks alone: a scenario records nothing.
    fn run(&mut self, until_tick: u64, received: &mut Vec<u8>, _: &mut dyn FnMut(&RigTick)) -> Result<(), RigError> {
        let mut inner = self.inner.borrow_mut();
        inner.advance(until_tick, true)?;
        received.append(&mut inner.inbox);
        Ok(())
    }

    fn cause(&mut self, fault: RigFault, ticks: u64) -> Result<(), RigError> {
        self.inner.borrow_mut().rig.cause(fault, ticks)
    }

    fn start_stroke(&mut self) {
        self.inner.borrow_mut().rig.start_stroke();
    }
}
