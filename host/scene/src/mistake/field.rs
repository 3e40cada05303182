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
        /// The same quantity in another unit, if there is such a field.
        other: Option<&'static str>,
        /// The table.
        table: String,
    },
    /// A layer that needs a place has none.
    #[error("{table} has no place: add a `region`, or `x_mm`, `y_mm` and `width_mm`")]
    MissingPlace {
        /// The layer.
        table: String,
    },
    /// The table of a finger has the name of a bundled one in place of its fields.
    #[error("a finger has no `name`: for a bundled one, write `finger = \"{name}\"` above the first [[layer]]")]
    BundledFinger {
        /// The name.
        name: String,
    },
    /// A value has another type than expected.
    #[error("`{field}` must be {expected}, found {found}")]
    WrongType {
        /// The field.
        field: &'static str,
        /// The expected type.
        expected: &'static str,
        /// The type that was found.
        found: &'static str,
    },
    /// A number is in quotation marks.
    #[error("`{field}` must be a number, found a text: {advice}")]
    QuotedNumber {
        /// The field.
        field: &'static str,
        /// What to do.
        advice: &'static str,
    },
    /// A value is not a table.
    #[error("`{field}` must be a table, found {found}: write {write}")]
    NotATable {
        /// The field.
        field: &'static str,
        /// The type that was found.
        found: &'static str,
        /// What to write instead.
        write: String,
    },
    /// A value is not a list of tables.
    #[error(
        "`{field}` must be a list of tables, found {found}: write `[[{field}]]`, in double brackets, before the \
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
    /// A time is longer than the time that contains it.
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
    /// A length is in pixels, but the scene states no design size.
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
    #[error("`{one}` and `{other}` are the same quantity in two units: remove one of them")]
    TwoUnits {
        /// A field.
        one: &'static str,
        /// Another field for the same amount.
        other: &'static str,
    },
    /// A number is not whole.
    #[error("`{field} = {}` must be a whole number: round it", Shown(*.found))]
    NotWhole {
        /// The field.
        field: &'static str,
        /// Its value.
        found: f64,
    },
    /// An interval is reversed.
    #[error("`{field} = [{}, {}]` is reversed: write the smaller number first", Shown(*.low), Shown(*.high))]
    IntervalReversed {
        /// The field.
        field: &'static str,
        /// The first number.
        low: f64,
        /// The second number.
        high: f64,
    },
    /// The numbers do not form an empirical law.
    #[error("`exponent`, `points` and `intervals_n` do not form a valid law: {reason}")]
    Law {
        /// The violated condition, and what is allowed.
        reason: String,
    },
    /// A date is not `YYYY-MM-DD`.
    #[error("`date = \"{}\"` is not a date: write it as \"YYYY-MM-DD\"", brief(.found))]
    Date {
        /// The date, as written.
        found: String,
    },
    /// A required text is empty.
    #[error("`{field}` is empty: write a few words")]
    EmptyText {
        /// The field.
        field: &'static str,
    },
    /// A text contains invisible characters.
    #[error("`{field}` contains a control or invisible character: remove it")]
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
    /// The speeds of a curve are not in ascending order.
    #[error(
        "the speeds of a curve must ascend in steps of 0.02 mm/s or more, but {after} follows \
         {before}: sort them"
    )]
    SpeedsDoNotRise {
        /// A speed, mm/s.
        before: f64,
        /// The one after it, mm/s.
        after: f64,
    },
    /// Stripes or rings move faster than a board supports.
    #[error(
        "at {found_mm_per_s} mm/s and a wavelength of {wavelength_mm} mm, more than {max_hz} waves per second pass \
         a place: write at most {max_mm_per_s} mm/s, either way"
    )]
    DriftsTooFast {
        /// Speed of the waves, mm/s.
        found_mm_per_s: f64,
        /// Wavelength, mm.
        wavelength_mm: f64,
        /// Largest number of waves that may pass a place per second, Hz.
        max_hz: f64,
        /// Largest speed at this wavelength, mm/s.
        max_mm_per_s: f64,
    },
    /// The region of a button is a polygon.
    #[error("a button is a rectangle or an ellipse, and this region is a polygon: change its `shape`")]
    ButtonPolygon,
    /// Copies of a layer lie at the same place.
    #[error("the {what} of this repeat would lie on top of each other: set their spacing, `{step}`")]
    RepeatInPlace {
        /// `columns` or `rows`.
        what: &'static str,
        /// The field of their spacing.
        step: &'static str,
    },
    /// A layer has a field for switching, but can never be switched.
    #[error("{layer} {what}, but nothing can switch it on: write `live = true`, or leave `{field}` out")]
    NeedsLive {
        /// The layer.
        layer: String,
        /// The field.
        field: &'static str,
        /// The field's effect, with a verb.
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
