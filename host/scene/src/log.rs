//! Collects the diagnostics of reading and compiling a scene.

use super::compile_error::{CompileError, MISTAKES_MAX};
use super::diagnostic::{Diagnostic, DiagnosticKind, Message};
use super::grammar::KnownTable;
use super::layer::Layer;
use super::mistake::Mistake;
use super::optimisation::Optimisation;
use super::source::Source;
use super::warning::Warning;

/// Collects diagnostics, so that all mistakes are reported at once.
pub(super) struct Log<'s> {
    source: &'s Source,
    /// `Mistake` while a scene is read, `Refusal` while it is compiled.
    kind: DiagnosticKind,
    /// The layer that is read or compiled.
    layer: Option<usize>,
    /// Mistakes and refusals without repetitions. One more than are reported stands for all others.
    mistakes: Vec<Diagnostic>,
    /// Warnings and notes, in the order they were added.
    remarks: Vec<Diagnostic>,
    /// Number of added mistakes, including repetitions.
    added: usize,
    /// The known fields of each table, in the order of closing; `None` except for making a schema.
    described: Option<Vec<KnownTable>>,
}

impl<'s> Log<'s> {
    pub(super) fn new(source: &'s Source) -> Self {
        let (layer, mistakes, remarks, added, described) = Default::default();
        Self { source, kind: DiagnosticKind::Mistake, layer, mistakes, remarks, added, described }
    }

    /// A log that starts with the mistakes found while reading the scene.
    pub(super) fn resuming(source: &'s Source, mistakes: &[Diagnostic]) -> Self {
        Self { mistakes: mistakes.to_vec(), added: mistakes.len(), ..Self::new(source) }
    }

    /// The same log for compiling the scene: mistakes become refusals.
    pub(super) fn of_refusals(self) -> Self {
        Self { kind: DiagnosticKind::Refusal, ..self }
    }

    /// A log of the same files whose mistakes do not count.
    pub(super) fn scratch(&self) -> Self {
        Self { kind: self.kind, layer: self.layer, ..Self::new(self.source) }
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

    /// Whether this log keeps the known fields of tables, so that mistakes do not matter.
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

    /// Sets the current layer, by the number of its table. Further diagnostics refer to it.
    pub(super) fn set_layer(&mut self, layer: Option<usize>) {
        self.layer = layer;
    }

    /// Adds a mistake at a byte offset of the files. A repetition is counted, but not reported: layers that share a
    /// field share its mistakes.
    pub(super) fn add(&mut self, offset: usize, mistake: impl Into<Mistake>) {
        if self.mistakes.len() > MISTAKES_MAX {
            self.added += 1;
            return;
        }
        let diagnostic = self.diagnostic(self.kind, offset, self.layer, Message::Mistake(mistake.into()));
        self.add_mistake(diagnostic);
    }

    /// Adds a warning about a byte offset of the files.
    pub(super) fn warn(&mut self, offset: usize, warning: Warning) {
        self.remark(DiagnosticKind::Warning, offset, self.layer, warning);
    }

    /// Adds a warning about a layer.
    pub(super) fn warn_about(&mut self, layer: &Layer, warning: Warning) {
        self.remark(DiagnosticKind::Warning, layer.places.table(), Some(layer.number().table), warning);
    }

    /// Adds a note about a byte offset of the files.
    pub(super) fn note(&mut self, offset: usize, sentence: String) {
        self.remark(DiagnosticKind::Note, offset, self.layer, Message::Note(sentence));
    }

    /// Notes that a layer, or a part of it, is not needed.
    pub(super) fn note_optimisation(&mut self, layer: &Layer, optimisation: Optimisation) {
        self.remark(DiagnosticKind::Note, layer.places.table(), Some(layer.number().table), optimisation);
    }

    fn remark(&mut self, kind: DiagnosticKind, offset: usize, layer: Option<usize>, message: impl Into<Message>) {
        let diagnostic = self.diagnostic(kind, offset, layer, message.into());
        self.remarks.push(diagnostic);
    }

    fn diagnostic(&self, kind: DiagnosticKind, offset: usize, layer: Option<usize>, message: Message) -> Diagnostic {
        let (line, column) = self.source.line_and_column(offset);
        let (file, text) = (self.source.name_at(offset).to_owned(), self.source.word_at(offset).to_owned());
        Diagnostic { kind, file, line, column, text, layer, message }
    }

    /// Adds the mistakes of another log of the same files.
    pub(super) fn extend(&mut self, other: Self) {
        for mistake in other.mistakes {
            self.add_mistake(mistake);
        }
    }

    fn add_mistake(&mut self, mistake: Diagnostic) {
        self.added += 1;
        if self.mistakes.len() <= MISTAKES_MAX && !self.mistakes.iter().any(|other| other.repeats(&mistake)) {
            self.mistakes.push(mistake);
        }
    }

    /// Returns the value if there are no mistakes, otherwise the mistakes.
    pub(super) fn finish<T>(self, value: Option<T>) -> Result<T, CompileError> {
        match value {
            Some(value) if self.mistakes.is_empty() => Ok(value),
            _ => {
                let file = self.source.name().to_owned();
                Err(CompileError::new(file, self.into_mistakes()))
            }
        }
    }

    /// Mistakes and refusals in the order of the scene file, followed by those of included files. There may be one more
    /// than are reported.
    pub(super) fn into_mistakes(self) -> Vec<Diagnostic> {
        let files = self.source.files();
        let number = |mistake: &Diagnostic| files.iter().position(|file| file.name == mistake.file);
        let mut mistakes = self.mistakes;
        mistakes.sort_by_key(|mistake| (number(mistake), mistake.line, mistake.column));
        mistakes
    }

    /// All diagnostics: mistakes and refusals in the order of the files, then warnings and notes.
    pub(super) fn into_diagnostics(mut self) -> Vec<Diagnostic> {
        let remarks = std::mem::take(&mut self.remarks);
        let mut diagnostics = self.into_mistakes();
        diagnostics.extend(remarks);
        diagnostics
    }

    /// Number of mistakes so far. A shared mistake counts once for each layer.
    pub(super) fn mistakes(&self) -> usize {
        self.added
    }
}
