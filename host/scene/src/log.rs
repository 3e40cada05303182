//! Collects mistakes while a scene is read and compiled.

use super::compile_error::{CompileError, Located, MISTAKES_MAX};
use super::grammar::KnownTable;
use super::mistake::Mistake;
use super::source::Source;

/// Collects mistakes, so that a person sees all of them at once.
pub(super) struct Log<'s> {
    source: &'s Source,
    /// The mistakes, each one once. One more than are reported stands for all others.
    mistakes: Vec<Located>,
    /// How many mistakes were added, those that were there already included.
    added: usize,
    /// The known fields of each table, in the order in which tables were closed; `None` except while a schema is made.
    described: Option<Vec<KnownTable>>,
}

impl<'s> Log<'s> {
    pub(super) fn new(source: &'s Source) -> Self {
        Self { source, mistakes: Vec::new(), added: 0, described: None }
    }

    /// A log that starts with the mistakes that were found before.
    pub(super) fn resuming(source: &'s Source, mistakes: &[Located]) -> Self {
        Self { mistakes: mistakes.to_vec(), added: mistakes.len(), ..Self::new(source) }
    }

    /// A log of the same file whose mistakes do not count.
    pub(super) fn scratch(&self) -> Self {
        Self::new(self.source)
    }

    /// A log that keeps the known fields of each table.
    pub(super) fn describing(source: &'s Source) -> Self {
        Self { described: Some(Vec::new()), ..Self::new(source) }
    }

    /// Keeps the known fields of a table, if this log keeps them.
    pub(super) fn describe(&mut self, table: impl FnOnce() -> KnownTable) {
        if let Some(described) = &mut self.described {
            described.push(table());
        }
    }

    /// Whether this log keeps the known fields of tables, so that its mistakes do not matter.
    pub(super) fn is_describing(&self) -> bool {
        self.described.is_some()
    }

    /// The known fields of each table.
    pub(super) fn into_described(self) -> Vec<KnownTable> {
        self.described.unwrap_or_default()
    }

    /// The files that are read.
    pub(super) fn source(&self) -> &'s Source {
        self.source
    }

    /// Adds a mistake at a byte offset of the files. A mistake that is there already is reported once, but counted
    /// again: layers that share a field share its mistakes.
    pub(super) fn add(&mut self, offset: usize, mistake: impl Into<Mistake>) {
        if self.mistakes.len() > MISTAKES_MAX {
            self.added += 1;
            return;
        }
        let (line, column) = self.source.line_and_column(offset);
        let (file, text) = (self.source.name_at(offset).to_owned(), self.source.word_at(offset).to_owned());
        self.add_located(Located { file, line, column, text, mistake: mistake.into() });
    }

    /// Adds the mistakes of another log of the same files.
    pub(super) fn extend(&mut self, other: Self) {
        for located in other.mistakes {
            self.add_located(located);
        }
    }

    fn add_located(&mut self, located: Located) {
        self.added += 1;
        if self.mistakes.len() <= MISTAKES_MAX && !self.mistakes.contains(&located) {
            self.mistakes.push(located);
        }
    }

    /// The value if there are no mistakes, otherwise the mistakes.
    pub(super) fn finish<T>(self, value: Option<T>) -> Result<T, CompileError> {
        match value {
            Some(value) if self.mistakes.is_empty() => Ok(value),
            _ => {
                let file = self.source.name().to_owned();
                Err(CompileError::new(file, self.into_mistakes()))
            }
        }
    }

    /// The mistakes, in the order of the scene file, then of those that it includes. There may be one more than are
    /// reported.
    pub(super) fn into_mistakes(mut self) -> Vec<Located> {
        let files = self.source.files();
        let number = |mistake: &Located| files.iter().position(|file| file.name == mistake.file);
        self.mistakes.sort_by_key(|mistake| (number(mistake), mistake.line, mistake.column));
        self.mistakes
    }

    /// Number of mistakes so far. A mistake that several layers share counts for each of them.
    pub(super) fn mistakes(&self) -> usize {
        self.added
    }
}
