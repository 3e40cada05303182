//! Reads the fields of a TOML table by name, type and range, and finds those that nobody asked for.

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::asked::{Asked, AskedTable, Holds};
use super::log::Log;
use super::mistake::Mistake;
use super::nearest::Nearest;
use super::source::Places;

/// What a number may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub(super) min: f64,
    pub(super) max: f64,
    /// With a space before it.
    pub(super) unit: &'static str,
}

impl Range {
    pub(super) const fn new(min: f64, max: f64, unit: &'static str) -> Self {
        Self { min, max, unit }
    }
}

/// A table that is being read. Every field that is asked for becomes known; [`Fields::close`] reports the rest.
pub(super) struct Fields<'i> {
    table: String,
    /// The field that the table stands in.
    key: &'static str,
    values: DeTable<'i>,
    places: Places,
    asked: Vec<Asked>,
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
            asked: Vec::new(),
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

    /// A number that has to be there.
    pub(super) fn number(&mut self, log: &mut Log, field: &'static str, range: Range) -> Option<f64> {
        self.require(field);
        self.optional_number(log, field, range)
    }

    /// A number that may be left out.
    pub(super) fn optional_number(&mut self, log: &mut Log, field: &'static str, range: Range) -> Option<f64> {
        let value = self.take(field, Holds::Number(range))?;
        number(log, field, range, &value)
    }

    /// `true` or `false`, or `default` where it is left out.
    pub(super) fn flag(&mut self, log: &mut Log, field: &'static str, default: bool) -> bool {
        let Some(value) = self.take(field, Holds::Flag) else { return default };
        if let DeValue::Boolean(flag) = value.get_ref() {
            return *flag;
        }
        log.add(value.span().start, wrong_type(field, "`true` or `false`", value.get_ref()));
        default
    }

    /// A text that has to be there.
    pub(super) fn text(&mut self, log: &mut Log, field: &'static str) -> Option<String> {
        self.require(field);
        self.optional_text(log, field)
    }

    /// A text that may be left out.
    pub(super) fn optional_text(&mut self, log: &mut Log, field: &'static str) -> Option<String> {
        let value = self.take(field, Holds::Text)?;
        Self::text_of(log, field, &value)
    }

    fn text_of(log: &mut Log, field: &'static str, value: &Spanned<DeValue>) -> Option<String> {
        if let DeValue::String(text) = value.get_ref() {
            return Some(text.clone().into_owned());
        }
        log.add(value.span().start, wrong_type(field, "a text in quotes", value.get_ref()));
        None
    }

    /// One of some words that has to be there. One that is not known is noted, and read as the one that may have been meant,
    /// so that what depends on it can be looked at.
    pub(super) fn choice_or_nearest<T: Copy>(
        &mut self,
        log: &mut Log,
        field: &'static str,
        choices: &[(&'static str, T)],
    ) -> Option<T> {
        self.require(field);
        match self.word(log, field, choices)? {
            Ok(choice) => Some(choice),
            Err(nearest) => {
                let meant = nearest.suggestion?;
                choices.iter().find(|(word, _)| *word == meant).map(|(_, choice)| *choice)
            }
        }
    }

    /// One of some words, that may be left out.
    pub(super) fn optional_choice<T: Copy>(
        &mut self,
        log: &mut Log,
        field: &'static str,
        choices: &[(&'static str, T)],
    ) -> Option<T> {
        self.word(log, field, choices)?.ok()
    }

    /// One of some words, or, when that was noted, what may have been meant.
    fn word<T: Copy>(
        &mut self,
        log: &mut Log,
        field: &'static str,
        choices: &[(&'static str, T)],
    ) -> Option<Result<T, Nearest>> {
        let words = choices.iter().map(|(word, _)| *word).collect();
        let value = self.take(field, Holds::Choice(words))?;
        let found = Self::text_of(log, field, &value)?;
        if let Some((_, choice)) = choices.iter().find(|(word, _)| *word == found) {
            return Some(Ok(*choice));
        }
        let nearest = Nearest::new(&found, choices.iter().map(|(word, _)| *word));
        log.add(self.places.field(field), Mistake::UnknownChoice { field, found, nearest: nearest.clone() });
        Some(Err(nearest))
    }

    /// A table that has to be there.
    pub(super) fn table(&mut self, log: &mut Log, field: &'static str) -> Option<Fields<'i>> {
        self.require(field);
        self.optional_table(log, field)
    }

    /// A table that may be left out.
    pub(super) fn optional_table(&mut self, log: &mut Log, field: &'static str) -> Option<Fields<'i>> {
        let value = self.take(field, Holds::Table)?;
        let offset = value.span().start;
        match value.into_inner() {
            DeValue::Table(values) => Some(Fields::of_field(&format!("[{field}]"), field, offset, values)),
            other => {
                log.add(offset, wrong_type(field, "a table", &other));
                None
            }
        }
    }

    /// Any number of tables, `[[field]]`; with `one`, `[field]` is a list of one. Nothing where there is no such list.
    pub(super) fn tables(&mut self, log: &mut Log, field: &'static str, one: bool) -> Option<Vec<Fields<'i>>> {
        let value = self.take(field, Holds::Tables { one })?;
        let offset = value.span().start;
        let values = match value.into_inner() {
            DeValue::Array(values) => values,
            DeValue::Table(values) if one => {
                return Some(vec![Fields::of_field(&format!("[{field}]"), field, offset, values)]);
            }
            other => {
                log.add(offset, wrong_type(field, "a list of tables, each with its name in double brackets", &other));
                return None;
            }
        };
        let mut tables = Vec::new();
        for value in values {
            let offset = value.span().start;
            match value.into_inner() {
                DeValue::Table(values) => {
                    tables.push(Fields::of_field(&format!("[[{field}]]"), field, offset, values));
                }
                other => log.add(offset, wrong_type(field, "a list of tables", &other)),
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
            let absent = self.asked.iter().map(|asked| asked.field).filter(|known| !self.places.has(known));
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

    /// A whole number that may be left out.
    pub(super) fn optional_whole(&mut self, log: &mut Log, field: &'static str, range: Range) -> Option<f64> {
        let value = self.take(field, Holds::Whole(range))?;
        let found = number(log, field, range, &value)?;
        if found.fract().abs() > 0.0 {
            log.add(self.places.field(field), Mistake::NotWhole { field, found });
            return None;
        }
        Some(found)
    }

    /// A list of numbers that has to be there.
    pub(super) fn numbers(&mut self, log: &mut Log, field: &'static str, range: Range) -> Option<Vec<f64>> {
        self.require(field);
        let list = self.list(log, field, Holds::Numbers(range), "a list of numbers in square brackets")?;
        let numbers: Vec<_> = list.iter().map(|value| number(log, field, range, value)).collect();
        numbers.into_iter().collect()
    }

    /// A list of pairs of numbers that has to be there.
    pub(super) fn pairs(&mut self, log: &mut Log, field: &'static str, range: Range) -> Option<Vec<(f64, f64)>> {
        const EXPECTED: &str = "a list of pairs, [[x, y], [x, y]]";
        self.require(field);
        let list = self.list(log, field, Holds::Pairs(range), EXPECTED)?;
        let pairs: Vec<_> = list
            .iter()
            .map(|value| match value.get_ref() {
                DeValue::Array(pair) if pair.len() == 2 => {
                    let mut numbers = pair.iter().map(|value| number(log, field, range, value));
                    numbers.next()?.zip(numbers.next()?)
                }
                other => {
                    log.add(value.span().start, wrong_type(field, EXPECTED, other));
                    None
                }
            })
            .collect();
        pairs.into_iter().collect()
    }

    fn list(
        &mut self,
        log: &mut Log,
        field: &'static str,
        holds: Holds,
        expected: &'static str,
    ) -> Option<DeArray<'i>> {
        let value = self.take(field, holds)?;
        let offset = value.span().start;
        match value.into_inner() {
            DeValue::Array(list) => Some(list),
            other => {
                log.add(offset, wrong_type(field, expected, &other));
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

    /// A missing field is a mistake. To be said before the field is read.
    pub(super) fn require(&mut self, field: &'static str) {
        self.required.push(field);
    }

    /// Two fields say the same, so that only one of them is to be there.
    pub(super) fn either(&mut self, one: &'static str, other: &'static str) {
        self.either.push([one, other]);
    }

    fn described(&self) -> AskedTable {
        let Self { key, asked, required, either, .. } = self;
        AskedTable { key, asked: asked.clone(), required: required.clone(), either: either.clone() }
    }

    fn take(&mut self, field: &'static str, holds: Holds) -> Option<Spanned<DeValue<'i>>> {
        self.asked.push(Asked { field, holds });
        let value = self.values.remove(field)?;
        self.places.add(field, value.span().start);
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
