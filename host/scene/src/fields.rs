//! Reads the fields of a TOML table by name, type and range, and finds those that are unknown.

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::grammar::{Absence, FieldSpec, Holds, KnownField, KnownTable, Range};
use super::log::Log;
use super::mistake::Mistake;
use super::nearest::Nearest;
use super::source::Places;

/// A table that is being read. Every field that the parser looks for becomes known; [`Fields::close`] reports the rest.
pub(super) struct Fields<'i> {
    table: String,
    /// The field that the table stands in.
    key: &'static str,
    values: DeTable<'i>,
    places: Places,
    known: Vec<KnownField>,
    required: Vec<&'static str>,
    either: Vec<[&'static str; 2]>,
}

impl<'i> Fields<'i> {
    /// `table` is how messages call it; `offset` is where it starts.
    pub(super) fn new(table: impl Into<String>, offset: usize, values: DeTable<'i>) -> Self {
        Self {
            table: table.into(),
            key: "",
            values,
            places: Places::new(offset),
            known: Vec::new(),
            required: Vec::new(),
            either: Vec::new(),
        }
    }

    /// The table of a field.
    fn of_field(brackets: &str, key: &'static str, offset: usize, values: DeTable<'i>) -> Self {
        Self { key, ..Self::new(brackets, offset, values) }
    }

    /// From here on, messages call the table so.
    pub(super) fn rename(&mut self, table: String) {
        self.table = table;
    }

    /// A number, or `None` where the file leaves it out or it is wrong.
    pub(super) fn number(&mut self, log: &mut Log, field: &FieldSpec) -> Option<f64> {
        let (Holds::Number(range) | Holds::Whole(range)) = field.holds else { return None };
        let value = self.take(field)?;
        let found = number(log, field.name, range, &value)?;
        if matches!(field.holds, Holds::Whole(_)) && found.fract().abs() > 0.0 {
            log.add(self.places.field(field.name), Mistake::NotWhole { field: field.name, found });
            return None;
        }
        Some(found)
    }

    /// A number, or its default where the file leaves it out or it is wrong.
    pub(super) fn number_or_default(&mut self, log: &mut Log, field: &FieldSpec) -> f64 {
        self.number(log, field).unwrap_or(field.default_number())
    }

    /// `true` or `false`, or the default where the file leaves it out.
    pub(super) fn flag(&mut self, log: &mut Log, field: &FieldSpec) -> bool {
        let default = field.absence == Absence::Flag(true);
        let Some(value) = self.take(field) else { return default };
        if let DeValue::Boolean(flag) = value.get_ref() {
            return *flag;
        }
        log.add(value.span().start, wrong_type(field.name, "`true` or `false`", value.get_ref()));
        default
    }

    /// A text.
    pub(super) fn text(&mut self, log: &mut Log, field: &FieldSpec) -> Option<String> {
        let value = self.take(field)?;
        Self::text_of(log, field.name, &value)
    }

    fn text_of(log: &mut Log, field: &'static str, value: &Spanned<DeValue>) -> Option<String> {
        if let DeValue::String(text) = value.get_ref() {
            return Some(text.clone().into_owned());
        }
        log.add(value.span().start, wrong_type(field, "a text in quotes", value.get_ref()));
        None
    }

