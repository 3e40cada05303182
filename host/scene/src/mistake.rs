//! What can be wrong with a scene, each in one sentence: what was found, what was expected, what to do.

use thiserror::Error;

use super::nearest::Nearest;

/// Something wrong in a scene file. Its text is one sentence for the person who wrote the file.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Mistake {
    /// The bytes are not UTF-8.
    #[error("this byte is not UTF-8 text: save the file as UTF-8")]
    NotUtf8,
    /// The text is not TOML.
    #[error("this is not TOML: {0}")]
    Syntax(String),
    /// A field that the table does not have.
    #[error("unknown field `{field}` in {table}; {nearest}")]
    UnknownField {
        /// As written.
        field: String,
        /// The table it stands in.
        table: String,
        /// What may have been meant.
        nearest: Nearest,
    },
    /// A field that the table must have.
    #[error("{table} has no `{field}`: add it")]
    MissingField {
        /// The field that is missing.
        field: &'static str,
        /// The table it is missing from.
        table: String,
    },
    /// A value of another type.
    #[error("`{field}` has to be {expected}, and this is {found}")]
    WrongType {
        /// The field.
        field: &'static str,
        /// What it should be.
        expected: &'static str,
        /// What it is.
        found: &'static str,
    },
    /// A number that is too small, too large, or none.
    #[error("`{field} = {found}` is out of range: expected {min} to {max}{unit}")]
    OutOfRange {
        /// The field.
        field: &'static str,
        /// Its value.
        found: f64,
        /// Least value.
        min: f64,
        /// Largest value.
        max: f64,
        /// The unit, with a space before it, or nothing.
        unit: &'static str,
    },
    /// A word that is none of the choices.
    #[error("`{field} = \"{found}\"` is not known; {nearest}")]
    UnknownChoice {
        /// The field.
        field: &'static str,
        /// As written.
        found: String,
        /// What may have been meant.
        nearest: Nearest,
    },
    /// A scene file of another version.
    #[error(
        "this scene file has version {found}, and this frixel reads version {expected}: use a frixel that knows it"
    )]
    Version {
        /// As written.
        found: f64,
        /// What this crate reads.
        expected: u32,
    },
    /// Low above high.
    #[error("`{low_name} = {low}` is above `{high_name} = {high}`: swap them")]
    LowAboveHigh {
        /// The field that is to be the lower one.
        low_name: &'static str,
        /// Its value.
        low: f64,
        /// The field that is to be the higher one.
        high_name: &'static str,
        /// Its value.
        high: f64,
    },
    /// One amount in two units.
    #[error("`{one}` and `{other}` say the same in two units: leave one of them out")]
    TwoUnits {
        /// A field.
        one: &'static str,
        /// Another that says the same.
        other: &'static str,
    },
    /// A number with a fraction where there can be none.
    #[error("`{field} = {found}` has to be a whole number: round it")]
    NotWhole {
        /// The field.
        field: &'static str,
        /// Its value.
        found: f64,
    },
    /// A list that is too short or too long.
    #[error("`{field}` has {found} entries: expected {}", count(*.min, *.max))]
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
    /// Speeds of a curve that do not rise.
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
    /// A button that is a polygon.
    #[error("a button is a rectangle or an ellipse, and this region is a polygon: change its `shape`")]
    ButtonPolygon,
    /// More of something than a board has room for.
    #[error("this is number {number} of the scene's {what}, and a board takes {max}: leave some out")]
    TooMany {
        /// What there are too many of.
        what: &'static str,
        /// The number of this one, from one.
        number: usize,
        /// Most of them.
        max: usize,
    },
    /// A layer that is added, in total newtons.
    #[error(
        "{layer} is added to what lies below it, so its friction is a difference and cannot be given in total: \
         write `above = \"natural\"` or leave `above` out"
    )]
    AddedTotal {
        /// The layer.
        layer: String,
    },
    /// A picture that is not there.
    #[error("picture \"{picture}\" was not found in {folder}{}: paths start from the scene file's folder", which_has(.nearest.as_deref()))]
    PictureMissing {
        /// As written.
        picture: String,
        /// Where it was looked for.
        folder: String,
        /// The file there whose name is nearest, where one is near enough.
        nearest: Option<String>,
    },
    /// A picture that cannot be used.
    #[error("picture \"{picture}\" cannot be used: {reason}")]
    PictureUnusable {
        /// As written.
        picture: String,
        /// Why, and what to do.
        reason: String,
    },
    /// A region that leaves the screen.
    #[error(
        "{layer} reaches {beyond_mm} mm past the {edge} edge of the {screen_width_mm} mm x {screen_height_mm} mm screen: \
         move it or make it smaller"
    )]
    OffScreen {
        /// The layer.
        layer: String,
        /// Which edge.
        edge: &'static str,
        /// How far, mm.
        beyond_mm: f64,
        /// The screen, mm.
        screen_width_mm: f64,
        /// The screen, mm.
        screen_height_mm: f64,
    },
    /// More friction than the drive can give.
    #[error(
        "{asking} up to {asked_n} N {reference}, and at {voltage_v_rms} V rms this finger feels at most {reach_n} N \
         {reference}: lower it, raise `voltage_max_v_rms`, or write `saturate = true` under [drive] to have it clamped"
    )]
    AboveReach {
        /// Which layer or layers ask, with the verb.
        asking: String,
        /// What is asked for, N.
        asked_n: f64,
        /// `in total` or `above natural friction`.
        reference: &'static str,
        /// Largest rms voltage, V.
        voltage_v_rms: f64,
        /// The most that can be reached, rounded down, N.
        reach_n: f64,
    },
    /// Less friction than the finger has at no voltage.
    #[error(
        "{asking} down to {asked_n} N {reference}, and a drive can only add to the finger's natural friction of \
         {natural_n} N: raise it, lower `normal_load_n`, or write `saturate = true` under [drive] to have it clamped"
    )]
    BelowNatural {
        /// Which layer or layers ask, with the verb.
        asking: String,
        /// What is asked for, N.
        asked_n: f64,
        /// `in total` or `above natural friction`.
        reference: &'static str,
        /// Friction at no voltage, N.
        natural_n: f64,
    },
    /// More layers than a scene may have.
    #[error("this is layer {number}, and the board takes {max}: leave some out or draw them into one picture")]
    TooManyLayers {
        /// Number of the first layer that is too many.
        number: usize,
        /// Most layers.
        max: usize,
    },
    /// A place where the tick takes too long.
    #[error(
        "{layers} {} at x {x_mm} mm, y {y_mm} mm: a tick there is estimated at {cycles} cycles, and the board has time for \
         {cycles_max}: move layers apart, or leave some out",
        if *.meet { "meet" } else { "are in one cell of the board's grid, though they do not meet," }
    )]
    TickTooLong {
        /// Cycles that the longest tick is estimated at.
        cycles: u32,
        /// Most cycles.
        cycles_max: u32,
        /// The layers that the tick evaluates there.
        layers: String,
        /// Those layers alone exceed the limit at this place. Otherwise layers only share a cell of the grid.
        meet: bool,
        /// The place, mm.
        x_mm: f64,
        /// The place, mm.
        y_mm: f64,
    },
    /// Pictures that need more memory than the board has for them.
    #[error(
        "the pictures up to this one need {needed_bytes} bytes, and the board has {pool_bytes}: \
         a pitch_mm of {pitch_mm} would fit"
    )]
    PoolTooSmall {
        /// Bytes of all different pictures up to this one.
        needed_bytes: u64,
        /// Bytes of the board's pool.
        pool_bytes: u32,
        /// A pitch that fits, mm.
        pitch_mm: f64,
    },
    /// A peak voltage above the board's.
    #[error("`voltage_max_v_peak = {found}` is above the board's limit of {board} V peak: lower it or leave it out")]
    PeakAboveBoard {
        /// As written, V.
        found: f64,
        /// The board's limit, V.
        board: f64,
    },
    /// A carrier that the tick cannot make.
    #[error("`frequency_hz = {found}` is too fast for {tick_hz} ticks a second: expected at most {max} Hz")]
    CarrierTooFast {
        /// As written, Hz.
        found: f64,
        /// Ticks a second.
        tick_hz: u32,
        /// Fastest carrier, Hz.
        max: f64,
    },
    /// More current into the electrode than the board allows.
    #[error(
        "this carrier drives {found_ma:.2} mA {kind} into the board's worst-case electrode, and its limit is \
         {board_ma:.2} mA: lower {cure}"
    )]
    CurrentAboveBoard {
        /// `rms` or `peak`.
        kind: &'static str,
        /// The current at the largest voltage, mA.
        found_ma: f64,
        /// The board's limit, mA.
        board_ma: f64,
        /// What to lower.
        cure: &'static str,
    },
    /// Numbers that are each in range and that the contact model or its table refuses together.
    #[error(
        "this finger on this coating cannot be played ({reason}): check [finger], [coating] and `voltage_max_v_rms`"
    )]
    Model {
        /// What it was refused for.
        reason: String,
    },
}

impl Mistake {
    /// The valid name that may have been meant, where a name is not known and one is near enough.
    pub fn nearest(&self) -> Option<&str> {
        match self {
            Self::UnknownField { nearest, .. } | Self::UnknownChoice { nearest, .. } => nearest.suggestion.as_deref(),
            Self::PictureMissing { nearest, .. } => nearest.as_deref(),
            _ => None,
        }
    }
}

fn which_has(nearest: Option<&str>) -> String {
    nearest.map_or(String::new(), |name| format!(", which has \"{name}\""))
}

fn count(min: usize, max: usize) -> String {
    if min == max { min.to_string() } else { format!("{min} to {max}") }
}
