//! Where the header stands among the first lines of a table.
//!
//! Instruments write lines of their own above the header, the header into a comment, or a row of units below it. The
//! header is the first line, unless that has numbers, or another number of cells than most lines: then it is the last
//! line of names above the first row of numbers.

use std::collections::BTreeMap;

use csv::{ByteRecord, ReaderBuilder};

use super::dialect::is_number;
use super::unit::is_unit;

/// First characters of a comment. The CSV reader itself skips only comments with the first of them.
pub(super) const COMMENTS: [u8; 2] = [b'#', b'%'];
/// The separator of columns that any number of blanks separates.
pub(super) const BLANK: u8 = b' ';
/// The last column of `LabVIEW`, whose cell rows leave out.
const COMMENT_COLUMN: &str = "Comment";

/// A line that is not blank.
struct Line {
    /// Place of its first byte.
    start: usize,
    is_comment: bool,
    cells: Vec<String>,
}

impl Line {
    fn of(start: usize, line: &[u8], separator: u8) -> Self {
        let end = line.iter().rposition(|byte| !matches!(byte, b'\n' | b'\r')).map_or(0, |last| last + 1);
        let mut text = line.get(..end).unwrap_or_default();
        let is_comment = line.first().is_some_and(|byte| COMMENTS.contains(byte));
        while let Some(rest) = text.split_first().filter(|(byte, _)| is_comment && COMMENTS.contains(byte)) {
            text = rest.1;
        }
        Self { start, is_comment, cells: cells(text, separator) }
    }

    /// Whether most cells are numbers.
    fn has_numbers(&self) -> bool {
        let filled = self.cells.iter().filter(|cell| !cell.is_empty());
        2 * filled.clone().filter(|cell| is_number(cell)).count() > filled.count()
    }

    /// Whether each cell is a unit, or a mark for none.
    fn has_units(&self) -> bool {
        let has_unit = |cell: &String| is_unit(cell);
        self.cells.iter().any(has_unit) && self.cells.iter().all(|cell| has_unit(cell) || matches!(&**cell, "" | "-"))
    }

    /// Whether it has a name for each of so many columns.
    fn names(&self, columns: usize) -> bool {
        let is_name = |cell: &String| !cell.is_empty() && !is_number(cell);
        (self.cells.len() == columns || is_short(&self.cells, columns))
            && self.cells.iter().all(is_name)
            && !self.has_units()
    }
}

/// Whether a row with so many cells leaves out no more than the last column of `LabVIEW`.
pub(super) fn is_short(names: &[String], cells: usize) -> bool {
    names.len() == cells + 1 && names.last().is_some_and(|name| name.eq_ignore_ascii_case(COMMENT_COLUMN))
}

/// The first lines of a table, as one separator divides them.
pub(super) struct Layout {
    pub(super) separator: u8,
    lines: Vec<Line>,
    /// Place of the header among the lines.
    header: usize,
    /// Place of a row of units.
    units: Option<usize>,
}

impl Layout {
    /// Divides the first lines, the last of which may be cut unless that `is_whole`.
    pub(super) fn of(head: &[u8], separator: u8, is_whole: bool) -> Self {
        let mut lines = lines(head, separator);
        if !is_whole && lines.len() > 1 {
            lines.pop();
        }
        if lines.iter().all(|line| line.is_comment) {
            lines.clear();
        }
        let header = header(&lines);
        let mut below = lines.iter().enumerate().skip(header + 1).filter(|(_, line)| !line.is_comment);
        let units = below.next().filter(|(_, line)| line.has_units()).map(|(index, _)| index);
        let units = units.filter(|_| below.next().is_some_and(|(_, line)| line.has_numbers()));
        Self { separator, lines, header, units }
    }

    pub(super) fn columns(&self) -> usize {
        self.lines.get(self.header).map_or(0, |line| line.cells.len())
    }

    /// Whether the header has names only.
    pub(super) fn has_names(&self) -> bool {
        self.lines.get(self.header).is_some_and(|line| !line.cells.iter().any(|cell| is_number(cell)))
    }

