//! Mistakes in the fields of a table, and between them.

use thiserror::Error;

use crate::kinds::KindName;
use crate::nearest::Nearest;
use crate::printable::{NAME_MAX_CHARS, Shown, brief};

/// A mistake in a field, or between fields of a table.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum FieldMistake {
    /// The table has no field of this name.
    #[error("unknown field `{}` in {table}; {nearest}", brief(.field))]
    UnknownField { field: String, table: String, nearest: Nearest },
    /// Fields that belong to another table.
    #[error("{} in {table} belong{} {home}: write {write}", listed(.fields), if .fields.len() == 1 { "s" } else { "" })]
    Misplaced { fields: Vec<String>, table: String, home: String, write: String },
    /// A required field is missing.
    #[error("{table} has no {}", missing(field, *.other))]
    MissingField { field: &'static str, other: Option<&'static str>, table: String },
    /// A layer that needs a place has none.
    #[error("{table} has no place: add a `region`, or `x_mm`, `y_mm` and `width_mm`")]
    MissingPlace { table: String },
    /// The table of a finger has the name of a bundled one in place of its fields.
    #[error("a finger has no `name`: for a bundled one, write `finger = \"{name}\"` above the first [[layer]]")]
    BundledFinger { name: String },
    /// A value has another type than expected.
    #[error("`{field}` must be {expected}, found {found}")]
    WrongType { field: &'static str, expected: &'static str, found: &'static str },
    /// A number is in quotation marks.
    #[error("`{field}` must be a number, found a string: {advice}")]
    QuotedNumber { field: &'static str, advice: &'static str },
    /// A value is not a table.
    #[error("`{field}` must be a table, found {found}: write {write}")]
    NotATable { field: &'static str, found: &'static str, write: String },
    /// A value is not a list of tables.
    #[error(
        "`{field}` must be a list of tables, found {found}: write `[[{field}]]`, in double brackets, before the \
         fields of each"
    )]
    NotTables { field: &'static str, found: &'static str },
    /// A number is out of range, or not a number.
    #[error("`{field} = {}` is out of range: expected {min} to {max}{unit}", Shown(*.found))]
    OutOfRange { field: &'static str, found: f64, min: f64, max: f64, unit: &'static str },
    /// A time is longer than the time that contains it.
    #[error("`{field} = {}` is longer than {whole}: expected at most {max_ms} ms", Shown(*.found))]
    TooLong { field: &'static str, found: f64, whole: &'static str, max_ms: f64 },
    /// A word is not one of the choices.
    #[error("`{field} = \"{}\"` is not known; {nearest}", brief(.found))]
    UnknownChoice { field: &'static str, found: String, nearest: Nearest },
    /// A field differs from layer to layer and has no default.
    #[error("`{field}` in [defaults] would be the same for every layer: write it in each layer")]
    NoDefault { field: &'static str },
    /// A length is in pixels, but the scene states no design size.
    #[error("`{field}` is in pixels, and the scene has no design size: add [design] with `width_px` and `height_px`")]
    NoDesign { field: &'static str },
    /// A lower limit is above its upper limit.
    #[error("`{low_name} = {}` is above `{high_name} = {}`: swap them", Shown(*.low), Shown(*.high))]
    LowAboveHigh { low_name: &'static str, low: f64, high_name: &'static str, high: f64 },
    /// One amount is given in two units.
    #[error("`{one}` and `{other}` are the same quantity in two units: remove one of them")]
    TwoUnits { one: &'static str, other: &'static str },
    /// A number is not whole.
    #[error("`{field} = {}` must be a whole number: round it", Shown(*.found))]
    NotWhole { field: &'static str, found: f64 },
    /// An interval is reversed.
    #[error("`{field} = [{}, {}]` is reversed: write the smaller number first", Shown(*.low), Shown(*.high))]
    IntervalReversed { field: &'static str, low: f64, high: f64 },
    /// The numbers do not form an empirical law.
    #[error("`exponent`, `points` and `intervals_n` do not form a valid law: {reason}")]
    Law { reason: String },
    /// A date is not `YYYY-MM-DD`.
    #[error("`date = \"{}\"` is not a date: write it as \"YYYY-MM-DD\"", brief(.found))]
    Date { found: String },
    /// A required text is empty.
    #[error("`{field}` is empty: write a few words")]
    EmptyText { field: &'static str },
    /// A text contains invisible characters.
    #[error("`{field}` contains a control or invisible character: remove it")]
    Unprintable { field: &'static str },
    /// A name is too long.
    #[error("`{field}` has {found} characters: expected at most {max}", max = NAME_MAX_CHARS)]
    NameTooLong { field: &'static str, found: usize },
    /// A list is too short or too long.
    #[error("`{field}` has {found} {}: expected {}", if *.found == 1 { "entry" } else { "entries" }, count(*.min, *.max))]
    Count { field: &'static str, found: usize, min: usize, max: usize },
    /// The speeds of a curve are not in ascending order.
    #[error(
        "the speeds of a curve must ascend in steps of 0.02 mm/s or more, but {after} follows \
         {before}: sort them"
    )]
    SpeedsDoNotRise { before: f64, after: f64 },
    /// Stripes or rings move faster than a board supports.
    #[error(
        "at {found_mm_per_s} mm/s and a wavelength of {wavelength_mm} mm, more than {max_hz} waves per second pass \
         a place: write at most {max_mm_per_s} mm/s, either way"
    )]
    DriftsTooFast { found_mm_per_s: f64, wavelength_mm: f64, max_hz: f64, max_mm_per_s: f64 },
    /// The region of a button is a polygon.
    #[error("a button is a rectangle or an ellipse, and this region is a polygon: change its `shape`")]
    ButtonPolygon,
    /// Copies of a layer lie at the same place.
    #[error("the {what} of this repeat would lie on top of each other: set their spacing, `{step}`")]
    RepeatInPlace { what: &'static str, step: &'static str },
    /// A layer has a field for switching, but can never be switched.
    #[error("{layer} {what}, but nothing can switch it on: write `live = true`, or leave `{field}` out")]
    NeedsLive { layer: String, field: &'static str, what: &'static str },
    /// The friction of a layer with `blend = "add"` is given in total.
    #[error(
        "{layer} is added to what lies below it, so its friction is a difference and cannot be given in total: \
         write `above = \"natural\"` or leave `above` out"
    )]
    AddedTotal { layer: String },
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
