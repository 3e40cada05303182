//! Reads the fields of a TOML table, and reports missing and unknown ones. [`text`] parses files, [`values`] reads
//! values, and [`misplaced`] finds fields in the wrong place.

mod misplaced;
mod text;
mod values;

pub use misplaced::has_unit;
pub(super) use text::{parsed, read_text};
pub(super) use values::{TableOrText, all};

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::grammar::{Absence, Axis, FieldSpec, KnownField, KnownTable, stem};
use super::log::Log;
use super::mistake::{FieldMistake, FileMistake};
use super::nearest::Nearest;
use super::source::Places;

/// A table that is being read. Each field that the parser reads becomes known; [`Fields::close`] reports the others.
#[derive(Default)]
pub(super) struct Fields<'i> {
    table: String,
    /// The field that contains the table.
    key: &'static str,
    values: DeTable<'i>,
    /// Defaults for fields that are absent from the table. Unknown ones are ignored.
    defaults: DeTable<'i>,
    /// The size of a pixel of the scene's design, if it has one.
    pixel_mm: Option<PixelSize>,
    /// The valid names that misspelt defaults probably stand for.
    misspelt_defaults: Vec<String>,
    places: Places,
    known: Vec<KnownField>,
    required: Vec<&'static str>,
    /// Whether a region would give the required place.
    region_is_place: bool,
    either: Vec<[&'static str; 2]>,
    /// Whether the table's fields follow from a misspelt word.
    pub(super) is_guess: bool,
    /// Fields of this table that are also tables in `[defaults]`; each replaces its default entirely.
    replaced_defaults: Vec<String>,
    /// Whether this table replaces one of `[defaults]`.
    replaces_default: bool,
}

/// The fields of a layer that may stand for its region, and are needed without one.
const PLACE: [&str; 3] = ["x_mm", "y_mm", "width_mm"];

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

/// Returns all fields of `upper`, and those of `lower` that `upper` does not have in any unit.
pub(super) fn overlaid<'i>(lower: &DeTable<'i>, upper: DeTable<'i>) -> DeTable<'i> {
    let mut fields = without(lower, &upper);
    fields.extend(upper);
    fields
}

/// Returns the fields of a table that `other` does not have in any unit.
fn without<'i>(table: &DeTable<'i>, other: &DeTable) -> DeTable<'i> {
    let has = |name: &str| other.keys().any(|key| stem(key.get_ref()) == stem(name));
    let fields = table.iter().filter(|(name, _)| !has(name.get_ref()));
    fields.map(|(name, value)| (name.clone(), value.clone())).collect()
}

impl<'i> Fields<'i> {
    /// A table that starts at byte `offset`. Messages call it `table`.
    pub(super) fn new(table: impl Into<String>, offset: usize, values: DeTable<'i>) -> Self {
        Self { table: table.into(), values, places: Places::new(offset), ..Self::default() }
    }

    /// The table of a field.
    fn of_field(&self, brackets: &str, key: &'static str, offset: usize, values: DeTable<'i>) -> Self {
        let replaces_default = self.replaced_defaults.iter().any(|field| field == key);
        Self { key, pixel_mm: self.pixel_mm, replaces_default, ..Self::new(brackets, offset, values) }
    }

    /// Sets the size of a pixel of the scene's design, in this table and in the tables inside it.
    pub(super) fn with_pixels(self, pixel_mm: Option<PixelSize>) -> Self {
        Self { pixel_mm, ..self }
    }

    /// Sets the values of absent fields. A field of the table takes precedence over a default in any unit. `misspelt`
    /// are the valid names that misspelt defaults probably stand for.
    pub(super) fn with_defaults(self, defaults: &DeTable<'i>, misspelt: &[String]) -> Self {
        let replaced_defaults = defaults
            .keys()
            .map(|name| name.get_ref().to_string())
            .filter(|name| self.values.contains_key(name.as_str()));
        Self {
            defaults: without(defaults, &self.values),
            misspelt_defaults: misspelt.to_vec(),
            replaced_defaults: replaced_defaults.collect(),
            ..self
        }
    }

    /// Moves a field here from another file's table; a field in both is a mistake.
    pub(super) fn adopt(&mut self, from: &mut Self, field: &FieldSpec, log: &mut Log) {
        let Some((key, value)) = from.values.remove_entry(field.name) else {
            from.known.push(KnownField { field: *field, words: Vec::new() });
            return;
        };
        match self.values.get_key_value(field.name) {
            Some((own, _)) => {
                let other = log.source().name_at(own.span().start).to_owned();
                let file = log.source().name_at(key.span().start).to_owned();
                log.add(key.span().start, FileMistake::TableTwice { field: field.name, file, other });
            }
            None => {
                self.values.insert(key, value);
            }
        }
    }

