//! Finds fields that belong to another table, and headers in the wrong brackets.

use std::sync::LazyLock;

use super::Fields;
use crate::digits::digits;
use crate::file::describe;
use crate::log::Log;
use crate::mistake::{FieldMistake, SLASH_ADVICE};
use crate::printable::brief;
use crate::stack::LAYER_FIELDS;

/// A field that its table does not have.
struct Unknown {
    name: String,
    /// Offset of the name.
    offset: usize,
    value_offset: usize,
}

/// The fields of a table that belong to another one. Their mistakes have been reported.
pub(super) struct Misplaced {
    fields: Vec<String>,
    /// The table to which they belong, if it should be inside of this table.
    pub(super) missing: Option<&'static str>,
}

impl Misplaced {
    pub(super) fn contains(&self, field: &str) -> bool {
        self.fields.iter().any(|other| other == field)
    }
}

/// A table and its fields.
struct OwningTable {
    key: &'static str,
    fields: Vec<&'static str>,
}

/// The name of a screen. In a scene, `name` is unlikely to mean the screen's.
const NAME: &str = "name";
/// A scene with every table of the head, and one with the tables inside a layer.
const TABLES: &str = "version = 1\n[drive]\n[screen]\n[finger]\n[carrier]\n[touch]\n[design]\n\
    [[layer]]\nkind = \"vibration\"\nregion = {}\nrepeat = {}\nburst = {}\n\
    [[layer]]\nkind = \"constant\"\nregion = { shape = \"polygon\" }\n";
/// The tables inside a layer.
const INSIDE_LAYERS: [&str; 3] = ["region", "repeat", "burst"];
/// Fields of the scene itself, which belong above its tables.
const ABOVE_TABLES: [&str; 3] = ["finger", "screen", "include"];
/// The tables that a field may belong to, in the order in which they are tried.
const KEYS: [&str; 9] = ["region", "repeat", "burst", "drive", "finger", "screen", "carrier", "touch", "design"];

static HOMES: LazyLock<Vec<OwningTable>> = LazyLock::new(|| {
    let tables = describe(TABLES);
    let fields = |key: &str| {
        let of_key = tables.iter().filter(|table| table.key == key);
        of_key.flat_map(|table| table.fields.iter().map(|known| known.field.name)).collect()
    };
    KEYS.into_iter().map(|key| OwningTable { key, fields: fields(key) }).collect()
});

/// The name of a field in a table; its unit may be omitted.
fn name_in(home: &OwningTable, field: &str) -> Option<&'static str> {
    let is_named = |name: &&&'static str| **name == field || name.strip_suffix("_mm") == Some(field);
    home.fields.iter().find(is_named).copied()
}

impl Fields<'_> {
    /// Reports the fields that belong to another table, as one mistake for each of these tables.
    pub(super) fn misplaced(&self, log: &mut Log) -> Misplaced {
        let mut misplaced = Misplaced { fields: Vec::new(), missing: None };
        // The known fields themselves result from reading tables.
        if self.values.is_empty() || log.is_describing() {
            return misplaced;
        }
        let unknown = self.values.iter().map(|(name, value)| Unknown {
            name: name.get_ref().clone().into_owned(),
            offset: name.span().start,
            value_offset: value.span().start,
        });
        let unknown: Vec<Unknown> = unknown.collect();
        let has = |field: &str| self.known.iter().any(|known| known.field.name == field);
        let (table, key) = (&self.table, self.key);
        for field in unknown.iter().filter(|field| !key.is_empty() && ABOVE_TABLES.contains(&field.name.as_str())) {
            misplaced.fields.push(field.name.clone());
            let written = brief(log.source().word_at(field.value_offset)).into_owned();
            let mistake = FieldMistake::Misplaced {
                fields: vec![field.name.clone()],
                table: table.clone(),
                home: if key == "layer" { "above the first [[layer]]" } else { "above the first line in brackets" }
                    .to_owned(),
                write: format!("`{} = {written}` below `version`", field.name),
            };
            log.add(field.offset, mistake);
        }
        for home in HOMES.iter().filter(|home| home.key != key) {
            let is_inside = INSIDE_LAYERS.contains(&home.key);
            if is_inside && key != "layer" {
                continue;
            }
            let belongs = |field: &str| {
                let is_of_layers = key == "layer" && LAYER_FIELDS.iter().any(|known| known.field.name == field);
                match name_in(home, field) {
                    Some(name) if name == field => is_inside || !is_of_layers && field != NAME,
                    Some(name) => is_inside && !has(name),
                    None => false,
                }
            };
            let here: Vec<&Unknown> =
                unknown.iter().filter(|field| belongs(&field.name) && !misplaced.contains(&field.name)).collect();
            let Some(first) = here.iter().min_by_key(|field| field.offset) else { continue };
            let (offset, mut here) = (first.offset, here.clone());
            here.sort_by_key(|field| field.offset);
            let written = |field: &&Unknown| {
                let name = name_in(home, &field.name).unwrap_or(&field.name);
                format!("{name} = {}", brief(log.source().word_at(field.value_offset)))
            };
            let written: Vec<String> = here.iter().map(written).collect();
            let fields: Vec<String> = here.iter().map(|field| field.name.clone()).collect();
            let (home_name, write) = if is_inside {
                misplaced.missing = misplaced.missing.or(Some(home.key));
                (format!("in `{}`", home.key), format!("`{} = {{ {} }}`", home.key, written.join(", ")))
            } else {
                let below = if fields.len() == 1 { "it" } else { "them" };
                (format!("to [{}]", home.key), format!("{below} below a line `[{}]`", home.key))
            };
            misplaced.fields.extend(fields.iter().cloned());
            log.add(offset, FieldMistake::Misplaced { fields, table: table.clone(), home: home_name, write });
        }
        misplaced
    }
}

