//! The values of fields, by type and range.

use toml::Spanned;
use toml::de::{DeArray, DeValue};

use super::Fields;
use crate::grammar::{Absence, FieldSpec, Holds, Range};
use crate::log::Log;
use crate::mistake::Mistake;
use crate::nearest::Nearest;

/// A table, or the name of a file that contains it.
pub(crate) enum TableOrText<'i> {
    Table(Fields<'i>),
    Text(String),
}

impl<'i> Fields<'i> {
    /// A number; `None` if it is absent or invalid.
    pub(crate) fn number(&mut self, log: &mut Log, field: &FieldSpec) -> Option<f64> {
        let (Holds::Number(range) | Holds::Whole(range)) = field.holds else { return None };
        let value = self.take(field)?;
        let found = number(log, field.name, range, &value)?;
        if matches!(field.holds, Holds::Whole(_)) && found.fract().abs() > 0.0 {
            log.add(self.places.field(field.name), Mistake::NotWhole { field: field.name, found });
            return None;
        }
        Some(found)
    }

    /// A number, or its default if it is absent or invalid.
    pub(crate) fn number_or_default(&mut self, log: &mut Log, field: &FieldSpec) -> f64 {
        self.number(log, field).unwrap_or(field.default_number())
    }

    /// `true` or `false`, or the default if the field is absent.
    pub(crate) fn flag(&mut self, log: &mut Log, field: &FieldSpec) -> bool {
        let default = field.absence == Absence::Flag(true);
        let Some(value) = self.take(field) else { return default };
        if let DeValue::Boolean(flag) = value.get_ref() {
            return *flag;
        }
        log.add(value.span().start, wrong_type(field.name, "`true` or `false`", value.get_ref()));
        default
    }

    /// A text.
    pub(crate) fn text(&mut self, log: &mut Log, field: &FieldSpec) -> Option<String> {
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

    /// One of some words. An unknown word is a mistake. The nearest word is then returned, so that the fields that
    /// depend on it can be read.
    pub(crate) fn choice_or_nearest<T: Copy>(
        &mut self,
        log: &mut Log,
        field: &FieldSpec,
        choices: &[(&'static str, T)],
    ) -> Option<T> {
        match self.word(log, field, choices)? {
            Ok(choice) => Some(choice),
            Err(nearest) => {
                let meant = nearest.suggestion?;
                self.is_guess = true;
                choices.iter().find(|(word, _)| *word == meant).map(|(_, choice)| *choice)
            }
        }
    }

    /// One of some words.
    pub(crate) fn choice<T: Copy>(
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
    pub(crate) fn table(&mut self, log: &mut Log, field: &FieldSpec) -> Option<Fields<'i>> {
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

    /// A table, or the name of a file that contains it.
    pub(crate) fn table_or_text(&mut self, log: &mut Log, field: &FieldSpec) -> Option<TableOrText<'i>> {
        let value = self.take(field)?;
        let (name, offset) = (field.name, value.span().start);
        match value.into_inner() {
            DeValue::Table(values) => {
                Some(TableOrText::Table(Fields::of_field(&format!("[{name}]"), name, offset, values)))
            }
            DeValue::String(text) => Some(TableOrText::Text(text.into_owned())),
            other => {
                log.add(offset, wrong_type(name, "a table, or the name of a profile in quotes", &other));
                None
            }
        }
    }

    /// Any number of tables, `[[field]]`. If the field may hold one table, `[field]` is a list of one.
    pub(crate) fn tables(&mut self, log: &mut Log, field: &FieldSpec) -> Option<Vec<Fields<'i>>> {
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

    /// A list of numbers.
    pub(crate) fn numbers(&mut self, log: &mut Log, field: &FieldSpec) -> Option<Vec<f64>> {
        let Holds::Numbers(range) = field.holds else { return None };
        let list = self.list(log, field, "a list of numbers in square brackets")?;
        let numbers: Vec<_> = list.iter().map(|value| number(log, field.name, range, value)).collect();
        numbers.into_iter().collect()
    }

    /// Two numbers, the second one not below the first.
    pub(crate) fn interval(&mut self, log: &mut Log, field: &FieldSpec) -> Option<[f64; 2]> {
        const EXPECTED: &str = "two numbers in square brackets, [least, largest]";
        let Holds::Interval(range) = field.holds else { return None };
        let list = self.list(log, field, EXPECTED)?;
        let offset = self.places.field(field.name);
        let [low, high] = &list[..] else {
            log.add(offset, Mistake::Count { field: field.name, found: list.len(), min: 2, max: 2 });
            return None;
        };
        let (low, high) = (number(log, field.name, range, low), number(log, field.name, range, high));
        let (low, high) = (low?, high?);
        if low > high {
            log.add(offset, Mistake::IntervalReversed { field: field.name, low, high });
            return None;
        }
        Some([low, high])
    }

    /// A list of pairs of numbers.
    pub(crate) fn pairs(&mut self, log: &mut Log, field: &FieldSpec) -> Option<Vec<(f64, f64)>> {
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
