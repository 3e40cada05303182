//! Reads the fields of a TOML table, and reports missing and unknown ones. [`values`] reads their values.

mod values;

pub(super) use values::TableOrText;

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::compile_error::CompileError;
use super::grammar::{Absence, Axis, FieldSpec, KnownField, KnownTable, stem};
use super::log::Log;
use super::mistake::Mistake;
use super::nearest::Nearest;
use super::source::{Places, Source, SourceFile};

/// A table that is being read. Every field that the parser reads becomes known; [`Fields::close`] reports the others.
pub(super) struct Fields<'i> {
    table: String,
    /// The field that the table stands in.
    key: &'static str,
    values: DeTable<'i>,
    /// Values of fields that the table does not have. Those that are not known are ignored.
    defaults: DeTable<'i>,
    /// The size of a pixel of the scene's design, if it has one.
    pixel_mm: Option<PixelSize>,
    places: Places,
    known: Vec<KnownField>,
    required: Vec<&'static str>,
    either: Vec<[&'static str; 2]>,
    /// The fields of the table follow from a word that was misspelt.
    pub(super) is_guess: bool,
}

/// Width and height of a pixel of a scene's design on its screen, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PixelSize {
    pub(super) width_mm: f64,
    pub(super) height_mm: f64,
}

impl PixelSize {
    /// The size of a pixel along an axis.
    fn along(self, axis: Axis) -> f64 {
        match axis {
            Axis::X => self.width_mm,
            Axis::Y => self.height_mm,
        }
    }
}

/// Reads the text of a file: `read` gets its fields, and messages call the whole text `table` and the file `name`.
pub(super) fn read_text<T>(
    text: &str,
    name: &str,
    table: &str,
    read: impl FnOnce(Fields, &mut Log) -> Option<T>,
) -> Result<T, CompileError> {
    let source = Source::new(name, text);
    let mut log = Log::new(&source);
    let fields = source.files().first().and_then(|file| parsed(file, &mut log));
    let value = fields.and_then(|values| read(Fields::new(table, 0, values), &mut log));
    log.finish(value)
}

/// The fields of a file, at their offsets in the source; `None` after a mistake, which has been logged.
pub(super) fn parsed<'i>(file: &'i SourceFile, log: &mut Log) -> Option<DeTable<'i>> {
    match DeTable::parse(&file.text) {
        Ok(values) => Some(moved_table(values.into_inner(), file.start)),
        Err(error) => {
            let offset = error.span().map_or(0, |span| span.start);
            let has_comma = file.text.get(offset..).is_some_and(|rest| rest.starts_with(','));
            let hint = if has_comma { "; a decimal has a point, not a comma" } else { "" };
            log.add(file.start + offset, Mistake::Syntax(format!("{}{hint}", error.message())));
            None
        }
    }
}

/// A table whose offsets all are larger by `start`.
fn moved_table(table: DeTable, start: usize) -> DeTable {
    let moved = |span: Range<usize>| span.start + start..span.end + start;
    let fields = table.into_iter().map(|(key, value)| {
        let (key_span, span) = (moved(key.span()), moved(value.span()));
        (Spanned::new(key_span, key.into_inner()), Spanned::new(span, moved_value(value.into_inner(), start)))
    });
    fields.collect()
}

fn moved_value(value: DeValue, start: usize) -> DeValue {
    match value {
        DeValue::Table(table) => DeValue::Table(moved_table(table, start)),
        DeValue::Array(array) => {
            let mut moved = DeArray::new();
            for value in array {
                let span = value.span().start + start..value.span().end + start;
                moved.push(Spanned::new(span, moved_value(value.into_inner(), start)));
            }
            DeValue::Array(moved)
        }
        other => other,
    }
}

/// The fields of `lower` that `upper` does not have in any unit, and all of `upper`.
pub(super) fn overlaid<'i>(lower: &DeTable<'i>, upper: DeTable<'i>) -> DeTable<'i> {
    let mut fields = without(lower, &upper);
    fields.extend(upper);
    fields
}

