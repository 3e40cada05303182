//! The tables that belong to no kind of layer, and the parts that the kinds share. The parser checks the fields;
//! [`super::json_schema`] and `docs/design/scene-reference.md` show them.
#![allow(clippy::wildcard_imports, reason = "every table is written with the same few words")]

use frixel_layers::{CARRIER_MIN_HZ, HOST_TIMEOUTS_MS, range};

use super::grammar::Absence::{Flag, Means, Mistake, Number};
use super::grammar::{Absence, AmountFields, FieldSpec, Holds, LengthFields, Range};

/// A number.
pub(crate) const fn number(name: &'static str, range: Range, absence: Absence, meaning: &'static str) -> FieldSpec {
    FieldSpec::new(name, Holds::Number(range), absence, meaning)
}

/// `true` or `false`.
pub(crate) const fn flag(name: &'static str, default: bool, meaning: &'static str) -> FieldSpec {
    FieldSpec::new(name, Holds::Flag, Flag(default), meaning)
}

/// One of some words.
pub(crate) const fn word(name: &'static str, absence: Absence, meaning: &'static str) -> FieldSpec {
    FieldSpec::new(name, Holds::Word, absence, meaning)
}

/// Two numbers, the second one not below the first.
pub(crate) const fn interval(name: &'static str, range: Range, meaning: &'static str) -> FieldSpec {
    FieldSpec::new(name, Holds::Interval(range), Mistake, meaning)
}

/// The fields of an amount whose names begin with a stem.
macro_rules! amount {
    ($stem:literal, $absence:expr, $meaning:expr) => {
        $crate::grammar::AmountFields {
            newtons: $crate::tables::number(concat!($stem, "_n"), $crate::tables::FRICTION_N, $absence, $meaning),
            fraction: $crate::tables::number(concat!($stem, "_fraction"), $crate::tables::FRACTION, $absence, $meaning),
            factor: $crate::tables::number(concat!($stem, "_factor"), $crate::tables::FACTOR, $absence, $meaning),
        }
    };
}
pub(crate) use amount;

/// The fields of a place or a size along an axis.
macro_rules! length {
    ($stem:literal, $axis:ident, $range:expr, $absence:expr, $meaning:expr $(,)?) => {
        $crate::grammar::LengthFields {
            mm: $crate::tables::number(concat!($stem, "_mm"), $range, $absence, $meaning),
            px: $crate::tables::number(concat!($stem, "_px"), $crate::tables::PIXELS, $absence, $meaning),
            axis: $crate::grammar::Axis::$axis,
        }
    };
}
pub(crate) use length;

pub(crate) const FRICTION_N: Range = Range::new(range::FRICTION_N.min, range::FRICTION_N.max, " N");
pub(crate) const FRACTION: Range = Range::new(-1.0, 1.0, "");
pub(crate) const FACTOR: Range = Range::new(range::FRICTION_N.min, range::FRICTION_N.max, "");
pub(crate) const PLACE_MM: Range = Range::new(-2_000.0, 2_000.0, " mm");
/// Pixels of a design. Converted to millimetres, they have the range of the field in millimetres.
pub(crate) const PIXELS: Range = Range::new(-1e6, 1e6, " px");
pub(crate) const SIZE_MM: Range = Range::new(0.01, 2_000.0, " mm");
pub(crate) const WAVELENGTH_MM: Range = Range::new(0.05, 2_000.0, " mm");
/// Angles up to ten thousand turns either way.
pub(crate) const ANGLE_DEG: Range = Range::new(-3_600_000.0, 3_600_000.0, " degrees");

/// The two amounts that limit most kinds.
pub(crate) const LOW: AmountFields = amount!("low", Mistake, "least friction");
pub(crate) const HIGH: AmountFields = amount!("high", Mistake, "largest friction");

/// The file itself.
pub(super) mod scene {
    use super::*;

