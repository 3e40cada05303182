//! Reads the fields of a TOML table, and reports missing and unknown ones. [`values`] reads their values.

mod values;

pub(super) use values::TableOrText;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::compile_error::{CompileError, Located};
use super::grammar::{Absence, FieldSpec, KnownField, KnownTable};
use super::log::Log;
use super::mistake::Mistake;
use super::nearest::Nearest;
use super::source::{Places, Source};

/// A table that is being read. Every field that the parser reads becomes known; [`Fields::close`] reports the others.
pub(super) struct Fields<'i> {
    table: String,
    /// The field that the table stands in.
    key: &'static str,
    values: DeTable<'i>,
    places: Places,
    known: Vec<KnownField>,
    required: Vec<&'static str>,
    either: Vec<[&'static str; 2]>,
    /// The fields of the table follow from a word that was misspelt.
    pub(super) is_guess: bool,
}

/// Reads the text of a file: `read` gets its fields, and messages call the whole text `table` and the file `name`.
pub(super) fn read_text<T>(
    text: &str,
    name: &str,
    table: &str,
    read: impl FnOnce(Fields, &mut Log, &Source) -> Option<T>,
) -> Result<T, CompileError> {
    match read_text_partly(text, name, table, read) {
        (Some(value), mistakes) if mistakes.is_empty() => Ok(value),
        (_, mistakes) => Err(CompileError { file: name.to_owned(), mistakes }),
    }
}

/// Reads the text of a file as [`read_text`] does, and returns what `read` makes of it beside the mistakes.
pub(super) fn read_text_partly<T>(
    text: &str,
    name: &str,
    table: &str,
    read: impl FnOnce(Fields, &mut Log, &Source) -> Option<T>,
) -> (Option<T>, Vec<Located>) {
    let source = Source::new(name, text);
    let mut log = Log::new(&source);
    let value = match DeTable::parse(text) {
        Ok(values) => read(Fields::new(table, 0, values.into_inner()), &mut log, &source),
        Err(error) => {
            let offset = error.span().map_or(0, |span| span.start);
            let has_comma = text.get(offset..).is_some_and(|rest| rest.starts_with(','));
            let hint = if has_comma { "; a decimal has a point, not a comma" } else { "" };
            log.add(offset, Mistake::Syntax(format!("{}{hint}", error.message())));
            None
        }
    };
    (value, log.into_mistakes())
}

impl<'i> Fields<'i> {
    /// A table that starts at byte `offset`. Messages call it `table`.
    pub(super) fn new(table: impl Into<String>, offset: usize, values: DeTable<'i>) -> Self {
        Self {
            table: table.into(),
            key: "",
            values,
            places: Places::new(offset),
            known: Vec::new(),
            required: Vec::new(),
            either: Vec::new(),
            is_guess: false,
        }
    }

    /// The table of a field.
    fn of_field(brackets: &str, key: &'static str, offset: usize, values: DeTable<'i>) -> Self {
        Self { key, ..Self::new(brackets, offset, values) }
    }

    /// Sets the name of the table in messages.
    pub(super) fn rename(&mut self, table: String) {
        self.table = table;
    }

    /// Reports unknown and missing fields, and returns the offsets of those that were read. A missing field is not
    /// reported if a misspelling of it is, or if the fields of the table were guessed.
    pub(super) fn close(self, log: &mut Log) -> Places {
        log.describe(|| self.described());
        let mut misspelt = Vec::new();
        for (name, _) in &self.values {
            let absent = self.known.iter().map(|known| known.field.name).filter(|known| !self.places.has(known));
            let nearest = Nearest::new(name.get_ref(), absent);
            misspelt.extend(nearest.suggestion.clone());
            let field = name.get_ref().clone().into_owned();
            log.add(name.span().start, Mistake::UnknownField { field, table: self.table.clone(), nearest });
        }
        for field in self.required {
            if self.is_guess || self.places.has(field) || misspelt.iter().any(|word| word == field) {
                continue;
            }
            log.add(self.places.table(), Mistake::MissingField { field, table: self.table.clone() });
        }
        self.places
    }

    /// Stops reading a table that cannot be understood without `field`. If the field is missing, reports only that, or
    /// its misspelling.
    pub(super) fn give_up_without(self, log: &mut Log, field: &'static str) {
        log.describe(|| self.described());
        if !self.required.contains(&field) || self.places.has(field) {
            return;
        }
        let misspelt = self.values.keys().find_map(|name| {
            let nearest = Nearest::new(name.get_ref(), std::iter::once(field));
            nearest.suggestion.is_some().then_some((name, nearest))
        });
        match misspelt {
            Some((name, nearest)) => {
                let field = name.get_ref().clone().into_owned();
                log.add(name.span().start, Mistake::UnknownField { field, table: self.table, nearest });
            }
            None => log.add(self.places.table(), Mistake::MissingField { field, table: self.table }),
        }
    }

    /// Whether the file has a field that was not read yet.
    pub(super) fn has(&self, field: &str) -> bool {
        self.values.contains_key(field)
    }

    /// Whether the file has a field that was read.
    pub(super) fn has_been_read(&self, field: &str) -> bool {
        self.places.has(field)
    }

    /// Offset of a field that was not read yet, or of the table if the file does not have it.
    pub(super) fn place(&self, field: &str) -> usize {
        self.values.get(field).map_or(self.places.table(), |value| value.span().start)
    }

    /// Reports a mistake if the file does not have a field.
    pub(super) fn require(&mut self, field: &FieldSpec) {
        self.required.push(field.name);
    }

    /// Offset of the table.
    pub(super) fn table_place(&self) -> usize {
        self.places.table()
    }

    /// The table's name in messages.
    pub(super) fn table_name(&self) -> &str {
        &self.table
    }

    /// Records that two fields have the same meaning, so that a file may have only one of them.
    pub(super) fn either(&mut self, one: &FieldSpec, other: &FieldSpec) {
        self.either.push([one.name, other.name]);
    }

    fn described(&self) -> KnownTable {
        let Self { key, known, required, either, .. } = self;
        KnownTable { key, fields: known.clone(), required: required.clone(), either: either.clone() }
    }

    fn take(&mut self, field: &FieldSpec) -> Option<Spanned<DeValue<'i>>> {
        self.take_word(field, Vec::new())
    }

    /// Removes a field from the table, and records that it is known, with the words that it may hold.
    fn take_word(&mut self, field: &FieldSpec, words: Vec<&'static str>) -> Option<Spanned<DeValue<'i>>> {
        if field.absence == Absence::Mistake {
            self.require(field);
        }
        self.known.push(KnownField { field: *field, words });
        let value = self.values.remove(field.name)?;
        self.places.add(field.name, value.span().start);
        Some(value)
    }
}
