//! Parses TOML, with limits on size and nesting: the parser and the code that walks its tables recurse once for each
//! nested table.

use toml::de::DeTable;

use super::mistake::FileMistake;

/// Largest text of a scene, profile, scenario or plan, in bytes: about 20,000 layers, of which a board plays 255.
pub const TEXT_MAX_BYTES: u64 = 4 << 20;
/// Deepest nesting of tables, lists and parts of a name.
const NESTING_MAX: usize = 64;

/// The tables of a text, or the offset of its first mistake.
pub(crate) fn toml(text: &str) -> Result<DeTable<'_>, (usize, FileMistake)> {
    check(text)?;
    let syntax = |error: toml::de::Error| {
        (error.span().map_or(0, |span| span.start), FileMistake::Syntax(error.message().to_owned()))
    };
    DeTable::parse(text).map(toml::Spanned::into_inner).map_err(syntax)
}

/// Checks the size and nesting of a text before it is parsed; returns the mistake as a sentence.
pub fn check_toml(text: &str) -> Result<(), String> {
    check(text).map_err(|(_, mistake)| mistake.to_string())
}

/// Checks the size and nesting of a text; otherwise returns the offending place.
fn check(text: &str) -> Result<(), (usize, FileMistake)> {
    if text.len() as u64 > TEXT_MAX_BYTES {
        let advice = "divide it, or leave out what is not needed";
        return Err((0, FileMistake::too_much("bytes in this text", text.len(), TEXT_MAX_BYTES as usize, advice)));
    }
    match deepest(text) {
        (_, found) if found <= NESTING_MAX => Ok(()),
        (offset, found) => {
            let advice = "no field needs more than four";
            Err((offset, FileMistake::too_much("nested tables, lists and parts of a name", found, NESTING_MAX, advice)))
        }
    }
}

/// The first place of the deepest nesting of tables, lists and parts of a name, and its depth.
fn deepest(text: &str) -> (usize, usize) {
    let bytes = text.as_bytes();
    let mut deepest = (0, 0);
    // The dots of the names of open tables and lists, and of the last name.
    let (mut open, mut nested, mut dots): (Vec<usize>, usize, usize) = (Vec::new(), 0, 0);
    let mut at = 0;
    while let Some(byte) = bytes.get(at) {
        match byte {
            b'"' | b'\'' => at = end_of_string(bytes, at, *byte),
            b'#' => {
                // Continue at the last byte before the end of the line.
                let rest = bytes.get(at..).unwrap_or_default();
                at += rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len()) - 1;
            }
            b'.' => dots += 1,
            b'[' | b'{' => {
                open.push(dots);
                nested += dots + 1;
                dots = 0;
            }
            b']' | b'}' => {
                nested -= open.pop().map_or(0, |dots| dots + 1);
                dots = 0;
            }
            b',' | b'\n' => dots = 0,
            _ => {}
        }
        if nested + dots > deepest.1 {
            deepest = (at, nested + dots);
        }
        at += 1;
    }
    deepest
}

/// Offset of the last quotation mark of the string that begins here. An unterminated string extends to the end of its
/// line, or of the text.
fn end_of_string(bytes: &[u8], start: usize, quote: u8) -> usize {
    let is_long = bytes.get(start..start + 3).is_some_and(|three| three == [quote; 3]);
    let mut at = start + if is_long { 3 } else { 1 };
    while let Some(byte) = bytes.get(at) {
        match byte {
            b'\\' if quote == b'"' => at += 1,
            b'\n' if !is_long => return at - 1,
            byte if *byte == quote && !is_long => return at,
            byte if *byte == quote && bytes.get(at..at + 3).is_some_and(|three| three == [quote; 3]) => return at + 2,
            _ => {}
        }
        at += 1;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str) -> Option<String> {
        check_toml(text).err()
    }

    #[test]
    fn a_text_that_would_take_the_stack_is_refused_with_its_depth() {
        let name = |parts: usize| format!("{} = 1\n", vec!["a"; parts].join("."));
        let tables = |depth: usize| format!("a = {}1{}", "{ a = ".repeat(depth), " }".repeat(depth));
        let lists = |depth: usize| format!("a = {}{}", "[".repeat(depth), "]".repeat(depth));
        for deep in [name(100_000), tables(100_000), lists(100_000), format!("[{}]", vec!["a"; 1_000_000].join("."))] {
            let error = refusal(&deep).unwrap();
            assert!(error.contains("at most 64 are read"), "{error}");
        }
        for flat in [name(64), tables(63), lists(64)] {
            assert_eq!(refusal(&flat), None);
            assert!(toml(&flat).is_ok());
        }
        let mixed = "a.b = { a.b = ".repeat(40) + "1" + &" }".repeat(40);
        assert!(refusal(&mixed).unwrap().contains("and at most 64"));
        assert!(refusal(&"#".repeat(5 << 20)).unwrap().contains("5242880 bytes in this text, and at most 4194304"));
    }

    #[test]
    fn dots_and_brackets_in_texts_and_comments_do_not_count() {
        let dots = ".[".repeat(100);
        for text in [
            format!("a = \"{dots}\"\nb = '{dots}'\n# {dots}\n"),
            format!("a = \"\"\"\n{dots}\\\"\"\"\"\nb = '''\n{dots}'''\n"),
            format!("a = \"\\\"{dots}\"\n"),
            "a = [0.1, 0.2]\n".repeat(100),
            "a = 0.1 # a part\n".repeat(100),
            "a.b = \"x\n".repeat(100),
        ] {
            assert_eq!(refusal(&text), None, "{text}");
            assert!(toml(&text).is_ok() || text.lines().count() == 100, "{text}");
        }
    }
}