    pub(crate) const VERSION: FieldSpec =
        number("version", Range::new(f64::MIN, f64::MAX, ""), Mistake, "version of the file format");
    pub(crate) const SCREEN: FieldSpec = FieldSpec::new(
        "screen",
        Holds::TableOrText,
        Means("the example screen"),
        "the screen: a table, the name of a bundled one, or of a file",
    );
    pub(crate) const FINGER: FieldSpec = FieldSpec::new(
        "finger",
        Holds::TableOrText,
        Means("the example finger"),
        "the finger that the scene is meant for: a table, the name of a bundled one, or of a file",
    );
    pub(crate) const DRIVE: FieldSpec =
        FieldSpec::new("drive", Holds::Table, Means("all defaults"), "limits of the drive");
    pub(crate) const CARRIER: FieldSpec =
        FieldSpec::new("carrier", Holds::Table, Means("all defaults"), "the alternating voltage");
    pub(crate) const TOUCH: FieldSpec =
        FieldSpec::new("touch", Holds::Table, Means("all defaults"), "how touch reports are used");
    pub(crate) const INCLUDE: FieldSpec = FieldSpec::new(
        "include",
        Holds::Texts,
        Means("nothing"),
        "other scene files whose layers lie below those of this one, see [several files](#several-files)",
    );
    pub(crate) const DESIGN: FieldSpec = FieldSpec::new(
        "design",
        Holds::Table,
        Means("no pixels"),
        "the size of the design in pixels, see [`[design]`](#design)",
    );
    pub(crate) const DEFAULTS: FieldSpec = FieldSpec::new(
        "defaults",
        Holds::Table,
        Means("none"),
        "fields that many layers share, see [`[defaults]`](#defaults)",
    );
    pub(crate) const LAYER: FieldSpec =
        FieldSpec::new("layer", Holds::Tables, Means("bare glass"), "the layers of friction");
}

/// `[screen]` of a scene, and a screen's file.
pub(super) mod screen {
    use super::*;

    pub(crate) const NAME: FieldSpec =
        FieldSpec::new("name", Holds::Text, Means("none"), "name by which finger profiles refer to this screen");

    const SIZE: Range = Range::new(5.0, 2_000.0, " mm");
    pub(crate) const WIDTH_MM: FieldSpec = number("width_mm", SIZE, Mistake, "width of the screen, along x");
    pub(crate) const HEIGHT_MM: FieldSpec = number("height_mm", SIZE, Mistake, "height of the screen, along y");
    pub(crate) const COATING: FieldSpec = FieldSpec::new(
        "coating",
        Holds::TableOrTables,
        Means("1 um of silicon dioxide: `{ thickness_um = 1, permittivity = 3.9 }`"),
        "the insulator between electrode and finger, see [`coating`](#coating)",
    );
    const NO_LIMIT: Absence = Means("no limit of its own");
    pub(crate) const VOLTAGE_MAX_V_RMS: FieldSpec =
        number("voltage_max_v_rms", super::drive::V_RMS, NO_LIMIT, "largest rms voltage that the screen withstands");
    pub(crate) const VOLTAGE_MAX_V_PEAK: FieldSpec =
        number("voltage_max_v_peak", super::drive::V_PEAK, NO_LIMIT, "largest peak voltage that the screen withstands");
    pub(crate) const SLEW_V_PER_US: FieldSpec =
        number("slew_v_per_us", super::drive::SLEW, NO_LIMIT, "fastest change of the envelope");
}

/// A file of a touch source. The ranges are within those of the simulated source.
pub(super) mod touch_source {
    use super::*;

    const SHARE: Range = Range::new(0.0, 1.0, "");
    const TIME: Range = Range::new(0.0, 1_000.0, " ms");
    const LENGTH: Range = Range::new(0.0, 10.0, " mm");
    pub(crate) const REPORTS_PER_S: FieldSpec =
        number("reports_per_s", Range::new(1.0, 40_000.0, " a second"), Mistake, "reports a second");
    pub(crate) const LATENCY_MS: FieldSpec = number(
        "latency_ms",
        TIME,
        Mistake,
        "latency from a sample to the arrival of its report, as the source states it",
    );
    pub(crate) const JITTER_MS: FieldSpec =
        number("jitter_ms", TIME, Number(0.0), "standard deviation of the latency; not stated by the source");
    pub(crate) const NOISE_MM: FieldSpec = number("noise_mm", LENGTH, Number(0.0), "rms position noise, each axis");
    pub(crate) const STEP_MM: FieldSpec = number("step_mm", LENGTH, Number(0.0), "position resolution, each axis");
    pub(crate) const LOST_SHARE: FieldSpec =
        number("lost_share", SHARE, Number(0.0), "fraction of the reports that are lost");
    pub(crate) const BUNCHED_SHARE: FieldSpec =
        number("bunched_share", SHARE, Number(0.0), "fraction of the reports that arrive together with the next one");
    pub(crate) const PAUSES_PER_S: FieldSpec = number(
        "pauses_per_s",
        Range::new(0.0, 10.0, " a second"),
        Number(0.0),
        "pauses per second; every report in a pause is lost",
    );
    pub(crate) const PAUSE_MAX_MS: FieldSpec =
        number("pause_max_ms", TIME, Number(0.0), "longest pause; durations are uniformly distributed");
}

