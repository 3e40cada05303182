//! The contact model applied to the rows of a CSV file, as in `frixel model eval` and `frixel model invert`.
//!
//! The first row names the columns, in any order. Each row names a `variant` of the model and gives the numbers that
//! the variant needs, in SI units:
//!
//! | variant | equations | needs, besides what every row needs | takes as well |
//! |---|---|---|---|
//! | `wf-upper` | (34), (36) | `stiffness_pa_per_m` | |
//! | `wf-lower` | (37)-(39), (42) | `stiffness_pa_per_m` | `normal_force_n` |
//! | `wf-loaded` | (43), (21) | `stiffness_pa_per_m`, `normal_force_n` | |
//! | `wf-finite` | (19), (21) | `stiffness_pa_per_m`, `outer_radius_m` | `normal_force_n` |
//! | `soft-upper` | (29)-(33) | `modulus_pa`, `stress_exponent`, `shape_constant` | |
//! | `soft-lower` | (40), (41) | `modulus_pa`, `stress_exponent`, `shape_constant` | |
//! | `soft-loaded` | (29), (43) | `modulus_pa`, `stress_exponent`, `shape_constant`, `normal_force_n` | |
//!
//! Every row needs `radius_m`, `coating_m`, `permittivity` and `friction_coefficient`. For [`eval`], it also needs
//! `voltage_v` (rms). For [`invert`], it needs either `friction_n` (total) or `electric_friction_n` (the part that the
//! voltage adds; exact where the difference of totals would cancel). A row with both is invalid. An optional
//! `normal_force_n` defaults to zero. Cells that a variant does not need are ignored.
//!
//! The output has the input's columns, followed by
//!
//! - [`eval`]: `sigma0_pa, contact_radius_m, effective_stiffness_pa_per_m, friction_n, status`,
//! - [`invert`]: `voltage_v, status`.
//!
//! These replace columns of the same names in the input, so that the output of one direction is an input of the other.
//! Numbers have 17 significant digits, or 9 in `f32`, so that they can be read back exactly. The output has the
//! separators and the decimal sign of the input; answers are in the units of their names, whatever the input has.
//!
//! `status` is `ok`, `no-contact` (radius and friction are zero), `below-natural` (the friction is less than at zero
//! voltage, possibly negative), `unstable`, `wider-than-finger`, or `invalid: REASON` with empty cells. A contact is
//! `wider-than-finger` if its radius exceeds the finger's radius of curvature, where the model is not valid. Its cells
//! are empty if it passes the outer radius.
//!
//! An invalid row does not stop the others. The file as a whole is refused ([`CsvError`]) when its header lacks a
//! column that every row needs, or repeats a column that the model reads. A missing column that only some variants need
//! makes the rows of those variants invalid.

mod columns;
mod error;
mod number;
mod row;
mod variant;

use std::io::{Read, Write};

use csv::WriterBuilder;
use frixel_model::{InverseError, StateError, contact_attraction_pa};

pub use error::CsvError;
pub use number::Precision;

use crate::table::{Column, Table, Unit, system_error};
use columns::{Columns, FRICTIONS, VOLTAGE};
use error::Refusal;
use number::Number;
use row::Row;
use variant::Model;

/// Counts of the processed rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Number of rows, without the header.
    pub rows: u64,
    /// Number of rows whose status is `invalid`.
    pub invalid_rows: u64,
    /// Number of rows whose status is `wider-than-finger`.
    pub beyond_finger_rows: u64,
    /// Description of the input's format, as from [`Table::understood`], and of its columns that answers replace.
    pub understood: Option<String>,
}

/// Status of a contact whose radius exceeds the finger's, where the paraboloid no longer approximates it.
const WIDER_THAN_FINGER: &str = "wider-than-finger";
const STATUS: &str = "status";

