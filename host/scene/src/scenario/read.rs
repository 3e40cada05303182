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
    let place = fields.table_place();
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
    log.source().line_and_column(fields.table_place()).0
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

/// Action of a command, before its fields are read.
#[derive(Clone, Copy)]
pub(super) enum CommandWord {
    Plain(fn() -> Action),
    Replace,
    Trigger,
    SetLayer,
    Hang,
}

pub(super) const COMMAND_WORDS: [(&str, CommandWord); 11] = [
    ("connect", CommandWord::Plain(|| Action::Connect)),
    ("play", CommandWord::Plain(|| Action::Play)),
    ("upload", CommandWord::Plain(|| Action::Upload)),
    ("stop", CommandWord::Plain(|| Action::Stop)),
    ("clear-fault", CommandWord::Plain(|| Action::ClearFault)),
    ("replace", CommandWord::Replace),
    ("trigger", CommandWord::Trigger),
    ("layer", CommandWord::SetLayer),
    ("hang", CommandWord::Hang),
    ("die", CommandWord::Plain(|| Action::Die)),
    ("other-client", CommandWord::Plain(|| Action::OtherClient)),
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
    let action = match fields.choice_or_nearest(log, &command::DO, &COMMAND_WORDS) {
        Some(CommandWord::Plain(action)) => Some(action()),
        Some(CommandWord::Replace) => fields.text(log, &command::SCENE).map(|scene| Action::Replace { scene }),
        Some(CommandWord::Trigger) => {
            let duration_s = fields.number(log, &when::FOR_MS).map(|ms| 1e-3 * ms);
            fields.text(log, &command::LAYER).map(|layer| Action::Trigger { layer, duration_s })
        }
        Some(CommandWord::SetLayer) => {
            let gain = fields.number(log, &command::GAIN);
            fields.text(log, &command::LAYER).map(|layer| Action::SetLayer { layer, gain })
        }
        Some(CommandWord::Hang) => {
            fields.require(&when::FOR_MS);
            fields.number(log, &when::FOR_MS).map(|ms| Action::Hang { ms })
        }
        None => {
            fields.give_up_without(log, command::DO.name);
            return None;
        }
    };
    fields.close(log);
    Some(ScenarioCommand { at_ms: at_ms?, name, line, action: action? })
}

/// Cause of a fault, before its fields are read.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Cut,
    Noise(fn(f64) -> NoiseConfig),
    Late,
    World(WorldFault),
    Gain(fn(f64) -> WorldFault),
    SlowOff,
    DacStuck,
    TouchJumps,
    Rig(RigFault),
    TickCountWraps,
}

pub(super) const KINDS: [(&str, Kind); 21] = [
    ("cable-cut", Kind::Cut),
    ("bytes-lost", Kind::Noise(|share| NoiseConfig { lost_share: share, ..NO_NOISE })),
    ("bytes-doubled", Kind::Noise(|share| NoiseConfig { doubled_share: share, ..NO_NOISE })),
    ("bits-flipped", Kind::Noise(|share| NoiseConfig { bit_error_rate: share, ..NO_NOISE })),
    ("bytes-late", Kind::Late),
    ("touch-silent", Kind::World(WorldFault::TouchSilent)),
    ("touch-stuck", Kind::World(WorldFault::TouchStuck)),
    ("touch-jumps", Kind::TouchJumps),
    ("finger-lifted", Kind::World(WorldFault::FingerLifted)),
    ("dac-stuck", Kind::DacStuck),
    ("amplifier-not-ready", Kind::World(WorldFault::AmplifierNotReady)),
    ("amplifier-stuck-on", Kind::World(WorldFault::AmplifierStuckOn)),
    ("amplifier-sags", Kind::Gain(WorldFault::AmplifierGain)),
    ("amplifier-slow-off", Kind::SlowOff),
    ("monitor-wrong", Kind::Gain(WorldFault::MonitorGain)),
    ("switch-open", Kind::World(WorldFault::SwitchOpen)),
    ("switch-welded", Kind::World(WorldFault::SwitchWelded)),
    ("reset", Kind::Rig(RigFault::Reset)),
    ("option-bytes", Kind::Rig(RigFault::OptionBytes)),
    ("late-tick", Kind::Rig(RigFault::LateTick)),
    ("tick-count-wraps", Kind::TickCountWraps),
];
const NO_NOISE: NoiseConfig = NoiseConfig { bit_error_rate: 0.0, lost_share: 0.0, doubled_share: 0.0 };

