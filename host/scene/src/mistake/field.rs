//! Mistakes in the fields of a table, and between them.

use thiserror::Error;

use crate::kinds::KindName;
use crate::nearest::Nearest;
use crate::printable::{NAME_MAX_CHARS, Shown, brief};

/// A mistake in a field, or between fields of a table.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FieldMistake {
    /// The table has no field of this name.
    #[error("unknown field `{}` in {table}; {nearest}", brief(.field))]
    UnknownField {
        /// The field, as written.
        field: String,
        /// The table that contains it.
        table: String,
        /// The known names, and the nearest one.
        nearest: Nearest,
    },
    /// A scene is to play without a host.
    #[error("a scene plays only while its host is connected: delete this line")]
    Autonomous,
    /// Fields that belong to another table.
    #[error("{} in {table} belong{} {home}: write {write}", listed(.fields), if .fields.len() == 1 { "s" } else { "" })]
    Misplaced {
        /// The fields, as written.
        fields: Vec<String>,
        /// The table that contains them.
        table: String,
        /// The table to which they belong, with a preposition.
        home: String,
        /// What to write instead.
        write: String,
    },
    /// A required field is missing.
    #[error("{table} has no {}", missing(field, *.other))]
    MissingField {
        /// The missing field.
        field: &'static str,
        /// Another field that says the same in another unit, if there is one.
        other: Option<&'static str>,
        /// The table.
        table: String,
    },
    /// A value has another type than expected.
    #[error("`{field}` has to be {expected}, and this is {found}")]
    WrongType {
        /// The field.
        field: &'static str,
        /// The expected type.
        expected: &'static str,
        /// The type that was found.
        found: &'static str,
    },
    /// Something else stands where a table is expected.
    #[error("`{field}` has to be a table, and this is {found}: write {write}")]
    NotATable {
        /// The field.
        field: &'static str,
        /// The type that was found.
        found: &'static str,
        /// What to write instead.
        write: String,
    },
    /// Something else stands where a list of tables is expected.
    #[error(
        "`{field}` has to be a list of tables, and this is {found}: write `[[{field}]]`, in double brackets, before the \
         fields of each"
    )]
    NotTables {
        /// The field.
        field: &'static str,
        /// The type that was found.
        found: &'static str,
    },
    /// A number is out of range, or not a number.
    #[error("`{field} = {}` is out of range: expected {min} to {max}{unit}", Shown(*.found))]
    OutOfRange {
        /// The field.
        field: &'static str,
        /// Its value.
        found: f64,
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
        /// The unit, with a space before it; empty if there is no unit.
        unit: &'static str,
    },
    /// A time is longer than one that it is a part of.
    #[error("`{field} = {}` is longer than {whole}: expected at most {max_ms} ms", Shown(*.found))]
    TooLong {
        /// The field.
        field: &'static str,
        /// Its value, ms.
        found: f64,
        /// The longer time, in words.
        whole: &'static str,
        /// The longer time, ms.
        max_ms: f64,
    },
    /// A word is not one of the choices.
    #[error("`{field} = \"{}\"` is not known; {nearest}", brief(.found))]
    UnknownChoice {
        /// The field.
        field: &'static str,
        /// The word, as written.
        found: String,
        /// The known names, and the nearest one.
        nearest: Nearest,
    },
    /// A field differs from layer to layer and has no default.
    #[error("`{field}` in [defaults] would be the same for every layer: write it in each layer")]
    NoDefault {
        /// The field.
        field: &'static str,
    },
    /// A length is in pixels, and the scene does not say how large its design is.
    #[error("`{field}` is in pixels, and the scene has no design size: add [design] with `width_px` and `height_px`")]
    NoDesign {
        /// The field.
        field: &'static str,
    },
    /// A lower limit is above its upper limit.
    #[error("`{low_name} = {}` is above `{high_name} = {}`: swap them", Shown(*.low), Shown(*.high))]
    LowAboveHigh {
        /// The field of the lower limit.
        low_name: &'static str,
        /// Its value.
        low: f64,
        /// The field of the upper limit.
        high_name: &'static str,
        /// Its value.
        high: f64,
    },
    /// One amount is given in two units.
    #[error("`{one}` and `{other}` say the same in two units: leave one of them out")]
    TwoUnits {
        /// A field.
        one: &'static str,
        /// Another field for the same amount.
        other: &'static str,
    },
    /// A number has a fraction and must not.
    #[error("`{field} = {}` has to be a whole number: round it", Shown(*.found))]
    NotWhole {
        /// The field.
        field: &'static str,
        /// Its value.
        found: f64,
    },
    /// The first number of an interval is above the second one.
    #[error("`{field} = [{}, {}]` falls: write the smaller number first", Shown(*.low), Shown(*.high))]
    IntervalReversed {
        /// The field.
        field: &'static str,
        /// The first number.
        low: f64,
        /// The second number.
        high: f64,
    },
    /// The numbers of an empirical law are none.
    #[error("`exponent`, `points` and `intervals_n` are no law: {reason}")]
    Law {
        /// What is wrong, and what is possible.
        reason: String,
    },
    /// A date is not `YYYY-MM-DD`.
    #[error("`date = \"{}\"` is not a day: write it as \"YYYY-MM-DD\"", brief(.found))]
    Date {
        /// The date, as written.
        found: String,
    },
    /// A text that has to say something is empty.
    #[error("`{field}` is empty: say it in a few words")]
    EmptyText {
        /// The field.
        field: &'static str,
    },
    /// A text has characters that are not seen.
    #[error("`{field}` has a character that controls a terminal, or is not seen: take it out")]
    Unprintable {
        /// The field.
        field: &'static str,
    },
    /// A name is too long.
    #[error("`{field}` has {found} characters: expected at most {max}", max = NAME_MAX_CHARS)]
    NameTooLong {
        /// The field.
        field: &'static str,
        /// How many characters it has.
        found: usize,
    },
    /// A list is too short or too long.
    #[error("`{field}` has {found} {}: expected {}", if *.found == 1 { "entry" } else { "entries" }, count(*.min, *.max))]
    Count {
        /// The field.
        field: &'static str,
        /// How many entries it has.
        found: usize,
        /// Fewest entries.
        min: usize,
        /// Most entries.
        max: usize,
    },
    /// The speeds of a curve do not rise.
    #[error(
        "the speeds of a curve have to rise, by 0.02 mm/s or more from each to the next, and {after} comes after \
         {before}: sort them"
    )]
    SpeedsDoNotRise {
        /// A speed, mm/s.
        before: f64,
        /// The one after it, mm/s.
        after: f64,
    },
    /// Stripes or rings move so fast that more of them pass a place than a board accepts.
    #[error(
        "at {found_mm_per_s} mm/s and a wavelength of {wavelength_mm} mm, more than {max_hz} waves pass a place in a second: \
         write at most {max_mm_per_s} mm/s, either way"
    )]
    DriftsTooFast {
        /// Speed of the waves, mm/s.
        found_mm_per_s: f64,
        /// From wave to wave, mm.
        wavelength_mm: f64,
        /// Most waves a second that pass a place.
        max_hz: f64,
        /// Fastest that waves of this length may move, mm/s.
        max_mm_per_s: f64,
    },
    /// The region of a button is a polygon.
    #[error("a button is a rectangle or an ellipse, and this region is a polygon: change its `shape`")]
    ButtonPolygon,
    /// Several copies of a layer would lie at the same place.
    #[error("the {what} of this repeat would lie on one another: give the distance from one to the next, `{step}`")]
    RepeatInPlace {
        /// `columns` or `rows`.
        what: &'static str,
        /// The field of their distance.
        step: &'static str,
    },
    /// A layer has a field for when it is switched, and can never be switched.
    #[error("{layer} {what}, and nothing could switch it on: write `live = true`, or leave `{field}` out")]
    NeedsLive {
        /// The layer.
        layer: String,
        /// The field.
        field: &'static str,
        /// What the field says, with a verb.
        what: &'static str,
    },
    /// The friction of a layer with `blend = "add"` is given in total.
    #[error(
        "{layer} is added to what lies below it, so its friction is a difference and cannot be given in total: \
         write `above = \"natural\"` or leave `above` out"
    )]
    AddedTotal {
        /// The layer.
        layer: String,
    },
}

fn missing(field: &str, other: Option<&str>) -> String {
    match other {
        _ if field == "version" => "`version`: write `version = 1` at the top".to_owned(),
        _ if field == "kind" => {
            let kinds: Vec<&str> = KindName::ALL.iter().map(|(word, _)| *word).collect();
            format!("`kind`: write one of `{}`", kinds.join("`, `"))
        }
        Some(other) => format!("`{field}` or `{other}`: add one of them"),
        None => format!("`{field}`: add it"),
    }
}

/// Names of fields, as in a sentence.
fn listed(fields: &[String]) -> String {
    match fields {
        [others @ .., last] if !others.is_empty() => format!("`{}` and `{last}`", others.join("`, `")),
        fields => format!("`{}`", fields.concat()),
    }
}

fn count(min: usize, max: usize) -> String {
    if min == max { min.to_string() } else { format!("{min} to {max}") }
}
