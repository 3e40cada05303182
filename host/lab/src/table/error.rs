//! Why a table is rejected: what was found, and what to do about it.

use std::error::Error;
use std::fmt::{self, Display, Formatter};
use std::io;

use frixel_scene::brief;

/// Why a table, or a row of it, cannot be read.
///
/// [`Display`] says what was found and what to do; [`Self::found`] says the former alone, for a caller that has better
/// advice.
#[derive(Debug)]
pub enum TableError {
    /// The input cannot be read.
    Read(io::Error),
    /// There is no header.
    Empty,
    /// The beginning of the input has no end of a line.
    HeaderTooLong {
        /// Most bytes of the lines down to the header.
        limit: u64,
    },
    /// The header can be separated in two ways.
    SeparatorDoubtful {
        /// Names of the separators, with the number of columns that each gives.
        readings: [(&'static str, usize); 2],
    },
    /// The header of a column states its unit in a way that can be read as two.
    UnitDoubtful {
        /// The column's header, or the name and the unit below it.
        header: String,
        /// The units, such as `newtons or in millinewtons`.
        readings: String,
        /// How to write it.
        advice: String,
    },
    /// The header has no column that is needed.
    ColumnMissing {
        /// The column, or those of which one is needed.
        column: String,
        /// Its unit; empty for words and plain numbers.
        unit: &'static str,
        /// A column with a similar name.
        nearest: Option<String>,
    },
    /// The header has a column twice.
    ColumnTwice {
        /// The headers that are this column, one for each time.
        names: Vec<String>,
    },
    /// A row has more or fewer cells than the header.
    Length {
        /// Number of the row.
        row: u64,
        /// Number of cells of the header.
        expected: usize,
        /// Number of cells of the row.
        found: usize,
    },
    /// A cell that has to have a number is empty.
    CellEmpty {
        /// Number of the row.
        row: u64,
        /// The column.
        column: String,
    },
    /// A cell is not a finite number.
    NotANumber {
        /// Number of the row.
        row: u64,
        /// The column.
        column: String,
        /// What the cell contains.
        found: String,
    },
    /// A number can be read in two ways.
    CellDoubtful {
        /// Number of the row.
        row: u64,
        /// The column.
        column: String,
        /// What the cell contains.
        found: String,
        /// The numbers that it can be, such as `1.234 or as 1234`.
        readings: String,
    },
}

impl TableError {
    /// An error of the CSV reader. Only the input itself fails: any bytes are a table.
    pub(super) fn read(error: csv::Error) -> Self {
        Self::Read(system_error(error))
    }

    /// What was found, and what was expected.
    pub fn found(&self) -> String {
        match self {
            Self::Read(error) => format!("the table cannot be read ({error})"),
            Self::Empty => "the table is empty".to_owned(),
            Self::HeaderTooLong { limit } => format!("the first line has more than {limit} bytes"),
            Self::SeparatorDoubtful { readings: [(one, columns), (other, others)] } => {
                format!(
                    "the header can be read as {columns} columns that {one} separate, or as {others} that {other} do"
                )
            }
            Self::UnitDoubtful { header, readings, .. } => {
                format!("the column `{}` can be read in {readings}", brief(header))
            }
            Self::ColumnMissing { column, nearest, .. } => {
                let nearest = nearest.as_ref().map(|name| format!(" (it has {})", brief(name)));
                format!("the header has no column {column}{}", nearest.unwrap_or_default())
            }
            Self::ColumnTwice { names } => match &names[..] {
                [one, other, ..] if one != other => {
                    format!("the header has one quantity twice, {} and {}", brief(one), brief(other))
                }
                _ => format!("the header has the column {} twice", brief(names.first().map_or("", String::as_str))),
            },
            Self::Length { row, expected, found } => {
                format!("row {row}: expected {expected} cells as in the header, found {found}")
            }
            Self::CellEmpty { row, column } => {
                format!("row {row}, column {}: expected a number, found an empty cell", brief(column))
            }
            Self::NotANumber { row, column, found } => {
                format!("row {row}, column {}: expected a number, found {found:?}", brief(column))
            }
            Self::CellDoubtful { row, column, found, readings } => {
                format!("row {row}, column {}: {found:?} can be read as {readings}", brief(column))
            }
        }
    }

    /// What to do about it.
    fn advice(&self) -> String {
        match self {
            Self::Read(_) | Self::Empty | Self::HeaderTooLong { .. } => "give a CSV file with a header row".to_owned(),
            Self::UnitDoubtful { advice, .. } => advice.clone(),
            Self::ColumnMissing { unit: "", .. } => "name the column so".to_owned(),
            Self::ColumnMissing { unit, .. } => format!("name the column so, in {unit}"),
            Self::SeparatorDoubtful { .. } | Self::ColumnTwice { .. } => "leave one of them out".to_owned(),
            Self::Length { expected, found, .. } if found > expected => {
                "correct or delete the row; if commas are decimal signs, save the file with semicolons between columns"
                    .to_owned()
            }
            Self::Length { .. } => "correct or delete the row".to_owned(),
            Self::CellDoubtful { .. } => {
                "save the file without separators of thousands, and with points in numbers".to_owned()
            }
            Self::CellEmpty { .. } | Self::NotANumber { .. } => "correct the cell or delete the row".to_owned(),
        }
    }
}

/// The error of the operating system with its kind, which the conversion of the `csv` crate discards.
pub(crate) fn system_error(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}

impl Display for TableError {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        write!(f, "{}: {}", self.found(), self.advice())
    }
}

impl Error for TableError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        if let Self::Read(error) = self { Some(error) } else { None }
    }
}