fn scenario_fault(mut fields: Fields, seconds: Option<f64>, names: &mut Names, log: &mut Log) -> Option<ScenarioFault> {
    let line = line_of(&fields, log);
    let at_ms = at_ms(&mut fields, seconds, log);
    let name = names.read(&mut fields, log);
    let Some(kind) = fields.choice_or_nearest(log, &fault::CAUSE, &KINDS) else {
        fields.give_up_without(log, fault::CAUSE.name);
        return None;
    };
    let cause = cause(kind, &mut fields, log);
    let happens_once = matches!(kind, Kind::Rig(_) | Kind::TickCountWraps);
    let for_ms = if happens_once { None } else { fields.number(log, &when::FOR_MS) };
    fields.close(log);
    Some(ScenarioFault { at_ms: at_ms?, for_ms, name, line, cause: cause? })
}

fn cause(kind: Kind, fields: &mut Fields, log: &mut Log) -> Option<Cause> {
    let world = |fault| Cause::Rig(RigFault::World(fault));
    let mut number = |field: &FieldSpec| fields.number(log, field);
    let damage = match kind {
        Kind::World(fault) => return Some(world(fault)),
        Kind::Gain(fault) => return number(&fault::GAIN).map(|gain| world(fault(gain))),
        Kind::SlowOff => {
            return number(&fault::BY_MS).map(|ms| world(WorldFault::AmplifierSlowOff { delay_s: 1e-3 * ms }));
        }
        Kind::DacStuck => return number(&fault::FRACTION).map(|fraction| Cause::DacStuck { fraction }),
        Kind::TouchJumps => return number(&fault::BY_MM).map(|mm| world(WorldFault::TouchJumps { by_m: 1e-3 * mm })),
        Kind::Rig(fault) => return Some(Cause::Rig(fault)),
        Kind::TickCountWraps => return number(&fault::IN_MS).map(|in_ms| Cause::TickCountWraps { in_ms }),
        Kind::Cut => Some(LineDamage::Cut),
        Kind::Noise(noise) => number(&fault::SHARE_OF).map(|share| LineDamage::Noise(noise(share))),
        Kind::Late => number(&fault::BY_MS).map(|ms| LineDamage::Late { ms }),
    };
    let lines = [("both", [true, true]), ("to-board", [true, false]), ("to-host", [false, true])];
    let directions = fields.choice(log, &fault::LINE, &lines).unwrap_or([true, true]);
    Some(Cause::Line { directions, damage: damage? })
}

/// Expected output.
#[derive(Clone, Copy)]
enum Output {
    Zero,
    Off,
    Driven,
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
    let outputs = [("zero", Output::Zero), ("off", Output::Off), ("driven", Output::Driven)];
    let output = fields.choice(log, &expect::OUTPUT, &outputs);
    let conditions = [
        output.map(|output| match output {
            Output::Zero => Condition::OutputZero,
            Output::Off => Condition::OutputOff,
            Output::Driven => Condition::OutputDriven,
        }),
        fields.number(log, &expect::ELECTRODE_BELOW_FRACTION).map(Condition::ElectrodeBelow),
        fields.interval(log, &expect::FRICTION_FRACTION).map(Condition::Friction),
        fields.choice(log, &expect::STATE, &STATES).map(Condition::State),
        fields.choice(log, &expect::FAULT, &FAULTS).map(Condition::Fault),
        fields.text(log, &expect::ERROR).map(Condition::Error),
    ];
    let place = fields.table_place();
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
