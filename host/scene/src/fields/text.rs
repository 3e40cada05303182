//! Parses the text of a file to its fields.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::{Fields, misplaced};
use crate::compile_error::CompileError;
use crate::file_kind::FileKind;
use crate::log::Log;
use crate::mistake::FileMistake;
use crate::source::{Source, SourceFile};
use crate::toml_text::toml;

/// Reads a file of a kind: `read` gets its fields, and messages call the file `name`.
pub(crate) fn read_text<T>(
    kind: FileKind,
    bytes: &[u8],
    name: &str,
    read: impl FnOnce(Fields, &mut Log) -> Option<T>,
) -> Result<T, CompileError> {
    let source = Source::new(name, kind.text(bytes, name)?);
    let mut log = Log::new(&source);
    let fields = source.files().first().and_then(|file| parsed(file, &mut log));
    let value = fields.and_then(|values| read(Fields::new(format!("this {}", kind.name()), 0, values), &mut log));
    log.finish(value)
}

/// The fields of a file, at their offsets in the source; `None` after a mistake, which has been logged.
pub(crate) fn parsed<'i>(file: &'i SourceFile, log: &mut Log) -> Option<DeTable<'i>> {
    match toml(&file.text) {
        Ok(values) => Some(moved_table(values, file.start)),
        Err((offset, mistake)) => {
            let (offset, mistake) = match mistake {
                FileMistake::Syntax(reason) => {
                    let (offset, reason) = misplaced::explained(&file.text, offset, &reason);
                    (offset, FileMistake::Syntax(reason))
                }
                other => (offset, other),
            };
            log.add(file.start + offset, mistake);
            None
        }
    }
}

/// A table whose offsets all are larger by `start`.
fn moved_table(table: DeTable, start: usize) -> DeTable {
    let moved = |span: Range<usize>| span.start + start..span.end + start;
    let fields = table.into_iter().map(|(key, value)| {
        let (key_span, span) = (moved(key.span()), moved(value.span()));
        (Spanned::new(key_span, key.into_inner()), Spanned::new(span, moved_value(value.into_inner(), start)))
    });
    fields.collect()
}

fn moved_value(value: DeValue, start: usize) -> DeValue {
    match value {
        DeValue::Table(table) => DeValue::Table(moved_table(table, start)),
        DeValue::Array(array) => {
            let mut moved = DeArray::new();
            for value in array {
                let span = value.span().start + start..value.span().end + start;
                moved.push(Spanned::new(span, moved_value(value.into_inner(), start)));
            }
            DeValue::Array(moved)
        }
        other => other,
    }
}
