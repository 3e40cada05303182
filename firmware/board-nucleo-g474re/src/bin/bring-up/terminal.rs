//! The person's terminal on the serial port, which is thereby tested in both directions.

use core::fmt::{Arguments, Write as _};

use board_nucleo_g474re::serial::Serial;
use embedded_io::{Read as _, ReadReady as _, Write as _};
use frixel_board::bring_up::{Line, LineReader, Typed};

/// Longest text that is shown at once, in bytes.
const TEXT_MAX_LEN: usize = 384;

/// The terminal. What it shows goes to the debug probe, too.
pub(crate) struct Terminal {
    serial: Serial,
    reader: LineReader,
}

impl Terminal {
    /// A terminal on the serial port.
    pub(crate) fn new(serial: Serial) -> Self {
        Self { serial, reader: LineReader::default() }
    }

    /// Shows a line. It waits until the port has taken it, some milliseconds.
    pub(crate) fn say(&mut self, text: Arguments<'_>) {
        let mut line = heapless::String::<TEXT_MAX_LEN>::new();
        // A text that is too long is cut.
        let _ = line.write_fmt(text);
        defmt::println!("{=str}", line.as_str());
        self.write(line.as_bytes());
        self.write(b"\r\n");
    }

    /// Forgets what was typed before it was asked for.
    pub(crate) fn forget(&mut self) {
        while self.next_byte().is_some() {}
        self.reader.clear();
    }

    /// Reads what has been typed, without waiting. Returns the line when it has ended.
    pub(crate) fn line(&mut self) -> Option<Line> {
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

    fn next_byte(&mut self) -> Option<u8> {
        let mut byte = [0];
        match self.serial.read_ready() {
            Ok(true) => self.serial.read(&mut byte).is_ok_and(|len| len > 0).then_some(byte[0]),
            _ => None,
        }
    }

    fn write(&mut self, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            let Ok(len) = self.serial.write(bytes);
            bytes = bytes.get(len..).unwrap_or_default();
        }
    }
}
