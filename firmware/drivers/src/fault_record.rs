//! The last fault, kept in RAM across a reset.
//!
//! A board places one [`FaultRecord`] in memory not cleared by the start-up code. A panic or a fault
//! [saves](FaultRecord::save) into it and resets; the next start [takes](FaultRecord::take) the record, once. After
//! power-on the memory holds random bits, which a CRC-32 distinguishes from a record.
//!
//! Each start [marks](FaultRecord::mark) the record, so that the next one can tell a brown-out, in which RAM keeps its
//! content, from power-on.

use core::fmt;
use core::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use frixel_wire::fault::Fault;
use frixel_wire::frame::Crc32;
use frixel_wire::message::FAULT_TEXT_MAX_LEN;

/// Value of the mark: any single changed bit invalidates it, and random memory is unlikely to hold it.
const MARK: u32 = 0x96c3_6a00;

/// A fault, its detail (a number whose meaning depends on the fault), and a text.
pub struct FaultRecord {
    number: AtomicU32,
    detail: AtomicU32,
    len: AtomicU32,
    check: AtomicU32,
    text: [AtomicU8; FAULT_TEXT_MAX_LEN],
    mark: AtomicU32,
}

/// Buffer for the text of a record.
pub type Text = [u8; FAULT_TEXT_MAX_LEN];

impl FaultRecord {
    /// An empty record.
    #[allow(clippy::new_without_default, reason = "it belongs in a static")]
    pub const fn new() -> Self {
        Self {
            number: AtomicU32::new(0),
            detail: AtomicU32::new(0),
            len: AtomicU32::new(0),
            check: AtomicU32::new(0),
            text: [const { AtomicU8::new(0) }; FAULT_TEXT_MAX_LEN],
            mark: AtomicU32::new(0),
        }
    }

    /// Whether the record's memory has kept its content since an earlier start. Call this before this start marks it.
    pub fn survived_reset(&self) -> bool {
        self.mark.load(Ordering::Relaxed) == MARK
    }

    /// Marks the record, for the next start.
    pub fn mark(&self) {
        self.mark.store(MARK, Ordering::Relaxed);
    }

    /// Stores a fault and the text written by `write_text`, truncated to [`FAULT_TEXT_MAX_LEN`] bytes.
    pub fn save(&self, fault: Fault, detail: u32, write_text: &mut dyn FnMut(&mut Writer)) {
        self.forget();
        self.number.store(u32::from(fault.number()), Ordering::Relaxed);
        self.detail.store(detail, Ordering::Relaxed);
        let mut writer = Writer { record: self, len: 0, full: false };
        write_text(&mut writer);
        self.len.store(writer.len as u32, Ordering::Relaxed);
        self.check.store(self.checksum(), Ordering::Relaxed);
    }

    /// Removes the record and returns the fault, its detail and its text (UTF-8); `None` without a valid record.
    pub fn take<'t>(&self, text: &'t mut Text) -> Option<(Fault, u32, &'t [u8])> {
        let good = self.check.load(Ordering::Relaxed) == self.checksum();
        let fault = Fault::try_from(self.number.load(Ordering::Relaxed) as u8).ok();
        let len = self.len.load(Ordering::Relaxed) as usize;
        let detail = self.detail.load(Ordering::Relaxed);
        self.forget();
        for (to, from) in text.iter_mut().zip(&self.text) {
            *to = from.load(Ordering::Relaxed);
        }
        let text = text.get(..len)?;
        fault.filter(|_| good).map(|fault| (fault, detail, text))
    }

    fn forget(&self) {
        self.number.store(0, Ordering::Relaxed);
        self.check.store(!self.checksum(), Ordering::Relaxed);
    }

    fn checksum(&self) -> u32 {
        let mut digest = Crc32::new();
        for word in [&self.number, &self.detail, &self.len] {
            digest.update(&word.load(Ordering::Relaxed).to_le_bytes());
        }
        let len = (self.len.load(Ordering::Relaxed) as usize).min(FAULT_TEXT_MAX_LEN);
        for byte in self.text.iter().take(len) {
            digest.update(&[byte.load(Ordering::Relaxed)]);
        }
        digest.finish()
    }
}

/// Writes the text of a record, in whole characters. It never fails. [`Writer::text`] and [`Writer::hex`] do not use
/// `core::fmt`, which takes 3 KiB of an image.
pub struct Writer<'r> {
    record: &'r FaultRecord,
    len: usize,
    /// Whether the text was truncated; nothing more is written.
    full: bool,
}

