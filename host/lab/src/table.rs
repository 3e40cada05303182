//! The one reader of tables: CSV text with a header row that names the columns, in any order.
//!
//! A caller names the [`Column`]s that it needs, and gets the place of each; columns that it does not name are ignored.
//! A header may state another unit than the caller's (`friction_mn`, `friction [mN]`); numbers are converted.
//!
//! Spreadsheets write tables differently from programs: with semicolons or tabs between columns, with decimal commas,
//! in UTF-16. The format is detected from the first 64 KiB of a file; ambiguous input is refused. [`Table::understood`]
//! describes the detected format in a sentence.
//!
//! A Parquet file of [`recording`](crate::recording) is a table, too, with its rows numbered as those of its CSV.
//!
//! Cells may have blanks around them. Blank lines, and lines that start with `#`, are skipped, and so is what
//! instruments write above the header (`layout`). Rows are numbered as the lines of the file, so that an editor or a
//! spreadsheet shows the row that a message names.

mod blanks;
mod dialect;
mod error;
mod layout;
mod lines;
mod unit;
mod utf16;

use std::borrow::Cow;
use std::io::{self, Chain, Cursor, Read};

use csv::{ByteRecord, Reader, ReaderBuilder};
use encoding_rs::mem::decode_latin1;
use frixel_play::TO_THE_END;
use frixel_scene::{FileKind, Nearest, WrongKind, brief, check_toml};

use crate::input::{ROWS_MAX, at_most, check_header};
use crate::recording::{MAGIC, Recording};

use blanks::Blanks;
pub(crate) use dialect::Dialect;
use dialect::Digits;
pub use error::TableError;
pub(crate) use error::system_error;
use layout::BLANK;
use lines::Lines;
use unit::Named;
pub use unit::Unit;
use utf16::Utf8;

/// Spellings of an unknown value.
const UNKNOWN: [&str; 6] = ["", "nan", "na", "n/a", "<na>", "null"];
const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();
/// Number of bytes at the beginning of a file that tell its kind and format. They contain a table's header.
pub(crate) const HEAD_BYTES: u64 = 64 << 10;

/// A column that a caller reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name in the header.
    pub name: &'static str,
    /// Unit of its cells in messages, such as `newtons`; empty for words and plain numbers.
    pub unit: &'static str,
    /// The unit to which its numbers are converted if a header may state another.
    pub converted: Option<Unit>,
}

impl Column {
    /// A column of this name, whose cells are in this unit.
    pub const fn new(name: &'static str, unit: &'static str) -> Self {
        Self { name, unit, converted: None }
    }

    /// The same column, which may also have another unit of the quantity. Its name has the symbol of `unit`, as in
    /// `friction_n`.
    #[must_use]
    pub const fn converted(self, unit: Unit) -> Self {
        Self { converted: Some(unit), ..self }
    }
}

/// Position of a column in a table, and the factor of its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    index: usize,
    power_of_ten: i32,
}

impl Place {
    /// The name of the column, among those of its table.
    pub(crate) fn name_in(self, names: &[String]) -> &str {
        names.get(self.index).map_or("", String::as_str)
    }
}

/// The result of reading a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading<T> {
    /// The value that was read.
    pub value: T,
    /// Description of the detected format, as from [`Table::understood`].
    pub understood: Option<String>,
}

type Input<R> = Lines<Blanks<Chain<Cursor<Vec<u8>>, Utf8<R>>>>;

/// A table that is read row by row.
pub struct Table<R> {
    reader: Reader<Input<R>>,
    dialect: Dialect,
    names: Vec<String>,
    /// The unit of each column, from a row of units; empty without such a row.
    units: Vec<String>,
    /// Positions of header and units, if not in the first lines.
    layout: Vec<String>,
    /// For each column, whether a caller has requested it.
    asked: Vec<bool>,
    /// Columns whose header states the unit differently from the requested name.
    stated: Vec<String>,
    kind: Option<FileKind>,
    /// Rows that were read.
    rows: u64,
    cells: ByteRecord,
}

