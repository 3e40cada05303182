//! The text of a scene file, and where in it something stands.

/// Name and text of a scene file: all that a message about it needs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Source {
    name: String,
    text: String,
}

impl Source {
    pub(super) fn new(name: &str, text: &str) -> Self {
        Self { name: name.to_owned(), text: text.to_owned() }
    }

    /// The file as messages call it.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Line and column of a byte, both from one; the column counts characters.
    pub(super) fn line_and_column(&self, offset: usize) -> (usize, usize) {
        let before = self.text.get(..offset).unwrap_or(&self.text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.matches('\n').count() + 1;
        let column = before.get(line_start..).map_or(0, |start| start.chars().count()) + 1;
        (line, column)
    }

    /// The key, value or table head that begins at a byte; of one that goes over several lines, the first.
    pub(super) fn word_at(&self, offset: usize) -> &str {
        let line = self.text.get(offset..).and_then(|rest| rest.lines().next()).unwrap_or_default();
        let end = match line.chars().next() {
            Some(quote @ ('"' | '\'')) => line.get(1..).and_then(|rest| rest.find(quote)).map(|len| len + 2),
            Some('[') => line.rfind(']').map(|last| last + 1),
            Some('{') => line.rfind('}').map(|last| last + 1),
            _ => line.find([' ', '\t', '=', ',', ']', '}', '#']),
        };
        end.and_then(|end| line.get(..end)).unwrap_or(line).trim_end()
    }
}

/// Where a table and its fields stand in the file, as byte offsets.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Places {
    table: usize,
    fields: Vec<(&'static str, usize)>,
}

impl Places {
    pub(super) fn new(table: usize) -> Self {
        Self { table, fields: Vec::new() }
    }

    pub(super) fn add(&mut self, field: &'static str, offset: usize) {
        self.fields.push((field, offset));
    }

    /// Where the table starts.
    pub(super) fn table(&self) -> usize {
        self.table
    }

    /// Where a field's value stands, or the table where the file leaves the field out.
    pub(super) fn field(&self, field: &str) -> usize {
        self.fields.iter().find(|(name, _)| *name == field).map_or(self.table, |(_, offset)| *offset)
    }

    /// The first of some fields that the file has, or the first of all where it has none.
    pub(super) fn first_of(&self, fields: [&'static str; 3]) -> &'static str {
        let [first, ..] = fields;
        fields.into_iter().find(|field| self.has(field)).unwrap_or(first)
    }

    /// Whether the file has the field.
    pub(super) fn has(&self, field: &str) -> bool {
        self.fields.iter().any(|(name, _)| *name == field)
    }
}
