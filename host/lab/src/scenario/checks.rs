//! The expectations of a scenario, compared with every tick.

use std::fmt::Display;

use frixel_hil_sim::RigTick;
use frixel_scene::{Condition, Expectation, Program, Reach, Scenario, brief};
use frixel_wire::fault::{Fault, State};

use super::host::Failure;
use super::state_history::StateHistory;
use super::{Unmet, ticks_of};

/// Longest time for which the code of a driven output stays zero, s.
const DRIVEN_WITHIN_S: f64 = 10e-3;

/// All expectations.
pub(super) struct Checks {
    checks: Vec<Check>,
    clock: Clock,
    /// Duration of the scenario, in ticks.
    ticks: u64,
    scale: Scale,
    /// Name of the scenario's file.
    file: String,
}

/// The ticks of a scenario.
#[derive(Clone, Copy)]
struct Clock {
    tick_hz: u32,
    first_tick: u64,
    end_tick: u64,
    lateness_ticks: u64,
}

impl Clock {
    /// Time since time zero, negative before it.
    fn ms(self, tick: u64) -> f64 {
        1e3 * (tick as f64 - self.first_tick as f64) / f64::from(self.tick_hz)
    }

    fn ticks(self, ms: f64) -> u64 {
        ticks_of(ms, self.tick_hz)
    }
}

/// Reach of the board with the scene, to which the fractions of expectations refer.
#[derive(Clone, Copy)]
struct Scale {
    reach: Reach,
    voltage_max_v_peak: f64,
}

impl Scale {
    /// A friction in total, N, as a fraction of the largest electric friction.
    fn friction_fraction(self, friction_n: f64) -> f64 {
        (friction_n - self.reach.natural_friction_n) / self.reach.electric_friction_max_n
    }
}

struct Check {
    expectation: Expectation,
    /// First and last tick; `None` before the event that it counts from.
    span: Option<[u64; 2]>,
    found: Found,
}

/// Observations for an expectation so far.
#[derive(Clone, Debug, Default)]
struct Found {
    /// The first tick that is not as expected, with its DAC code, whether the amplifier was enabled, and the
    /// electrode's voltage.
    first_wrong: Option<(u64, i16, bool, f64)>,
    /// Number of compared ticks.
    ticks: u64,
    last_driven_tick: Option<u64>,
    friction_sum_n: f64,
    friction_ticks: u64,
}

impl Checks {
    pub(super) fn new(scenario: &Scenario, program: &Program, tick_hz: u32, lateness_ticks: u64) -> Self {
        let clock = Clock { tick_hz, first_tick: 0, end_tick: u64::MAX, lateness_ticks };
        let voltage_max_v_peak = f64::from(program.header.voltage_max_v_peak);
        let scale = Scale { reach: program.reach, voltage_max_v_peak };
        let checks = scenario.expectations.iter().map(|expectation| Check {
            expectation: expectation.clone(),
            span: None,
            found: Found::default(),
        });
        let ticks = ticks_of(1e3 * scenario.seconds, tick_hz);
        Self { checks: checks.collect(), clock, ticks, scale, file: scenario.file.clone() }
    }

    /// Makes this tick time zero.
    pub(super) fn begin_time(&mut self, tick: u64) {
        (self.clock.first_tick, self.clock.end_tick) = (tick, tick + self.ticks);
        self.begin_all(None, tick);
    }

    /// Time of a tick, ms.
    pub(super) fn ms(&self, tick: u64) -> f64 {
        self.clock.ms(tick)
    }

    /// Records that the command of this name has ended, or that the fault of this name has begun.
    pub(super) fn begin(&mut self, name: Option<&str>, tick: u64) {
        if name.is_some() {
            self.begin_all(name, tick);
        }
    }

    fn begin_all(&mut self, name: Option<&str>, tick: u64) {
        let clock = self.clock;
        for check in self.checks.iter_mut().filter(|check| check.span.is_none()) {
            if check.expectation.after.as_deref() == name {
                let Expectation { from_ms, to_ms, .. } = check.expectation;
                let end = to_ms.map_or(clock.end_tick, |ms| clock.end_tick.min(tick + clock.ticks(ms)));
                check.set_span([tick + clock.ticks(from_ms), end], clock.lateness_ticks);
            }
        }
    }

    /// Compares a tick.
    pub(super) fn see(&mut self, tick: &RigTick) {
        let driven_within = self.clock.ticks(1e3 * DRIVEN_WITHIN_S);
        for check in &mut self.checks {
            let Some([start, end]) = check.span else { continue };
            // A tick begins where the one before ends.
            if tick.tick > start && tick.tick <= end {
                check.see(tick, start, driven_within, self.scale);
            }
        }
    }