    /// One of some words. For one that is unknown, which is a mistake, the word that may have been meant, so that the
    /// fields that depend on it can be read.
    pub(super) fn choice_or_nearest<T: Copy>(
        &mut self,
        log: &mut Log,
        field: &FieldSpec,
        choices: &[(&'static str, T)],
    ) -> Option<T> {
        match self.word(log, field, choices)? {
            Ok(choice) => Some(choice),
            Err(nearest) => {
                let meant = nearest.suggestion?;
                choices.iter().find(|(word, _)| *word == meant).map(|(_, choice)| *choice)
            }
        }
    }

    /// One of some words.
    pub(super) fn choice<T: Copy>(
        &mut self,
        log: &mut Log,
        field: &FieldSpec,
        choices: &[(&'static str, T)],
    ) -> Option<T> {
        self.word(log, field, choices)?.ok()
    }

    /// One of some words; after a mistake, the nearest ones.
    fn word<T: Copy>(
        &mut self,
        log: &mut Log,
        field: &FieldSpec,
        choices: &[(&'static str, T)],
    ) -> Option<Result<T, Nearest>> {
        let words = choices.iter().map(|(word, _)| *word).collect();
        let value = self.take_word(field, words)?;
        let name = field.name;
        let found = Self::text_of(log, name, &value)?;
        if let Some((_, choice)) = choices.iter().find(|(word, _)| *word == found) {
            return Some(Ok(*choice));
        }
        let nearest = Nearest::new(&found, choices.iter().map(|(word, _)| *word));
        log.add(self.places.field(name), Mistake::UnknownChoice { field: name, found, nearest: nearest.clone() });
        Some(Err(nearest))
    }

    /// A table.
    pub(super) fn table(&mut self, log: &mut Log, field: &FieldSpec) -> Option<Fields<'i>> {
        let value = self.take(field)?;
        let (name, offset) = (field.name, value.span().start);
        match value.into_inner() {
            DeValue::Table(values) => Some(Fields::of_field(&format!("[{name}]"), name, offset, values)),
            other => {
                log.add(offset, wrong_type(name, "a table", &other));
                None
            }
        }
    }

    /// Any number of tables, `[[field]]`; where the field holds a table as well, `[field]` is a list of one.
    pub(super) fn tables(&mut self, log: &mut Log, field: &FieldSpec) -> Option<Vec<Fields<'i>>> {
        let value = self.take(field)?;
        let (name, offset) = (field.name, value.span().start);
        let values = match value.into_inner() {
            DeValue::Array(values) => values,
            DeValue::Table(values) if field.holds == Holds::TableOrTables => {
                return Some(vec![Fields::of_field(&format!("[{name}]"), name, offset, values)]);
            }
            other => {
                log.add(offset, wrong_type(name, "a list of tables, each with its name in double brackets", &other));
                return None;
            }
        };
        let mut tables = Vec::new();
        for value in values {
            let offset = value.span().start;
            match value.into_inner() {
                DeValue::Table(values) => {
                    tables.push(Fields::of_field(&format!("[[{name}]]"), name, offset, values));
                }
                other => log.add(offset, wrong_type(name, "a list of tables", &other)),
            }
        }
        Some(tables)
    }

    /// Reports what is left over and what is missing; gives back where the fields stand. A missing field whose
    /// misspelling is reported is not reported again.
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
            if self.places.has(field) || misspelt.iter().any(|word| word == field) {
                continue;
            }
            log.add(self.places.table(), Mistake::MissingField { field, table: self.table.clone() });
        }
        self.places
    }

    /// Ends the reading of a table that cannot be understood without `field`: when the field is missing, reports that,
    /// or its misspelling, and nothing else.
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

    /// A list of numbers.
    pub(super) fn numbers(&mut self, log: &mut Log, field: &FieldSpec) -> Option<Vec<f64>> {
        let Holds::Numbers(range) = field.holds else { return None };
        let list = self.list(log, field, "a list of numbers in square brackets")?;
        let numbers: Vec<_> = list.iter().map(|value| number(log, field.name, range, value)).collect();
        numbers.into_iter().collect()
    }

    /// A list of pairs of numbers.
    pub(super) fn pairs(&mut self, log: &mut Log, field: &FieldSpec) -> Option<Vec<(f64, f64)>> {
        const EXPECTED: &str = "a list of pairs, [[x, y], [x, y]]";
        let Holds::Pairs(range) = field.holds else { return None };
        let list = self.list(log, field, EXPECTED)?;
        let pairs: Vec<_> = list
            .iter()
            .map(|value| match value.get_ref() {
                DeValue::Array(pair) if pair.len() == 2 => {
                    let mut numbers = pair.iter().map(|value| number(log, field.name, range, value));
                    numbers.next()?.zip(numbers.next()?)
                }
                other => {
                    log.add(value.span().start, wrong_type(field.name, EXPECTED, other));
                    None
                }
            })
            .collect();
        pairs.into_iter().collect()
    }

    fn list(&mut self, log: &mut Log, field: &FieldSpec, expected: &'static str) -> Option<DeArray<'i>> {
        let value = self.take(field)?;
        let offset = value.span().start;
        match value.into_inner() {
            DeValue::Array(list) => Some(list),
            other => {
                log.add(offset, wrong_type(field.name, expected, &other));
                None
            }
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

    /// Where a field stands that was not read yet, or the table where the file leaves it out.
    pub(super) fn place(&self, field: &str) -> usize {
        self.values.get(field).map_or(self.places.table(), |value| value.span().start)
    }

    /// Makes it a mistake when the file leaves a field out.
    pub(super) fn require(&mut self, field: &FieldSpec) {
        self.required.push(field.name);
    }

    /// Two fields say the same, so that only one of them may be there.
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

    /// Takes a field out of the table, and notes that it is known, with the words that it may be.
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

fn number(log: &mut Log, field: &'static str, range: Range, value: &Spanned<DeValue>) -> Option<f64> {
    let offset = value.span().start;
    let found = match value.get_ref() {
        DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix()).ok().map(|i| i as f64),
        DeValue::Float(float) => float.as_str().parse().ok(),
        _ => None,
    };
    let Some(found) = found else {
        log.add(offset, wrong_type(field, "a number", value.get_ref()));
        return None;
    };
    if found >= range.min && found <= range.max {
        return Some(found);
    }
    log.add(offset, Mistake::OutOfRange { field, found, min: range.min, max: range.max, unit: range.unit });
    None
}

fn wrong_type(field: &'static str, expected: &'static str, found: &DeValue) -> Mistake {
    let found = match found {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "`true` or `false`",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    };
    Mistake::WrongType { field, expected, found }
}