    /// The cells of the rows below the header.
    pub(super) fn rows(&self) -> impl Iterator<Item = &[String]> {
        let below = self.lines.iter().enumerate().skip(self.header + 1);
        below.filter(|(index, line)| !line.is_comment && self.units != Some(*index)).map(|(_, line)| &*line.cells)
    }

    /// Whether each row has a cell for each column.
    pub(super) fn is_even(&self) -> bool {
        let names = self.lines.get(self.header).map_or(&[][..], |line| &line.cells);
        self.rows().all(|row| row.len() == names.len() || is_short(names, row.len()))
    }

    /// Whether there are two columns or more, and all rows have numbers for them.
    pub(super) fn has_numbers(&self) -> bool {
        let rows = self.lines.iter().skip(self.units.unwrap_or(self.header) + 1).filter(|line| !line.is_comment);
        self.columns() > 1 && self.is_even() && rows.clone().count() > 0 && rows.clone().all(Line::has_numbers)
    }

    /// The units that stand below the names; none without such a row.
    pub(super) fn units(&self) -> &[String] {
        self.units.and_then(|index| self.lines.get(index)).map_or(&[], |line| &line.cells)
    }

    /// Makes comments, which the CSV reader skips, of the lines above the header and of the units.
    pub(super) fn mark(&self, head: &mut [u8]) {
        let Some(header) = self.lines.get(self.header) else { return };
        let mut begins = true;
        for byte in head.iter_mut().take(header.start) {
            let ends = matches!(byte, b'\n' | b'\r');
            if begins && !ends {
                *byte = b'#';
            }
            begins = ends;
        }
        let names = head.get_mut(header.start..).unwrap_or_default();
        if header.is_comment {
            names.iter_mut().take_while(|byte| COMMENTS.contains(byte)).for_each(|byte| *byte = BLANK);
        }
        let units = self.units.and_then(|index| self.lines.get(index));
        if let Some(first) = units.and_then(|units| head.get_mut(units.start)) {
            *first = b'#';
        }
    }

    /// Where header and units stand, if not in the first lines.
    pub(super) fn words(&self, head: &[u8]) -> Vec<String> {
        let number = |index: usize| {
            let start = self.lines.get(index).map_or(0, |line| line.start);
            1 + head.iter().take(start).filter(|byte| **byte == b'\n').count()
        };
        let is_first = self.lines.iter().position(|line| !line.is_comment).is_none_or(|first| first == self.header);
        let header = (!is_first).then(|| format!("the header is line {}", number(self.header)));
        header.into_iter().chain(self.units.map(|index| format!("line {} has units", number(index)))).collect()
    }
}

fn lines(head: &[u8], separator: u8) -> Vec<Line> {
    let mut start = 0;
    let mut lines = Vec::new();
    for line in head.split_inclusive(|byte| matches!(byte, b'\n' | b'\r')) {
        if !line.trim_ascii().is_empty() {
            lines.push(Line::of(start, line, separator));
        }
        start += line.len();
    }
    lines
}

fn cells(text: &[u8], separator: u8) -> Vec<String> {
    let cell = |bytes: &[u8]| String::from_utf8_lossy(bytes.trim_ascii()).into_owned();
    if separator == BLANK {
        return text.split(u8::is_ascii_whitespace).filter(|cell| !cell.is_empty()).map(cell).collect();
    }
    let mut reader =
        ReaderBuilder::new().has_headers(false).delimiter(separator).buffer_capacity(text.len() + 1).from_reader(text);
    let mut record = ByteRecord::new();
    // Bytes in memory are read without an error.
    let _ = reader.read_byte_record(&mut record);
    record.iter().map(cell).collect()
}

