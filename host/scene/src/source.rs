//! The texts of a scene file and its included files, and places in them.

use super::files::file_name;

/// The files that a scene is read from, for use in messages. A place is a byte offset from the start of the first file;
/// each file begins after the previous one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Source {
    files: Vec<SourceFile>,
}

/// A file of a scene.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SourceFile {
    /// The name of the file in messages.
    pub(super) name: String,
    /// The name of the file from the scene file's folder.
    pub(super) path: String,
    pub(super) text: String,
    /// Offset of the file's first byte.
    pub(super) start: usize,
    /// Numbers of the included files.
    pub(super) includes: Vec<usize>,
    lines: Lines,
}

/// The lines of a text.
#[derive(Clone, Debug, PartialEq)]
pub struct Lines {
    /// Offsets of all lines but the first.
    starts: Vec<usize>,
}

impl Lines {
    /// The lines of `text`.
    pub fn of(text: &str) -> Self {
        Self { starts: text.match_indices('\n').map(|(newline, _)| newline + 1).collect() }
    }

    /// Line and column of a byte offset in the text, both from one. The column counts characters.
    pub fn line_and_column(&self, text: &str, offset: usize) -> (usize, usize) {
        let line = self.starts.partition_point(|start| *start <= offset);
        let line_start = line.checked_sub(1).and_then(|last| self.starts.get(last)).copied().unwrap_or(0);
        let column = text.get(line_start..offset).map_or(0, |start| start.chars().count());
        (line + 1, column + 1)
    }
}

impl Source {
    pub(super) fn new(name: &str, text: &str) -> Self {
        let mut source = Self { files: Vec::new() };
        source.add(name.to_owned(), file_name(name).to_owned(), text.to_owned());
        source
    }

    /// Adds a file, and returns its number.
    pub(super) fn add(&mut self, name: String, path: String, text: String) -> usize {
        // One more than the text's length, so that the end of a file is a distinct place.
        let start = self.files.last().map_or(0, |last| last.start + last.text.len() + 1);
        let lines = Lines::of(&text);
        self.files.push(SourceFile { name, path, text, start, includes: Vec::new(), lines });
        self.files.len() - 1
    }

    /// Records that file `number` includes file `included`.
    pub(super) fn include(&mut self, number: usize, included: usize) {
        if let Some(file) = self.files.get_mut(number) {
            file.includes.push(included);
        }
    }

    /// The scene file, and the files that it includes.
    pub(super) fn files(&self) -> &[SourceFile] {
        &self.files
    }

    /// The name in messages of the file that includes file `number`.
    pub(super) fn includer(&self, number: usize) -> &str {
        self.files.iter().find(|file| file.includes.contains(&number)).map_or(self.name(), |file| &file.name)
    }

    /// The name of the scene file in messages.
    pub(super) fn name(&self) -> &str {
        self.files.first().map_or("", |file| &file.name)
    }

    /// Number of the file at a byte offset.
    pub(super) fn number_at(&self, offset: usize) -> usize {
        self.files.partition_point(|file| file.start <= offset).saturating_sub(1)
    }

    /// The name in messages of the file at a byte offset.
    pub(super) fn name_at(&self, offset: usize) -> &str {
        self.files.get(self.number_at(offset)).map_or("", |file| &file.name)
    }

    /// The path of a file named at a byte offset, relative to the scene file's folder. Names in a file are relative to
    /// its own folder.
    pub(super) fn path_at(&self, offset: usize, name: &str) -> String {
        match self.number_at(offset) {
            _ if name.is_empty() => String::new(),
            0 => name.to_owned(),
            number => joined(self.files.get(number).map_or("", |file| &file.path), name),
        }
    }

    fn text_at(&self, offset: usize) -> (&str, usize) {
        self.files.get(self.number_at(offset)).map_or(("", 0), |file| (&file.text, offset - file.start))
    }

    /// Line and column of a byte offset in its file, both from one. The column counts characters.
    pub(super) fn line_and_column(&self, offset: usize) -> (usize, usize) {
        let file = self.files.get(self.number_at(offset));
        file.map_or((1, 1), |file| file.lines.line_and_column(&file.text, offset - file.start))
    }

    /// The key, value or table header at a byte offset; only its first line if it has several.
    pub(super) fn word_at(&self, offset: usize) -> &str {
        let (text, offset) = self.text_at(offset);
        let line = text.get(offset..).and_then(|rest| rest.lines().next()).unwrap_or_default();
        let end = match line.chars().next() {
            Some(quote @ ('"' | '\'')) => line.get(1..).and_then(|rest| rest.find(quote)).map(|len| len + 2),
            Some('[') => line.rfind(']').map(|last| last + 1),
            Some('{') => line.rfind('}').map(|last| last + 1),
            _ => line.find([' ', '\t', '=', ',', ']', '}', '#']),
        };
        end.and_then(|end| line.get(..end)).unwrap_or(line).trim_end()
    }
}

/// The path of a file called `name` by the file at `path`, without `.` and, where possible, without `..`, so that each
/// file has one path. An absolute name does not depend on `path`.
pub(super) fn joined(path: &str, name: &str) -> String {
    let is_absolute = name.starts_with(['/', '\\']) || name.get(1..2) == Some(":");
    let folder = if is_absolute { "" } else { path.strip_suffix(file_name(path)).unwrap_or_default() };
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(name.split('/')) {
        match part {
            "" | "." => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    let root = if folder.starts_with('/') || name.starts_with('/') { "/" } else { "" };
    format!("{root}{}", parts.join("/"))
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

    /// Whether the file has a field whose name ends in a unit.
    pub(super) fn has_unit(&self, unit: &str) -> bool {
        self.fields.iter().any(|(name, _)| name.ends_with(unit))
    }

    /// Whether the file has the field.
    pub(super) fn has(&self, field: &str) -> bool {
        self.fields.iter().any(|(name, _)| *name == field)
    }
}
