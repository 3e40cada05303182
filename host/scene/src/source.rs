//! The text of a scene file, and places in it.

/// Name and text of a scene file, for messages about it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Source {
    name: String,
    text: String,
}

impl Source {
    pub(super) fn new(name: &str, text: &str) -> Self {
        Self { name: name.to_owned(), text: text.to_owned() }
    }

    /// The name of the file in messages.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Line and column of a byte offset, both from one. The column counts characters.
    pub(super) fn line_and_column(&self, offset: usize) -> (usize, usize) {
        let before = self.text.get(..offset).unwrap_or(&self.text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.matches('\n').count() + 1;
        let column = before.get(line_start..).map_or(0, |start| start.chars().count()) + 1;
        (line, column)
    }

    /// The key, value or table header at a byte offset; only its first line if it has several.
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

/// Byte offsets of a table and its fields.
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

    /// Offset of the table.
    pub(super) fn table(&self) -> usize {
        self.table
    }

    /// Offset of a field's value, or of the table if the file does not have the field.
    pub(super) fn field(&self, field: &str) -> usize {
        self.fields.iter().find(|(name, _)| *name == field).map_or(self.table, |(_, offset)| *offset)
    }

    /// The first of these fields that the file has, or the first of the list if the file has none of them.
    pub(super) fn first_of(&self, fields: [&'static str; 3]) -> &'static str {
        let [first, ..] = fields;
        fields.into_iter().find(|field| self.has(field)).unwrap_or(first)
    }

    /// Whether the file has the field.
    pub(super) fn has(&self, field: &str) -> bool {
        self.fields.iter().any(|(name, _)| *name == field)
    }
}
