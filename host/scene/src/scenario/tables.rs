//! The tables of a scenario file. The parser checks the fields, and `docs/inside/scenarios.md` shows them.
#![allow(clippy::wildcard_imports, reason = "every table is written with the same few words")]

use crate::grammar::Absence::{Means, Mistake, Number};
use crate::grammar::{FieldSpec, Holds, Range};
use crate::tables::{number, word};

/// Longest scenario, and longest time in one: an hour.
const SECONDS_MAX: f64 = 3_600.0;
const TIME_MS: Range = Range::new(0.0, 1e3 * SECONDS_MAX, " ms");
/// Fractions of the board's reach. A fault may exceed it.
const FRACTION: Range = Range::new(-10.0, 10.0, "");
const SHARE: Range = Range::new(0.0, 1.0, "");

const fn text(name: &'static str, meaning: &'static str) -> FieldSpec {
    FieldSpec::new(name, Holds::Text, Means(""), meaning)
}

/// The file itself.
pub(super) mod file {
    use super::{FieldSpec, Holds, Means, Mistake, Number, Range, SECONDS_MAX, number, text, word};

    pub(crate) const SCENARIO: FieldSpec =
        number("scenario", Range::new(1.0, 1.0, ""), Mistake, "version of the file format");
    pub(crate) const ABOUT: FieldSpec = text("about", "what the scenario shows, for its readers");
    pub(crate) const SCENE: FieldSpec =
        FieldSpec::new("scene", Holds::Text, Mistake, "the scene's file, relative to this file's folder");
    pub(crate) const SECONDS: FieldSpec =
        number("seconds", Range::new(0.001, SECONDS_MAX, " s"), Mistake, "duration after the start of the play");
    pub(crate) const SEED: FieldSpec =
        FieldSpec::new("seed", Holds::Whole(Range::new(0.0, 1e15, "")), Number(1.0), "seed of all random effects");
    pub(crate) const WORLD: FieldSpec = word(
        "world",
        Means("`\"ideal\"`"),
        "`\"realistic\"` for every effect of amplifier, finger and touch source that `frixel play` has",
    );
    pub(crate) const STROKE: FieldSpec = FieldSpec::new(
        "stroke",
        Holds::Table,
        Means("a repeated sweep over the screen in 3 s"),
        "path of the finger from each `play` on",
    );
    pub(crate) const COMMAND: FieldSpec =
        FieldSpec::new("command", Holds::Tables, Means("none"), "actions of the host, in chronological order");
    pub(crate) const FAULT: FieldSpec = FieldSpec::new("fault", Holds::Tables, Means("none"), "what goes wrong");
    pub(crate) const EXPECT: FieldSpec = FieldSpec::new("expect", Holds::Tables, Means("none"), "expected outcomes");
    #[cfg(test)]
    pub(crate) const ALL: &[FieldSpec] =
        &[SCENARIO, ABOUT, SCENE, SECONDS, SEED, WORLD, STROKE, COMMAND, FAULT, EXPECT];
}

/// `[stroke]`.
pub(super) mod stroke {
    use super::{FieldSpec, Holds, Mistake, Number, Range, number};

    const PLACE_MM: Range = Range::new(-2_000.0, 2_000.0, " mm");
    pub(crate) const FROM_MM: FieldSpec =
        FieldSpec::new("from_mm", Holds::Numbers(PLACE_MM), Mistake, "where it begins, `[x, y]`");
    pub(crate) const TO_MM: FieldSpec =
        FieldSpec::new("to_mm", Holds::Numbers(PLACE_MM), Mistake, "where it ends; 0.2 s later it begins again");
    pub(crate) const SPEED_MM_PER_S: FieldSpec =
        number("speed_mm_per_s", Range::new(0.1, 10_000.0, " mm/s"), Number(100.0), "sliding speed");
    #[cfg(test)]
    pub(crate) const ALL: &[FieldSpec] = &[FROM_MM, TO_MM, SPEED_MM_PER_S];
}

/// Fields shared by commands, faults and expectations.
pub(super) mod when {
    use super::{FieldSpec, Means, Mistake, TIME_MS, number, text};

    pub(crate) const AT_MS: FieldSpec =
        number("at_ms", TIME_MS, Mistake, "start time, in ms since the start of the play");
    pub(crate) const NAME: FieldSpec = text("name", "a name, for `after` of an expectation");
    pub(crate) const FOR_MS: FieldSpec = number("for_ms", TIME_MS, Means("until the end"), "how long");
    #[cfg(test)]
    pub(crate) const ALL: &[FieldSpec] = &[AT_MS, NAME, FOR_MS];
}