/// A slab of the coating.
pub(super) mod coating {
    use super::*;

    pub(crate) const THICKNESS_UM: FieldSpec = number(
        "thickness_um",
        Range::new(0.01, 1_000.0, " um"),
        Mistake,
        "thickness of the insulator between electrode and finger",
    );
    pub(crate) const PERMITTIVITY: FieldSpec =
        number("permittivity", Range::new(1.0, 10_000.0, ""), Mistake, "its relative permittivity");
}

/// `[finger]` of a scene, and a finger profile.
pub(super) mod finger {
    use super::*;

    pub(crate) const RADIUS_MM: FieldSpec =
        number("radius_mm", Range::new(0.1, 100.0, " mm"), Mistake, "radius of curvature at the contact");
    pub(crate) const STIFFNESS_PA_PER_M: FieldSpec =
        number("stiffness_pa_per_m", Range::new(1e3, 1e14, " Pa/m"), Mistake, "Winkler-Fuss stiffness");
    const COEFFICIENT: Range = Range::new(0.001, 10.0, "");
    pub(crate) const FRICTION_COEFFICIENT: FieldSpec =
        number("friction_coefficient", COEFFICIENT, Mistake, "friction coefficient on the bare screen");
    const LOAD_N: Range = Range::new(0.0, 50.0, " N");
    pub(crate) const NORMAL_LOAD_N: FieldSpec = number("normal_load_n", LOAD_N, Mistake, "normal load of the finger");
    pub(crate) const SKIN_GAP_UM: FieldSpec = number(
        "skin_gap_um",
        Range::new(0.0, 10_000.0, " um"),
        Mistake,
        "stratum corneum and air between coating and living tissue, as an effective gap: thickness over permittivity",
    );
    pub(crate) const MODEL: FieldSpec = word(
        "model",
        Means("`\"winkler-fuss\"`"),
        "`\"winkler-fuss\"`: linear springs; `\"soft\"`: a material that stiffens under stress, see \
         [soft fingers](#soft-fingers)",
    );
    pub(crate) const MODULUS_PA: FieldSpec =
        number("modulus_pa", Range::new(1.0, 1e12, " Pa"), Mistake, "modulus `E` of a soft finger");
    pub(crate) const STRESS_EXPONENT: FieldSpec = number(
        "stress_exponent",
        Range::new(0.02, 1.0, ""),
        Mistake,
        "stress exponent of a soft finger: strain is proportional to stress^exponent",
    );
    pub(crate) const SHAPE_CONSTANT: FieldSpec =
        number("shape_constant", Range::new(0.001, 1_000.0, ""), Mistake, "constant `B` of a soft finger, Eq. (24)");
    pub(crate) const ORIGIN: FieldSpec = word(
        "origin",
        Means("`\"assumed\"`"),
        "source of the numbers: `\"assumed\"`; `\"perceptual\"`: reported by a person; `\"measured\"`: with a force \
         sensor; or `\"empirical\"`: with a force sensor, as a law of the voltage, see \
         [empirical fingers](#empirical-fingers)",
    );
    pub(crate) const EXPONENT: FieldSpec = number(
        "exponent",
        Range::new(0.5, 12.0, ""),
        Mistake,
        "power of the voltage with which electric friction grows below the first point",
    );
    pub(crate) const POINTS: FieldSpec = FieldSpec::new(
        "points",
        Holds::Pairs(Range::new(0.0, 1_000.0, "")),
        Mistake,
        "1 to 16 points `[V rms, N]`: voltage and electric friction under `normal_load_n`, both ascending",
    );
    pub(crate) const INTERVALS_N: FieldSpec = FieldSpec::new(
        "intervals_n",
        Holds::Pairs(Range::new(0.0, 1_000.0, " N")),
        Mistake,
        "95 % interval of the friction of each point, `[least, largest]`",
    );
    pub(crate) const DATE: FieldSpec =
        FieldSpec::new("date", Holds::Text, Mistake, "day of the experiment, `\"YYYY-MM-DD\"`");
    pub(crate) const METHOD: FieldSpec = FieldSpec::new("method", Holds::Text, Mistake, "method of the experiment");
    pub(crate) const SCREEN: FieldSpec = FieldSpec::new(
        "screen",
        Holds::Text,
        Mistake,
        "`name` of the screen of the experiment; on another screen the profile counts as assumed",
    );
    const VOLTAGE: Range = Range::new(0.0, 1_000.0, " V rms");
    pub(crate) const THRESHOLD_V_RMS: FieldSpec =
        number("threshold_v_rms", VOLTAGE, Mistake, "rms voltage at the detection threshold");
    pub(crate) const THRESHOLD_INTERVAL_V_RMS: FieldSpec =
        interval("threshold_interval_v_rms", VOLTAGE, "95 % interval of the threshold, `[least, largest]`");
    pub(crate) const FRICTION_COEFFICIENT_INTERVAL: FieldSpec = interval(
        "friction_coefficient_interval",
        COEFFICIENT,
        "95 % interval of the friction coefficient, `[least, largest]`",
    );
    pub(crate) const ELECTRIC_FRICTION_INTERVAL_N: FieldSpec = interval(
        "electric_friction_interval_n",
        Range::new(0.0, 100.0, " N"),
        "95 % interval of the electric friction at `measured_voltage_max_v_rms` under `normal_load_n`",
    );
    pub(crate) const MEASURED_VOLTAGE_MAX_V_RMS: FieldSpec =
        number("measured_voltage_max_v_rms", VOLTAGE, Mistake, "largest rms voltage of the measurement");
    pub(crate) const MEASURED_NORMAL_LOAD_RANGE_N: FieldSpec =
        interval("measured_normal_load_range_n", LOAD_N, "least and largest normal load of the measurement");
}