/// The place and the reason of a mistake that the parser found at `offset`, with advice.
pub(super) fn explained(text: &str, offset: usize, reason: &str) -> (usize, String) {
    let line_start = text.get(..offset).and_then(|before| before.rfind('\n')).map_or(0, |newline| newline + 1);
    let line = text.get(line_start..).and_then(|rest| rest.lines().next()).unwrap_or_default();
    // A byte order mark begins many files.
    match invisible(line).filter(|(place, _)| line_start + place > 0) {
        Some((place, said)) => (line_start + place, said),
        None => match value_at(line, offset - line_start).and_then(no_number) {
            Some(said) => (offset, said),
            None => (offset, format!("{reason}{}", syntax_hint(text, offset, line_start, line.trim()))),
        },
    }
}

/// The value of the field of a line, or of a table within braces, in which a place is.
fn value_at(line: &str, place: usize) -> Option<&str> {
    let code = line.split('#').next().unwrap_or_default();
    let (before, _) = code.split_at_checked(place)?;
    let start = before.rfind('=').or_else(|| code.find('='))? + 1;
    let value = code.get(start..)?;
    let end = if before.contains('{') { value.find([',', '}']).unwrap_or(value.len()) } else { value.len() };
    value.get(..end).map(str::trim)
}

/// The place of the first invisible character of a line outside of quotation marks and comments, with what to do.
fn invisible(line: &str) -> Option<(usize, String)> {
    let code = line.split('#').next().unwrap_or_default();
    let is_quoted = |place: usize| code.get(..place).is_some_and(|before| before.matches('"').count() % 2 == 1);
    let said = |character: char| {
        let (name, advice) = match character {
            '\u{a0}' | '\u{2007}' | '\u{202f}' => ("a no-break space", "replace it by a plain space"),
            '\u{200b}'..='\u{200f}' | '\u{2060}' | '\u{ad}' | '\u{feff}' => ("an invisible character", "remove it"),
            _ if character.is_whitespace() && !character.is_ascii() => {
                ("a space that is not a plain one", "replace it by a plain space")
            }
            _ => return None,
        };
        Some(format!("{name} (U+{:04X}) stands here; {advice}", u32::from(character)))
    };
    let mut unquoted = code.char_indices().filter(|(place, _)| !is_quoted(*place));
    unquoted.find_map(|(place, character)| Some((place, said(character)?)))
}

/// Advice that follows the parser's message on a text that is not TOML; empty for an unknown mistake.
fn syntax_hint(text: &str, offset: usize, line_start: usize, line: &str) -> String {
    let has_single = || text.lines().any(|line| line.trim_start().starts_with("[layer]"));
    let value = line.split_once('=').map(|(_, value)| value.split('#').next().unwrap_or_default().trim());
    if let Some(after) = text.get(offset..).and_then(|rest| rest.strip_prefix(',')) {
        if after.starts_with(|next: char| next.is_ascii_digit()) {
            "; a decimal has a point, not a comma".to_owned()
        } else {
            "; leave the comma out: each field has a line of its own".to_owned()
        }
    } else if (line.starts_with("[layer]") || line.starts_with("[[layer]]")) && has_single() {
        "; write `[[layer]]`, in double brackets, before the fields of each layer".to_owned()
    } else if value.is_some_and(|value| value.starts_with(CURLY_QUOTES)) {
        "; quotation marks are straight: \"".to_owned()
    } else if value.is_some_and(|value| value.contains('\\'))
        && text.get(line_start..offset + 1).is_some_and(|part| part.contains('\\'))
    {
        format!("; {SLASH_ADVICE}")
    } else if value == Some("") {
        "; the value after the `=` is missing".to_owned()
    } else if let Some(lower) = value.map(str::to_ascii_lowercase).filter(|value| value == "true" || value == "false") {
        format!("; write it in lower case: {lower}")
    } else if let Some(words) = value.filter(|value| are_bare_words(value)) {
        format!("; write a string in quotation marks: \"{}\"", brief(words))
    } else {
        String::new()
    }
}

/// Quotation marks that text editors put in place of straight ones.
const CURLY_QUOTES: [char; 6] = ['\u{201c}', '\u{201d}', '\u{201e}', '\u{2018}', '\u{2019}', '\u{ab}'];

/// Advice about a number with a unit.
pub(super) const UNIT_ADVICE: &str = "leave the unit out: the field's name has it";

/// Whether a value is a number with a unit behind it, as in `4 mm`.
pub fn has_unit(value: &str) -> bool {
    let is_of_unit = |character: char| character.is_alphabetic() || "°/".contains(character);
    let number = value.trim_end_matches(is_of_unit);
    number != value && number.trim_end().parse::<f64>().is_ok()
}

/// Whether a value is words that lack quotation marks.
fn are_bare_words(value: &str) -> bool {
    let is_of_words = |character: char| character.is_alphanumeric() || " _-./".contains(character);
    value.starts_with(char::is_alphabetic) && value.chars().all(is_of_words)
}

/// Describes the mistake of a number with a unit or a percent sign behind it.
fn no_number(value: &str) -> Option<String> {
    let advice = if has_unit(value) {
        UNIT_ADVICE.to_owned()
    } else {
        let percent: f64 = value.strip_suffix('%')?.trim().parse().ok()?;
        format!("write the part as a number: {}", digits(percent / 100.0, f64::round))
    };
    Some(format!("`{}` is not a number; {advice}", brief(value)))
}
