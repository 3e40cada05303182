//! What `docs/scene.md` says of a field, for an editor to show.

use std::collections::HashMap;

const DOCS: &str = include_str!("../../../../docs/scene.md");

/// The meanings of fields, by the heading that they stand under.
pub(super) struct Meanings(HashMap<String, HashMap<String, String>>);

/// The meanings of one table's fields, from the nearest heading to the most general one.
pub(super) struct Section<'m>(Vec<&'m HashMap<String, String>>);

impl Meanings {
    /// Reads the tables of the docs: fields in the first column, what they mean in the second.
    pub(super) fn of_docs() -> Self {
        let mut sections: HashMap<String, HashMap<String, String>> = HashMap::new();
        let mut heading = String::new();
        for line in DOCS.lines() {
            if let Some(title) = line.strip_prefix('#') {
                heading = title.trim_start_matches('#').trim().trim_matches(['`', '[', ']']).to_lowercase();
            }
            let Some(row) = line.strip_prefix('|') else { continue };
            let mut cells = row.split('|');
            let (Some(fields), Some(meaning)) = (cells.next(), cells.next()) else { continue };
            let meaning = plain(meaning);
            for field in fields.split('`').skip(1).step_by(2).filter(|_| !meaning.is_empty()) {
                sections.entry(heading.clone()).or_default().insert(field.to_owned(), meaning.clone());
            }
        }
        Self(sections)
    }

    /// The fields under a heading.
    pub(super) fn section(&self, heading: &str) -> Section<'_> {
        Section(self.0.get(heading).into_iter().collect())
    }

    /// The fields of a kind of layer, and those of every layer.
    pub(super) fn layer(&self, kind: &str) -> Section<'_> {
        Section([self.0.get(kind), self.0.get("layers")].into_iter().flatten().collect())
    }
}

impl Section<'_> {
    pub(super) fn of(&self, field: &str) -> Option<String> {
        self.0.iter().find_map(|meanings| meanings.get(field)).cloned()
    }
}

/// A cell without its links.
fn plain(cell: &str) -> String {
    let mut text = String::new();
    for (number, part) in cell.trim().split("](").enumerate() {
        let rest = if number == 0 { part } else { part.split_once(')').map_or("", |(_, rest)| rest) };
        text.push_str(rest);
    }
    text.replace('[', "")
}
