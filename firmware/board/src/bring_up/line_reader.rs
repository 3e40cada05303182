//! Lines typed at a terminal.

use super::Line;

const BACKSPACE: u8 = 0x08;
const DELETE: u8 = 0x7f;

/// Assembles lines from a terminal's bytes.
#[derive(Debug, Default)]
pub struct LineReader {
    line: Line,
    /// Whether the last byte was a carriage return: a following line feed does not end a second line.
    returned: bool,
}

/// Echo of the terminal for a byte.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Typed {
    /// Nothing.
    Ignored,
    /// This character.
    Character(char),
    /// The last character was erased.
    Erased,
    /// The line has ended.
    Ended(Line),
}

impl LineReader {
    /// Discards the current line.
    pub fn clear(&mut self) {
        self.line.clear();
    }

    /// Processes a byte. Printable ASCII is text, backspace and delete erase, carriage return and line feed end the
    /// line. A character beyond the longest line is ignored.
    pub fn push(&mut self, byte: u8) -> Typed {
        let after_return = core::mem::replace(&mut self.returned, byte == b'\r');
        match byte {
            b'\n' if after_return => Typed::Ignored,
            b'\r' | b'\n' => Typed::Ended(core::mem::take(&mut self.line)),
            BACKSPACE | DELETE => self.line.pop().map_or(Typed::Ignored, |_| Typed::Erased),
            b' '..=b'~' => {
                let character = char::from(byte);
                self.line.push(character).map_or(Typed::Ignored, |()| Typed::Character(character))
            }
            _ => Typed::Ignored,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Vec<String> {
        let mut reader = LineReader::default();
        let ended = |byte: &u8| if let Typed::Ended(line) = reader.push(*byte) { Some(line.to_string()) } else { None };
        bytes.iter().filter_map(ended).collect()
    }

    #[test]
    fn a_line_ends_at_a_return_a_feed_or_both() {
        assert_eq!(lines(b"10.2\r\n25\n50\r\r\ndone"), ["10.2", "25", "50", ""]);
    }

    #[test]
    fn typing_errors_can_be_erased() {
        assert_eq!(lines(b"\x7f12\x083\x7f\x7f4\r"), ["4"]);
    }

    #[test]
    fn noise_and_excess_characters_are_ignored() {
        assert_eq!(lines(b"\x00\xff\x1b1\xc2\xb50\t\r"), ["10"]);
        assert_eq!(lines(&[&[b'1'; 99][..], b"\r"].concat()), ["1".repeat(crate::bring_up::LINE_MAX_LEN)]);
    }
}