    /// Each expectation that was not met, and each command that failed unexpectedly, by line.
    pub(super) fn unmet(&self, states: &StateHistory, mut failures: Vec<Failure>) -> Vec<Unmet> {
        let Self { checks, clock, scale, file, .. } = self;
        let mut unmet = Vec::new();
        for (number, check) in checks.iter().enumerate() {
            if let Some(sentence) = check.unmet(*clock, *scale, states, &mut failures) {
                let line = check.expectation.line;
                unmet.push(Unmet { file: file.clone(), line, expectation: Some(number), sentence });
            }
        }
        let unexpected = failures.iter().filter(|failure| !failure.is_expected).map(|failure| {
            let Failure { what, tick, sentence, line, .. } = failure;
            let sentence = format!("expected {what} to succeed; at {:.3} ms it failed: {sentence}", clock.ms(*tick));
            Unmet { file: file.clone(), line: *line, expectation: None, sentence }
        });
        unmet.extend(unexpected);
        unmet.sort_by_key(|unmet| unmet.line);
        unmet
    }
}

impl Check {
    /// Whether the host reports what is expected; everything else is seen in each tick.
    fn is_of_reports(&self) -> bool {
        matches!(self.expectation.condition, Condition::State(_) | Condition::Fault(_) | Condition::Error(_))
    }

    /// Sets the span, without the time in which a late rig may still show the previous state or already the next one.
    /// Reports may come later by that time.
    fn set_span(&mut self, [start, end]: [u64; 2], lateness_ticks: u64) {
        self.span = Some(if self.is_of_reports() {
            [start, end.saturating_add(lateness_ticks)]
        } else {
            [start + lateness_ticks, end.saturating_sub(lateness_ticks)]
        });
    }

    fn see(&mut self, tick: &RigTick, start: u64, driven_within: u64, scale: Scale) {
        let (code, enable) = (tick.drive.dac_code.bits(), tick.drive.amplifier_enable);
        let found = &mut self.found;
        found.ticks += 1;
        let is_wrong = match self.expectation.condition {
            Condition::OutputZero => code != 0,
            Condition::OutputOff => code != 0 || enable,
            Condition::OutputDriven => {
                if code != 0 {
                    found.last_driven_tick = Some(tick.tick);
                }
                tick.tick - found.last_driven_tick.unwrap_or(start) > driven_within
            }
            Condition::ElectrodeBelow(limit) => tick.felt.electrode_v.abs() >= limit * scale.voltage_max_v_peak,
            Condition::Friction(_) => {
                if tick.felt.finger.is_some() {
                    found.friction_sum_n += tick.felt.friction_n;
                    found.friction_ticks += 1;
                }
                false
            }
            Condition::State(_) | Condition::Fault(_) | Condition::Error(_) => false,
        };
        if is_wrong {
            found.first_wrong.get_or_insert((tick.tick, code, enable, tick.felt.electrode_v));
        }
    }

    /// The sentence, if the expectation was not met. Marks failures that were expected.
    fn unmet(&self, clock: Clock, scale: Scale, states: &StateHistory, failures: &mut [Failure]) -> Option<String> {
        let Some([start, end]) = self.span else {
            let after = self.expectation.after.as_deref().unwrap_or_default();
            return Some(format!("expected {}, and `{after}` never happened", self.expected()));
        };
        let span = format!("from {:.3} to {:.3} ms", clock.ms(start), clock.ms(end));
        let expected = format!("expected {} {span}", self.expected());
        let Found { first_wrong, ticks, last_driven_tick, friction_sum_n, friction_ticks } = self.found;
        if !self.is_of_reports() && ticks == 0 {
            return Some(self.no_tick(clock, [start, end]));
        }
        match &self.expectation.condition {
            Condition::Friction([least, largest]) => {
                let mean = scale.friction_fraction(friction_sum_n / friction_ticks as f64);
                if friction_ticks == 0 {
                    Some(format!("{expected}; found no finger on the screen"))
                } else if (*least..=*largest).contains(&mean) {
                    None
                } else {
                    Some(format!("{expected}; found {mean:.3}"))
                }
            }
            Condition::State(state) => {
                let found = states.by(end);
                (found.map(|(_, found, _)| found) != Some(*state)).then(|| self.unreported(clock, end, found))
            }
            Condition::Fault(fault) => {
                let found = states.by(end);
                (found.and_then(|(.., found)| found) != Some(*fault)).then(|| self.unreported(clock, end, found))
            }
            Condition::Error(words) => {
                let is_it = |failure: &&mut Failure| {
                    (start..=end).contains(&failure.tick) && failure.sentence.contains(words.as_str())
                };
                let met = failures.iter_mut().filter(is_it).map(|failure| failure.is_expected = true).count();
                (met == 0).then(|| format!("{expected}; {}", failed(clock, failures)))
            }
            // A span of less than 10 ms has no tick that is wrong by itself.
            Condition::OutputDriven if first_wrong.is_none() && last_driven_tick.is_none() => {
                Some(format!("{expected}; found DAC code 0 in each of its {ticks} ticks"))
            }
            Condition::OutputZero | Condition::OutputOff | Condition::OutputDriven | Condition::ElectrodeBelow(_) => {
                let (tick, code, enable, electrode_v) = first_wrong?;
                let enabled = if enable { "enabled" } else { "disabled" };
                let at = clock.ms(tick);
                Some(format!(
                    "{expected}; found DAC code {code}, the amplifier {enabled} and {electrode_v:.2} V at {at:.3} ms"
                ))
            }
        }
    }

