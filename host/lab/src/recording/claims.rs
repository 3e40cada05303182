//! Checks of the counts and sizes in the footer and the page headers of a Parquet file. They are checked before memory
//! is allocated for them.
//!
//! Both are structs of Thrift's compact protocol, with the numbers of `parquet.thrift`:
//! <https://github.com/apache/parquet-format/blob/master/src/main/thrift/parquet.thrift>.

mod thrift;

use parquet::errors::ParquetError;
use parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData};

use super::RecordingError;
use crate::input::{self, ROWS_MAX};
use thrift::{I32, LIST, STRUCT, Thrift};

/// Most columns of a recording; a play has 12.
const COLUMNS_MAX: u64 = 64;
/// Most row groups: a writer that is killed loses 10 s, and a week has 60,480 times as much.
const GROUPS_MAX: u64 = 65_536;
/// Most values of all columns, 1 GiB of them: 93 minutes of a play at 1 kHz.
const VALUES_MAX: u64 = 64 << 20;

/// Fails if a recording of this many rows and columns would be too long to read back.
pub fn check_length(rows: u64, columns: usize) -> Result<(), RecordingError> {
    let max = ROWS_MAX.min(VALUES_MAX / columns.max(1) as u64);
    if rows <= max {
        return Ok(());
    }
    Err(RecordingError::refused(format!(
        "it would have {rows} rows of {columns} columns, and at most {max} are read back: record for a shorter time, or \
         fewer rows a second"
    )))
}

/// Most pages of all columns.
const PAGES_MAX: u64 = 1 << 20;
/// Largest page, unpacked. Writers end one at 1 MiB.
const PAGE_MAX_BYTES: u64 = 16 << 20;
/// Most bytes of all pages, unpacked.
const UNPACKED_MAX_BYTES: u64 = 1 << 30;
/// Largest footer: it has the files of the play twice.
pub(super) const FOOTER_MAX_BYTES: u64 = 64 << 20;

/// Bytes that the shortest value takes in a dictionary.
const DICTIONARY_VALUE_BYTES: u64 = 4;
/// `PageType`.
const DATA_PAGE: u64 = 0;
const DICTIONARY_PAGE: u64 = 2;

fn at_most(what: &'static str, found: u64, max: u64) -> Result<(), RecordingError> {
    Ok(input::at_most(what, found, max)?)
}

fn damaged(what: &str) -> RecordingError {
    RecordingError::Damaged(ParquetError::General(what.to_owned()))
}

/// Checks a `FileMetaData`: columns side by side, and no more rows and row groups than are read.
pub(super) fn check_footer(encoded: &[u8]) -> Result<(), RecordingError> {
    at_most("bytes of metadata", encoded.len() as u64, FOOTER_MAX_BYTES)?;
    let (mut columns, mut rows) = (0, 0);
    Thrift::new(encoded).fields(|footer, id, kind| match (id, kind) {
        (2, LIST) => {
            let elements = footer.list()?;
            columns = elements.saturating_sub(1);
            at_most("columns", columns, COLUMNS_MAX)?;
            (0..elements).try_for_each(|number| schema_element(footer, number == 0)).map(|()| true)
        }
        (4, LIST) => {
            let groups = footer.list()?;
            at_most("row groups", groups, GROUPS_MAX)?;
            (0..groups).try_for_each(|_| {
                rows += row_group(footer, columns)?;
                at_most("rows", rows, ROWS_MAX)?;
                at_most("values", rows * columns, VALUES_MAX)
            })?;
            Ok(true)
        }
        _ => Ok(false),
    })
}

/// A `SchemaElement`: only the first one has children.
fn schema_element(footer: &mut Thrift<'_>, is_root: bool) -> Result<(), RecordingError> {
    footer.fields(|element, id, kind| match (id, kind) {
        (5, I32) if element.count()? > 0 && !is_root => Err(RecordingError::nested()),
        (5, I32) => Ok(true),
        _ => Ok(false),
    })
}

/// A `RowGroup`: returns its number of rows.
fn row_group(footer: &mut Thrift<'_>, columns: u64) -> Result<u64, RecordingError> {
    let mut rows = 0;
    footer.fields(|group, id, kind| match (id, kind) {
        (1, LIST) => {
            let chunks = group.list()?;
            at_most("columns in a row group", chunks, columns)?;
            (0..chunks).try_for_each(|_| group.skip(STRUCT)).map(|()| true)
        }
        (3, thrift::I64) => {
            rows = group.count()?;
            Ok(true)
        }
        _ => Ok(false),
    })?;
    Ok(rows)
}