/// Refuses pictures, zips, and whole TOML files. Lines of an instrument above a header may look like a field.
fn refuse_other_kinds(head: &[u8], is_whole: bool) -> Result<(), TableError> {
    let is_toml = |text: &str| check_toml(text).is_ok() && toml::from_str::<toml::Table>(text).is_ok();
    let is_other = |kind: &FileKind| match kind {
        FileKind::Picture | FileKind::Zip => true,
        _ => is_whole && str::from_utf8(head).is_ok_and(is_toml),
    };
    let wrong = FileKind::of(head).filter(is_other).map(|found| WrongKind { found, expected: FileKind::Table });
    wrong.map_or(Ok(()), |wrong| Err(wrong.into()))
}

impl<R: Read> Table<R> {
    /// Reads up to the header. Fails if the separator of the columns cannot be determined.
    pub fn new(input: R) -> Result<Self, TableError> {
        let mut input = Utf8::new(input)?;
        let mut head = Vec::new();
        input.by_ref().take(HEAD_BYTES).read_to_end(&mut head)?;
        let mut is_cut_off = false;
        if head.starts_with(MAGIC) {
            input.read_to_end(&mut head)?;
            let recording = Recording::read_parquet(head, TO_THE_END).map_err(io::Error::other)?;
            is_cut_off = recording.is_cut_off;
            head = recording.to_csv();
        }
        let is_whole = (head.len() as u64) < HEAD_BYTES;
        refuse_other_kinds(&head, is_whole)?;
        if head.starts_with(BYTE_ORDER_MARK) {
            head.drain(..BYTE_ORDER_MARK.len());
        }
        if !is_whole && !head.iter().any(|byte| matches!(byte, b'\n' | b'\r')) {
            return Err(TableError::no_table(format!("the first line has more than {HEAD_BYTES} bytes")));
        }
        let kind = FileKind::of(&head);
        let (dialect, found) = Dialect::of(&mut head, is_whole, input.order())?;
        let (units, mut layout) = (found.units().to_vec(), found.words(&head));
        layout.extend(is_cut_off.then(|| "the recording was cut off, and ends with its last whole rows".to_owned()));
        found.mark(&mut head);
        let input = Blanks::new(Cursor::new(head).chain(input), dialect.separator() == BLANK);
        let input = Lines::new(input);
        let builder = &mut ReaderBuilder::new();
        let mut reader = builder.flexible(true).comment(Some(b'#')).delimiter(dialect.separator()).from_reader(input);
        let header = reader.byte_headers()?;
        check_header(header.iter()).map_err(io::Error::from)?;
        let names: Vec<String> = header.iter().map(name).collect();
        let asked = vec![false; names.len()];
        let (stated, rows, cells) = (Vec::new(), 0, ByteRecord::new());
        Ok(Self { reader, dialect, names, units, layout, asked, stated, kind, rows, cells })
    }

    /// How the table is written.
    pub(crate) fn dialect(&self) -> Dialect {
        self.dialect
    }

    /// Describes in one sentence how the table deviates from documented names, comma separators and decimal points.
    ///
    /// `None` if it does not deviate. Call this after requesting the columns.
    pub fn understood(&self) -> Option<String> {
        let stated = self.stated.iter().map(String::as_str).collect::<Vec<_>>().join(" and ");
        let stated = (!stated.is_empty()).then(|| format!("read {stated}"));
        let words: Vec<String> = stated.into_iter().chain(self.layout.clone()).chain(self.dialect.words()).collect();
        (!words.is_empty()).then(|| words.join("; "))
    }

    /// The names of all columns, in the order of the file.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The cells of the header as they stand in the file.
    pub fn header(&mut self) -> Result<&ByteRecord, TableError> {
        Ok(self.reader.byte_headers()?)
    }

    /// The names of the columns that no caller has requested.
    pub(crate) fn ignored(&self) -> Vec<String> {
        let unasked = self.names.iter().zip(&self.asked).filter(|(_, asked)| !**asked);
        unasked.map(|(name, _)| name.clone()).collect()
    }

