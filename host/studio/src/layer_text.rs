//! The text of a scene as the map edits it: values that are read, and layers that change while all else stays as it is
//! written, byte by byte.
//!
//! The reader of TOML is the compiler's, which gives the place of each value. `toml_edit` would be a second one in the
//! module (48 KB gzipped, more than `<frixel-scene>` has room for), and moves dotted keys that stand apart.

mod json;
mod node;
mod tables;

use std::ops::Range;

use serde_json::{Map, Value};
use thiserror::Error;

pub(crate) use json::of as json;
use node::{Form, Node, entries, parsed};

/// Name of the layers in a scene.
const LAYER: &str = "layer";
/// Divides the parts of a request. No text of TOML has it.
const BETWEEN: char = '\0';
/// Divides the keys of a path.
const BETWEEN_KEYS: char = '\n';

/// Why a text cannot be read or changed.
#[derive(Debug, Error)]
pub enum TextError {
    /// It is not TOML.
    #[error("this is not TOML: {}", .0.message())]
    Toml(#[from] toml::de::Error),
    /// The page asks for something that this engine does not know. Only a mistake in the page leads to it.
    #[error("this engine does not know the page's request")]
    Request,
    /// A value would stand in a table that the text does not have.
    #[error("the text has no table {0}: write it first")]
    NoTable(String),
    /// The text has fewer layers.
    #[error("the text has no layer {}: the number of a layer counts from 1", .0 + 1)]
    NoLayer(usize),
}

/// A value at a path.
struct Change<'r> {
    /// Keys, and numbers of elements.
    path: Vec<&'r str>,
    /// The value as TOML.
    value: &'r str,
    /// The key behind which the value is added where the text does not have it; otherwise it comes last.
    after: &'r str,
}

/// Reads a text, as JSON: its `values`; the `lines` in which its layers begin, from 1; and the `fields` of each layer.
/// These include a default if the layer does not have that field in any unit. The request is the text, optionally
/// followed by a zero character and the defaults as `check` returns them.
pub(crate) fn read(request: &str) -> Result<String, TextError> {
    let (text, defaults) = request.split_once(BETWEEN).unwrap_or((request, "{}"));
    let defaults: Map<String, Value> = serde_json::from_str(defaults).map_err(|_| TextError::Request)?;
    let root = parsed(text)?;
    let (mut line, mut before) = (1, 0);
    let (mut lines, mut fields) = (Vec::new(), Vec::new());
    for layer in (0..).map_while(|at| layer(&root, at)) {
        let Range { start, .. } = layer.span();
        line += text.get(before..start).unwrap_or_default().matches('\n').count();
        before = start;
        lines.push(line.to_string());
        fields.push(json::with_defaults(layer.get_ref(), &defaults));
    }
    let (values, lines, fields) = (json(root.get_ref()), lines.join(","), fields.join(","));
    Ok(format!("{{\"values\":{values},\"lines\":[{lines}],\"fields\":[{fields}]}}"))
}

/// Carries out an edit, and returns the new text. The request has these parts, with a zero character between:
///
/// | parts | edit |
/// |---|---|
/// | `set`, text; path, value and the key before it, or nothing, of each change | values are changed or added |
/// | `copy`, text, number | a copy of a layer comes right behind it, without the comment above it |
/// | `remove`, text, number | a layer goes with the comment right above it; other comments and tables stay |
///
/// Values are TOML; a path has its keys and numbers of elements in lines.
pub(crate) fn edit(request: &str) -> Result<String, TextError> {
    let mut parts = request.split(BETWEEN);
    let (Some(act), Some(text)) = (parts.next(), parts.next()) else { return Err(TextError::Request) };
    let rest: Vec<&str> = parts.collect();
    let number = || rest.first().and_then(|at| at.parse().ok()).ok_or(TextError::Request);
    match act {
        "set" => rest.chunks(3).try_fold(text.to_owned(), |text, change| {
            let &[path, value, after] = change else { return Err(TextError::Request) };
            set(&text, &Change { path: path.split(BETWEEN_KEYS).collect(), value, after })
        }),
        "copy" => copy(text, number()?),
        "remove" => remove(text, number()?),
        _ => Err(TextError::Request),
    }
}

