//! What a scene file may have: fields with their ranges and meanings, and which of them go together.

/// A field of a table: what the parser checks, editors show, and `docs/scene.md` says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FieldSpec {
    pub(crate) name: &'static str,
    pub(crate) holds: Holds,
    pub(crate) absence: Absence,
    /// In Markdown.
    pub(crate) meaning: &'static str,
}

/// What a field may hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Holds {
    Number(Range),
    /// A whole number.
    Whole(Range),
    /// `true` or `false`.
    Flag,
    Text,
    /// One of some words, which the parser lists.
    Word,
    Table,
    /// A list of tables.
    Tables,
    /// A list of tables, or one table in its place.
    TableOrTables,
    Numbers(Range),
    /// A list of pairs of numbers.
    Pairs(Range),
}

/// What it means when a file leaves a field out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Absence {
    /// It is a mistake.
    Mistake,
    /// The field is this number.
    Number(f64),
    /// The field is this.
    Flag(bool),
    /// What the documentation says of it; empty where there is nothing to say.
    Means(&'static str),
}

/// What a number may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub(crate) min: f64,
    pub(crate) max: f64,
    /// With a space before it.
    pub(crate) unit: &'static str,
}

impl Range {
    pub(crate) const fn new(min: f64, max: f64, unit: &'static str) -> Self {
        Self { min, max, unit }
    }
}

impl FieldSpec {
    pub(crate) const fn new(name: &'static str, holds: Holds, absence: Absence, meaning: &'static str) -> Self {
        Self { name, holds, absence, meaning }
    }

    /// The number that it is when a file leaves it out, or not-a-number where it has no such number.
    pub(crate) fn default_number(&self) -> f64 {
        if let Absence::Number(number) = self.absence { number } else { f64::NAN }
    }
}

/// The three fields that an amount may stand in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AmountFields {
    pub(crate) newtons: FieldSpec,
    pub(crate) fraction: FieldSpec,
    pub(crate) factor: FieldSpec,
}

impl AmountFields {
    /// Their names, so that the one in use can be found among a layer's fields.
    pub(crate) fn names(&self) -> [&'static str; 3] {
        [self.newtons.name, self.fraction.name, self.factor.name]
    }
}

/// A field that the parser looked for, with the words that it may be.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KnownField {
    pub(crate) field: FieldSpec,
    pub(crate) words: Vec<&'static str>,
}

/// All fields that the parser looked for in a table, where the rest of the table was as it was.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KnownTable {
    /// The field that the table stands in.
    pub(crate) key: &'static str,
    pub(crate) fields: Vec<KnownField>,
    pub(crate) required: Vec<&'static str>,
    /// Fields of which only one may be there; where the first is required, either will do.
    pub(crate) either: Vec<[&'static str; 2]>,
}
