//! Why data are refused: what was found, and what to do about it.

use frixel_scene::brief;
use thiserror::Error;

use super::faults::{FaultyStroke, sentence};
use crate::table::TableError;

/// Why data cannot be fitted.
#[derive(Debug, Error)]
pub enum FitError {
    /// The file is no table of the columns that are needed, or a cell is no number.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A voltage is negative.
    #[error(
        "row {row}, column voltage_v_rms: {} V is below zero: give the root mean square of the drive, which has no sign",
        plain(*.found)
    )]
    NegativeVoltage {
        /// Number of the row.
        row: u64,
        /// The voltage.
        found: f64,
    },
    /// The voltages are samples of the carrier.
    #[error(
        "the voltages look like samples of the carrier itself, since they stay the same for {rest_rows:.1} rows only: give the \
         root mean square of the drive over one carrier period"
    )]
    RawCarrier {
        /// Rows, on average, for which the voltage rests.
        rest_rows: f64,
    },
    /// A voltage is above what any driver board has.
    #[error(
        "row {row}, column voltage_v_rms: {} V is above 1000 V: give volts rms, not DAC codes, or name the column \
         voltage_mv_rms if it is in millivolts",
        plain(*.found)
    )]
    VoltageTooHigh {
        /// Number of the row.
        row: u64,
        /// The voltage.
        found: f64,
    },
    /// The highest voltage is below what adds friction.
    #[error(
        "the highest voltage of voltage_v_rms is {max} V, and below 1 V a drive adds no friction that can be measured: name \
         the column voltage_kv_rms if it is in kilovolts"
    )]
    VoltageTooLow {
        /// Highest voltage of the data.
        max: f64,
    },
    /// Time goes backwards.
    #[error(
        "row {row}, column time_s: {found} s comes after {before} s, time goes backwards: sort the rows by time, or \
         number the strokes in a column stroke if each has a clock of its own"
    )]
    TimeBackwards {
        /// Number of the row.
        row: u64,
        /// Its time.
        found: f64,
        /// Time of the row before it.
        before: f64,
    },
    /// Rows stand in the recording twice.
    #[error(
        "rows {} to {} have the numbers of rows {} to {}: delete the copy, or record anew what was not measured twice",
        rows[0], rows[1], of[0], of[1]
    )]
    RowsTwice {
        /// The first and the last row of the copy.
        rows: [u64; 2],
        /// Those of what was copied.
        of: [u64; 2],
    },
    /// Most rows have a time, and many have none.
    #[error(
        "{unknown} of {rows} rows have no time, row {row} the first, where a few are left out: give each its time in \
         column time_s, or leave the column out"
    )]
    TimesMissing {
        /// Rows without a time.
        unknown: usize,
        /// Number of rows.
        rows: usize,
        /// The first row without a time.
        row: u64,
    },
    /// A stroke turns, and no times tell what lies around the turn.
    #[error(
        "row {row}: the finger turns within stroke {}, friction or speed changes its sign there: add a column time_s, \
         so that what lies around the turn is left out, or give each direction a stroke of its own",
        brief(.stroke)
    )]
    TurnWithoutTime {
        /// The first row after the turn.
        row: u64,
        /// The stroke.
        stroke: String,
    },
    /// The loads are all zero.
    #[error("column normal_force_n is zero throughout, there are no loads: record the normal force with a load cell")]
    NoLoads,
    /// The load is not that of a finger on a touchscreen.
    #[error(
        "the median of normal_force_n is {}, and a finger on a touchscreen presses with 0.03 to 3 N: the column {guess}; \
         give newtons, or name the column normal_force_mn if it is in millinewtons",
        plain(*.median)
    )]
    LoadUnit {
        /// Median of the column.
        median: f64,
        /// What the numbers probably are.
        guess: &'static str,
    },
    /// The friction does not fit the load.
    #[error(
        "friction_n over normal_force_n has a median of {ratio:.3} at no voltage, and that of skin on glass is 0.05 \
         to 5: one of the \
         columns {guess}; give newtons in both, or name the column friction_mn or normal_force_mn if it is in \
         millinewtons"
    )]
    FrictionUnit {
        /// Friction over load.
        ratio: f64,
        /// What the numbers probably are.
        guess: &'static str,
    },
    /// A force is none of a finger.
    #[error(
        "row {row}, column {column}: {} N is no force of a finger: correct the cell, or name the column friction_mn or \
         normal_force_mn if it is in millinewtons",
        plain(*.found_n)
    )]
    ForceTooHigh {
        /// Number of the row.
        row: u64,
        /// The column.
        column: &'static str,
        /// The force, in newtons.
        found_n: f64,
    },
    /// A table of means has two kinds of errors.
    #[error("the header has both friction_se_n and friction_sd_n: leave one of them out")]
    TwoErrors,
    /// A standard deviation alone says nothing about the error of a mean.
    #[error(
        "the header has friction_sd_n and no column n: say how many were averaged in a column n, or give the standard \
         error of the mean in friction_se_n"
    )]
    DeviationWithoutNumber,
    /// A mean of fewer than two has no error.
    #[error("row {row}, column n: expected a whole number of at least 2, found {found}: give how many were averaged")]
    MeanOfTooFew {
        /// Number of the row.
        row: u64,
        /// What was found.
        found: f64,
    },
    /// An error is none of a measured force.
    #[error(
        "row {row}: the standard error of {} N is none of a measured force, which is 1 nN to 50 N: give the error of the \
         mean, or leave the row out",
        plain(*.found_n)
    )]
    ErrorOutOfRange {
        /// Number of the row.
        row: u64,
        /// The standard error, in newtons.
        found_n: f64,
    },
    /// Means are not strokes.
    #[error(
        "--without {}: a table of means has no strokes: delete the row of the mean that is to be left out",
        brief(.stroke)
    )]
    MeansWithout {
        /// What was asked for.
        stroke: String,
    },
    /// A mean has no load.
    #[error(
        "row {row}, column normal_force_n: {} N is no load: give the mean normal force of that row",
        plain(*.found_n)
    )]
    MeanWithoutLoad {
        /// Number of the row.
        row: u64,
        /// The load, in newtons.
        found_n: f64,
    },
    /// Too few means.
    #[error("{found} means are too few: give one at no voltage and at least two at others, {needed} or more")]
    TooFewMeans {
        /// Number of means.
        found: usize,
        /// Least number of means.
        needed: usize,
    },
    /// The means scatter more than their errors.
    #[error(
        "the means lie {times:.1} times their stated errors from the closest power law, and chance does that \
         in fewer than 1 of 1,000 tables: check that errors are standard errors, that voltages are rms, and that all \
         rows are of the same fingers; if so, electric friction follows no power of the voltage: write its points into a \
         profile (docs/scene.md, \"Empirical fingers\")"
    )]
    MeansScatter {
        /// Root of the mean square of deviations over errors.
        times: f64,
    },
    /// Too few strokes.
    #[error(
        "{found} strokes are too few for an interval: record at least {needed}, 60 s of strokes back and forth are \
         best"
    )]
    TooFewStrokes {
        /// Number of strokes.
        found: usize,
        /// Least number of strokes.
        needed: usize,
    },
    /// Too few strokes at a voltage that an interval rests on.
    #[error(
        "{found} of the strokes have {voltage_v_rms:.0} V rms, too few for an interval there: record at least {needed}, as many as \
         at the other voltages are best, or leave them out with --without"
    )]
    TooFewAtVoltage {
        /// Number of strokes of this voltage.
        found: usize,
        /// Least number of strokes.
        needed: usize,
        /// The voltage, in volts rms.
        voltage_v_rms: f64,
    },
    /// Too few rows to divide into blocks.
    #[error(
        "{found} {} without a column stroke {} too few: record at least {needed} rows, or number the strokes in a column stroke",
        if *.found == 1 { "row" } else { "rows" },
        if *.found == 1 { "is" } else { "are" }
    )]
    TooFewRows {
        /// Number of rows.
        found: usize,
        /// Least number of rows.
        needed: usize,
    },
    /// Strokes that cannot be used: all that were found.
    #[error("{}", sentence(.0))]
    FaultyStrokes(Vec<FaultyStroke>),
    /// A stroke that is to be left out does not exist.
    #[error(
        "--without {}: there is no such stroke; the column stroke has {} to {}",
        brief(.stroke), brief(.first), brief(.last)
    )]
    NoSuchStroke {
        /// What was asked for.
        stroke: String,
        /// The first stroke.
        first: String,
        /// The last stroke.
        last: String,
    },
    /// There is nothing to compare with.
    #[error(
        "no row has a voltage of zero, so natural friction is unknown: switch the drive on and off while the finger \
         slides"
    )]
    NoNaturalFriction,
    /// There is only one voltage.
    #[error(
        "one voltage only ({found:.1} V rms besides zero): the model is tested by how friction grows from one voltage \
         to another; record at least two, for example 75, 106 and 150 V rms"
    )]
    OneVoltage {
        /// The voltage.
        found: f64,
    },
    /// The drive is never on.
    #[error("the voltage is zero throughout: record with the drive switched on and off")]
    NoVoltage,
    /// The voltage makes no friction.
    #[error(
        "the voltage adds no friction ({found_n:.2e} N at the highest one): check that the electrode is driven, \
         that voltage and friction belong to the same time, and that friction was not smoothed, so that it changes before its switch"
    )]
    NoElectricFriction {
        /// Electric friction at the highest voltage.
        found_n: f64,
    },
    /// The stated voltage was not reached.
    #[error(
        "the data reach {max:.1} V rms, friction at {stated} V would be extrapolated: record up to {stated} V rms, or \
         state it lower with --voltage {max:.0}"
    )]
    VoltageExtrapolated {
        /// Highest voltage of the data.
        max: f64,
        /// The voltage at which friction is to be stated.
        stated: f64,
    },
    /// The stated load was not measured.
    #[error(
        "the data have loads from {low:.3} to {high:.3} N, friction under {stated} N would be extrapolated: record \
         under that load, or leave out --load"
    )]
    LoadExtrapolated {
        /// Smallest load of the data.
        low: f64,
        /// Largest load of the data.
        high: f64,
        /// The load at which friction is to be stated.
        stated: f64,
    },
    /// An interval is too wide.
    #[error(
        "the 95 % interval of the {quantity} is {low:.4} to {high:.4} around {value:.4}, {}: {advice}",
        if .high - .value < *.value && .value - .low < *.value {
            format!("wider than +-20 % of the {natural:.4} without the drive")
        } else {
            "wider than the value itself, as where the drive adds next to nothing or friction was smoothed".to_owned()
        }
    )]
    TooUncertain {
        /// The quantity with its unit.
        quantity: &'static str,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
        /// Estimate.
        value: f64,
        /// What the width is compared with.
        natural: f64,
        /// What narrows it.
        advice: &'static str,
    },
    /// The force sensor is too slow.
    #[error(
        "the force sensor is too slow: friction takes {rise_ms:.1} ms from 10 to 90 % of its way after a switch of the \
         drive, as with a bandwidth of {bandwidth_hz:.0} Hz, so that electric friction would come out too small; use \
         a sensor, and a filter behind it, of at least 200 Hz, with at least 250 rows a second"
    )]
    SlowSensor {
        /// Rise time in milliseconds.
        rise_ms: f64,
        /// Bandwidth with this rise time, in Hz.
        bandwidth_hz: f64,
    },
    /// Noise hides whether electric friction depends on how many rows beside a switch of the drive are left out.
    #[error(
        "the drive adds too little friction for the noise to tell whether friction was smoothed: electric friction may \
         change by {percent:.0} % with the rows that are left out beside each switch; fit what the sensor gave, without \
         a mean or a filter behind it, and check that the electrode is driven"
    )]
    SettlingUnknown {
        /// The 99.9 % half-interval of the change, in percent of electric friction.
        percent: f64,
    },
    /// Electric friction depends on how many rows beside a switch of the drive are left out.
    #[error(
        "electric friction comes out {:.1} % {} if rows within {edge} {side} each switch of the drive are left \
         out: {cause}",
        .percent.abs(),
        if *.percent < 0.0 { "smaller" } else { "larger" }
    )]
    NotSettled {
        /// How far the rows reach that are left out.
        edge: String,
        /// The side of the switch.
        side: &'static str,
        /// Change of electric friction, in percent.
        percent: f64,
        /// What does that, and what to do.
        cause: &'static str,
    },
    /// Rows are too far apart to tell friction at a voltage from friction on its way there.
    #[error(
        "the drive is switched every {rows:.0} rows, too few to leave out the rows beside a switch, where friction is on \
         its way: record at least 250 rows a second and switch every 20 ms or later"
    )]
    RowsTooFarApart {
        /// Median number of rows from one switch to the next.
        rows: f64,
    },
    /// The finger changed during the recording.
    #[error(
        "the {quantity} was {first:.4} in the first third and {last:.4} in the last: the finger changed while it was \
         measured; rest for a minute, wipe finger and screen, and record again"
    )]
    Drifted {
        /// The quantity with its unit.
        quantity: &'static str,
        /// Mean of the first third.
        first: f64,
        /// Mean of the last third.
        last: f64,
    },
    /// The exponent of voltage or load contradicts the model.
    #[error(
        "electric friction grows as {quantity} to the power {value:.2} ({low:.2} to {high:.2}, the 99.9 % interval and \
         0.1 more on either side), and the model says {model:.2}: the contact model does not hold for these data, so no \
         profile is fitted; check {}; see docs/truth.md",
        cure(.quantity)
    )]
    LawBroken {
        /// `voltage` or `load`.
        quantity: &'static str,
        /// Measured exponent.
        value: f64,
        /// Lower end of its 99.9 % interval, with an allowance for leakage.
        low: f64,
        /// Upper end of its 99.9 % interval, likewise.
        high: f64,
        /// The model's exponent.
        model: f64,
    },
    /// Electric friction follows no power of the voltage.
    #[error(
        "at {voltage_v_rms:.0} V rms electric friction was {measured_mn:.1} mN, and the power law that fits best says \
         {law_mn:.1} mN, further than the noise of these strokes explains ({error_mn:.1} mN): write the points that you \
         measured into a profile (docs/scene.md, \"Empirical fingers\")"
    )]
    NoPowerLaw {
        /// Voltage, in volts rms.
        voltage_v_rms: f64,
        /// Mean of the strokes, in millinewtons.
        measured_mn: f64,
        /// What the law says, in millinewtons.
        law_mn: f64,
        /// 99.9 % half-interval of the mean, in millinewtons.
        error_mn: f64,
    },
    /// A profile has fewer points than the data have voltages.
    #[error(
        "electric friction follows no power of the voltage, and has {found} voltages, where a profile has at most {max} points: \
         leave strokes of some voltages out with --without"
    )]
    TooManyPoints {
        /// Number of voltages.
        found: usize,
        /// Most points of a profile.
        max: usize,
    },
    /// Friction between two voltages has no power that a profile can have.
    #[error(
        "electric friction follows no power of the voltage, and from {low_v_rms:.0} to {high_v_rms:.0} V rms it grows as voltage to \
         the power {exponent:.2}, where a profile takes 0.5 to 12: {}",
        rise_cure(*.exponent)
    )]
    NoRise {
        /// Power of the voltage.
        exponent: f64,
        /// The lower voltage, in volts rms.
        low_v_rms: f64,
        /// The higher voltage, in volts rms.
        high_v_rms: f64,
    },
    /// No profile has such an exponent.
    #[error(
        "electric friction grows as voltage to the power {exponent:.2}, and a profile takes 0.5 to 12: check for a \
         voltage that was not applied, and for strokes in which the finger stuck"
    )]
    ExponentOutOfRange {
        /// Exponent of the voltage.
        exponent: f64,
    },
    /// The gap of the fit is smaller than the screen's coating.
    #[error(
        "the measured attraction needs an effective gap of {gap_um:.3} um, and the coating alone has {coating_um:.3} \
         um: check the coating, and that the voltages are those at the electrode, not ahead of the amplifier"
    )]
    GapInsideCoating {
        /// Gap of the fit, in micrometres.
        gap_um: f64,
        /// Gap of the coating, in micrometres.
        coating_um: f64,
    },
    /// The search for the best parameters did not converge.
    #[error(
        "no finger of the model comes close to these data: check that voltage, load and friction belong to the same \
         rows"
    )]
    NotConverged,
}

/// What to do about friction between two voltages that has no power of a profile.
fn rise_cure(exponent: f64) -> &'static str {
    if exponent > 12.0 {
        "record strokes at voltages between them"
    } else {
        "check that the amplifier reaches the higher one; if it does, this finger is played up to the lower one: leave the \
         strokes above that out with --without"
    }
}

/// A number without hundreds of zeros.
fn plain(value: f64) -> String {
    if value != 0.0 && !(1e-6..1e7).contains(&value.abs()) { format!("{value:e}") } else { value.to_string() }
}

/// What bends the measured exponent of a quantity, which a factor on volts or newtons does not; and what to do if
/// nothing does.
fn cure(quantity: &str) -> &'static str {
    if quantity == "load" {
        "that friction does not leak into the sensor's normal force, nor the load into its friction"
    } else {
        "that the amplifier reaches the highest voltage with the electrode connected, and that the force sensor is \
         linear; if so, `frixel finger fit DATA.csv --law empirical` fits a power law of the voltage in the model's \
         place"
    }
}