/// The value at a path.
fn found<'n, 't>(root: &'n Node<'t>, path: &[&str]) -> Option<&'n Node<'t>> {
    path.iter().try_fold(root, |node, key| match node.get_ref() {
        toml::de::DeValue::Array(elements) => elements.get(key.parse::<usize>().ok()?),
        value => value.get(*key),
    })
}

fn layer<'n, 't>(root: &'n Node<'t>, at: usize) -> Option<&'n Node<'t>> {
    root.get_ref().get(LAYER)?.get_ref().get(at)
}

/// A text in which a range is replaced.
fn replaced(text: &str, Range { start, end }: Range<usize>, insert: &str) -> String {
    [text.get(..start).unwrap_or_default(), insert, text.get(end..).unwrap_or_default()].concat()
}

/// Offset of the beginning of a line.
fn line_start(text: &str, offset: usize) -> usize {
    text.get(..offset).and_then(|before| before.rfind('\n')).map_or(0, |newline| newline + 1)
}

/// Offset of the end of a line, before its terminator.
fn line_end(text: &str, offset: usize) -> usize {
    text.get(offset..).and_then(|behind| behind.find('\n')).map_or(text.len(), |newline| offset + newline)
}

fn set(text: &str, change: &Change) -> Result<String, TextError> {
    let root = parsed(text)?;
    let Some(node) = found(&root, &change.path) else { return insert(text, &root, change) };
    if !node::is_value(text, node) {
        return Err(TextError::NoTable(change.path.join(".")));
    }
    let (before, value) = (text.get(node.span()).unwrap_or_default(), &change.value);
    match node::number(node.get_ref()) {
        Some(number) if value.parse() == Ok(number) => Ok(text.to_owned()),
        // A number keeps its point.
        Some(_) if before.contains('.') && !value.contains('.') => {
            Ok(replaced(text, node.span(), &format!("{value}.0")))
        }
        _ => Ok(replaced(text, node.span(), value)),
    }
}

/// Adds a value in the form that its table has.
fn insert(text: &str, root: &Node<'_>, change: &Change) -> Result<String, TextError> {
    let Change { path, value, after } = change;
    let no_table = || TextError::NoTable(path.split_last().map_or(String::new(), |(_, table)| table.join(".")));
    let Some((key, table_path)) = path.split_last() else { return Err(no_table()) };
    let node = found(root, table_path).ok_or_else(no_table)?;
    let table = node.get_ref().as_table().ok_or_else(no_table)?;
    let own: Vec<_> = entries(table).into_iter().filter(|(_, value)| node::is_value(text, value)).collect();
    let named = own.iter().find(|(own, _)| own.get_ref() == after);
    let Some((anchor, last)) = named.or(own.last()) else {
        return match Form::of(text, node) {
            Form::Inline => Ok(replaced(text, node.span(), &format!("{{ {key} = {value} }}"))),
            Form::Header => {
                let at = line_end(text, node.span().end);
                Ok(replaced(text, at..at, &format!("\n{key} = {value}")))
            }
            Form::Dotted => Err(no_table()),
        };
    };
    // Keys of the tables around it that stand in front of its own, as in `region.x_mm`.
    let around = (1..=table_path.len()).rev().filter_map(|len| table_path.get(..len));
    let form = |path: &[&str]| found(root, path).map_or(Form::Header, |node| Form::of(text, node));
    let is_inline = around.clone().map(form).find(|form| *form != Form::Dotted) == Some(Form::Inline);
    let dotted = around.take_while(|path| form(path) == Form::Dotted).filter_map(|path| path.last());
    let entry = dotted.fold(format!("{key} = {value}"), |entry, key| format!("{key}.{entry}"));
    if is_inline {
        return Ok(replaced(text, last.span().end..last.span().end, &format!(", {entry}")));
    }
    let line = text.get(line_start(text, anchor.span().start)..).unwrap_or_default();
    let indent = line.get(..line.len() - line.trim_start().len()).unwrap_or_default();
    let at = line_end(text, last.span().end);
    Ok(replaced(text, at..at, &format!("\n{indent}{entry}")))
}