/// Warning about contacts whose radius exceeds the finger's; `None` without any.
pub fn wider_than_finger(contacts: u64) -> Option<String> {
    let voltages = match contacts {
        0 => return None,
        1 => "1 voltage".to_owned(),
        contacts => format!("{contacts} voltages"),
    };
    Some(format!(
        "at {voltages} the contact would be wider than the finger, where the model is not valid: is a skin gap missing \
         from the coating?"
    ))
}

/// Evaluates the model row by row: voltage to friction.
///
/// ```
/// use frixel_lab::model_csv::{Precision, eval};
/// let input = "variant,radius_m,stiffness_pa_per_m,coating_m,permittivity,friction_coefficient,voltage_v\n\
///              wf-upper,8e-3,1.8e7,1e-5,1,0.5,150\n";
/// let mut output = Vec::new();
/// let summary = eval(Precision::F64, input.as_bytes(), &mut output)?;
/// assert_eq!((summary.rows, summary.invalid_rows), (1, 0));
/// assert!(String::from_utf8(output)?.trim_end().ends_with(",ok"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn eval(precision: Precision, input: impl Read, output: impl Write) -> Result<Summary, CsvError> {
    match precision {
        Precision::F64 => transform(&EVAL, evaluated::<f64>, input, output),
        Precision::F32 => transform(&EVAL, evaluated::<f32>, input, output),
    }
}

/// Inverts the model row by row: friction to voltage.
pub fn invert(precision: Precision, input: impl Read, output: impl Write) -> Result<Summary, CsvError> {
    match precision {
        Precision::F64 => transform(&INVERT, inverted::<f64>, input, output),
        Precision::F32 => transform(&INVERT, inverted::<f32>, input, output),
    }
}

/// The columns that one direction of the model reads and writes.
struct Direction {
    /// The input needs at least one of these columns, besides the common ones.
    given: &'static [Column],
    answers: &'static [&'static str],
}

const EVAL: Direction = Direction {
    given: &[Column::new(VOLTAGE, "volts rms").converted(Unit::VOLTS)],
    answers: &["sigma0_pa", "contact_radius_m", "effective_stiffness_pa_per_m", "friction_n"],
};
const INVERT: Direction = Direction {
    given: &[
        Column::new(FRICTIONS[0], "newtons").converted(Unit::NEWTONS),
        Column::new(FRICTIONS[1], "newtons").converted(Unit::NEWTONS),
    ],
    answers: &["voltage_v"],
};

/// The cells that are appended to a row.
struct Answer {
    /// One cell for each of the direction's answers.
    cells: Vec<String>,
    status: &'static str,
}

fn transform(
    direction: &Direction,
    answer: fn(&Row) -> Result<Answer, Refusal>,
    input: impl Read,
    output: impl Write,
) -> Result<Summary, CsvError> {
    let mut table = Table::new(input)?;
    let dialect = table.dialect();
    let mut writer = WriterBuilder::new().delimiter(dialect.separator()).from_writer(output);
    let columns = Columns::new(&mut table, direction.given)?;
    let is_answer = |name: &String| direction.answers.iter().chain([&STATUS]).any(|answer| answer == name);
    let is_kept: Vec<bool> = table.names().iter().map(|name| !is_answer(name)).collect();
    let replaced: Vec<&str> = table.names().iter().filter(|name| is_answer(name)).map(String::as_str).collect();
    let replaced = (!replaced.is_empty()).then(|| format!("answers replace its {}", replaced.join(", ")));
    let understood: Vec<String> = table.understood().into_iter().chain(replaced).collect();
    let understood = (!understood.is_empty()).then(|| understood.join("; "));
    let names = direction.answers.iter().map(|name| name.as_bytes());
    write(&mut writer, kept(table.header()?.iter(), &is_kept).chain(names).chain([STATUS.as_bytes()]))?;

    let mut summary = Summary { understood, ..Summary::default() };
    while let Some(row) = table.next_row()? {
        summary.rows += 1;
        let (cells, status) = match answer(&Row { cells: row, columns: &columns }) {
            Ok(answer) => {
                summary.beyond_finger_rows += u64::from(answer.status == WIDER_THAN_FINGER);
                (answer.cells.into_iter().map(|cell| dialect.number(cell)).collect(), answer.status.to_owned())
            }
            Err(Refusal(reason)) => {
                summary.invalid_rows += 1;
                (vec![String::new(); direction.answers.len()], format!("invalid: {reason}"))
            }
        };
        // A row of the wrong length is invalid, and is padded or cut so that its status is in the status column.
        write(
            &mut writer,
            kept(row.cells(), &is_kept).chain(cells.iter().map(String::as_bytes)).chain([status.as_bytes()]),
        )?;
    }
    writer.flush().map_err(CsvError::Write)?;
    Ok(summary)
}

