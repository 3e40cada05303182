//! The grammar of a scene file: fields with their ranges and meanings, and the sets of fields that can occur together.

/// A field of a table, as the parser checks it, editors show it, and `docs/scene.md` documents it.
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
    /// One of several words. The parser lists them.
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

/// The effect of omitting a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Absence {
    /// Omitting the field is a mistake.
    Mistake,
    /// The field defaults to this number.
    Number(f64),
    /// The field defaults to this value.
    Flag(bool),
    /// The default in the words of the documentation; empty if there is nothing to state.
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

    /// The default of the field, or not-a-number if it has no default number.
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
    /// Their names, so that the one in use can be found among a layer's fields.
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

/// The name of a field without the unit of an amount or a length: fields with the same stem say the same.
pub(crate) fn stem(name: &str) -> &str {
    let units = ["_n", "_fraction", "_factor", "_mm", "_px"];
    units.iter().find_map(|unit| name.strip_suffix(unit)).unwrap_or(name)
}

/// A field that the parser read, with the words that it may hold.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KnownField {
    pub(crate) field: FieldSpec,
    pub(crate) words: Vec<&'static str>,
}

/// All fields that the parser read in a table, with the rest of the table unchanged.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KnownTable {
    /// The field that the table stands in.
    pub(crate) key: &'static str,
    pub(crate) fields: Vec<KnownField>,
    pub(crate) required: Vec<&'static str>,
    /// Fields of which at most one may be present. If the first is required, either one is enough.
    pub(crate) either: Vec<[&'static str; 2]>,
}
