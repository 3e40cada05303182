//! The one reader of tables: CSV text with a header row that names the columns, in any order.
//!
//! A caller names the [`Column`]s that it needs, and gets the place of each; columns that it does not name are ignored.
//! Cells may have blanks around them. Blank lines, and lines that start with `#`, are skipped. Rows are numbered as the
//! lines of the file, so that an editor or a spreadsheet shows the row that a message names.

mod error;
mod lines;

use std::borrow::Cow;
use std::io::Read;

use csv::{ByteRecord, Reader, ReaderBuilder};

pub use error::TableError;
pub(crate) use error::system_error;
use lines::Lines;

/// Similarity from which one name is suggested for another, as a part of their length.
const LIKENESS: f64 = 0.6;
/// Number of characters of a cell that a message quotes.
const QUOTED_CHARS: usize = 40;
/// What stands between columns where the decimal sign is a comma, with its name.
const OTHER_SEPARATORS: [(char, &str); 2] = [(';', "semicolons"), ('\t', "tabs")];

/// A column that a caller reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name in the header.
    pub name: &'static str,
    /// The unit of its cells, for a message, such as `newtons`; empty for words and plain numbers.
    pub unit: &'static str,
}

impl Column {
    /// A column of this name, whose cells are in this unit.
    pub const fn new(name: &'static str, unit: &'static str) -> Self {
        Self { name, unit }
    }
}

/// Where a column stands in a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    column: &'static str,
    index: usize,
}

/// A table that is read row by row.
pub struct Table<R> {
    reader: Reader<Lines<R>>,
    names: Vec<String>,
    /// Whether a caller has asked for the column of each name.
    asked: Vec<bool>,
    cells: ByteRecord,
}

impl<R: Read> Table<R> {
    /// Reads the header. Fails if there are other separators than commas.
    pub fn new(input: R) -> Result<Self, TableError> {
        let mut reader = ReaderBuilder::new().flexible(true).comment(Some(b'#')).from_reader(Lines::new(input));
        let header = reader.byte_headers().map_err(TableError::read)?;
        let names: Vec<String> = header.iter().map(|cell| String::from_utf8_lossy(cell).trim().to_owned()).collect();
        if let [only] = &names[..]
            && let Some((_, found)) = OTHER_SEPARATORS.into_iter().find(|(separator, _)| only.contains(*separator))
        {
            return Err(TableError::Separator { found });
        }
        Ok(Self { reader, asked: vec![false; names.len()], names, cells: ByteRecord::new() })
    }

    /// The names of all columns, in the order of the file.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The cells of the header as they stand in the file.
    pub fn header(&mut self) -> Result<&ByteRecord, TableError> {
        self.reader.byte_headers().map_err(TableError::read)
    }

    /// The place of a column that may be missing. Fails if the header has it twice.
    pub fn find(&mut self, column: Column) -> Result<Option<Place>, TableError> {
        let mut places = (0..).zip(&self.names).filter(|(_, name)| *name == column.name);
        let place = places.next().map(|(index, _)| Place { column: column.name, index });
        if places.next().is_some() {
            return Err(TableError::ColumnTwice { column: column.name });
        }
        if let Some(asked) = place.and_then(|place| self.asked.get_mut(place.index)) {
            *asked = true;
        }
        Ok(place)
    }

    /// The place of a column that is needed.
    pub fn need(&mut self, column: Column) -> Result<Place, TableError> {
        self.find(column)?.ok_or_else(|| self.missing(&[column]))
    }

    /// The error of a header that has none of these columns. A name that the caller has asked for is not suggested.
    pub(crate) fn missing(&self, columns: &[Column]) -> TableError {
        let likeness = |name: &str| {
            let each = columns.iter().map(|column| strsim::normalized_damerau_levenshtein(column.name, name));
            each.fold(0.0, f64::max)
        };
        let nearest = self
            .names
            .iter()
            .zip(&self.asked)
            .filter(|(_, asked)| !**asked)
            .map(|(name, _)| (likeness(name), name))
            .filter(|(likeness, _)| *likeness >= LIKENESS)
            .max_by(|one, other| one.0.total_cmp(&other.0))
            .map(|(_, name)| name.clone());
        let names: Vec<&str> = columns.iter().map(|column| column.name).collect();
        let unit = columns.first().map_or("", |column| column.unit);
        TableError::ColumnMissing { column: names.join(" or "), unit, nearest }
    }

