//! Text as UTF-8, whether a file has it as UTF-8 or, as spreadsheets save "Unicode text", as UTF-16.

use std::io::{self, Chain, Cursor, Read};

use encoding_rs::{Decoder, Encoding, UTF_16BE, UTF_16LE};

/// Number of bytes that are read of the input at once.
const CHUNK: usize = 8192;

/// The order of the two bytes of a unit of UTF-16.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ByteOrder {
    LittleEndian,
    BigEndian,
}

impl ByteOrder {
    /// The order that a text begins with: its byte order mark, or else a zero byte in one half of its first character,
    /// which is an ASCII character in a header. `None` for UTF-8.
    fn of(start: &[u8]) -> Option<Self> {
        match *start {
            [0xff, 0xfe, ..] => Some(Self::LittleEndian),
            [0xfe, 0xff, ..] => Some(Self::BigEndian),
            [first, 0, ..] if first != 0 => Some(Self::LittleEndian),
            [0, second, ..] if second != 0 => Some(Self::BigEndian),
            _ => None,
        }
    }

    fn encoding(self) -> &'static Encoding {
        match self {
            Self::LittleEndian => UTF_16LE,
            Self::BigEndian => UTF_16BE,
        }
    }

    fn unit(self, bytes: [u8; 2]) -> u16 {
        match self {
            Self::LittleEndian => u16::from_le_bytes(bytes),
            Self::BigEndian => u16::from_be_bytes(bytes),
        }
    }
}

/// Where the last line feed of a text ends; zero if it has none.
pub(super) fn end_of_lines(bytes: &[u8]) -> usize {
    let place = match ByteOrder::of(bytes) {
        None => bytes.iter().rposition(|byte| *byte == b'\n').map(|place| place + 1),
        Some(order) => {
            let (pairs, _) = bytes.as_chunks::<2>();
            pairs.iter().rposition(|pair| order.unit(*pair) == u16::from(b'\n')).map(|place| 2 * (place + 1))
        }
    };
    place.unwrap_or_default()
}

/// An input whose text comes out as UTF-8. Invalid UTF-16 becomes the replacement character; UTF-8 is not checked.
pub(super) struct Utf8<R> {
    input: Chain<Cursor<Vec<u8>>, R>,
    order: Option<ByteOrder>,
    /// `None` for UTF-8.
    decoder: Option<Decoder>,
    /// Text that has been decoded, and how much of it was given.
    text: String,
    given: usize,
    is_over: bool,
}

impl<R: Read> Utf8<R> {
    /// Reads the first bytes, which show the encoding.
    pub(super) fn new(mut input: R) -> io::Result<Self> {
        let mut start = Vec::new();
        input.by_ref().take(2).read_to_end(&mut start)?;
        let order = ByteOrder::of(&start);
        let decoder = order.map(|order| order.encoding().new_decoder_without_bom_handling());
        let input = Cursor::new(start).chain(input);
        Ok(Self { input, order, decoder, text: String::new(), given: 0, is_over: false })
    }

    /// The byte order if the input is UTF-16.
    pub(super) fn order(&self) -> Option<ByteOrder> {
        self.order
    }
}

impl<R: Read> Read for Utf8<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let Some(decoder) = &mut self.decoder else { return self.input.read(buffer) };
        while self.given == self.text.len() && !self.is_over {
            self.text.clear();
            self.given = 0;
            let mut chunk = [0; CHUNK];
            let count = self.input.read(&mut chunk)?;
            self.is_over = count == 0;
            self.text.reserve(decoder.max_utf8_buffer_length(count).unwrap_or_default());
            let _ = decoder.decode_to_string(chunk.get(..count).unwrap_or_default(), &mut self.text, self.is_over);
        }
        let count = self.text.as_bytes().get(self.given..).unwrap_or_default().read(buffer)?;
        self.given += count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use std::io::{self, Read};

    use super::Utf8;

    /// An input that gives a byte at a time.
    struct Slow<'b>(&'b [u8]);

    impl Read for Slow<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let count = buffer.len().min(1);
            self.0.read(&mut buffer[..count])
        }
    }

    fn decoded(bytes: &[u8]) -> String {
        let mut text = String::new();
        Utf8::new(Slow(bytes)).unwrap().read_to_string(&mut text).unwrap();
        text
    }

    #[test]
    fn text_comes_out_as_utf_8_whatever_a_file_has() {
        let text = "Größe;\u{1f642}\n".repeat(3000);
        let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(decoded(text.as_bytes()), text);
        assert_eq!(decoded(&little), text);
        assert_eq!(decoded(&big), text);
        assert_eq!(decoded(&[&[0xff, 0xfe], &little[..]].concat()), format!("\u{feff}{text}"));
        assert_eq!(decoded(&[&[0xfe, 0xff], &big[..]].concat()), format!("\u{feff}{text}"));
        assert_eq!(decoded(b""), "");
        assert_eq!(decoded(b"a"), "a");
    }

    #[test]
    fn half_a_character_is_replaced() {
        assert_eq!(decoded(b"a\0b\0c"), "ab\u{fffd}");
        assert_eq!(decoded(b"a\0\x3d\xd8"), "a\u{fffd}");
        assert_eq!(decoded(b"a\0\x3d\xd8b\0"), "a\u{fffd}b");
    }
}
