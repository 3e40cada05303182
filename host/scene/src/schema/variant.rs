//! Finds the fields of a table that can occur together: the parser reads the table with each possible choice.

use super::super::file::describe;
use super::super::grammar::{Holds, KnownField, KnownTable};
use super::super::kinds::KindName;
use super::super::tables::layer::KIND;

/// Scene text into which fields are inserted, between `before` and `after`; `key` is the field that holds the table.
pub(in super::super) struct Tables<'t> {
    pub(in super::super) before: &'t str,
    pub(in super::super) after: &'t str,
    pub(in super::super) key: &'t str,
}

/// A set of fields that can occur together.
pub(in super::super) struct Variant {
    pub(in super::super) table: KnownTable,
    /// The choices that lead to this set; choices without effect are omitted.
    pub(in super::super) parts: Vec<Part>,
}

/// Values of a field that lead to the same set of fields.
#[derive(Clone)]
pub(in super::super) struct Part {
    pub(in super::super) field: &'static str,
    /// Whether the field is a table.
    pub(in super::super) table: bool,
    pub(in super::super) words: Vec<&'static str>,
    /// Whether the field may be absent.
    pub(in super::super) absent: bool,
}

impl Tables<'_> {
    /// The fields that the parser reads if the table contains `fields`.
    fn known(&self, fields: &[String]) -> Option<KnownTable> {
        let comma = if self.before.ends_with('{') { "" } else { ", " };
        let fields = if fields.is_empty() { String::new() } else { format!("{comma}{}", fields.join(", ")) };
        let tables = describe(&format!("{}{fields}{}", self.before, self.after));
        tables.into_iter().find(|table| table.key == self.key)
    }
}

impl Part {
    /// One of the values as written in a file; `None` if the field is absent.
    fn written(&self) -> Option<String> {
        match (self.absent, self.table, self.words.first()) {
            (true, ..) => None,
            (false, true, _) => Some(format!("{} = {{}}", self.field)),
            (false, false, word) => word.map(|word| format!("{} = \"{word}\"", self.field)),
        }
    }
}

/// All sets of fields that can occur together in a table.
pub(in super::super) fn variants(tables: &Tables) -> Vec<Variant> {
    let Some(plain) = tables.known(&[]) else { return Vec::new() };
    let mut chosen: Vec<Vec<Part>> = vec![Vec::new()];
    for known in &plain.fields {
        let parts = parts(tables, known, &plain);
        if parts.len() > 1 {
            let extended = chosen
                .iter()
                .flat_map(|before| parts.iter().map(|part| before.iter().chain([part]).cloned().collect()));
            chosen = extended.collect();
        }
    }
    let variant = |parts: Vec<Part>| {
        let written: Vec<String> = parts.iter().filter_map(Part::written).collect();
        tables.known(&written).map(|table| Variant { table, parts })
    };
    chosen.into_iter().filter_map(variant).collect()
}

/// The values of a field, grouped by the set of fields that they lead to.
fn parts(tables: &Tables, known: &KnownField, plain: &KnownTable) -> Vec<Part> {
    let KnownField { field, words } = known;
    let name = field.name;
    let part = |table, words: &[&'static str], absent| Part { field: name, table, words: words.to_vec(), absent };
    let absent = !plain.required.contains(&name);
    match field.holds {
        Holds::Word if *field != KIND => {
            let mut parts = vec![(plain.clone(), part(false, &[], absent))];
            for word in words {
                let Some(table) = tables.known(&[format!("{name} = \"{word}\"")]) else { continue };
                match parts.iter_mut().find(|(other, _)| *other == table) {
                    Some((_, part)) => part.words.push(word),
                    None => parts.push((table, part(false, &[word], false))),
                }
            }
            parts.into_iter().map(|(_, part)| part).collect()
        }
        Holds::Table if absent => {
            let table = tables.known(&[format!("{name} = {{}}")]);
            let changes = table.is_some_and(|table| table != *plain);
            if changes { vec![part(true, &[], true), part(true, &[], false)] } else { Vec::new() }
        }
        _ => Vec::new(),
    }
}

/// Every field of any kind of layer, with all words that it can hold in any kind.
pub(in super::super) fn known_layer_fields() -> Vec<KnownField> {
    let mut all: Vec<KnownField> = Vec::new();
    for (kind, _) in KindName::ALL {
        let before = format!("layer = [{{ kind = \"{kind}\"");
        let variants = variants(&Tables { before: &before, after: "}]", key: "layer" });
        for known in variants.into_iter().flat_map(|variant| variant.table.fields) {
            match all.iter_mut().find(|other| other.field.name == known.field.name) {
                Some(other) => {
                    let new = known.words.into_iter().filter(|word| !other.words.contains(word));
                    let new: Vec<_> = new.collect();
                    other.words.extend(new);
                }
                None => all.push(known),
            }
        }
    }
    all
}
