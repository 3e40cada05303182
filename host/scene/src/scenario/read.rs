//! Reads a scenario's file.
//!
//! [`Fields`], the reader of scene files, does so instead of `serde`. `serde` stops at the first mistake and names a
//! type; this reader finds all mistakes, and its sentences name line, column, unit, range and the nearest word
//! (`tests/corpus/scenarios/mistakes.md`). With `serde`, every struct would carry spans, and the same checks would
//! follow. The constants of [`super::tables`] are read here, and compared with the documentation by a test.

use std::collections::{HashMap, HashSet};

use frixel_hil_sim::{NoiseConfig, RigFault, WorldFault};
use frixel_wire::fault::{Fault, State};

use super::tables::{command, expect, fault, file, stroke, when};
use super::{
    Action, Cause, Condition, Expectation, LineDamage, Scenario, ScenarioCommand, ScenarioFault, StraightStroke,
};
use crate::fields::Fields;
use crate::grammar::FieldSpec;
use crate::log::Log;
use crate::mistake::{FieldMistake, FileMistake, Mistake};
use crate::nearest::Nearest;

/// Largest number of commands, faults and expectations in a scenario.
const ENTRIES_MAX: usize = 1_000;

pub(super) const STATES: [(&str, State); 4] =
    [("disarmed", State::Disarmed), ("armed", State::Armed), ("active", State::Active), ("faulted", State::Faulted)];
pub(super) const FAULTS: [(&str, Fault); 9] = [
    ("amplifier", Fault::Amplifier),
    ("monitor", Fault::Monitor),
    ("deadline", Fault::Deadline),
    ("panic", Fault::Panic),
    ("hard-fault", Fault::HardFault),
    ("stack-overflow", Fault::StackOverflow),
    ("watchdog", Fault::Watchdog),
    ("arm-switch", Fault::ArmSwitch),
    ("dac", Fault::Dac),
];

pub(super) fn scenario(mut fields: Fields, name: &str, log: &mut Log) -> Option<Scenario> {
    let _ = fields.number(log, &file::SCENARIO);
    let about = fields.free_text(log, &file::ABOUT).unwrap_or_default();
    let scene = fields.text(log, &file::SCENE);
    let seconds = fields.number(log, &file::SECONDS);
    let seed = fields.number_or_default(log, &file::SEED) as u64;
    let worlds = [("ideal", false), ("realistic", true)];
    let is_realistic = fields.choice(log, &file::WORLD, &worlds).unwrap_or_default();
    let stroke = fields.table(log, &file::STROKE).map(|table| straight_stroke(table, log));
    let before = log.mistakes();
    let commands = fields.tables(log, &file::COMMAND).unwrap_or_default();
    let faults = fields.tables(log, &file::FAULT).unwrap_or_default();
    let mut names = Names { given: Vec::new(), known: HashSet::new(), are_known: log.mistakes() == before };
    let expectations = fields.tables(log, &file::EXPECT).unwrap_or_default();
    let place = fields.places().table();
    fields.close(log);
    let entries = commands.len() + faults.len() + expectations.len();
    if entries > ENTRIES_MAX {
        let advice = "make several scenarios of it";
        log.add(place, FileMistake::too_much("commands, faults and expectations", entries, ENTRIES_MAX, advice));
        return None;
    }
    let commands: Vec<_> =
        commands.into_iter().filter_map(|table| scenario_command(table, seconds, &mut names, log)).collect();
    let faults: Vec<_> =
        faults.into_iter().filter_map(|table| scenario_fault(table, seconds, &mut names, log)).collect();
    names.check(log);
    let expectations = expectations.into_iter().flat_map(|table| expected(table, &names, log)).collect();
    let stroke = match stroke {
        Some(stroke) => Some(stroke?),
        None => None,
    };
    let (file, scene, seconds) = (name.to_owned(), scene?, seconds?);
    Some(Scenario { file, about, scene, seconds, seed, is_realistic, stroke, commands, faults, expectations })
}

