//! Prints text from scenes, file names and boards safely.

use std::borrow::Cow;
use std::fmt::{self, Display, Write};

/// Most characters of a name in a scene: of a layer, a screen or a finger.
pub(crate) const NAME_MAX_CHARS: usize = 64;

/// Whether a character controls a terminal or the order of a line instead of being visible: control characters, line
/// and paragraph separators, direction marks, and the byte order mark. XML cannot represent most of them.
fn is_unprintable(character: char) -> bool {
    character.is_control()
        || matches!(character, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
        || matches!(character, '\u{61c}' | '\u{feff}' | '\u{fffe}' | '\u{ffff}')
}

/// Whether a text can be printed unchanged.
pub(crate) fn is_printable(text: &str) -> bool {
    !text.contains(is_unprintable)
}

/// A text on one line in printable form: invisible characters are escaped as `\u001b`, as in JSON.
///
/// ```
/// assert_eq!(frixel_scene::printable("wood"), "wood");
/// assert_eq!(frixel_scene::printable("wood\u{1b}[2J\nfelt"), "wood\\u001b[2J\\u000afelt");
/// ```
pub fn printable(text: &str) -> Cow<'_, str> {
    if is_printable(text) { text.into() } else { escaped(text, |_| false).into() }
}

/// Like [`printable`], but keeps the line breaks of a text that a program has composed.
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    let is_kept = |character| character == '\n';
    if text.chars().any(|character| is_unprintable(character) && !is_kept(character)) {
        escaped(text, is_kept).into()
    } else {
        text.into()
    }
}

fn escaped(text: &str, is_kept: impl Fn(char) -> bool) -> String {
    let mut escaped = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if is_unprintable(character) && !is_kept(character) {
            // Writing to a string cannot fail.
            let _ = write!(escaped, "\\u{:04x}", u32::from(character));
        } else {
            escaped.push(character);
        }
    }
    escaped
}

/// A text for use in a sentence, cut at the largest length of a name.
pub fn brief(name: &str) -> Cow<'_, str> {
    match name.char_indices().nth(NAME_MAX_CHARS) {
        Some((end, _)) => format!("{}\u{2026}", name.get(..end).unwrap_or_default()).into(),
        None => name.into(),
    }
}

/// A number for use in a sentence, with an exponent if it has many digits.
pub struct Shown(pub f64);

impl Display for Shown {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value) = self;
        let has_many_digits = value.is_finite() && *value != 0.0 && !(1e-6..1e15).contains(&value.abs());
        if has_many_digits { write!(formatter, "{value:e}") } else { write!(formatter, "{value}") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_controls_a_terminal_is_escaped() {
        for (raw, shown) in [
            ("\u{1b}]0;title\u{7}", "\\u001b]0;title\\u0007"),
            ("one\r\ntwo", "one\\u000d\\u000atwo"),
            ("\u{9b}2J\u{7f}", "\\u009b2J\\u007f"),
            ("\u{202e}gnp.exe", "\\u202egnp.exe"),
            ("größe \u{1f44d} ~`\"\\", "größe \u{1f44d} ~`\"\\"),
        ] {
            assert_eq!(printable(raw), shown);
        }
        assert_eq!(printable_lines("one\ntwo\u{1b}"), "one\ntwo\\u001b");
    }
}