/// Checks the headers of all pages of a file whose footer is checked: each unpacks to no more than is read, and those
/// of a column have the rows of its row group.
pub(super) fn check_pages(bytes: &[u8], file: &ParquetMetaData) -> Result<(), RecordingError> {
    let mut total = Total::default();
    for group in file.row_groups() {
        let rows = u64::try_from(group.num_rows()).unwrap_or_default();
        for chunk in group.columns() {
            let pages = pages(bytes, chunk).ok_or_else(|| damaged("a column lies outside of the file"))?;
            total.column(pages, rows)?;
        }
    }
    Ok(())
}

/// The pages of a column in one row group.
fn pages<'b>(bytes: &'b [u8], chunk: &ColumnChunkMetaData) -> Option<&'b [u8]> {
    let start = usize::try_from(chunk.dictionary_page_offset().unwrap_or(chunk.data_page_offset())).ok()?;
    let len = usize::try_from(chunk.compressed_size()).ok()?;
    bytes.get(start..start.checked_add(len)?)
}

/// Totals over all pages.
#[derive(Default)]
struct Total {
    pages: u64,
    unpacked_bytes: u64,
}

impl Total {
    /// Checks the pages of a column with so many rows.
    fn column(&mut self, mut pages: &[u8], mut rows_left: u64) -> Result<(), RecordingError> {
        while !pages.is_empty() {
            let values = self.page(&mut pages)?;
            rows_left = rows_left.checked_sub(values).ok_or_else(|| damaged("a column has more values than rows"))?;
        }
        Ok(())
    }

    /// Checks the first page, and advances past it. Returns its number of values; 0 for a dictionary.
    fn page(&mut self, pages: &mut &[u8]) -> Result<u64, RecordingError> {
        let (mut kind, mut unpacked, mut packed, mut values) = (None, 0, 0, 0);
        let mut header = Thrift::new(pages);
        header.fields(|header, id, of| {
            match (id, of) {
                (1, I32) => kind = Some(header.count()?),
                (2, I32) => unpacked = header.count()?,
                (3, I32) => packed = header.count()?,
                (5 | 7, STRUCT) => values = page_values(header)?,
                _ => return Ok(false),
            }
            Ok(true)
        })?;
        self.pages += 1;
        self.unpacked_bytes += unpacked;
        at_most("pages", self.pages, PAGES_MAX)?;
        at_most("bytes in a page", unpacked, PAGE_MAX_BYTES)?;
        at_most("bytes in its pages", self.unpacked_bytes, UNPACKED_MAX_BYTES)?;
        let rest = usize::try_from(packed).ok().and_then(|packed| header.rest().get(packed..));
        *pages = rest.ok_or_else(|| damaged("a page ends outside of its column"))?;
        match kind {
            Some(DATA_PAGE) => Ok(values),
            Some(DICTIONARY_PAGE) if values <= unpacked / DICTIONARY_VALUE_BYTES => Ok(0),
            Some(DICTIONARY_PAGE) => Err(damaged("a dictionary has more values than bytes")),
            _ => Err(damaged("a page has a type that recordings do not use")),
        }
    }
}