/// `[drive]`
pub(super) mod drive {
    use super::*;

    pub(crate) const V_RMS: Range = Range::new(1.0, 1_000.0, " V rms");
    pub(crate) const V_PEAK: Range = Range::new(2.0, 2_000.0, " V peak");
    pub(crate) const SLEW: Range = Range::new(0.001, 1_000.0, " V/us");
    pub(crate) const VOLTAGE_MAX_V_RMS: FieldSpec =
        number("voltage_max_v_rms", V_RMS, Number(150.0), "largest rms voltage over a carrier period");
    pub(crate) const VOLTAGE_MAX_V_PEAK: FieldSpec = number(
        "voltage_max_v_peak",
        V_PEAK,
        Means("what the rms voltage needs, within the board's limit"),
        "largest peak voltage; at most the board's limit",
    );
    pub(crate) const SLEW_V_PER_US: FieldSpec =
        number("slew_v_per_us", SLEW, Number(5.0), "fastest change of the envelope");
    pub(crate) const HOST_TIMEOUT_MS: FieldSpec = number(
        "host_timeout_ms",
        Range::new(HOST_TIMEOUTS_MS[0] as f64, HOST_TIMEOUTS_MS[1] as f64, " ms"),
        Number(250.0),
        "silence of the host after which the output goes to zero",
    );
    pub(crate) const SATURATE: FieldSpec =
        flag("saturate", false, "friction out of reach is clamped and flagged, not refused");
}

/// `[carrier]`
pub(super) mod carrier {
    use super::*;

    pub(crate) const SHAPE: FieldSpec =
        word("shape", Means("`\"square\"`"), "`\"square\"`, which has no ripple in V^2, or `\"sine\"`");
    /// Below this frequency the drive is not an alternating carrier. The upper limit depends on the board's ticks.
    pub(crate) const FREQUENCY_HZ: FieldSpec = number(
        "frequency_hz",
        Range::new(CARRIER_MIN_HZ as f64, 100_000.0, " Hz, and at most an eighth of the board's ticks a second"),
        Number(1_000.0),
        "rounded to whole ticks per half period; the rounding is reported",
    );
}

/// `[touch]`
pub(super) mod touch {
    use super::*;

    pub(crate) const PREDICTION: FieldSpec =
        flag("prediction", true, "the board predicts the current position of the finger from late touch reports");
    pub(crate) const LEADER: FieldSpec = word(
        "leader",
        Means("`\"first\"`"),
        "which of several fingers is followed, since one electrode renders one effect: the `\"first\"` on the screen, \
         or the `\"latest\"`; when it lifts, the rule selects the next",
    );
}

/// `[design]`
pub(super) mod design {
    use super::*;

    const SIZE: Range = Range::new(1.0, 100_000.0, " px");
    pub(crate) const WIDTH_PX: FieldSpec =
        number("width_px", SIZE, Mistake, "width of the design; it spans the width of the screen");
    pub(crate) const HEIGHT_PX: FieldSpec =
        number("height_px", SIZE, Mistake, "height of the design; it spans the height of the screen");
}

/// `[[layer]]`: the fields that every kind has.
pub(super) mod layer {
    use super::*;

