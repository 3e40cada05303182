//! The mistakes that a scene file can have. Each message states what was found, what is expected, and what to do.

use thiserror::Error;

use super::nearest::Nearest;

/// What to do about a path that starts with a tilde.
pub const TILDE_ADVICE: &str = "only a shell replaces `~` by your folder, so write that folder's path in full";

/// A mistake in a scene file. Its text is one sentence for the person who wrote the file.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Mistake {
    /// The bytes are not UTF-8.
    #[error("this byte is not UTF-8 text: save the file as UTF-8")]
    NotUtf8,
    /// The text is not TOML.
    #[error("this is not TOML: {0}")]
    Syntax(String),
    /// The table has no field of this name.
    #[error("unknown field `{field}` in {table}; {nearest}")]
    UnknownField {
        /// The field, as written.
        field: String,
        /// The table that contains it.
        table: String,
        /// The known names, and the nearest one.
        nearest: Nearest,
    },
    /// A required field is missing.
    #[error("{table} has no `{field}`: {}", if *.field == "version" { "write `version = 2` at the top" } else { "add it" })]
    MissingField {
        /// The missing field.
        field: &'static str,
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
    /// A number is out of range, or not a number.
    #[error("`{field} = {found}` is out of range: expected {min} to {max}{unit}")]
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
    /// A word is not one of the choices.
    #[error("`{field} = \"{found}\"` is not known; {nearest}")]
    UnknownChoice {
        /// The field.
        field: &'static str,
        /// The word, as written.
        found: String,
        /// The known names, and the nearest one.
        nearest: Nearest,
    },
    /// The scene file has another version.
    #[error("this scene file has version {found}, and this frixel reads versions 1 and 2: use a frixel that knows it")]
    Version {
        /// The version, as written.
        found: f64,
    },
    /// Screen or finger of a scene of version 1 cannot be exchanged.
    #[error(
        "the coating of a scene of version 1 contains the finger's skin, so that it cannot be played with another {what}: \
         `frixel scene migrate {file}` prints it as version 2"
    )]
    VersionOneProfile {
        /// `finger` or `screen`.
        what: &'static str,
        /// The scene file.
        file: String,
    },
    /// The scene to be written as version 2 is of version 2.
    #[error("this scene has version 2 already: there is nothing to migrate")]
    NothingToMigrate,
    /// No screen or finger of this name is bundled.
    #[error("no {what} \"{found}\" is bundled, and the name of a file has an ending such as .toml; {nearest}")]
    UnknownProfile {
        /// `finger` or `screen`.
        what: &'static str,
        /// The name, as written.
        found: String,
        /// The bundled names, and the nearest one.
        nearest: Nearest,
    },
    /// A scene of version 1 has a field of version 2.
    #[error("`{field}` came with version 2: `frixel scene migrate {file}` prints a scene of version 1 as version 2")]
    SinceVersionTwo {
        /// The field.
        field: &'static str,
        /// The scene file.
        file: String,
    },
    /// An included file has another version.
    #[error(
        "{file} includes {included}, which has another version than 2: `frixel scene migrate {included}` prints it as 2"
    )]
    IncludedVersion {
        /// The file that includes it.
        file: String,
        /// The included file.
        included: String,
    },
    /// Files include one another.
    #[error("{file} includes {included}, which includes {file} itself: take one of the two out")]
    IncludedByItself {
        /// The file with this `include`.
        file: String,
        /// The file that it includes.
        included: String,
    },
    /// A file is included by two files, or twice by one.
    #[error(
        "{included} is included by {file} and by {other}: a scene includes each file once, so leave one of them out"
    )]
    IncludedTwice {
        /// The file with this `include`.
        file: String,
        /// The included file.
        included: String,
        /// The file that includes it already.
        other: String,
    },
    /// A file that is to be included is not there.
    #[error(
        "{file} includes {included}, which was not found: names start from the folder of {file}{}",
        did_you_mean(.nearest.as_deref())
    )]
    IncludedMissing {
        /// The file with this `include`.
        file: String,
        /// The file that it includes.
        included: String,
        /// The nearest name in the place that was searched, if one is near enough.
        nearest: Option<String>,
    },
    /// A file that is to be included cannot be used.
    #[error("{file} includes {included}, which cannot be used: {reason}")]
    IncludedUnusable {
        /// The file with this `include`.
        file: String,
        /// The file that it includes.
        included: String,
        /// The reason, and what to do.
        reason: String,
    },
    /// Two files of a scene have the same table.
    #[error("`{field}` stands in {file} and in {other}: a scene has one, so leave one of them out")]
    TableTwice {
        /// The table.
        field: &'static str,
        /// The file with this table.
        file: String,
        /// Another file that has it.
        other: String,
    },
    /// Layers of two files have the same name.
    #[error("a layer \"{name}\" is in {file} and in {other}: give one of them another name")]
    NameTwice {
        /// The name.
        name: String,
        /// The file with this layer.
        file: String,
        /// Another file that has a layer of this name.
        other: String,
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
    #[error("`{low_name} = {low}` is above `{high_name} = {high}`: swap them")]
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
    #[error("`{field} = {found}` has to be a whole number: round it")]
    NotWhole {
        /// The field.
        field: &'static str,
        /// Its value.
        found: f64,
    },
    /// The first number of an interval is above the second one.
    #[error("`{field} = [{low}, {high}]` falls: write the smaller number first")]
    IntervalReversed {
        /// The field.
        field: &'static str,
        /// The first number.
        low: f64,
        /// The second number.
        high: f64,
    },
    /// A date is not `YYYY-MM-DD`.
    #[error("`date = \"{found}\"` is not a day: write it as \"YYYY-MM-DD\"")]
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
    /// The scene has more of something than a board has room for.
    #[error("this is number {number} of the scene's {what}, and a board takes {max}: leave some out")]
    TooMany {
        /// The kind of thing that there are too many of.
        what: &'static str,
        /// The number of this one, from one.
        number: usize,
        /// The board's limit.
        max: usize,
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
    /// There is no file of this name.
    #[error(
        "{what} \"{file}\" was not found in {folder}{}: {}",
        which_has(.nearest.as_deref()),
        if .file.starts_with('~') { TILDE_ADVICE } else { "paths start from the folder of the file that names it" }
    )]
    FileMissing {
        /// `picture`, `finger` or `screen`.
        what: &'static str,
        /// The file's name, as written.
        file: String,
        /// The place that was searched.
        folder: String,
        /// The nearest name in that place, if one is near enough.
        nearest: Option<String>,
    },
    /// The name of a file is empty.
    #[error("`{field}` names no file: write its name between the quotation marks")]
    NoFileName {
        /// The field.
        field: &'static str,
    },
    /// A file cannot be used.
    #[error("{what} \"{file}\" cannot be used: {reason}")]
    FileUnusable {
        /// `picture`, `finger` or `screen`.
        what: &'static str,
        /// The file's name, as written.
        file: String,
        /// The reason, and what to do.
        reason: String,
    },
    /// A region extends past the screen.
    #[error(
        "{layer} reaches {beyond_mm} mm past the {edge} edge of the {screen_width_mm} mm x {screen_height_mm} mm screen: \
         move it or make it smaller"
    )]
    OffScreen {
        /// The layer.
        layer: String,
        /// The edge of the screen.
        edge: &'static str,
        /// How far the region extends past the edge, mm.
        beyond_mm: f64,
        /// Width of the screen, mm.
        screen_width_mm: f64,
        /// Height of the screen, mm.
        screen_height_mm: f64,
    },
    /// The target friction of a layer is more than the drive can give.
    #[error(
        "{asking} up to {asked_n} N {reference}, and at {voltage_v_rms} V rms this finger feels at most {reach_n} N \
         {reference}: {}lower it, {}or write `saturate = true` under [drive] to have it clamped",
        if *.may_be_millinewtons { "were mN meant? 1 mN is 0.001 N; " } else { "" },
        if *.voltage_helps { "raise `voltage_max_v_rms`, " } else { "" },
    )]
    AboveReach {
        /// The layer or layers, with the verb.
        asking: String,
        /// The layers' target friction, N.
        asked_n: f64,
        /// `in total` or `above natural friction`.
        reference: &'static str,
        /// Largest rms voltage, V.
        voltage_v_rms: f64,
        /// The largest friction that can be reached, rounded down, N.
        reach_n: f64,
        /// Whether a larger `voltage_max_v_rms` would reach the target, within the limits of screen and board.
        voltage_helps: bool,
        /// Whether the number is in reach if it was meant in millinewtons.
        may_be_millinewtons: bool,
    },
    /// The target friction of a layer is less than the friction at no voltage.
    #[error(
        "{asking} down to {asked_n} N {reference}, and a drive can only add to the finger's natural friction of \
         {natural_n} N: raise it, lower `normal_load_n`, or write `saturate = true` under [drive] to have it clamped"
    )]
    BelowNatural {
        /// The layer or layers, with the verb.
        asking: String,
        /// The layers' target friction, N.
        asked_n: f64,
        /// `in total` or `above natural friction`.
        reference: &'static str,
        /// Friction at no voltage, N.
        natural_n: f64,
    },
    /// The scene has more layers than the board takes.
    #[error("this is layer {number}, and the board takes {max}: leave some out or draw them into one picture")]
    TooManyLayers {
        /// Number of the first layer beyond the limit.
        number: usize,
        /// The board's limit.
        max: usize,
    },
    /// A tick takes too long at some place.
    #[error(
        "{layers} {} at x {x_mm} mm, y {y_mm} mm: a tick there is estimated at {cycles} cycles, and the board has time for \
         {cycles_max}: move layers apart, or leave some out",
        if *.meet { "meet" } else { "are in one cell of the board's grid, though they do not meet," }
    )]
    TickTooLong {
        /// Estimated cycles of the longest tick.
        cycles: u32,
        /// The board's limit.
        cycles_max: u32,
        /// The layers that the tick evaluates there.
        layers: String,
        /// Whether those layers alone exceed the limit at this place. Otherwise they only share a cell of the grid.
        meet: bool,
        /// The place from the left edge of the screen, mm.
        x_mm: f64,
        /// The place from the top edge of the screen, mm.
        y_mm: f64,
    },
    /// The pictures need more memory than the board has for them.
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
    /// The peak voltage is above the board's limit.
    #[error("`voltage_max_v_peak = {found}` is above the board's limit of {board} V peak: lower it or leave it out")]
    PeakAboveBoard {
        /// The peak voltage, as written, V.
        found: f64,
        /// The board's limit, V.
        board: f64,
    },
    /// The carrier is too fast for the board's tick.
    #[error("`frequency_hz = {found}` is too fast for {tick_hz} ticks a second: expected at most {max} Hz")]
    CarrierTooFast {
        /// The frequency, as written, Hz.
        found: f64,
        /// Ticks a second.
        tick_hz: u32,
        /// Fastest carrier, Hz.
        max: f64,
    },
    /// The current into the electrode is above the board's limit.
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
        /// The field to lower.
        cure: &'static str,
    },
    /// The contact at the largest voltage is wider than the finger.
    #[error(
        "at {voltage_v_rms:.1} V rms the contact would have a radius of {contact_mm:.1} mm under a finger of {radius_mm} mm, \
         where the model is not valid: a skin gap is missing, since {gap_um:.2} um between electrode and finger are too few; \
         give the finger a `skin_gap_um` of some micrometres (in version 1 another slab of [[coating]]), or lower \
         `voltage_max_v_rms`"
    )]
    ContactWiderThanFinger {
        /// The largest rms voltage, V.
        voltage_v_rms: f64,
        /// Contact radius at that voltage, mm.
        contact_mm: f64,
        /// The finger's radius, mm.
        radius_mm: f64,
        /// Effective gap of coating and skin, um.
        gap_um: f64,
    },
    /// The springs of a board cannot stand in for a soft finger.
    #[error(
        "a board plays springs of one stiffness, and those nearest to this soft finger differ from it by {found_percent:.1} % \
         of the reach, more than {max_percent} %: lower `voltage_max_v_rms`, or give the finger `stiffness_pa_per_m`"
    )]
    SoftFinger {
        /// Largest deviation, in percent of the reachable electric friction.
        found_percent: f64,
        /// Largest deviation that is played, in percent.
        max_percent: f64,
    },
    /// Each number is in range, but the contact model or its table refuses their combination.
    #[error("this finger on this coating cannot be played ({reason}): check finger, coating and `voltage_max_v_rms`")]
    Model {
        /// The reason.
        reason: String,
    },
}

impl Mistake {
    /// The nearest valid name to an unknown one, if one is near enough.
    pub fn nearest(&self) -> Option<&str> {
        match self {
            Self::UnknownField { nearest, .. }
            | Self::UnknownChoice { nearest, .. }
            | Self::UnknownProfile { nearest, .. } => nearest.suggestion.as_deref(),
            Self::FileMissing { nearest, .. } | Self::IncludedMissing { nearest, .. } => nearest.as_deref(),
            _ => None,
        }
    }
}

fn did_you_mean(nearest: Option<&str>) -> String {
    nearest.map_or(String::new(), |name| format!("; did you mean \"{name}\"?"))
}

fn which_has(nearest: Option<&str>) -> String {
    nearest.map_or(String::new(), |name| format!(", which has \"{name}\""))
}

fn count(min: usize, max: usize) -> String {
    if min == max { min.to_string() } else { format!("{min} to {max}") }
}
