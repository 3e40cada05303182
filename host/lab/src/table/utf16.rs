//! Text as UTF-8, whether a file has it as UTF-8 or, as spreadsheets save "Unicode text", as UTF-16.

use std::io::{self, Read};

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

/// An input whose text comes out as UTF-8. What is no UTF-16 becomes the replacement character; UTF-8 is not checked.
pub(super) struct Utf8<R> {
    input: R,
    order: Option<ByteOrder>,
    /// Text that has been read and not yet asked for.
    text: Vec<u8>,
    given: usize,
    /// The first byte of a unit whose second is still to come.
    byte: Option<u8>,
    /// The first unit of a pair whose second is still to come.
    surrogate: Option<u16>,
}

impl<R: Read> Utf8<R> {
    /// Reads the first bytes, which show the encoding.
    pub(super) fn new(mut input: R) -> io::Result<Self> {
        let mut start = Vec::new();
        input.by_ref().take(2).read_to_end(&mut start)?;
        let order = ByteOrder::of(&start);
        let mut decoded = Self { input, order, text: Vec::new(), given: 0, byte: None, surrogate: None };
        decoded.add(&start);
        Ok(decoded)
    }

    /// The byte order if the input is UTF-16.
    pub(super) fn order(&self) -> Option<ByteOrder> {
        self.order
    }

    fn add(&mut self, bytes: &[u8]) {
        let Some(order) = self.order else {
            self.text.extend_from_slice(bytes);
            return;
        };
        let bytes = self.byte.take().into_iter().chain(bytes.iter().copied()).collect::<Vec<u8>>();
        let (pairs, rest) = bytes.as_chunks::<2>();
        self.byte = rest.first().copied();
        let mut units: Vec<u16> = self.surrogate.take().into_iter().collect();
        units.extend(pairs.iter().map(|pair| order.unit(*pair)));
        self.surrogate = units.pop_if(|last| (0xd800..0xdc00).contains(last));
        self.decode(units);
    }

    fn decode(&mut self, units: impl IntoIterator<Item = u16>) {
        for found in char::decode_utf16(units) {
            let found = found.unwrap_or(char::REPLACEMENT_CHARACTER);
            self.text.extend_from_slice(found.encode_utf8(&mut [0; 4]).as_bytes());
        }
    }

    /// The end of the input: half a character has no second half.
    fn end(&mut self) {
        if self.byte.take().is_some() || self.surrogate.is_some() {
            self.surrogate = None;
            self.decode([0xd800]);
        }
    }
}

impl<R: Read> Read for Utf8<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while self.given == self.text.len() {
            self.text.clear();
            self.given = 0;
            if self.order.is_none() {
                return self.input.read(buffer);
            }
            let mut chunk = [0; CHUNK];
            let count = self.input.read(&mut chunk)?;
            if count == 0 {
                self.end();
                if self.text.is_empty() {
                    return Ok(0);
                }
            } else {
                self.add(chunk.get(..count).unwrap_or_default());
            }
        }
        let ready = self.text.get(self.given..).unwrap_or_default();
        let count = ready.len().min(buffer.len());
        for (into, from) in buffer.iter_mut().zip(ready) {
            *into = *from;
        }
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
