//! Parsers of headers and records under arbitrary bytes; `frixel-session` loads whole scenes (`loader`).
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use frixel_layers::{HEADER_LEN, Header, RECORD_LEN, Record};
use proptest::prelude::*;

proptest! {
    /// A header or record that is accepted has one form only.
    #[test]
    fn headers_have_one_form(
        mut bytes in prop::array::uniform32(any::<u8>()),
        flags in 0..34u8,
        carrier in 0..4u8,
        max in prop::array::uniform2(0..3u8),
    ) {
        bytes[..4].copy_from_slice(&[1, 0, flags % 3, flags]);
        let mut header = [0; HEADER_LEN];
        header[..32].copy_from_slice(&bytes);
        header[52] = carrier;
        header[54..].copy_from_slice(&max);
        if let Ok((read, records, points)) = Header::parse(&header) {
            prop_assert_eq!(read.write(records, points), header);
        }
    }

    #[test]
    fn records_have_one_form(
        head in prop::array::uniform4(0..11u8),
        tail in prop::array::uniform32(any::<u8>()),
        long in any::<bool>(),
    ) {
        let mut record = [0; RECORD_LEN];
        record[..4].copy_from_slice(&head);
        let at = if long { 24 } else { 12 };
        record[at..at + 32].copy_from_slice(&tail);
        if let Ok(read) = Record::parse(&record, 0) {
            prop_assert_eq!(read.write(), record);
        }
    }
}