fn straight_stroke(mut fields: Fields, log: &mut Log) -> Option<StraightStroke> {
    let from_mm = place(&mut fields, log, &stroke::FROM_MM);
    let to_mm = place(&mut fields, log, &stroke::TO_MM);
    let speed_mm_per_s = fields.number_or_default(log, &stroke::SPEED_MM_PER_S);
    fields.close(log);
    Some(StraightStroke { from_mm: from_mm?, to_mm: to_mm?, speed_mm_per_s })
}

fn place(fields: &mut Fields, log: &mut Log, field: &FieldSpec) -> Option<[f64; 2]> {
    let place = fields.place(field.name);
    let numbers = fields.numbers(log, field)?;
    let found = numbers.len();
    let pair = numbers.try_into().ok();
    if pair.is_none() {
        log.add(place, FieldMistake::Count { field: field.name, found, min: 2, max: 2 });
    }
    pair
}

/// Names of commands and faults, including those with mistakes.
struct Names {
    /// Each name with its place in the file.
    given: Vec<(usize, String)>,
    /// The same names.
    known: HashSet<String>,
    /// Whether all names are known, with none hidden by a mistake.
    are_known: bool,
}

impl Names {
    /// Reads the name of a command or a fault.
    fn read(&mut self, fields: &mut Fields, log: &mut Log) -> Option<String> {
        let (place, before) = (fields.place(when::NAME.name), log.mistakes());
        let name = fields.text(log, &when::NAME);
        self.are_known &= log.mistakes() == before;
        self.given.extend(name.iter().map(|name| (place, name.clone())));
        self.known.extend(name.clone());
        name
    }

    /// Reports repeated names.
    fn check(&mut self, log: &mut Log) {
        self.given.sort_by_key(|(place, _)| *place);
        let mut first: HashMap<&str, usize> = HashMap::new();
        for (place, name) in &self.given {
            let first = *first.entry(name).or_insert(*place);
            if first != *place {
                let (line, _) = log.source().line_and_column(first);
                log.add(*place, Mistake::NameTwice { name: name.clone(), line });
            }
        }
    }

    /// Reports an `after` that refers to an unknown name.
    fn check_after(&self, found: &str, place: usize, log: &mut Log) {
        if !self.are_known || self.known.contains(found) {
            return;
        }
        let names = self.given.iter().map(|(_, name)| name.as_str());
        let (nearest, found) = (Nearest::new(found, names), found.to_owned());
        if nearest.suggestion.is_some() {
            log.add(place, FieldMistake::UnknownChoice { field: expect::AFTER.name, found, nearest });
        } else {
            log.add(place, Mistake::UnknownEvent { found });
        }
    }
}

fn line_of(fields: &Fields, log: &Log) -> usize {
    log.source().line_and_column(fields.places().table()).0
}

/// Start time of a command or a fault, checked against the scenario's duration.
fn at_ms(fields: &mut Fields, seconds: Option<f64>, log: &mut Log) -> Option<f64> {
    let place = fields.place(when::AT_MS.name);
    let at_ms = fields.number(log, &when::AT_MS);
    if let (Some(at_ms), Some(seconds)) = (at_ms, seconds)
        && at_ms > 1e3 * seconds
    {
        log.add(place, Mistake::AfterEnd { at_ms, seconds });
    }
    at_ms
}

/// Reads the fields of an action.
type ReadAction = fn(&mut Fields, &mut Log) -> Option<Action>;