    /// The place of a column that may be missing. Fails if the header has it twice, or in a unit that can be read in
    /// two ways.
    pub fn find(&mut self, column: Column) -> Result<Option<Place>, TableError> {
        let exact = (0..).zip(&self.names).filter(|(_, name)| *name == column.name);
        let mut places: Vec<Place> = exact.map(|(index, _)| Place { index, power_of_ten: 0 }).collect();
        if let Some(unit) = column.converted
            && (places.is_empty() || !self.units.is_empty())
        {
            places = self.find_converted(column.name, unit)?;
        }
        match places[..] {
            [] => Ok(None),
            [place] => {
                if let Some(asked) = self.asked.get_mut(place.index) {
                    *asked = true;
                }
                Ok(Some(place))
            }
            [one, other, ..] => {
                let [one, other] = [one, other].map(|place| place.name_in(&self.names));
                let found = if one == other {
                    format!("the header has the column {} twice", brief(one))
                } else {
                    format!("the header has one quantity twice, {} and {}", brief(one), brief(other))
                };
                Err(TableError::new(found, "leave one of them out"))
            }
        }
    }

    /// The places of the columns that state the quantity in another unit.
    fn find_converted(&mut self, name: &str, unit: Unit) -> Result<Vec<Place>, TableError> {
        let mut places = Vec::new();
        for (index, plain) in self.names.iter().enumerate() {
            let header = &match self.units.get(index).map(|unit| unit::without_brackets(unit)) {
                Some(unit) if unit::is_unit(unit) => format!("{plain} [{unit}]"),
                _ => plain.clone(),
            };
            match unit::named(header, name, unit) {
                Named::Other => {}
                Named::In(_) if plain == name => places.push(Place { index, power_of_ten: 0 }),
                Named::In(scale) => {
                    places.push(Place { index, power_of_ten: unit.power_from(scale) });
                    let stated = format!("`{header}` in {}", unit::words(name, unit, scale));
                    if !self.stated.contains(&stated) {
                        self.stated.push(stated);
                    }
                }
                Named::Doubtful { readings, advice } => {
                    let readings = readings.join(" or in ");
                    return Err(TableError::new(
                        format!("the column `{}` can be read in {readings}", brief(header)),
                        advice,
                    ));
                }
            }
        }
        Ok(places)
    }

    /// The place of a column that is needed.
    pub fn need(&mut self, column: Column) -> Result<Place, TableError> {
        self.find(column)?.ok_or_else(|| self.missing(&[column]))
    }

    /// The error of a header that has none of these columns. A name that the caller has asked for is not suggested.
    pub(crate) fn missing(&self, columns: &[Column]) -> TableError {
        if self.names.is_empty() {
            return TableError::no_table("the table is empty");
        }
        let expected = columns.iter().find_map(|column| FileKind::of_column(column.name));
        if let (Some(found @ (FileKind::Calibration | FileKind::Stroke)), Some(expected)) = (self.kind, expected)
            && found != expected
        {
            return WrongKind { found, expected }.into();
        }
        let ignored = self.ignored();
        let nearest = |column: &Column| Nearest::new(column.name, ignored.iter().map(String::as_str)).suggestion;
        let nearest = columns.iter().find_map(nearest);
        let nearest = nearest.map_or(String::new(), |name| format!(" (it has {})", brief(&name)));
        let names: Vec<&str> = columns.iter().map(|column| column.name).collect();
        let found = format!("the header has no column {}{nearest}", names.join(" or "));
        match columns.first().map_or("", |column| column.unit) {
            "" => TableError::new(found, "name the column so"),
            unit => TableError::new(found, format!("name the column so, in {unit}")),
        }
    }

    /// Reads the next row; `None` at the end.
    pub fn next_row(&mut self) -> Result<Option<Row<'_>>, TableError> {
        loop {
            if !self.reader.read_byte_record(&mut self.cells)? {
                return Ok(None);
            }
            // A line of blanks, such as some editors leave at the end of a file.
            let is_blank = self.cells.len() == 1 && self.cells.iter().all(|cell| cell.trim_ascii().is_empty());
            if !is_blank || self.names.len() == 1 {
                break;
            }
        }
        self.rows += 1;
        at_most("rows or more", self.rows, ROWS_MAX).map_err(io::Error::from)?;
        let number = self.number();
        Ok(Some(Row { number, names: &self.names, dialect: self.dialect, cells: &self.cells }))
    }

    /// The line in which the row that was just read begins. The CSV reader itself knows only the first of the lines
    /// that it skipped.
    fn number(&mut self) -> u64 {
        let end = self.reader.position().byte();
        let inside = self.cells.iter().flatten().filter(|byte| **byte == b'\n').count() as u64;
        self.reader.get_mut().last_line(end).saturating_sub(inside)
    }
}

