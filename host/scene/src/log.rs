//! Collects mistakes while a scene is read and compiled.

use super::compile_error::{CompileError, Located};
use super::grammar::KnownTable;
use super::mistake::Mistake;
use super::source::Source;

/// Collects mistakes, so that a person sees all of them at once.
pub(super) struct Log<'s> {
    source: &'s Source,
    mistakes: Vec<Located>,
    /// The known fields of each table, in the order in which tables were closed; `None` except while a schema is made.
    described: Option<Vec<KnownTable>>,
}

impl<'s> Log<'s> {
    pub(super) fn new(source: &'s Source) -> Self {
        Self { source, mistakes: Vec::new(), described: None }
    }

    /// A log that starts with the mistakes that were found before.
    pub(super) fn resuming(source: &'s Source, mistakes: &[Located]) -> Self {
        Self { mistakes: mistakes.to_vec(), ..Self::new(source) }
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

    /// The known fields of each table.
    pub(super) fn into_described(self) -> Vec<KnownTable> {
        self.described.unwrap_or_default()
    }

    /// Adds a mistake at a byte offset of the file.
    pub(super) fn add(&mut self, offset: usize, mistake: Mistake) {
        let (line, column) = self.source.line_and_column(offset);
        let text = self.source.word_at(offset).to_owned();
        self.mistakes.push(Located { line, column, text, mistake });
    }

    /// The value if there are no mistakes, otherwise the mistakes.
    pub(super) fn finish<T>(self, value: Option<T>) -> Result<T, CompileError> {
        match value {
            Some(value) if self.mistakes.is_empty() => Ok(value),
            _ => {
                let file = self.source.name().to_owned();
                Err(CompileError { file, mistakes: self.into_mistakes() })
            }
        }
    }

    /// The mistakes, in the order of the file.
    pub(super) fn into_mistakes(mut self) -> Vec<Located> {
        self.mistakes.sort_by_key(|mistake| (mistake.line, mistake.column));
        self.mistakes
    }

    /// The mistake that was added last.
    pub(super) fn last(&self) -> Option<&Mistake> {
        self.mistakes.last().map(|located| &located.mistake)
    }

    /// Number of mistakes so far.
    pub(super) fn mistakes(&self) -> usize {
        self.mistakes.len()
    }
}
