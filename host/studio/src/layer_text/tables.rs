//! Layers that are written as tables with headers: which parts of the text belong to one.

use std::ops::Range;

use toml::de::DeValue;

use super::node::{Form, Node, entries, is_value};
use super::{LAYER, line_end, line_start, replaced};

/// A table with a header, or the values before all headers.
struct Section {
    /// Where the header begins.
    start: usize,
    /// End of the last value in it.
    end: usize,
    /// Number of its own layer, or of the layer that contains it.
    layer: Option<usize>,
}

/// A table with a header.
struct Headed {
    /// The text between the value before and the header: empty lines, comments and the header's indent.
    prefix: Range<usize>,
    /// Number of its own layer, or of the layer that contains it.
    layer: Option<usize>,
}

/// The tables with a header, in the order of the text, and the end of the text behind all values in their place.
fn headed(text: &str, root: &Node<'_>) -> Vec<Headed> {
    let mut sections = vec![Section { start: 0, end: values_end(text, root).unwrap_or(0), layer: None }];
    for (name, node) in root.get_ref().as_table().into_iter().flat_map(entries) {
        match node.get_ref() {
            DeValue::Array(layers) if name.get_ref() == LAYER => {
                for (at, layer) in layers.iter().enumerate() {
                    visit(text, layer, Some(at), &mut sections);
                }
            }
            _ => visit(text, node, None, &mut sections),
        }
    }
    sections.sort_unstable_by_key(|section| (section.start, section.end));
    let starts = sections.iter().skip(1).map(|section| (section.start, section.layer));
    let starts: Vec<_> = starts.chain([(text.len(), None)]).collect();
    let before = sections.iter().map(|section| match section.end {
        0 => 0,
        end => (line_end(text, end) + 1).min(text.len()),
    });
    before.zip(starts).map(|(before, (start, layer))| Headed { prefix: before..start, layer }).collect()
}

fn visit(text: &str, node: &Node<'_>, layer: Option<usize>, sections: &mut Vec<Section>) {
    match node.get_ref() {
        _ if is_value(text, node) => {}
        DeValue::Table(table) => {
            if Form::of(text, node) == Form::Header {
                let end = values_end(text, node).unwrap_or(node.span().end);
                sections.push(Section { start: node.span().start, end, layer });
            }
            for (_, node) in entries(table) {
                visit(text, node, layer, sections);
            }
        }
        DeValue::Array(tables) => {
            for node in tables {
                visit(text, node, layer, sections);
            }
        }
        _ => {}
    }
}

/// The end of the last value that a table has below its header, if there is one.
fn values_end(text: &str, table: &Node<'_>) -> Option<usize> {
    let ends = entries(table.get_ref().as_table()?).into_iter().filter_map(|(_, node)| match node.get_ref() {
        _ if is_value(text, node) => Some(node.span().end),
        DeValue::Table(_) if Form::of(text, node) == Form::Dotted => values_end(text, node),
        _ => None,
    });
    ends.max()
}

/// The runs of tables that belong to a layer, each with the table behind it.
fn runs(headed: &[Headed], at: usize) -> Vec<(&Headed, &Headed)> {
    let runs = headed.chunk_by(|one, other| one.layer == other.layer);
    let starts: Vec<&Headed> = runs.filter_map(<[Headed]>::first).collect();
    starts
        .windows(2)
        .filter_map(|pair| <[_; 2]>::try_from(pair).ok())
        .map(|[run, behind]| (run, behind))
        .filter(|(run, _)| run.layer == Some(at))
        .collect()
}

/// A text with a copy of a layer right behind it.
pub(super) fn copied(text: &str, root: &Node<'_>, at: usize) -> String {
    let headed = headed(text, root);
    let runs = runs(&headed, at);
    let part = |(run, behind): &(&Headed, &Headed)| {
        let own = text.get(line_start(text, run.prefix.end)..behind.prefix.start).unwrap_or_default();
        format!("\n\n{}", own.trim_end_matches(['\r', '\n']))
    };
    let copy: String = runs.iter().map(part).collect();
    let end = runs.last().map_or(text.len(), |(_, behind)| behind.prefix.start);
    let end = text.get(..end).unwrap_or_default().trim_end_matches(['\r', '\n']).len();
    replaced(text, end..end, &copy)
}

/// A text without a layer.
pub(super) fn without(text: &str, root: &Node<'_>, at: usize) -> String {
    let headed = headed(text, root);
    runs(&headed, at).into_iter().rev().fold(text.to_owned(), |text, (run, behind)| {
        let (from, to) = (first_of(&text, &run.prefix), rest_of(&text, &behind.prefix));
        if to < text.len() {
            return replaced(&text, from..to, "");
        }
        // No empty lines are left at the end.
        let before = text.get(..from).unwrap_or_default();
        let kept = before.trim_end().len();
        let kept = if kept == 0 { 0 } else { (kept + 1).min(from) };
        replaced(&text, kept..to, "")
    })
}

/// The begin of what belongs to the table below: the comment right above it. The head of the file stays.
fn first_of(text: &str, prefix: &Range<usize>) -> usize {
    let header = line_start(text, prefix.end);
    let above = text.get(prefix.start..header).unwrap_or_default().split_inclusive('\n').rev();
    let comment: usize = above.take_while(|line| is_comment(line)).map(str::len).sum();
    if comment == header { header } else { header - comment }
}

/// The begin of what stays behind a table that goes: not the comments right below it, which no empty line parts from
/// it, nor the empty lines. A comment right above the next table belongs to that one.
fn rest_of(text: &str, prefix: &Range<usize>) -> usize {
    let is_end = prefix.end == text.len();
    let end = if is_end { prefix.end } else { line_start(text, prefix.end) };
    let between = text.get(prefix.start..end).unwrap_or_default();
    let comments: usize = between.split_inclusive('\n').take_while(|line| is_comment(line)).map(str::len).sum();
    let comments = if !is_end && comments == between.len() { 0 } else { comments };
    let empty = between.get(comments..).unwrap_or_default().split_inclusive('\n');
    let empty: usize = empty.take_while(|line| line.trim().is_empty()).map(str::len).sum();
    prefix.start + comments + empty
}

fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with('#')
}
