//! Which fields of a table go together: found by giving the parser every choice that the table has.

use super::super::asked::{Asked, AskedTable, Holds};
use super::super::file::describe;

/// A text around the fields of a table, and the field that the table stands in.
pub(super) struct Tables<'t> {
    pub(super) before: &'t str,
    pub(super) after: &'t str,
    pub(super) key: &'t str,
}

/// A set of fields that goes together.
pub(super) struct Variant {
    pub(super) table: AskedTable,
    /// The choices that lead to it; those that change nothing are left out.
    pub(super) parts: Vec<Part>,
}

/// Values of a field that all lead to the same fields.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) field: &'static str,
    /// The field is a table; there are no words.
    pub(super) table: bool,
    pub(super) words: Vec<&'static str>,
    /// It may be left out.
    pub(super) absent: bool,
}

impl Tables<'_> {
    /// What is asked for when these fields stand in the table.
    fn asked(&self, fields: &[String]) -> Option<AskedTable> {
        let comma = if self.before.ends_with('{') { "" } else { ", " };
        let fields = if fields.is_empty() { String::new() } else { format!("{comma}{}", fields.join(", ")) };
        let tables = describe(&format!("{}{fields}{}", self.before, self.after));
        tables.into_iter().find(|table| table.key == self.key)
    }
}

impl Part {
    /// One of the values, as it is written; nothing where it is left out.
    fn written(&self) -> Option<String> {
        match (self.absent, self.table, self.words.first()) {
            (true, ..) => None,
            (false, true, _) => Some(format!("{} = {{}}", self.field)),
            (false, false, word) => word.map(|word| format!("{} = \"{word}\"", self.field)),
        }
    }
}

/// Every set of fields that goes together in a table.
pub(super) fn variants(tables: &Tables) -> Vec<Variant> {
    let Some(plain) = tables.asked(&[]) else { return Vec::new() };
    let mut chosen: Vec<Vec<Part>> = vec![Vec::new()];
    for asked in &plain.asked {
        let parts = parts(tables, asked, &plain);
        if parts.len() > 1 {
            let extended = chosen
                .iter()
                .flat_map(|before| parts.iter().map(|part| before.iter().chain([part]).cloned().collect()));
            chosen = extended.collect();
        }
    }
    let variant = |parts: Vec<Part>| {
        let written: Vec<String> = parts.iter().filter_map(Part::written).collect();
        tables.asked(&written).map(|table| Variant { table, parts })
    };
    chosen.into_iter().filter_map(variant).collect()
}

/// The values of a field, those together that lead to the same fields.
fn parts(tables: &Tables, asked: &Asked, plain: &AskedTable) -> Vec<Part> {
    let Asked { field, holds } = asked;
    let part = |table, words: &[&'static str], absent| Part { field, table, words: words.to_vec(), absent };
    // A field that cannot be left out is only asked for.
    let absent = !plain.required.contains(field);
    match holds {
        Holds::Choice(words) if *field != "kind" => {
            let mut parts = vec![(plain.clone(), part(false, &[], absent))];
            for word in words {
                let Some(table) = tables.asked(&[format!("{field} = \"{word}\"")]) else { continue };
                match parts.iter_mut().find(|(known, _)| *known == table) {
                    Some((_, part)) => part.words.push(word),
                    None => parts.push((table, part(false, &[word], false))),
                }
            }
            parts.into_iter().map(|(_, part)| part).collect()
        }
        Holds::Table if absent => {
            let table = tables.asked(&[format!("{field} = {{}}")]);
            let changes = table.is_some_and(|table| table != *plain);
            if changes { vec![part(true, &[], true), part(true, &[], false)] } else { Vec::new() }
        }
        _ => Vec::new(),
    }
}