    /// Returns the fields, and drops the rest of the table.
    pub(super) fn into_values(self) -> DeTable<'i> {
        self.values
    }

    /// Sets the name of the table in messages.
    pub(super) fn rename(&mut self, table: String) {
        self.table = table;
    }

    /// Reports unknown and missing fields, and returns the offsets of the fields that were read. A missing field is not
    /// reported if its misspelling is, or if the table's fields were guessed.
    pub(super) fn close(self, log: &mut Log) -> Places {
        log.describe(|| self.described());
        let mut misspelt = self.misspelt_defaults.clone();
        let misplaced = self.misplaced(log);
        for (name, _) in &self.values {
            if misplaced.contains(name.get_ref().as_ref()) {
                continue;
            }
            let absent = self.known.iter().map(|known| known.field.name).filter(|known| !self.places.has(known));
            // Pixels have no meaning in a scene without a design.
            let in_mm =
                |px: &str| self.known.iter().any(|other| other.field.name != px && stem(other.field.name) == stem(px));
            let absent = absent.filter(|known| self.pixel_mm.is_some() || !known.ends_with("_px") || !in_mm(known));
            // An amount may be given in only one unit.
            let is_said = |known: &&str| {
                self.known.iter().any(|other| {
                    let other = other.field.name;
                    stem(other) == stem(known) && self.places.has(other)
                })
            };
            let nearest = Nearest::new(name.get_ref(), absent.filter(|known| !is_said(known)));
            misspelt.extend(nearest.suggestion.clone());
            let field = name.get_ref().clone().into_owned();
            log.add(name.span().start, FieldMistake::UnknownField { field, table: self.table.clone(), nearest });
        }
        let is_missing = |field: &&&str| {
            let is_reported =
                misplaced.missing == Some(**field) || misspelt.iter().any(|word| stem(word) == stem(field));
            !(self.is_guess || self.places.has(field) || is_reported)
        };
        let missing: Vec<&'static str> = self.required.iter().filter(is_missing).copied().collect();
        let has_no_place = self.region_is_place && PLACE.iter().all(|field| missing.contains(field));
        if has_no_place {
            log.add(self.places.table(), FieldMistake::MissingPlace { table: self.table.clone() });
        }
        for field in missing.iter().filter(|field| !(has_no_place && PLACE.contains(field))) {
            let replaces = if self.replaces_default { ", which replaces the default as a whole," } else { "" };
            let (other, table) = (self.other_unit(field), format!("{}{replaces}", self.table));
            log.add(self.places.table(), FieldMistake::MissingField { field, other, table });
        }
        self.places
    }

    /// The field for the same quantity in another unit, if a file may contain it.
    fn other_unit(&self, field: &str) -> Option<&'static str> {
        let other = self.either.iter().find_map(|[one, other]| (*one == field).then_some(*other))?;
        (self.pixel_mm.is_some() || !other.ends_with("_px")).then_some(other)
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
                log.add(name.span().start, FieldMistake::UnknownField { field, table: self.table, nearest });
            }
            None => log.add(self.places.table(), FieldMistake::MissingField { field, other: None, table: self.table }),
        }
    }

    /// Whether the file has a field that was not read yet.
    pub(super) fn has(&self, field: &str) -> bool {
        self.values.contains_key(field) || self.defaults.contains_key(field)
    }

    /// The text of a field that was not read yet, and its offset; `None` if it is absent or no text.
    pub(super) fn raw_text(&self, field: &str) -> Option<(usize, String)> {
        let value = self.values.get(field).or_else(|| self.defaults.get(field))?;
        Some((value.span().start, value.get_ref().as_str()?.to_owned()))
    }

    /// Whether the table has fields that were not read yet.
    pub(super) fn has_unread(&self) -> bool {
        !self.values.is_empty()
    }

    /// Offsets of the table and of the fields that were read.
    pub(super) fn places(&self) -> &Places {
        &self.places
    }

    /// Offset of a field that was not read yet, or of the table if the file does not have it.
    pub(super) fn place(&self, field: &str) -> usize {
        let value = self.values.get(field).or_else(|| self.defaults.get(field));
        value.map_or(self.places.table(), |value| value.span().start)
    }

    /// Reports a mistake if the file lacks a field.
    pub(super) fn require(&mut self, field: &FieldSpec) {
        self.required.push(field.name);
    }

    /// Requires a field of a layer's place, which a region would give as well.
    pub(super) fn require_place(&mut self, field: &FieldSpec) {
        self.region_is_place = true;
        self.require(field);
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