/// The cells of the columns that no answer replaces.
fn kept<'a>(cells: impl Iterator<Item = &'a [u8]>, is_kept: &[bool]) -> impl Iterator<Item = &'a [u8]> {
    cells.zip(is_kept).filter_map(|(cell, is_kept)| is_kept.then_some(cell))
}

fn write<'a>(writer: &mut csv::Writer<impl Write>, cells: impl Iterator<Item = &'a [u8]>) -> Result<(), CsvError> {
    writer.write_record(cells).map_err(|error| CsvError::Write(system_error(error)))
}

fn evaluated<T: Number>(row: &Row) -> Result<Answer, Refusal> {
    let model = Model::<T>::read(row)?;
    let voltage_v_rms = row.real(VOLTAGE)?;
    let sigma0_pa = contact_attraction_pa(voltage_v_rms, model.gap_m)?;
    let (contact_radius_m, stiffness_pa_per_m, friction_n, status) = match model.contact.state(voltage_v_rms) {
        Ok(state) => (state.contact_radius_m, state.stiffness_pa_per_m, state.friction_n, model.status_of(&state)),
        Err(StateError::NoContact) => (T::ZERO, model.stiffness_pa_per_m, T::ZERO, "no-contact"),
        Err(StateError::PassesOuterRadius) => {
            return Ok(Answer { cells: vec![String::new(); 4], status: WIDER_THAN_FINGER });
        }
        Err(error) => return Err(error.into()),
    };
    let numbers = [sigma0_pa, contact_radius_m, stiffness_pa_per_m, friction_n];
    Ok(Answer { cells: cells(&numbers)?, status })
}

fn inverted<T: Number>(row: &Row) -> Result<Answer, Refusal> {
    let model = Model::<T>::read(row)?;
    let [total, electric] = FRICTIONS;
    let number = row.cells.number();
    let refused = |reason: &str| Err(Refusal(format!("row {number}{reason}")));
    let voltage_v_rms = match (row.is_filled(total), row.is_filled(electric)) {
        (true, true) => return refused(": friction_n and electric_friction_n are both filled in; leave one empty"),
        (false, false) => {
            return refused(", column friction_n: neither friction_n nor electric_friction_n is filled in");
        }
        (true, false) => model.contact.voltage_for_friction(row.real(total)?),
        (false, true) => model.contact.voltage_for_electric_friction(row.real(electric)?),
    };
    let (cells, status) = match voltage_v_rms {
        Ok(voltage_v_rms) => {
            let state = model.contact.state(voltage_v_rms);
            (cells(&[voltage_v_rms])?, state.map_or("ok", |state| model.status_of(&state)))
        }
        Err(InverseError::BelowNatural) => (vec![String::new()], "below-natural"),
        Err(InverseError::Unstable) => (vec![String::new()], "unstable"),
        Err(InverseError::PassesOuterRadius) => (vec![String::new()], WIDER_THAN_FINGER),
        Err(error) => return Err(error.into()),
    };
    Ok(Answer { cells, status })
}

/// Formats the numbers; fails if one of them is not finite.
fn cells<T: Number>(numbers: &[T]) -> Result<Vec<String>, Refusal> {
    if numbers.iter().all(|number| number.is_finite()) {
        return Ok(numbers.iter().map(|number| number.digits()).collect());
    }
    Err(Refusal("the answer is too large or too small for this precision".to_owned()))
}
