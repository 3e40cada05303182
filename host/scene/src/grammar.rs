//! The grammar of a scene file: fields with their ranges and meanings, and the sets of fields that can occur together.

/// A field of a table, as used by the parser, by editors, and by `docs/design/scene-reference.md`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FieldSpec {
    pub(crate) name: &'static str,
    pub(crate) holds: Holds,
    pub(crate) absence: Absence,
    /// The meaning of the field, in Markdown.
    pub(crate) meaning: &'static str,
}

/// The type of a field's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Holds {
    Number(Range),
    /// A whole number.
    Whole(Range),
    /// `true` or `false`.
    Flag,
    Text,
    /// One of several words, which the parser lists.
    Word,
    Table,
    /// A table, or the name of a file that contains it.
    TableOrText,
    /// A list of tables.
    Tables,
    /// A list of tables, or one table in its place.
    TableOrTables,
    Numbers(Range),
    /// A number, or `"auto"`.
    NumberOrAuto(Range),
    /// A list of texts.
    Texts,
    /// Two numbers in square brackets, the second one not below the first.
    Interval(Range),
    /// A list of pairs of numbers.
    Pairs(Range),
}

/// Default of an absent field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Absence {
    /// Omitting the field is a mistake.
    Mistake,
    /// The field defaults to this number.
    Number(f64),
    /// The field defaults to this value.
    Flag(bool),
    /// The default in words, for the documentation; empty if there is nothing to state.
    Means(&'static str),
}

/// The range and unit of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub(crate) min: f64,
    pub(crate) max: f64,
    /// The unit, with a space before it.
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

    /// The default of the field; NaN if it is not a number.
    pub(crate) fn default_number(&self) -> f64 {
        if let Absence::Number(number) = self.absence { number } else { f64::NAN }
    }
}

/// The three fields that can hold an amount.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AmountFields {
    pub(crate) newtons: FieldSpec,
    pub(crate) fraction: FieldSpec,
    pub(crate) factor: FieldSpec,
}

impl AmountFields {
    /// The fields' names, to find the one that a layer uses.
    pub(crate) fn names(&self) -> [&'static str; 3] {
        [self.newtons.name, self.fraction.name, self.factor.name]
    }
}

/// The two fields that can hold a place or a size along an axis of the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LengthFields {
    pub(crate) mm: FieldSpec,
    /// In pixels of the scene's design size.
    pub(crate) px: FieldSpec,
    pub(crate) axis: Axis,
}

/// An axis of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axis {
    X,
    Y,
}

/// The name of a field without its unit. Fields with the same stem mean the same quantity.
pub fn stem(name: &str) -> &str {
    let units = ["_n", "_fraction", "_factor", "_mm", "_px"];
    units.iter().find_map(|unit| name.strip_suffix(unit)).unwrap_or(name)
}

/// A field that the parser read, with its allowed words.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KnownField {
    pub(crate) field: FieldSpec,
    pub(crate) words: Vec<&'static str>,
}

/// All fields that the parser read in a table, with the rest of the table unchanged.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KnownTable {
    /// The field that contains the table.
    pub(crate) key: &'static str,
    pub(crate) fields: Vec<KnownField>,
    pub(crate) required: Vec<&'static str>,
    /// Fields of which at most one may be present. If the first is required, either one is enough.
    pub(crate) either: Vec<[&'static str; 2]>,
}