    pub(crate) const KIND: FieldSpec = word("kind", Mistake, "what the layer is: one of the kinds below");
    pub(crate) const NAME: FieldSpec =
        FieldSpec::new("name", Holds::Text, Means("its number and kind"), "its name in messages");
    pub(crate) const REGION: FieldSpec = FieldSpec::new(
        "region",
        Holds::Table,
        Means("the screen; for a bitmap, the picture; a button needs one"),
        "where it acts, see [regions](#regions)",
    );
    pub(crate) const REPEAT: FieldSpec = FieldSpec::new(
        "repeat",
        Holds::Table,
        Means("once"),
        "copies of the layer in columns and rows, see [repeats](#repeats)",
    );
    pub(crate) const BLEND: FieldSpec = word(
        "blend",
        Means("`\"replace\"`; for an edge `\"add\"`, for a curve of speed `\"multiply\"`"),
        "how it combines with the layers below, see [blends](#blends)",
    );
    pub(crate) const GAIN: FieldSpec = number(
        "gain",
        Range::new(range::GAIN.min, range::GAIN.max, ""),
        Number(1.0),
        "factor on the layer's friction above natural friction, or on its factor if it multiplies",
    );
    pub(crate) const ABOVE: FieldSpec = word(
        "above",
        Means("see there"),
        "zero point of friction in newtons, see [what can be reached](#what-can-be-reached); not `\"zero\"` if added",
    );
    pub(crate) const LIVE: FieldSpec = flag(
        "live",
        false,
        "`true`: the host may switch the layer or change its gain during play, so it is never \
         [left out](#what-is-left-out) and hides no other layer for good",
    );
    pub(crate) const PATTERN_MS: FieldSpec = FieldSpec::new(
        "pattern_ms",
        Holds::Numbers(Range::new(1.0, 60_000.0, " ms")),
        Means("on"),
        "pattern of a `trigger` of the layer, see [while it plays](#while-it-plays): alternating on and off times, 1 \
         to 64; needs `live = true`",
    );
    pub(crate) const START: FieldSpec = word(
        "start",
        Means("`\"on\"`"),
        "`\"off\"`: the layer is inactive until the host switches it on; needs `live = true`",
    );
}

/// `repeat` of a layer.
pub(super) mod repeat {
    use super::*;

    const COPIES: Range = Range::new(1.0, 64.0, "");
    const STEP_MM: Range = Range::new(-1000.0, 1000.0, " mm");

    pub(crate) const COLUMNS: FieldSpec =
        FieldSpec::new("columns", Holds::Whole(COPIES), Number(1.0), "copies side by side");
    pub(crate) const ROWS: FieldSpec =
        FieldSpec::new("rows", Holds::Whole(COPIES), Number(1.0), "copies below one another");
    pub(crate) const DX: LengthFields =
        length!("dx", X, STEP_MM, Number(0.0), "spacing of columns; not 0 with several columns");
    pub(crate) const DY: LengthFields =
        length!("dy", Y, STEP_MM, Number(0.0), "spacing of rows; not 0 with several rows");
}

/// `region` of a layer.
pub(super) mod region {
    use super::*;

    pub(crate) const SHAPE: FieldSpec = word(
        "shape",
        Means("`\"rectangle\"`"),
        "`\"rectangle\"`: left and top edge belong to it, right and bottom do not; `\"ellipse\"`: it touches the \
         rectangle's sides, and its border belongs to it; or `\"polygon\"`",
    );
    pub(crate) const X: LengthFields = length!("x", X, PLACE_MM, Mistake, "left side of rectangle or ellipse");
    pub(crate) const Y: LengthFields = length!("y", Y, PLACE_MM, Mistake, "top side of rectangle or ellipse");
    pub(crate) const WIDTH: LengthFields = length!("width", X, SIZE_MM, Mistake, "width of rectangle or ellipse");
    pub(crate) const HEIGHT: LengthFields = length!("height", Y, SIZE_MM, Mistake, "height of rectangle or ellipse");
    const POINTS: &str = "3 to 32 vertices of a polygon, `[[x, y], [x, y], [x, y]]`; a tick has time for about ten \
        polygons under one finger. Lines that cross follow the even-odd rule. A place on an edge shared by two \
        polygons belongs to exactly one of them";
    pub(crate) const POINTS_MM: FieldSpec = FieldSpec::new("points_mm", Holds::Pairs(PLACE_MM), Mistake, POINTS);
    pub(crate) const POINTS_PX: FieldSpec = FieldSpec::new("points_px", Holds::Pairs(PIXELS), Mistake, POINTS);
}
