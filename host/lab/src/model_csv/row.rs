//! Access to the cells of one row.

use std::borrow::Cow;

use super::columns::{Columns, VARIANT};
use super::error::Refusal;
use super::number::Number;
use crate::table::{self, Place};

/// A row with the places of its columns.
pub(super) struct Row<'a> {
    cells: table::Row<'a>,
    columns: &'a Columns,
}

impl<'a> Row<'a> {
    pub(super) fn new(cells: table::Row<'a>, columns: &'a Columns) -> Self {
        Self { cells, columns }
    }

    /// Its line in the file.
    pub(super) fn number(&self) -> u64 {
        self.cells.number()
    }

    /// Fails if the row has more or fewer cells than the header.
    pub(super) fn check_length(&self) -> Result<(), Refusal> {
        Ok(self.cells.check_length()?)
    }

    /// A cell without surrounding blanks; empty if the column does not exist.
    pub(super) fn text(&self, column: &str) -> Cow<'a, str> {
        self.columns.place(column).map_or(Cow::Borrowed(""), |place| self.cells.text(place))
    }

    /// The beginning of a cell, for a message.
    pub(super) fn quoted(&self, column: &str) -> String {
        self.columns.place(column).map_or(String::new(), |place| self.cells.quoted(place))
    }

    /// Whether a cell is not blank.
    pub(super) fn is_filled(&self, column: &str) -> bool {
        !self.text(column).is_empty()
    }

    /// The number in a required cell.
    pub(super) fn real<T: Number>(&self, column: &'static str) -> Result<T, Refusal> {
        let row = self.number();
        let missing = || Refusal::ColumnMissing { row, column, variant: self.quoted(VARIANT) };
        let place: Place = self.columns.place(column).ok_or_else(missing)?;
        let wide = self.cells.real(place)?;
        // From the digits, not from `wide`, which is rounded already.
        let number = self.cells.digits(place)?.parse::<T>().ok();
        let fits = |number: &T| number.is_finite() && (*number != T::ZERO || !(wide.abs() > 0.0));
        number.filter(fits).ok_or_else(|| Refusal::OutOfF32 { row, column, found: self.cells.quoted(place) })
    }

    /// The number in an optional cell; zero if it is empty.
    pub(super) fn real_or_zero<T: Number>(&self, column: &'static str) -> Result<T, Refusal> {
        if self.is_filled(column) { self.real(column) } else { Ok(T::ZERO) }
    }
}