    /// The sentence about a state or a fault that the board's last report until the end of the span does not have.
    fn unreported(&self, clock: Clock, end: u64, found: Option<(u64, State, Option<Fault>)>) -> String {
        format!("expected {} at {:.3} ms; {}", self.expected(), clock.ms(end), reported(clock, found))
    }

    /// The sentence about a span without a tick. On a late rig, the span is the rest of a longer one.
    fn no_tick(&self, clock: Clock, [start, end]: [u64; 2]) -> String {
        let late = clock.lateness_ticks;
        let [start, end] = [start.saturating_sub(late), end + late];
        let (expected, from_ms, to_ms) = (self.expected(), clock.ms(start), clock.ms(end));
        if start >= clock.end_tick {
            return format!(
                "expected {expected} from {from_ms:.3} ms on, and the scenario ends at {:.3} ms: let it run for longer",
                clock.ms(clock.end_tick)
            );
        }
        let span = format!("expected {expected} from {from_ms:.3} to {to_ms:.3} ms");
        let late_ms = 1e3 * late as f64 / f64::from(clock.tick_hz);
        if start < end && end - start <= 2 * late {
            format!(
                "{span}, and this rig is up to {late_ms:.0} ms late, which shortens a span by as much at both ends: \
                 expect it for more than {:.0} ms",
                2.0 * late_ms
            )
        } else {
            format!("{span}, and there is no tick in it: expect it for longer")
        }
    }

    /// The expectation, in words.
    fn expected(&self) -> String {
        match &self.expectation.condition {
            Condition::OutputZero => "an output of zero".to_owned(),
            Condition::OutputOff => "an output that is off".to_owned(),
            Condition::OutputDriven => "a driven output".to_owned(),
            Condition::ElectrodeBelow(limit) => format!("an electrode below {limit} of the scene's largest voltage"),
            Condition::Friction([least, largest]) => {
                format!("an electric friction of {least} to {largest} of the largest")
            }
            Condition::State(state) => format!("the state \"{}\"", without_advice(state)),
            Condition::Fault(fault) => format!("\"{}\"", without_advice(fault)),
            Condition::Error(words) => format!("a failure with the words \"{}\"", brief(words)),
        }
    }
}

/// The board's last report, for a sentence.
fn reported(clock: Clock, found: Option<(u64, State, Option<Fault>)>) -> String {
    let Some((tick, state, fault)) = found else { return "the board reported none".to_owned() };
    let fault = fault.map_or_else(String::new, |fault| format!(", {}", without_advice(&fault)));
    format!("the board last reported \"{}{fault}\", at {:.3} ms", without_advice(&state), clock.ms(tick))
}

/// A state or a fault without its advice.
fn without_advice(said: &impl Display) -> String {
    let text = said.to_string();
    let is_fault = text.starts_with("fault ");
    text.split(if is_fault { ';' } else { ':' }).next().unwrap_or_default().to_owned()
}

/// The failures, for a sentence.
fn failed(clock: Clock, failures: &[Failure]) -> String {
    let failures: Vec<String> =
        failures.iter().map(|failure| format!("at {:.3} ms: {}", clock.ms(failure.tick), failure.sentence)).collect();
    if failures.is_empty() { "nothing failed".to_owned() } else { format!("found {}", failures.join("; ")) }
}