/// The place of the header.
fn header(lines: &[Line]) -> usize {
    let rows = || lines.iter().enumerate().filter(|(_, line)| !line.is_comment);
    let Some((first, line)) = rows().next() else { return 0 };
    let mut counts = BTreeMap::<usize, usize>::new();
    for (_, row) in rows() {
        *counts.entry(row.cells.len()).or_default() += 1;
    }
    let is_usual = |(columns, count): &(usize, usize)| (*count, *columns == line.cells.len());
    let usual = counts.into_iter().max_by_key(is_usual).map_or(0, |(columns, _)| columns);
    if line.cells.len() == usual && !line.has_numbers() && !line.has_units() {
        return first;
    }
    let numbers = rows().find(|(_, row)| row.cells.len() == usual && row.has_numbers());
    let above = lines.iter().enumerate().take(numbers.map_or(0, |(index, _)| index));
    above.rev().find(|(_, line)| usual > 1 && line.names(usual)).map_or(first, |(index, _)| index)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{Column, Table, TableError, Unit};

    /// Row number, voltage and friction.
    type Numbers = (u64, f64, f64);

    /// The rows of a table, and how it was understood.
    fn read(text: &[u8]) -> Result<(Vec<Numbers>, String), TableError> {
        let mut table = Table::new(text)?;
        let voltage = table.need(Column::new("voltage_v_rms", "volts rms").converted(Unit::VOLTS))?;
        let friction = table.need(Column::new("friction_n", "newtons").converted(Unit::NEWTONS))?;
        let mut rows = Vec::new();
        while let Some(row) = table.next_row()? {
            row.check_length()?;
            rows.push((row.number(), row.real(voltage)?, row.real(friction)?));
        }
        Ok((rows, table.understood().unwrap_or_default()))
    }

    #[test]
    fn the_header_is_found_below_what_instruments_write_above_it() {
        let labview = "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDate\t2026/11/26\n***End_of_Header***\t\n\t\n\
                       Channels\t3\t\t\t\nSamples\t2\t2\t2\t\nY_Unit_Label\tVolts\tNewtons\tNewtons\t\nX0\t0.0E+0\t0.0E+0\t0.0E+0\t\n\
                       ***End_of_Header***\t\t\t\t\nX_Value\tvoltage_v_rms\tfriction_n\tz\tComment\n";
        let labview = format!("{labview}{}", "0.0\t0\t0.25\t1\n0.1\t150\t0.3\t1\n".repeat(4));
        let tribometer = "Tribometer 5, serial 12\nDate: Mon, 3 Jan\nLoad;0,5;N\n\nvoltage_v_rms;z;friction_n\nV;-;N\n0;1;0,25\n150;1;0,3\n";
        for (text, first, said) in [
            (
                "Recorder 3\nRate 1000 Hz\n\nvoltage_v_rms\tz\tfriction_n\nV\tmm\tN\n0\t1\t0.25\n150\t1\t0.3\n",
                6,
                "the header is line 4; line 5 has units; columns are separated by tabs",
            ),
            (
                "% recorder 3\n% voltage_v_rms z friction_n\n0 1 0.25\n150  1  0.3\n",
                3,
                "the header is line 2; columns are separated by blanks",
            ),
            ("# voltage_v_rms,friction_n\n0,0.25\n150,0.3\n", 2, "the header is line 1"),
            ("\u{feff}Recorder\r\n\r\nvoltage_v_rms,friction_n\r\n0,0.25\r\n150,0.3\r\n", 4, "the header is line 3"),
            (
                "  voltage_v_rms   friction_n\n    0       0.25\n# pause\n  150\t  0.3  \n\n",
                2,
                "columns are separated by blanks",
            ),
            ("voltage_v_rms,friction_n\n[V],[N]\n0,0.25\n150,0.3\n", 3, "line 2 has units"),
            (
                "Voltage rms,Friction\nV,mN\n0,250\n150,300\n",
                3,
                "read `Voltage rms [V]` in volts rms and `Friction [mN]` in millinewtons; line 2 has units",
            ),
            (
                tribometer,
                7,
                "the header is line 5; line 6 has units; columns are separated by semicolons, with decimal commas",
            ),
            (&labview, 13, "the header is line 12; columns are separated by tabs"),
        ] {
            let (rows, understood) = read(text.as_bytes()).unwrap_or_else(|error| panic!("{text}: {error}"));
            let numbers: Vec<(f64, f64)> = rows.iter().map(|(_, voltage, friction)| (*voltage, *friction)).collect();
            assert_eq!(numbers[..2], [(0.0, 0.25), (150.0, 0.3)], "{text}");
            assert_eq!((rows[0].0, &*understood), (first, said), "{text}");
        }
    }

    #[test]
    fn a_unit_below_a_name_that_states_another_is_refused_with_both() {
        let said = read(b"voltage_v_rms,friction_n\nV,mN\n0,250\n").unwrap_err().to_string();
        assert_eq!(
            said,
            "the column `friction_n [mN]` can be read in newtons or in millinewtons: name it friction_n or friction_mn"
        );
    }

    #[test]
    fn the_first_line_is_the_header_where_nothing_says_another() {
        for (text, said) in [
            ("a,b\n1,2,3\n4,5,6\n", "the header has no column voltage_v_rms"),
            ("1,2\n3,4\n", "the header has no column voltage_v_rms"),
            ("voltage_v_rms,friction_n\n1,2,3\n4,5,6\n", "row 2: expected 2 cells as in the header, found 3"),
            ("voltage v,friction\n1,2\n", "the column `voltage v` can be read in volts rms or in volts peak"),
            ("# only\n# comments\n", "the table is empty"),
        ] {
            let found = read(text.as_bytes()).unwrap_err().to_string();
            assert!(found.starts_with(said), "{text}: {found}");
        }
    }

    #[test]
    fn a_header_without_an_end_is_refused_and_a_long_name_is_cut() {
        let endless = [&b"voltage_v_rms,"[..], &vec![b'a'; 70_000]].concat();
        let said = read(&endless).unwrap_err().to_string();
        assert_eq!(said, "the first line has more than 65536 bytes: give a CSV file with a header row");
        let long = format!("voltage_v_rms_{}\n1\n", "a".repeat(1000));
        let said = read(long.as_bytes()).unwrap_err().to_string();
        assert!(said.len() < 200, "{said}");
    }

    proptest! {
        /// The same numbers, however an instrument dresses them.
        #[test]
        fn a_table_says_the_same_in_each_dress(
            numbers in prop::collection::vec((0.0_f64..300.0, -2.0_f64..2.0), 8..40),
            separator in prop::sample::select(vec![",", ";", "\t", " ", "   "]),
            comma in any::<bool>(),
            crlf in any::<bool>(),
            mark in any::<bool>(),
            comment in prop::sample::select(vec!["", "#", "% "]),
            has_units in any::<bool>(),
            above in prop::collection::vec(prop::sample::select(vec!["", "Recorder 3", "Date: 3 Jan 2026", "***", "# note", "% note"]), 0..6),
        ) {
            let comma = comma && separator != ",";
            let numeral = |number: f64| if comma { format!("{number:.4}").replace('.', ",") } else { format!("{number:.4}") };
            let mut lines: Vec<String> = above.iter().map(ToString::to_string).collect();
            lines.push(format!("{comment}{}", ["voltage_v_rms", "z", "friction_n"].join(separator)));
            if has_units {
                lines.push(["V", "-", "N"].join(separator));
            }
            let header = 1 + lines.iter().position(|line| line.contains("voltage")).unwrap();
            lines.extend(numbers.iter().map(|(v, f)| [numeral(*v), "7".to_owned(), numeral(*f)].join(separator)));
            let end = if crlf { "\r\n" } else { "\n" };
            let text = format!("{}{}{end}", if mark { "\u{feff}" } else { "" }, lines.join(end));
            let (rows, _) = read(text.as_bytes()).unwrap();
            prop_assert_eq!(rows.len(), numbers.len());
            prop_assert_eq!(rows[0].0, (header + 1 + usize::from(has_units)) as u64);
            for ((_, v, f), (voltage, friction)) in rows.iter().zip(&numbers) {
                prop_assert!((v - voltage).abs() < 1e-4 && (f - friction).abs() < 1e-4);
            }
        }
    }
}
