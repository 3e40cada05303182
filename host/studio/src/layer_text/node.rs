//! Values with the places where they stand, and the forms in which tables are written.

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue, Error};

/// A value, and where it stands: a table with its header alone, one of dotted keys with the first of them.
pub(super) type Node<'t> = Spanned<DeValue<'t>>;

/// The values of a text.
pub(super) fn parsed(text: &str) -> Result<Node<'_>, Error> {
    DeTable::parse(text).map(|root| Spanned::new(root.span(), DeValue::Table(root.into_inner())))
}

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// With a header of its own.
    Header,
    /// In braces.
    Inline,
    /// In front of its keys or of the headers of its tables.
    Dotted,
}

impl Form {
    /// The form of a table other than the root.
    pub(super) fn of(text: &str, table: &Node<'_>) -> Self {
        match text.as_bytes().get(table.span().start) {
            Some(b'[') => Self::Header,
            Some(b'{') => Self::Inline,
            _ => Self::Dotted,
        }
    }
}

/// Whether a value stands at one place, behind a key or in an array: all but tables of other forms than in braces.
pub(super) fn is_value(text: &str, node: &Node<'_>) -> bool {
    match node.get_ref() {
        DeValue::Table(_) => Form::of(text, node) == Form::Inline,
        DeValue::Array(elements) => {
            elements.first().is_none_or(|first| !first.get_ref().is_table() || is_value(text, first))
        }
        _ => true,
    }
}

/// The entries of a table in the order of the text.
pub(super) fn entries<'n, 't>(table: &'n DeTable<'t>) -> Vec<(&'n Spanned<DeString<'t>>, &'n Node<'t>)> {
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_unstable_by_key(|(key, _)| key.span().start);
    entries
}

/// The value of a number.
pub(super) fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Integer(number) => {
            i64::from_str_radix(number.as_str(), number.radix()).ok().map(|number| number as f64)
        }
        DeValue::Float(number) => number.as_str().parse().ok(),
        _ => None,
    }
}
