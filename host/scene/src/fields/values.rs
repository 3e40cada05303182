//! The values of fields, by type and range.

use toml::Spanned;
use toml::de::{DeArray, DeValue};

use super::Fields;
use super::misplaced::has_unit;
use crate::digits::digits;
use crate::grammar::{Absence, Axis, FieldSpec, Holds, LengthFields, Range};
use crate::log::Log;
use crate::mistake::FieldMistake;
use crate::nearest::Nearest;
use crate::printable::{NAME_MAX_CHARS, is_printable};

/// The name field, which has a length limit.
const NAME: &str = "name";

/// A table, or the name of a file that contains it.
pub(crate) enum TableOrText<'i> {
    Table(Box<Fields<'i>>),
    Text(String),
}

impl<'i> Fields<'i> {
    /// A number; `None` if it is absent or invalid.
    pub(crate) fn number(&mut self, log: &mut Log, field: &FieldSpec) -> Option<f64> {
        let (Holds::Number(range) | Holds::Whole(range)) = field.holds else { return None };
        let value = self.take(field)?;
        let found = number(log, field.name, range, &value)?;
        if matches!(field.holds, Holds::Whole(_)) && found.fract().abs() > 0.0 {
            log.add(self.places.field(field.name), FieldMistake::NotWhole { field: field.name, found });
            return None;
        }
        Some(found)
    }

    /// A number, or its default if it is absent or invalid.
    pub(crate) fn number_or_default(&mut self, log: &mut Log, field: &FieldSpec) -> f64 {
        self.number(log, field).unwrap_or(field.default_number())
    }

    /// An angle in degrees, reduced to one turn; the default if the field is absent or invalid.
    pub(crate) fn angle_deg(&mut self, log: &mut Log, field: &FieldSpec) -> f64 {
        let found_deg = self.number_or_default(log, field);
        if found_deg.abs() > 360.0 { found_deg % 360.0 } else { found_deg }
    }

    /// A number; `None` for `"auto"`, and if it is absent or invalid.
    pub(crate) fn number_or_auto(&mut self, log: &mut Log, field: &FieldSpec) -> Option<f64> {
        const AUTO: &str = "auto";
        let Holds::NumberOrAuto(range) = field.holds else { return None };
        let value = self.take(field)?;
        let found = match value.get_ref() {
            DeValue::Integer(_) | DeValue::Float(_) => return number(log, field.name, range, &value),
            DeValue::String(found) if found == AUTO => return None,
            other => other,
        };
        let nearest = found.as_str().map(|found| Nearest::new(found, std::iter::once(AUTO)));
        let mistake = match nearest.filter(|nearest| nearest.suggestion.is_some()) {
            Some(nearest) => {
                let found = found.as_str().unwrap_or_default().to_owned();
                FieldMistake::UnknownChoice { field: field.name, found, nearest }
            }
            None => wrong_type(field.name, "a number or \"auto\"", found),
        };
        log.add(value.span().start, mistake);
        None
    }

    /// A place or a size in millimetres, from millimetres or pixels; `None` if it is absent or invalid.
    pub(crate) fn length_mm(&mut self, log: &mut Log, field: &LengthFields) -> Option<f64> {
        let Holds::Number(range) = field.mm.holds else { return None };
        let [mm, px] = self.in_either_unit(log, &field.mm, &field.px);
        let found_mm = self.number(log, &mm);
        let place = self.place(px.name);
        let found_px = self.number(log, &px);
        let converted = || self.pixels_in_mm(log, px.name, place, range, field.axis, found_px?);
        found_mm.or_else(converted)
    }

    /// Places in millimetres, from millimetres or pixels; `None` if they are absent or invalid.
    pub(crate) fn places_mm(&mut self, log: &mut Log, mm: &FieldSpec, px: &FieldSpec) -> Option<Vec<(f64, f64)>> {
        let Holds::Pairs(range) = mm.holds else { return None };
        let [mm, px] = self.in_either_unit(log, mm, px);
        let found_mm = self.pairs(log, &mm);
        let place = self.place(px.name);
        let found_px = self.pairs(log, &px);
        found_mm.or_else(|| {
            let mut converted = |axis, found_px| self.pixels_in_mm(log, px.name, place, range, axis, found_px);
            let places = found_px?.into_iter().map(|(x_px, y_px)| {
                let (x_mm, y_mm) = (converted(Axis::X, x_px), converted(Axis::Y, y_px));
                x_mm.zip(y_mm)
            });
            places.collect()
        })
    }

    /// Two fields for one quantity in two units. Either is enough; both are a mistake.
    pub(crate) fn in_either_unit(&mut self, log: &mut Log, one: &FieldSpec, other: &FieldSpec) -> [FieldSpec; 2] {
        self.either(one, other);
        let has_other = self.has(other.name);
        if self.has(one.name) && has_other {
            log.add(self.place(other.name), FieldMistake::TwoUnits { one: one.name, other: other.name });
        }
        if one.absence == Absence::Mistake && !has_other {
            self.require(one);
        }
        // Either of the two fields is enough, so neither is required alone.
        [one, other].map(|field| FieldSpec { absence: Absence::Means(""), ..*field })
    }