/// The beginning of a cell of the header. Bytes that are not UTF-8 are read as Latin-1, which older programs use for
/// the `µ` of a unit.
fn name(cell: &[u8]) -> String {
    let text = str::from_utf8(cell).map_or_else(|_| decode_latin1(cell), Cow::Borrowed);
    brief(text.trim()).into_owned()
}

/// A row of a table.
#[derive(Clone, Copy, Debug)]
pub struct Row<'t> {
    number: u64,
    names: &'t [String],
    dialect: Dialect,
    cells: &'t ByteRecord,
}

impl<'t> Row<'t> {
    /// Its line in the file. The header is line 1 if nothing stands above it.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// The cells as they stand in the file, as many as the header has: cells that are missing are empty.
    pub fn cells(&self) -> impl Iterator<Item = &'t [u8]> {
        let cells = self.cells;
        (0..self.names.len()).map(move |index| cells.get(index).unwrap_or_default())
    }

    /// Fails if the row has more or fewer cells than the header.
    pub fn check_length(&self) -> Result<(), TableError> {
        let (row, expected, found) = (self.number, self.names.len(), self.cells.len());
        if found == expected || layout::is_short(self.names, found) {
            return Ok(());
        }
        let advice = if found > expected {
            "correct or delete the row; if commas are decimal signs, save the file with semicolons between columns"
        } else {
            "correct or delete the row"
        };
        Err(TableError::new(format!("row {row}: expected {expected} cells as in the header, found {found}"), advice))
    }

    /// A cell without blanks around it; empty if the row is too short.
    pub fn text(&self, place: Place) -> Cow<'t, str> {
        String::from_utf8_lossy(self.cells.get(place.index).unwrap_or_default().trim_ascii())
    }

    /// The beginning of a cell, for a message.
    pub fn quoted(&self, place: Place) -> String {
        brief(&self.text(place)).into_owned()
    }

    /// The number in a cell, which is finite, in the unit of the caller.
    pub fn real(&self, place: Place) -> Result<f64, TableError> {
        let number = self.digits(place)?.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| not_a_number(self.number, place.name_in(self.names), &self.quoted(place)))
    }

    /// The digits of the number in a cell, in the unit of the caller and with a decimal point. They need not be a
    /// number.
    pub(crate) fn digits(&self, place: Place) -> Result<Cow<'t, str>, TableError> {
        let (row, column) = (self.number, place.name_in(self.names));
        let text = self.text(place);
        if text.is_empty() {
            return Err(not_a_number(row, column, ""));
        }
        let digits = match self.dialect.digits(&text) {
            Digits::Number(digits) => digits.into_owned(),
            Digits::Doubtful(readings) => {
                let (column, found, readings) = (brief(column), self.quoted(place), readings.join(" or as "));
                return Err(TableError::new(
                    format!("row {row}, column {column}: {found:?} can be read as {readings}"),
                    "save the file with decimal points and without thousands separators",
                ));
            }
        };
        if place.power_of_ten == 0 {
            return Ok(digits.into());
        }
        // The exponent is moved, so that the number is rounded once.
        let (mantissa, exponent) = digits.split_once(['e', 'E']).unwrap_or((&digits, "0"));
        let exponent = exponent.parse::<i32>().ok().and_then(|exponent| exponent.checked_add(place.power_of_ten));
        Ok(exponent.map_or(digits.clone(), |exponent| format!("{mantissa}e{exponent}")).into())
    }

    /// The name that a column has in the file.
    pub(crate) fn column(&self, place: Place) -> String {
        place.name_in(self.names).to_owned()
    }

    /// The text of a cell; `None` if the value is unknown.
    pub fn known(&self, place: Place) -> Option<Cow<'t, str>> {
        let text = self.text(place);
        (!UNKNOWN.iter().any(|unknown| text.eq_ignore_ascii_case(unknown))).then_some(text)
    }

    /// The number in a cell; `None` if the value is unknown.
    pub fn real_if_known(&self, place: Place) -> Result<Option<f64>, TableError> {
        self.known(place).map(|_| self.real(place)).transpose()
    }
}