/// The number of values in a `DataPageHeader` or a `DictionaryPageHeader`.
fn page_values(header: &mut Thrift<'_>) -> Result<u64, RecordingError> {
    let mut values = 0;
    header.fields(|header, id, kind| match (id, kind) {
        (1, I32) => {
            values = header.count()?;
            Ok(true)
        }
        _ => Ok(false),
    })?;
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number as Thrift has it.
    fn number(value: i64) -> Vec<u8> {
        let mut left = ((value << 1) ^ (value >> 63)) as u64;
        let mut bytes = Vec::new();
        while left >= 0x80 {
            bytes.push(left as u8 | 0x80);
            left >>= 7;
        }
        bytes.push(left as u8);
        bytes
    }

    /// A field whose number is larger by `delta` than that of the one before.
    fn field(delta: u8, kind: u8, value: &[u8]) -> Vec<u8> {
        [&[delta << 4 | kind], value].concat()
    }

    fn count(delta: u8, value: i64) -> Vec<u8> {
        field(delta, I32, &number(value))
    }

    fn list(elements: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = vec![0xf0 | STRUCT];
        // The length of a list is not a signed number.
        let mut left = elements.len();
        while left >= 0x80 {
            bytes.push(left as u8 | 0x80);
            left >>= 7;
        }
        bytes.push(left as u8);
        bytes.extend(elements.concat());
        bytes
    }

    /// A page of this kind that claims these sizes and values, and has no bytes.
    fn page(kind: i64, unpacked: i64, packed: i64, values: i64) -> Vec<u8> {
        let of_kind = [count(1, values), vec![0]].concat();
        let delta = if kind == 2 { 4 } else { 2 };
        [count(1, kind), count(1, unpacked), count(1, packed), field(delta, STRUCT, &of_kind), vec![0]].concat()
    }

    fn refusal(outcome: Result<(), RecordingError>) -> String {
        outcome.unwrap_err().to_string()
    }

    fn column(pages: &[u8], rows: u64) -> Result<(), RecordingError> {
        Total::default().column(pages, rows)
    }

    #[test]
    fn a_page_has_the_rows_and_the_bytes_that_are_read() {
        const HUGE: i64 = (1 << 31) - 1;
        assert!(column(&page(0, 9, 0, 10), 10).is_ok());
        assert!(column(&[page(2, 40, 0, 5), page(0, 9, 0, 10)].concat(), 10).is_ok());
        for (pages, says) in [
            (page(0, 9, 0, HUGE), "a column has more values than rows"),
            (
                page(0, HUGE, 0, 10),
                "it has 2147483647 bytes in a page, and at most 16777216 are read: give a recording",
            ),
            (page(2, 40, 0, HUGE), "a dictionary has more values than bytes"),
            (page(0, 9, 1, 10), "a page ends outside of its column"),
            (page(0, -9, 0, 10), "a count is negative"),
            (page(3, 9, 0, 10), "a page has a type that recordings do not use"),
            (page(0, 9, 0, 10)[..5].to_vec(), "its metadata ends early"),
            (page(0, 16 << 20, 0, 0).repeat(65), "bytes in its pages"),
            (page(0, 0, 0, 0).repeat(1 << 21), "pages, and at most 1048576 are read"),
        ] {
            let error = refusal(column(&pages, 10));
            assert!(error.contains(says), "{says}: {error}");
        }
    }

    /// A footer of a root with these elements, and a row group of each of these numbers of rows.
    fn footer(children: &[i64], rows: &[i64]) -> Vec<u8> {
        let element = |children: &i64| [count(5, *children), vec![0]].concat();
        let root = element(&(children.len() as i64));
        let schema = list(&std::iter::once(root).chain(children.iter().map(element)).collect::<Vec<_>>());
        let group = |rows: &i64| [field(3, thrift::I64, &number(*rows)), vec![0]].concat();
        let groups = list(&rows.iter().map(group).collect::<Vec<_>>());
        [count(1, 1), field(1, LIST, &schema), field(2, LIST, &groups), vec![0]].concat()
    }

    /// Written recordings can be read.
    #[test]
    fn a_recording_is_as_long_as_is_read() {
        for (columns, max) in [(1, 10_000_000), (6, 10_000_000), (12, 5_592_405), (64, 1_048_576)] {
            for rows in [max, max + 1] {
                let read = check_footer(&footer(&vec![0; columns], &[rows as i64]));
                assert_eq!(
                    (check_length(rows, columns).is_ok(), read.is_ok()),
                    (rows == max, rows == max),
                    "{columns}"
                );
            }
        }
        assert_eq!(
            check_length(24_000_000, 12).unwrap_err().to_string(),
            "it would have 24000000 rows of 12 columns, and at most 5592405 are read back: record for a shorter time, or \
             fewer rows a second"
        );
    }

    #[test]
    fn a_footer_has_the_columns_and_the_rows_that_are_read() {
        assert!(check_footer(&footer(&[0; 12], &[65_536; 80])).is_ok());
        for (encoded, says) in [
            (footer(&[1; 60], &[]), "nested columns"),
            (footer(&vec![1; 10_000], &[]), "it has 10000 columns, and at most 64 are read"),
            (footer(&[0; 1], &[(1 << 31) - 1]), "2147483647 rows, and at most 10000000"),
            (footer(&[0; 1], &[i64::MAX; 3]), "rows, and at most 10000000"),
            (footer(&[0; 64], &[9_000_000]), "576000000 values, and at most 67108864"),
            (footer(&[0; 1], &vec![0; 70_000]), "70000 row groups, and at most 65536"),
            (field(9, LIST, &[0xf0 | STRUCT, 0xff, 0xff, 0xff, 0x7f]), "a list ends early"),
            (field(1, STRUCT, &vec![0x1c; 100_000]), "nested columns"),
            (field(1, LIST, &vec![0x19; 100_000]), "nested columns"),
        ] {
            let error = refusal(check_footer(&encoded));
            assert!(error.contains(says), "{says}: {error}");
        }
    }
}