/// `[[command]]`.
pub(super) mod command {
    use frixel_wire::message::GAIN_MAX;

    use super::{FieldSpec, Holds, Means, Mistake, Range, number, word};

    pub(crate) const DO: FieldSpec = word("do", Mistake, "what the host does");
    pub(crate) const LAYER: FieldSpec =
        FieldSpec::new("layer", Holds::Text, Mistake, "the layer's name, or its number as a string");
    pub(crate) const GAIN: FieldSpec =
        number("gain", Range::new(-GAIN_MAX, GAIN_MAX, ""), Means("as it is"), "the layer's gain");
    pub(crate) const SCENE: FieldSpec = FieldSpec::new("scene", Holds::Text, Mistake, "file of the next scene");
    #[cfg(test)]
    pub(crate) const ALL: &[FieldSpec] = &[DO, LAYER, GAIN, SCENE];
}

/// `[[fault]]`.
pub(super) mod fault {
    use super::{FRACTION as FRACTIONS, FieldSpec, Means, Mistake, Range, SHARE, TIME_MS, number, word};

    pub(crate) const CAUSE: FieldSpec = word("cause", Mistake, "what goes wrong");
    pub(crate) const LINE: FieldSpec = word("line", Means("`\"both\"`"), "`\"to-board\"`, `\"to-host\"` or `\"both\"`");
    pub(crate) const SHARE_OF: FieldSpec = number("share", SHARE, Mistake, "fraction of the bytes, or of the bits");
    pub(crate) const BY_MS: FieldSpec = number("by_ms", Range::new(0.0, 10_000.0, " ms"), Mistake, "delay");
    pub(crate) const BY_MM: FieldSpec =
        number("by_mm", Range::new(-2_000.0, 2_000.0, " mm"), Mistake, "x offset of every second report");
    pub(crate) const GAIN: FieldSpec = number("gain", Range::new(-10.0, 10.0, ""), Mistake, "factor on the voltage");
    pub(crate) const FRACTION: FieldSpec = number(
        "fraction",
        FRACTIONS,
        Mistake,
        "the voltage that the DAC holds, as a fraction of the largest one that the scene may drive",
    );
    pub(crate) const IN_MS: FieldSpec = number("in_ms", TIME_MS, Mistake, "time until the tick count wraps around");
    #[cfg(test)]
    pub(crate) const ALL: &[FieldSpec] = &[CAUSE, LINE, SHARE_OF, BY_MS, BY_MM, GAIN, FRACTION, IN_MS];
}

/// `[[expect]]`.
pub(super) mod expect {
    use super::{FRACTION, FieldSpec, Holds, Means, Number, TIME_MS, number, text, word};

    pub(crate) const AFTER: FieldSpec =
        text("after", "name of a command or fault: times count from its end or its start");
    pub(crate) const FROM_MS: FieldSpec = number("from_ms", TIME_MS, Number(0.0), "start of the interval");
    pub(crate) const TO_MS: FieldSpec = number("to_ms", TIME_MS, Means("the end"), "end of the interval");
    pub(crate) const OUTPUT: FieldSpec = word(
        "output",
        Means(""),
        "`\"zero\"`: DAC code zero in every tick; `\"off\"`: and the amplifier disabled; `\"driven\"`: a code other than \
         zero at least once, and at least once in every 10 ms",
    );
    pub(crate) const ELECTRODE_BELOW_FRACTION: FieldSpec = number(
        "electrode_below_fraction",
        FRACTION,
        Means(""),
        "limit of the absolute electrode voltage in every tick, as a fraction of the largest one that the scene may \
         drive",
    );
    pub(crate) const FRICTION_FRACTION: FieldSpec = FieldSpec::new(
        "friction_fraction",
        Holds::Interval(FRACTION),
        Means(""),
        "`[least, largest]`: the mean of the electric friction felt while the finger is down, as a fraction of the \
         largest",
    );
    pub(crate) const STATE: FieldSpec =
        word("state", Means(""), "state reported by the board by the end of the interval");
    pub(crate) const FAULT: FieldSpec =
        word("fault", Means(""), "fault reported by the board by the end of the interval");
    pub(crate) const ERROR: FieldSpec =
        text("error", "text in the message with which a command or the connection fails in that interval");
    #[cfg(test)]
    pub(crate) const ALL: &[FieldSpec] =
        &[AFTER, FROM_MS, TO_MS, OUTPUT, ELECTRODE_BELOW_FRACTION, FRICTION_FRACTION, STATE, FAULT, ERROR];
}