pub(super) const ACTIONS: [(&str, ReadAction); 11] = [
    ("connect", |_, _| Some(Action::Connect)),
    ("play", |_, _| Some(Action::Play)),
    ("upload", |_, _| Some(Action::Upload)),
    ("stop", |_, _| Some(Action::Stop)),
    ("clear-fault", |_, _| Some(Action::ClearFault)),
    ("replace", |fields, log| Some(Action::Replace { scene: fields.text(log, &command::SCENE)? })),
    ("trigger", |fields, log| {
        let duration_s = fields.number(log, &when::FOR_MS).map(|ms| 1e-3 * ms);
        Some(Action::Trigger { layer: fields.text(log, &command::LAYER)?, duration_s })
    }),
    ("layer", |fields, log| {
        let gain = fields.number(log, &command::GAIN);
        Some(Action::SetLayer { layer: fields.text(log, &command::LAYER)?, gain })
    }),
    ("hang", |fields, log| {
        fields.require(&when::FOR_MS);
        Some(Action::Hang { ms: fields.number(log, &when::FOR_MS)? })
    }),
    ("die", |_, _| Some(Action::Die)),
    ("other-client", |_, _| Some(Action::OtherClient)),
];

fn scenario_command(
    mut fields: Fields,
    seconds: Option<f64>,
    names: &mut Names,
    log: &mut Log,
) -> Option<ScenarioCommand> {
    let line = line_of(&fields, log);
    let at_ms = at_ms(&mut fields, seconds, log);
    let name = names.read(&mut fields, log);
    let Some(read) = fields.choice_or_nearest(log, &command::DO, &ACTIONS) else {
        fields.give_up_without(log, command::DO.name);
        return None;
    };
    let action = read(&mut fields, log);
    fields.close(log);
    Some(ScenarioCommand { at_ms: at_ms?, name, line, action: action? })
}

/// Reads the fields of a cause.
type ReadCause = fn(&mut Fields, &mut Log) -> Option<Cause>;

pub(super) const CAUSES: [(&str, ReadCause); 21] = [
    ("cable-cut", |fields, log| on_line(fields, log, Some(LineDamage::Cut))),
    ("bytes-lost", |fields, log| noise(fields, log, |share| NoiseConfig { lost_share: share, ..NO_NOISE })),
    ("bytes-doubled", |fields, log| noise(fields, log, |share| NoiseConfig { doubled_share: share, ..NO_NOISE })),
    ("bits-flipped", |fields, log| noise(fields, log, |share| NoiseConfig { bit_error_rate: share, ..NO_NOISE })),
    ("bytes-late", |fields, log| {
        let damage = fields.number(log, &fault::BY_MS).map(|ms| LineDamage::Late { ms });
        on_line(fields, log, damage)
    }),
    ("touch-silent", |_, _| Some(world(WorldFault::TouchSilent))),
    ("touch-stuck", |_, _| Some(world(WorldFault::TouchStuck))),
    ("touch-jumps", |fields, log| {
        Some(world(WorldFault::TouchJumps { by_m: 1e-3 * fields.number(log, &fault::BY_MM)? }))
    }),
    ("finger-lifted", |_, _| Some(world(WorldFault::FingerLifted))),
    ("dac-stuck", |fields, log| Some(Cause::DacStuck { fraction: fields.number(log, &fault::FRACTION)? })),
    ("amplifier-not-ready", |_, _| Some(world(WorldFault::AmplifierNotReady))),
    ("amplifier-stuck-on", |_, _| Some(world(WorldFault::AmplifierStuckOn))),
    ("amplifier-sags", |fields, log| Some(world(WorldFault::AmplifierGain(fields.number(log, &fault::GAIN)?)))),
    ("amplifier-slow-off", |fields, log| {
        Some(world(WorldFault::AmplifierSlowOff { delay_s: 1e-3 * fields.number(log, &fault::BY_MS)? }))
    }),
    ("monitor-wrong", |fields, log| Some(world(WorldFault::MonitorGain(fields.number(log, &fault::GAIN)?)))),
    ("switch-open", |_, _| Some(world(WorldFault::SwitchOpen))),
    ("switch-welded", |_, _| Some(world(WorldFault::SwitchWelded))),
    ("reset", |_, _| Some(Cause::Rig(RigFault::Reset))),
    ("option-bytes", |_, _| Some(Cause::Rig(RigFault::OptionBytes))),
    ("late-tick", |_, _| Some(Cause::Rig(RigFault::LateTick))),
    ("tick-count-wraps", |fields, log| Some(Cause::TickCountWraps { in_ms: fields.number(log, &fault::IN_MS)? })),
];