impl Writer<'_> {
    /// Appends a text.
    pub fn text(&mut self, s: &str) -> &mut Self {
        let room = if self.full { 0 } else { FAULT_TEXT_MAX_LEN - self.len };
        let part = s.get(..s.floor_char_boundary(room)).unwrap_or_default();
        self.full |= part.len() < s.len();
        part.bytes().for_each(|byte| self.byte(byte));
        self
    }

    fn byte(&mut self, byte: u8) {
        if let Some(place) = self.record.text.get(self.len) {
            place.store(byte, Ordering::Relaxed);
            self.len += 1;
        }
    }

    /// Appends a number in hexadecimal, such as `0x1fff_fff8` without the underscore.
    pub fn hex(&mut self, number: u32) -> &mut Self {
        self.text("0x");
        for place in (0..u32::BITS).step_by(4).rev() {
            let digit = (number >> place) as u8 & 0xf;
            self.byte(if digit < 10 { b'0' + digit } else { b'a' + digit - 10 });
        }
        self
    }
}

impl fmt::Write for Writer<'_> {
    fn write_str(&mut self, s: &str) -> fmt::Result {
        self.text(s);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use core::fmt::Write as _;

    use super::*;
    use proptest::prelude::*;

    fn take(record: &FaultRecord) -> Option<(Fault, u32, String)> {
        record
            .take(&mut [0; FAULT_TEXT_MAX_LEN])
            .map(|(fault, detail, text)| (fault, detail, String::from_utf8(text.to_vec()).unwrap()))
    }

    #[test]
    fn a_record_is_taken_once() {
        let record = FaultRecord::new();
        assert_eq!(take(&record), None);
        record.save(Fault::Panic, 42, &mut |text| write!(text, "src/tick.rs:{}", 42).unwrap());
        assert_eq!(take(&record), Some((Fault::Panic, 42, "src/tick.rs:42".to_owned())));
        assert_eq!(take(&record), None);
    }

    #[test]
    fn a_later_record_replaces_an_earlier_one() {
        let record = FaultRecord::new();
        record.save(Fault::Panic, 1, &mut |text| _ = text.text("a long first text"));
        record.save(Fault::Watchdog, 2, &mut |text| _ = text.text("short"));
        assert_eq!(take(&record), Some((Fault::Watchdog, 2, "short".to_owned())));
    }

    #[test]
    fn only_a_record_that_a_start_has_marked_survived_a_reset() {
        let record = FaultRecord::new();
        assert!(!record.survived_reset());
        record.mark();
        record.save(Fault::Panic, 1, &mut |text| _ = text.text("again"));
        assert!(record.survived_reset() && take(&record).is_some() && record.survived_reset());
        for bit in 0..32 {
            record.mark();
            record.mark.fetch_xor(1 << bit, Ordering::Relaxed);
            assert!(!record.survived_reset(), "bit {bit}");
        }
        for fill in 0..=u8::MAX {
            record.mark.store(u32::from_le_bytes([fill; 4]), Ordering::Relaxed);
            assert!(!record.survived_reset(), "{fill:#04x}");
        }
    }

    #[test]
    fn random_memory_is_not_a_record() {
        for fill in [0x00, 0xff, 0x55, 0xa5_u8] {
            let record = FaultRecord::new();
            let word = u32::from_le_bytes([fill; 4]);
            for place in [&record.number, &record.detail, &record.len, &record.check] {
                place.store(word, Ordering::Relaxed);
            }
            for byte in &record.text {
                byte.store(fill, Ordering::Relaxed);
            }
            assert_eq!(take(&record), None, "{fill:#x}");
        }
    }

    #[test]
    fn any_changed_bit_invalidates_it() {
        let saved = || {
            let record = FaultRecord::new();
            record.save(Fault::StackOverflow, 0x1fff_fff8, &mut |text| _ = text.text("stack"));
            record
        };
        for bit in 0..32 {
            for place in 0..4 {
                let record = saved();
                let places = [&record.number, &record.detail, &record.len, &record.check];
                places[place].fetch_xor(1 << bit, Ordering::Relaxed);
                assert_eq!(take(&record), None);
            }
        }
        let record = saved();
        record.text[4].fetch_xor(1, Ordering::Relaxed);
        assert_eq!(take(&record), None);
    }

    proptest! {
        /// The record keeps the beginning of any text, in whole characters, however the text is divided into pieces.
        #[test]
        fn the_beginning_of_a_text_is_kept(pieces in proptest::collection::vec("\\PC{0,60}", 0..8)) {
            let whole = pieces.concat();
            let record = FaultRecord::new();
            record.save(Fault::Panic, 0, &mut |text| pieces.iter().for_each(|piece| _ = text.text(piece)));
            let (_, _, text) = take(&record).unwrap();
            prop_assert!(whole.starts_with(&text));
            prop_assert!(text.len() == whole.len() || text.len() + 3 >= FAULT_TEXT_MAX_LEN);
        }
    }
}
