//! What the parser asks of a table: the scene file's grammar, as it is read.

use super::fields::Range;

/// What a field may hold.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Holds {
    Number(Range),
    Whole(Range),
    Flag,
    Text,
    /// One of some words.
    Choice(Vec<&'static str>),
    Table,
    /// A list of tables, or, with `one`, a table in its place.
    Tables {
        one: bool,
    },
    Numbers(Range),
    /// A list of pairs of numbers.
    Pairs(Range),
}

/// A field that was asked for.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Asked {
    pub(super) field: &'static str,
    pub(super) holds: Holds,
}

/// All that was asked of a table, the rest of which stood as it did.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AskedTable {
    /// The field that the table stands in.
    pub(super) key: &'static str,
    pub(super) asked: Vec<Asked>,
    pub(super) required: Vec<&'static str>,
    /// Fields of which only one is to be there; where the first is required, either will do.
    pub(super) either: Vec<[&'static str; 2]>,
}
