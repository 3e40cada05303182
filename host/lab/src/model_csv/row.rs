//! Access to the cells of one row.

use std::borrow::Cow;

use super::columns::{Columns, VARIANT};
use super::error::Refusal;
use super::number::Number;
use crate::table;

/// A row with the places of its columns.
pub(super) struct Row<'a> {
    pub(super) cells: table::Row<'a>,
    pub(super) columns: &'a Columns,
}

impl<'a> Row<'a> {
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
        let refused = |reason: String| Refusal(format!("row {}, column {column}: {reason}", self.cells.number()));
        let missing = || refused(format!("the header has no such column, and {} needs it", self.quoted(VARIANT)));
        let place = self.columns.place(column).ok_or_else(missing)?;
        let wide = self.cells.real(place)?;
        // From the digits, not from `wide`, which is rounded already.
        let number = self.cells.digits(place)?.parse::<T>().ok();
        let fits = |number: &T| number.is_finite() && (*number != T::ZERO || !(wide.abs() > 0.0));
        let found = || self.cells.quoted(place);
        let out_of_f32 = || refused(format!("{} is out of the range of f32; use --precision f64", found()));
        number.filter(fits).ok_or_else(out_of_f32)
    }

    /// The number in an optional cell; zero if it is empty.
    pub(super) fn real_or_zero<T: Number>(&self, column: &'static str) -> Result<T, Refusal> {
        if self.is_filled(column) { self.real(column) } else { Ok(T::ZERO) }
    }
}