/// The text with a layer behind all others, whose fields are lines.
pub(crate) fn add(text: &str, fields: &str) -> Result<String, TextError> {
    let root = parsed(text)?;
    let fields: Vec<&str> = fields.lines().collect();
    let layers = root.get_ref().get(LAYER).filter(|layers| node::is_value(text, layers));
    let Some((layers, elements)) = layers.and_then(|layers| Some((layers, layers.get_ref().as_array()?))) else {
        let gap = match text {
            "" => "",
            text if text.ends_with("\n\n") => "",
            text if text.ends_with('\n') => "\n",
            _ => "\n\n",
        };
        return Ok(format!("{text}{gap}[[{LAYER}]]\n{}\n", fields.join("\n")));
    };
    let element = format!("{{ {} }}", fields.join(", "));
    let behind_last = elements.last().map(|last| (last.span().end, format!(", {element}")));
    let (at, insert) = behind_last.unwrap_or((layers.span().start + 1, element));
    Ok(replaced(text, at..at, &insert))
}

fn copy(text: &str, at: usize) -> Result<String, TextError> {
    let root = parsed(text)?;
    let layer = layer(&root, at).ok_or(TextError::NoLayer(at))?;
    if Form::of(text, layer) == Form::Header {
        return Ok(tables::copied(text, &root, at));
    }
    let Range { start, end } = layer.span();
    let copy = text.get(start..end).unwrap_or_default();
    Ok(replaced(text, end..end, &format!(", {copy}")))
}

fn remove(text: &str, at: usize) -> Result<String, TextError> {
    let root = parsed(text)?;
    let layer = layer(&root, at).ok_or(TextError::NoLayer(at))?;
    if Form::of(text, layer) == Form::Header {
        return Ok(tables::without(text, &root, at));
    }
    Ok(without_element(text, &root, at, layer.span()))
}

/// A text without an element of the array of layers. The comment of the element before stays.
fn without_element(text: &str, root: &Node<'_>, at: usize, Range { start, end }: Range<usize>) -> String {
    if let Some(next) = layer(root, at + 1) {
        return replaced(text, start..next.span().start, "");
    }
    // Its own comma goes, and the comment behind that in the line.
    let behind = behind_comma(text, end).unwrap_or(end);
    let Some(previous) = at.checked_sub(1).and_then(|at| layer(root, at)).map(|previous| previous.span().end) else {
        return replaced(text, start..behind, "");
    };
    let between = text.get(previous..start).unwrap_or_default();
    if !between.contains('#') {
        return replaced(text, previous..end, "");
    }
    let rest = text.get(behind..line_end(text, behind)).unwrap_or_default();
    let behind = if rest.trim_start().starts_with('#') { behind + rest.len() } else { behind };
    let start = previous + between.trim_end_matches([' ', '\t']).len();
    let start = if text.get(..start).is_some_and(|before| before.ends_with('\n')) { start - 1 } else { start };
    // What follows in the line would come into the comment.
    let newline = if text.get(behind..).is_some_and(|behind| behind.starts_with('\n')) { "" } else { "\n" };
    replaced(text, start..behind, newline)
}

/// The offset behind the comma of an element that ends at an offset, if it has one; comments may stand before it.
fn behind_comma(text: &str, end: usize) -> Option<usize> {
    let rest = text.get(end..)?;
    let at = end + rest.len() - rest.trim_start().len();
    match text.get(at..)?.chars().next()? {
        ',' => Some(at + 1),
        '#' => behind_comma(text, line_end(text, at)),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