    /// Converts pixels along an axis to millimetres, and checks the range.
    fn pixels_in_mm(
        &self,
        log: &mut Log,
        field: &'static str,
        place: usize,
        range: Range,
        axis: Axis,
        found_px: f64,
    ) -> Option<f64> {
        let Some(pixel) = self.pixel_mm else {
            log.add(place, FieldMistake::NoDesign { field });
            return None;
        };
        let pixel_mm = pixel.along(axis);
        let found_mm = found_px * pixel_mm;
        if (range.min..=range.max).contains(&found_mm) {
            return Some(found_mm);
        }
        let (min, max) = (digits(range.min / pixel_mm, f64::ceil), digits(range.max / pixel_mm, f64::floor));
        log.add(place, FieldMistake::OutOfRange { field, found: found_px, min, max, unit: " px" });
        None
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

    /// A text for use in messages: all its characters are visible.
    pub(crate) fn text(&mut self, log: &mut Log, field: &FieldSpec) -> Option<String> {
        let value = self.take(field)?;
        Self::text_of(log, field.name, &value)
    }

    /// A text of any characters.
    pub(crate) fn free_text(&mut self, log: &mut Log, field: &FieldSpec) -> Option<String> {
        let value = self.take(field)?;
        if let DeValue::String(text) = value.get_ref() {
            return Some(text.clone().into_owned());
        }
        Self::text_of(log, field.name, &value)
    }

    fn text_of(log: &mut Log, field: &'static str, value: &Spanned<DeValue>) -> Option<String> {
        if let DeValue::String(text) = value.get_ref() {
            if !is_printable(text) {
                log.add(value.span().start, FieldMistake::Unprintable { field });
                return None;
            }
            let found = text.chars().count();
            if field == NAME && found > NAME_MAX_CHARS {
                log.add(value.span().start, FieldMistake::NameTooLong { field, found });
                return None;
            }
            return Some(text.clone().into_owned());
        }
        log.add(value.span().start, wrong_type(field, "a string in quotes", value.get_ref()));
        None
    }

    /// One of some words. An unknown word is a mistake. The nearest word is then returned, so that the fields that
    /// depend on it can be read.
    pub(crate) fn choice_or_nearest<T: Clone>(
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
                choices.iter().find(|(word, _)| *word == meant).map(|(_, choice)| choice.clone())
            }
        }
    }

    /// One of some words.
    pub(crate) fn choice<T: Clone>(
        &mut self,
        log: &mut Log,
        field: &FieldSpec,
        choices: &[(&'static str, T)],
    ) -> Option<T> {
        self.word(log, field, choices)?.ok()
    }

    /// One of some words; after a mistake, the nearest ones.
    fn word<T: Clone>(
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
            return Some(Ok(choice.clone()));
        }
        let nearest = Nearest::new(&found, choices.iter().map(|(word, _)| *word));
        log.add(self.places.field(name), FieldMistake::UnknownChoice { field: name, found, nearest: nearest.clone() });
        Some(Err(nearest))
    }

    /// A table.
    pub(crate) fn table(&mut self, log: &mut Log, field: &FieldSpec) -> Option<Fields<'i>> {
        let value = self.take(field)?;
        let (name, offset) = (field.name, value.span().start);
        match value.into_inner() {
            DeValue::Table(values) => Some(self.of_field(&format!("[{name}]"), name, offset, values)),
            other => {
                log.add(offset, not_a_table(name, &other));
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
                Some(TableOrText::Table(Box::new(self.of_field(&format!("[{name}]"), name, offset, values))))
            }
            DeValue::String(text) if !is_printable(&text) => {
                log.add(offset, FieldMistake::Unprintable { field: name });
                None
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
                return Some(vec![self.of_field(&format!("[{name}]"), name, offset, values)]);
            }
            other => {
                log.add(offset, FieldMistake::NotTables { field: name, found: type_of(&other) });
                return None;
            }
        };
        let mut tables = Vec::new();
        for value in values {
            let offset = value.span().start;
            match value.into_inner() {
                DeValue::Table(values) => {
                    tables.push(self.of_field(&format!("[[{name}]]"), name, offset, values));
                }
                other => log.add(offset, FieldMistake::NotTables { field: name, found: type_of(&other) }),
            }
        }
        Some(tables)
    }

    /// A list of texts, each with its offset.
    pub(crate) fn texts(&mut self, log: &mut Log, field: &FieldSpec) -> Option<Vec<(usize, String)>> {
        let list = self.list(log, field, "a list of strings in square brackets")?;
        all(list.iter().map(|value| Some((value.span().start, Self::text_of(log, field.name, value)?))))
    }

    /// A list of numbers.
    pub(crate) fn numbers(&mut self, log: &mut Log, field: &FieldSpec) -> Option<Vec<f64>> {
        let Holds::Numbers(range) = field.holds else { return None };
        let list = self.list(log, field, "a list of numbers in square brackets")?;
        all(list.iter().map(|value| number(log, field.name, range, value)))
    }

    /// Two numbers, the second one not below the first.
    pub(crate) fn interval(&mut self, log: &mut Log, field: &FieldSpec) -> Option<[f64; 2]> {
        const EXPECTED: &str = "two numbers in square brackets, [least, largest]";
        let Holds::Interval(range) = field.holds else { return None };
        let list = self.list(log, field, EXPECTED)?;
        let offset = self.places.field(field.name);
        let [low, high] = &list[..] else {
            log.add(offset, FieldMistake::Count { field: field.name, found: list.len(), min: 2, max: 2 });
            return None;
        };
        let (low, high) = (number(log, field.name, range, low), number(log, field.name, range, high));
        let (low, high) = (low?, high?);
        if low > high {
            log.add(offset, FieldMistake::IntervalReversed { field: field.name, low, high });
            return None;
        }
        Some([low, high])
    }

    /// A list of pairs of numbers.
    pub(crate) fn pairs(&mut self, log: &mut Log, field: &FieldSpec) -> Option<Vec<(f64, f64)>> {
        const EXPECTED: &str = "a list of pairs, [[x, y], [x, y]]";
        let Holds::Pairs(range) = field.holds else { return None };
        let list = self.list(log, field, EXPECTED)?;
        all(list.iter().map(|value| match value.get_ref() {
            DeValue::Array(pair) if pair.len() == 2 => {
                let mut numbers = pair.iter().map(|value| number(log, field.name, range, value));
                numbers.next()?.zip(numbers.next()?)
            }
            other => {
                log.add(value.span().start, wrong_type(field.name, EXPECTED, other));
                None
            }
        }))
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

/// All values; `None` if one is missing. Every value is read, to report the mistakes of all.
pub(crate) fn all<T>(values: impl Iterator<Item = Option<T>>) -> Option<Vec<T>> {
    values.collect::<Vec<_>>().into_iter().collect()
}

fn number(log: &mut Log, field: &'static str, range: Range, value: &Spanned<DeValue>) -> Option<f64> {
    let offset = value.span().start;
    let found = match value.get_ref() {
        // A number with more digits than an i64 is out of every range.
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
        DeValue::Integer(integer) => {
            let whole = i64::from_str_radix(integer.as_str(), integer.radix());
            Some(whole.map_or(f64::MAX, |whole| whole as f64))
        }
        DeValue::Float(float) => float.as_str().parse().ok(),
        _ => None,
    };
    let Some(found) = found else {
        let advice = value.get_ref().as_str().and_then(quoted_number_advice);
        let mistake = match advice {
            Some(advice) => FieldMistake::QuotedNumber { field, advice },
            None => wrong_type(field, "a number", value.get_ref()),
        };
        log.add(offset, mistake);
        return None;
    };
    if found >= range.min && found <= range.max {
        return Some(found);
    }
    log.add(offset, FieldMistake::OutOfRange { field, found, min: range.min, max: range.max, unit: range.unit });
    None
}

/// Advice about a number in quotation marks; `None` for other texts.
fn quoted_number_advice(text: &str) -> Option<&'static str> {
    match text.trim() {
        text if text.parse::<f64>().is_ok() => Some("leave the quotation marks out"),
        text if has_unit(text) => Some("leave the quotation marks out and the unit, which the field's name has"),
        _ => None,
    }
}