/// The error of a cell that is not a number; `found` is empty if the cell is.
pub(crate) fn not_a_number(row: u64, column: &str, found: &str) -> TableError {
    let found = if found.is_empty() { "an empty cell".to_owned() } else { format!("{found:?}") };
    TableError::new(
        format!("row {row}, column {}: expected a number, found {found}", brief(column)),
        "correct the cell or delete the row",
    )
}

/// The complete rows of a file that may still be growing, without an unterminated last line.
pub fn whole_rows(bytes: &[u8]) -> &[u8] {
    bytes.get(..utf16::end_of_lines(bytes)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::{Column, Table, TableError, Unit, whole_rows};

    fn numbers(text: &str) -> Vec<u64> {
        let mut table = Table::new(text.as_bytes()).unwrap();
        std::iter::from_fn(|| table.next_row().unwrap().map(|row| row.number())).collect()
    }

    #[test]
    fn rows_are_numbered_as_the_lines_of_the_file() {
        assert_eq!(numbers("a,b\n1,2\n3,4\n"), [2, 3]);
        assert_eq!(numbers("a,b\n1,2\n3,4"), [2, 3]);
        assert_eq!(numbers("a,b\r\n1,2\r\n3,4\r\n"), [2, 3]);
        assert_eq!(numbers("a,b\r\n\r\n1,2\r\n \t \r\n3,4"), [3, 5]);
        assert_eq!(numbers("\n# made by hand\na,b\n\n1,2\n\n\n# and\n3,4\n\n"), [5, 9]);
        assert_eq!(numbers("a,b\n\"1\n\",2\n3,\"\n\n4\"\n5,6\n"), [2, 4, 7]);
        assert_eq!(numbers("% made by hand\na,b\n1,2\n% and\n3,4\n"), [3, 5]);
        assert_eq!(numbers("a,b\n"), Vec::<u64>::new());
        assert_eq!(numbers(""), Vec::<u64>::new());
    }

    fn read(bytes: &[u8]) -> Result<(Vec<f64>, Option<String>), TableError> {
        let mut table = Table::new(bytes)?;
        let voltage = table.need(Column::new("voltage_v_rms", "volts rms").converted(Unit::VOLTS))?;
        let friction = table.need(Column::new("friction_n", "newtons").converted(Unit::NEWTONS))?;
        let mut numbers = Vec::new();
        while let Some(row) = table.next_row()? {
            row.check_length()?;
            numbers.extend([row.real(voltage)?, row.real(friction)?]);
        }
        Ok((numbers, table.understood()))
    }

    #[test]
    fn a_table_is_read_as_spreadsheets_of_other_countries_write_it() {
        let numbers = vec![150.5, 0.25, 0.0, 1.25];
        let plain = "voltage_v_rms,friction_n\n150.5,0.25\n0,1.25\n";
        assert_eq!(read(plain.as_bytes()).unwrap(), (numbers.clone(), None));
        let german = "voltage_kv_rms;Friction [mN]\r\n0,1505;250,0\r\n0;1,25e3\r\n";
        let said = "read `voltage_kv_rms` in kilovolts rms and `Friction [mN]` in millinewtons; columns are separated by \
                    semicolons, with decimal commas";
        assert_eq!(read(german.as_bytes()).unwrap(), (numbers.clone(), Some(said.to_owned())));
        let tabs = "\u{feff}voltage_v_rms\tfriction_n\n150.5\t0.25\n0\t1.25\n";
        let bytes: Vec<u8> = tabs.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let said = "columns are separated by tabs; the text is UTF-16, little-endian";
        assert_eq!(read(&bytes).unwrap(), (numbers.clone(), Some(said.to_owned())));
        let latin = read(b"voltage_v_rms\tfriction (\xb5N)\n150\t250000\n").unwrap();
        assert_eq!(latin.0, [150.0, 0.25]);
        let quoted = "voltage_v_rms,friction_n\n\"150,5\",\"0,25\"\n0,\"1,25\"\n";
        let said = "numbers have decimal commas";
        assert_eq!(read(quoted.as_bytes()).unwrap(), (numbers, Some(said.to_owned())));
    }

    /// How a table is written is found from its first 64 KiB, and comments are skipped wherever they stand.
    #[test]
    fn a_comment_is_skipped_wherever_it_stands() {
        for sign in ["#", "%"] {
            let rows = 30_000;
            let text = format!("a b\n{}{sign} pause, 3 s\n5 6\n", "1 2\n".repeat(rows));
            let mut expected: Vec<u64> = (2..=rows as u64 + 1).collect();
            expected.push(rows as u64 + 3);
            assert_eq!(numbers(&text), expected, "{sign}");
        }
    }

    #[test]
    fn a_line_that_tells_the_separator_is_not_the_header() {
        for start in ["", "\u{feff}"] {
            let text = format!("{start}sep=;\r\nvoltage_v_rms;friction_n\r\n1;0,5\r\n");
            assert_eq!(read(text.as_bytes()).unwrap().0, [1.0, 0.5]);
            let wrong = format!("{start}sep=;\nvoltage_v_rms;friction_n\n1;x\n");
            assert!(read(wrong.as_bytes()).unwrap_err().to_string().starts_with("row 3, column friction_n"));
        }
    }

    #[test]
    fn decimal_commas_between_commas_are_refused_with_what_to_do() {
        let said = "row 2: expected 2 cells as in the header, found 3: correct or delete the row; if commas are decimal \
                    signs, save the file with semicolons between columns";
        let error = read("voltage_v_rms,friction_n\n150,0,25\n75,0,5\n".as_bytes()).unwrap_err();
        assert_eq!(error.to_string(), said);
    }

    #[test]
    fn a_number_is_rounded_once_when_its_unit_is_converted() {
        for (text, number) in
            [("150", 0.15), ("0.3", 0.3e-3), ("1e2", 0.1), ("-7.5e-1", -0.75e-3), ("1e2147483647", f64::NAN)]
        {
            let table = format!("voltage_v_rms,friction_mn\n1,{text}\n");
            match read(table.as_bytes()) {
                Ok((numbers, _)) => assert_eq!(numbers.get(1), Some(&number), "{text}"),
                Err(error) => assert!(number.is_nan() && error.to_string().contains("expected a number"), "{error}"),
            }
        }
    }

    #[test]
    fn the_last_line_of_a_file_that_grows_is_left_out_in_each_encoding() {
        let text = "\u{feff}a;b\n1;2\n\u{a0a}3;";
        let whole = "\u{feff}a;b\n1;2\n";
        assert_eq!(whole_rows(text.as_bytes()), whole.as_bytes());
        let little = |text: &str| text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
        let big = |text: &str| text.encode_utf16().flat_map(u16::to_be_bytes).collect::<Vec<u8>>();
        assert_eq!(whole_rows(&little(text)), little(whole));
        assert_eq!(whole_rows(&big(text)), big(whole));
        assert_eq!(whole_rows(b"a;b"), b"");
    }

    #[test]
    fn cells_are_found_by_the_names_of_their_columns() {
        let mut table = Table::new("\u{feff}note, b ,\"a\"\nx, 1e3 ,-2\ny,,\n".as_bytes()).unwrap();
        let [a, b] = ["a", "b"].map(|name| table.need(Column::new(name, "newtons")).unwrap());
        assert_eq!(table.find(Column::new("c", "newtons")).unwrap(), None);
        assert!(table.need(Column::new("note", "words")).is_ok());
        let row = table.next_row().unwrap().unwrap();
        assert_eq!([a, b].map(|place| row.real(place).unwrap().to_string()), ["-2", "1000"]);
        let row = table.next_row().unwrap().unwrap();
        assert_eq!(row.real_if_known(a).unwrap(), None);
        let said = row.real(b).unwrap_err().to_string();
        assert_eq!(said, "row 3, column b: expected a number, found an empty cell: correct the cell or delete the row");
    }
}