/// The fields of a table that another one does not have in any unit.
fn without<'i>(table: &DeTable<'i>, other: &DeTable) -> DeTable<'i> {
    let has = |name: &str| other.keys().any(|key| stem(key.get_ref()) == stem(name));
    let fields = table.iter().filter(|(name, _)| !has(name.get_ref()));
    fields.map(|(name, value)| (name.clone(), value.clone())).collect()
}

impl<'i> Fields<'i> {
    /// A table that starts at byte `offset`. Messages call it `table`.
    pub(super) fn new(table: impl Into<String>, offset: usize, values: DeTable<'i>) -> Self {
        Self {
            table: table.into(),
            key: "",
            values,
            defaults: DeTable::new(),
            pixel_mm: None,
            places: Places::new(offset),
            known: Vec::new(),
            required: Vec::new(),
            either: Vec::new(),
            is_guess: false,
        }
    }

    /// The table of a field.
    fn of_field(&self, brackets: &str, key: &'static str, offset: usize, values: DeTable<'i>) -> Self {
        Self { key, pixel_mm: self.pixel_mm, ..Self::new(brackets, offset, values) }
    }

    /// Sets the size of a pixel of the scene's design, in this table and in the tables inside it.
    pub(super) fn with_pixels(self, pixel_mm: Option<PixelSize>) -> Self {
        Self { pixel_mm, ..self }
    }

    /// Sets the values of fields that the table does not have. A field of the table counts before a default in any
    /// unit.
    pub(super) fn with_defaults(self, defaults: &DeTable<'i>) -> Self {
        Self { defaults: without(defaults, &self.values), ..self }
    }

    /// Moves a field here from another file's table. A field that both have is a mistake.
    pub(super) fn adopt(&mut self, from: &mut Self, field: &FieldSpec, log: &mut Log) {
        let Some((key, value)) = from.values.remove_entry(field.name) else {
            from.known.push(KnownField { field: *field, words: Vec::new() });
            return;
        };
        match self.values.get_key_value(field.name) {
            Some((own, _)) => {
                let other = log.source().name_at(own.span().start).to_owned();
                let file = log.source().name_at(key.span().start).to_owned();
                log.add(key.span().start, Mistake::TableTwice { field: field.name, file, other });
            }
            None => {
                self.values.insert(key, value);
            }
        }
    }

    /// Removes a field whose mistake has been reported.
    pub(super) fn ignore(&mut self, field: &str) {
        self.values.remove(field);
    }

    /// The fields, when nothing else of the table matters.
    pub(super) fn into_values(self) -> DeTable<'i> {
        self.values
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
            // Pixels mean nothing in a scene without a design.
            let in_mm =
                |px: &str| self.known.iter().any(|other| other.field.name != px && stem(other.field.name) == stem(px));
            let absent = absent.filter(|known| self.pixel_mm.is_some() || !known.ends_with("_px") || !in_mm(known));
            let nearest = Nearest::new(name.get_ref(), absent);
            misspelt.extend(nearest.suggestion.clone());
            let field = name.get_ref().clone().into_owned();
            log.add(name.span().start, Mistake::UnknownField { field, table: self.table.clone(), nearest });
        }
        for field in self.required {
            if self.is_guess || self.places.has(field) || misspelt.iter().any(|word| stem(word) == stem(field)) {
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
        self.values.contains_key(field) || self.defaults.contains_key(field)
    }

    /// Whether the file has a field that was read.
    pub(super) fn has_been_read(&self, field: &str) -> bool {
        self.places.has(field)
    }

    /// Offset of a field that was not read yet, or of the table if the file does not have it.
    pub(super) fn place(&self, field: &str) -> usize {
        let value = self.values.get(field).or_else(|| self.defaults.get(field));
        value.map_or(self.places.table(), |value| value.span().start)
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
        let value = self.values.remove(field.name).or_else(|| self.defaults.remove(field.name))?;
        self.places.add(field.name, value.span().start);
        Some(value)
    }
}
