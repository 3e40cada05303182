//! The person's terminal on the serial port; using it tests the port in both directions.

use core::fmt::{Arguments, Write as _};

use embedded_io::{Read, ReadReady, Write, WriteReady};

use crate::bring_up::{Line, LineReader, Typed};

/// Longest text shown at once, in bytes.
const TEXT_MAX_LEN: usize = 384;

/// The terminal. Its output also goes to the debug probe. On a failing port, lines are lost in both directions.
pub struct Terminal<P> {
    serial: P,
    reader: LineReader,
}

impl<P: Read + ReadReady + Write + WriteReady> Terminal<P> {
    /// A terminal on the serial port.
    pub fn new(serial: P) -> Self {
        Self { serial, reader: LineReader::default() }
    }

    /// Shows a line. Waits some milliseconds until the port has accepted it.
    pub fn say(&mut self, text: Arguments<'_>) {
        let mut line = heapless::String::<TEXT_MAX_LEN>::new();
        // A text that is too long is truncated.
        let _ = line.write_fmt(text);
        #[cfg(feature = "defmt")]
        defmt::println!("{=str}", line.as_str());
        self.write(line.as_bytes());
        self.write(b"\r\n");
    }

    /// Discards earlier input.
    pub fn forget(&mut self) {
        while self.next_byte().is_some() {}
        self.reader.clear();
    }

    /// Reads typed characters without waiting. Returns the line when it has ended.
    pub fn line(&mut self) -> Option<Line> {
        while let Some(byte) = self.next_byte() {
            match self.reader.push(byte) {
                Typed::Ignored => {}
                Typed::Character(_) => self.write(&[byte]),
                Typed::Erased => self.write(b"\x08 \x08"),
                Typed::Ended(line) => {
                    self.write(b"\r\n");
                    return Some(line);
                }
            }
        }
        None
    }

    /// Takes received bytes, and returns their number, without waiting.
    pub fn read(&mut self, bytes: &mut [u8]) -> usize {
        match self.serial.read_ready() {
            Ok(true) => self.serial.read(bytes).unwrap_or(0),
            _ => 0,
        }
    }

    /// Begins to send bytes unless others are still under way, and returns the number accepted.
    pub fn send(&mut self, bytes: &[u8]) -> usize {
        match self.serial.write_ready() {
            Ok(true) => self.serial.write(bytes).unwrap_or(0),
            _ => 0,
        }
    }

    fn next_byte(&mut self) -> Option<u8> {
        let mut byte = [0];
        (self.read(&mut byte) > 0).then_some(byte[0])
    }

    fn write(&mut self, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            let Ok(len) = self.serial.write(bytes) else { return };
            bytes = bytes.get(len..).unwrap_or_default();
        }
    }
}