fn world(fault: WorldFault) -> Cause {
    Cause::Rig(RigFault::World(fault))
}

fn noise(fields: &mut Fields, log: &mut Log, of_share: fn(f64) -> NoiseConfig) -> Option<Cause> {
    let damage = fields.number(log, &fault::SHARE_OF).map(|share| LineDamage::Noise(of_share(share)));
    on_line(fields, log, damage)
}

/// Damage to a line, in the directions that the file names.
fn on_line(fields: &mut Fields, log: &mut Log, damage: Option<LineDamage>) -> Option<Cause> {
    let lines = [("both", [true, true]), ("to-board", [true, false]), ("to-host", [false, true])];
    let directions = fields.choice(log, &fault::LINE, &lines).unwrap_or([true, true]);
    Some(Cause::Line { directions, damage: damage? })
}

const NO_NOISE: NoiseConfig = NoiseConfig { bit_error_rate: 0.0, lost_share: 0.0, doubled_share: 0.0 };

fn scenario_fault(mut fields: Fields, seconds: Option<f64>, names: &mut Names, log: &mut Log) -> Option<ScenarioFault> {
    let line = line_of(&fields, log);
    let at_ms = at_ms(&mut fields, seconds, log);
    let name = names.read(&mut fields, log);
    let Some(read) = fields.choice_or_nearest(log, &fault::CAUSE, &CAUSES) else {
        fields.give_up_without(log, fault::CAUSE.name);
        return None;
    };
    let cause = read(&mut fields, log);
    let happens_once = matches!(
        cause,
        Some(Cause::Rig(RigFault::Reset | RigFault::OptionBytes | RigFault::LateTick) | Cause::TickCountWraps { .. })
    );
    let for_ms = if happens_once { None } else { fields.number(log, &when::FOR_MS) };
    fields.close(log);
    Some(ScenarioFault { at_ms: at_ms?, for_ms, name, line, cause: cause? })
}

/// The expectations of one table, which share an interval of time.
fn expected(mut fields: Fields, names: &Names, log: &mut Log) -> Vec<Expectation> {
    let (line, before) = (line_of(&fields, log), log.mistakes());
    let after_place = fields.place(expect::AFTER.name);
    let after = fields.text(log, &expect::AFTER);
    if let Some(after) = &after {
        names.check_after(after, after_place, log);
    }
    let from_ms = fields.number_or_default(log, &expect::FROM_MS);
    let to_place = fields.place(expect::TO_MS.name);
    let to_ms = fields.number(log, &expect::TO_MS);
    if let Some(to_ms) = to_ms.filter(|to_ms| *to_ms < from_ms) {
        log.add(to_place, Mistake::EndsBeforeStart { from_ms, to_ms });
    }
    let outputs = [("zero", Condition::OutputZero), ("off", Condition::OutputOff), ("driven", Condition::OutputDriven)];
    let conditions = [
        fields.choice(log, &expect::OUTPUT, &outputs),
        fields.number(log, &expect::ELECTRODE_BELOW_FRACTION).map(Condition::ElectrodeBelow),
        fields.interval(log, &expect::FRICTION_FRACTION).map(Condition::Friction),
        fields.choice(log, &expect::STATE, &STATES).map(Condition::State),
        fields.choice(log, &expect::FAULT, &FAULTS).map(Condition::Fault),
        fields.text(log, &expect::ERROR).map(Condition::Error),
    ];
    let place = fields.places().table();
    fields.close(log);
    let conditions: Vec<Condition> = conditions.into_iter().flatten().collect();
    if conditions.is_empty() && log.mistakes() == before {
        log.add(place, Mistake::NothingExpected);
    }
    conditions
        .into_iter()
        .map(|condition| Expectation { line, after: after.clone(), from_ms, to_ms, condition })
        .collect()
}
