//! Input of the command: regular files and standard input, each up to a stated size.

use std::io::{self, BufRead};

pub(crate) use frixel_lab::input::{
    Bounded, CSV_MAX_BYTES, PICTURE_MAX_BYTES, TOML_MAX_BYTES, open, read, read_toml, whole_lines,
};

/// Largest WAV file: 12 minutes of 44.1 kHz, 16 bits, stereo.
pub(crate) const WAV_MAX_BYTES: u64 = 128 << 20;
/// Longest line read from standard input, in bytes; the rest of a longer line is dropped.
pub(crate) const LINE_MAX_BYTES: usize = 4096;

/// Reads the next line, without its line ending; `None` at the end of the input or on a read error. Drops bytes beyond
/// [`LINE_MAX_BYTES`], and replaces bytes that are not UTF-8.
pub(crate) fn next_line(input: &mut impl BufRead) -> Option<String> {
    let mut line = Vec::new();
    let mut has_read = false;
    loop {
        let bytes = match input.fill_buf() {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(_) => return None,
        };
        if bytes.is_empty() {
            return has_read.then(|| text(&line));
        }
        has_read = true;
        let end = bytes.iter().position(|byte| *byte == b'\n');
        let part = bytes.get(..end.unwrap_or(bytes.len())).unwrap_or_default();
        let room = LINE_MAX_BYTES - line.len();
        line.extend(part.iter().take(room));
        let used = part.len() + usize::from(end.is_some());
        input.consume(used);
        if end.is_some() {
            return Some(text(&line));
        }
    }
}

fn text(line: &[u8]) -> String {
    String::from_utf8_lossy(line.strip_suffix(b"\r").unwrap_or(line)).into_owned()
}

#[cfg(test)]
mod tests {
    use std::io::{BufReader, Read, repeat};

    use super::*;

    #[test]
    fn an_endless_line_is_cut_at_the_limit() {
        let mut input = BufReader::new(repeat(b'x').take(50_000_000).chain(&b"\r\nnext\nlast"[..]));
        assert_eq!(next_line(&mut input).unwrap().len(), LINE_MAX_BYTES);
        assert_eq!(next_line(&mut input).as_deref(), Some("next"));
        assert_eq!(next_line(&mut input).as_deref(), Some("last"));
        assert_eq!(next_line(&mut input), None);
    }
}