fn wrong_type(field: &'static str, expected: &'static str, found: &DeValue) -> FieldMistake {
    FieldMistake::WrongType { field, expected, found: type_of(found) }
}

fn type_of(value: &DeValue) -> &'static str {
    match value {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "`true` or `false`",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

/// The mistake of a value in place of a table, with the table that was probably meant.
fn not_a_table(field: &'static str, found: &DeValue) -> FieldMistake {
    let write = match field {
        "region" => {
            let [x, y, width, height] = four_numbers(found).unwrap_or(["10", "10", "40", "20"].map(str::to_owned));
            format!("`region = {{ x_mm = {x}, y_mm = {y}, width_mm = {width}, height_mm = {height} }}`")
        }
        "repeat" => {
            let columns = found.as_integer().map_or("3", |columns| columns.as_str());
            format!("`repeat = {{ columns = {columns}, dx_mm = 10 }}`, with the distance from a copy to the next")
        }
        "burst" => "`burst = { period_ms = 1000, on_ms = 400 }`".to_owned(),
        _ => format!("`[{field}]` on a line of its own, and its fields below it"),
    };
    FieldMistake::NotATable { field, found: type_of(found), write }
}

/// The numbers of a list of four, as written.
fn four_numbers(list: &DeValue) -> Option<[String; 4]> {
    let number = |value: &Spanned<DeValue>| match value.get_ref() {
        DeValue::Integer(integer) => Some(integer.as_str().to_owned()),
        DeValue::Float(float) => Some(float.as_str().to_owned()),
        _ => None,
    };
    let numbers: Option<Vec<String>> = list.as_array()?.iter().map(number).collect();
    numbers?.try_into().ok()
}