    /// Reads the next row; `None` at the end.
    pub fn next_row(&mut self) -> Result<Option<Row<'_>>, TableError> {
        loop {
            if !self.reader.read_byte_record(&mut self.cells).map_err(TableError::read)? {
                return Ok(None);
            }
            // A line of blanks, such as some editors leave at the end of a file.
            let is_blank = self.cells.len() == 1 && self.cells.iter().all(|cell| cell.trim_ascii().is_empty());
            if !is_blank || self.names.len() == 1 {
                break;
            }
        }
        let number = self.number();
        Ok(Some(Row { number, expected: self.names.len(), cells: &self.cells }))
    }

    /// The line in which the row that was just read begins. The CSV reader itself knows only the first of the lines
    /// that it skipped.
    fn number(&mut self) -> u64 {
        let end = self.reader.position().byte();
        let inside = self.cells.iter().flatten().filter(|byte| **byte == b'\n').count() as u64;
        self.reader.get_mut().last_line(end).saturating_sub(inside)
    }
}

/// A row of a table.
#[derive(Clone, Copy, Debug)]
pub struct Row<'t> {
    number: u64,
    expected: usize,
    cells: &'t ByteRecord,
}

impl<'t> Row<'t> {
    /// Its line in the file; that of the header is 1 if nothing stands above it.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// The cells as they stand in the file, as many as the header has: cells that are missing are empty.
    pub fn cells(&self) -> impl Iterator<Item = &'t [u8]> {
        let cells = self.cells;
        (0..self.expected).map(move |index| cells.get(index).unwrap_or_default())
    }

    /// Fails if the row has more or fewer cells than the header.
    pub fn check_length(&self) -> Result<(), TableError> {
        let (row, expected, found) = (self.number, self.expected, self.cells.len());
        if found == expected { Ok(()) } else { Err(TableError::Length { row, expected, found }) }
    }

    /// A cell without blanks around it; empty if the row is too short.
    pub fn text(&self, place: Place) -> Cow<'t, str> {
        String::from_utf8_lossy(self.cells.get(place.index).unwrap_or_default().trim_ascii())
    }

    /// The beginning of a cell, for a message.
    pub fn quoted(&self, place: Place) -> String {
        let text = self.text(place);
        let mut quoted: String = text.chars().take(QUOTED_CHARS).collect();
        if quoted.len() < text.len() {
            quoted.push_str("...");
        }
        quoted
    }

    /// The number in a cell, which is finite.
    pub fn real(&self, place: Place) -> Result<f64, TableError> {
        let (row, column) = (self.number, place.column);
        let text = self.text(place);
        if text.is_empty() {
            return Err(TableError::CellEmpty { row, column });
        }
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| TableError::NotANumber { row, column, found: self.quoted(place) })
    }

    /// The number in a cell; `None` if the cell is empty.
    pub fn real_if_filled(&self, place: Place) -> Result<Option<f64>, TableError> {
        if self.text(place).is_empty() { Ok(None) } else { self.real(place).map(Some) }
    }
}

/// The whole rows of a file that its writer may still be writing: without a last line that has no line feed.
pub fn whole_rows(text: &str) -> &str {
    text.rsplit_once('\n').map_or("", |(whole, _)| whole)
}

#[cfg(test)]
mod tests {
    use super::{Column, Table};

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
        assert_eq!(numbers("a,b\n"), Vec::<u64>::new());
        assert_eq!(numbers(""), Vec::<u64>::new());
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
        assert_eq!(row.real_if_filled(a).unwrap(), None);
        let said = row.real(b).unwrap_err().to_string();
        assert_eq!(said, "row 3, column b: expected a number, found an empty cell: correct the cell or delete the row");
    }
}
