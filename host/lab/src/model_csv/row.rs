//! Access to the cells of one row.

use std::borrow::Cow;

use csv::ByteRecord;

use super::columns::{Columns, VARIANT};
use super::error::Refusal;
use super::number::Number;

/// Number of characters of a cell that a message quotes.
const QUOTED_CHARS: usize = 40;

/// A row with the positions of its columns.
pub(super) struct Row<'a> {
    number: u64,
    columns: &'a Columns,
    cells: &'a ByteRecord,
}

impl<'a> Row<'a> {
    pub(super) fn new(number: u64, columns: &'a Columns, cells: &'a ByteRecord) -> Self {
        Self { number, columns, cells }
    }

    /// Number of the row; the header is row 1.
    pub(super) fn number(&self) -> u64 {
        self.number
    }

    /// Fails if the row has more or fewer cells than the header.
    pub(super) fn check_length(&self) -> Result<(), Refusal> {
        let (expected, found) = (self.columns.len(), self.cells.len());
        if found == expected { Ok(()) } else { Err(Refusal::Length { row: self.number, expected, found }) }
    }

    /// A cell without surrounding blanks; empty if the column does not exist.
    pub(super) fn text(&self, column: &str) -> Cow<'a, str> {
        let cell = self.columns.place(column).and_then(|place| self.cells.get(place)).unwrap_or_default();
        String::from_utf8_lossy(cell.trim_ascii())
    }

    /// The beginning of a cell, for a message.
    pub(super) fn quoted(&self, column: &str) -> String {
        let text = self.text(column);
        let mut quoted: String = text.chars().take(QUOTED_CHARS).collect();
        if quoted.len() < text.len() {
            quoted.push_str("...");
        }
        quoted
    }

    /// Whether a cell is not blank.
    pub(super) fn is_filled(&self, column: &str) -> bool {
        !self.text(column).is_empty()
    }

    /// The number in a required cell.
    pub(super) fn real<T: Number>(&self, column: &'static str) -> Result<T, Refusal> {
        let row = self.number;
        if !self.columns.has(column) {
            return Err(Refusal::ColumnMissing { row, column, variant: self.quoted(VARIANT) });
        }
        let text = self.text(column);
        if text.is_empty() {
            return Err(Refusal::CellEmpty { row, column });
        }
        let not_a_number = || Refusal::NotANumber { row, column, found: self.quoted(column) };
        let number: T = text.parse().map_err(|_| not_a_number())?;
        let wide: f64 = text.parse().map_err(|_| not_a_number())?;
        let overflowed = wide.is_finite() && !number.is_finite();
        let vanished = wide.abs() > 0.0 && number == T::ZERO;
        if overflowed || vanished {
            return Err(Refusal::OutOfF32 { row, column, found: self.quoted(column) });
        }
        Ok(number)
    }

    /// The number in an optional cell; zero if it is empty.
    pub(super) fn real_or_zero<T: Number>(&self, column: &'static str) -> Result<T, Refusal> {
        if self.is_filled(column) { self.real(column) } else { Ok(T::ZERO) }
    }
}
