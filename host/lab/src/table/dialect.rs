//! The format of a table: the separator of its columns, and the decimal sign of its numbers.

use std::borrow::Cow;

use super::TableError;
use super::layout::{BLANK, Layout};
use super::utf16::ByteOrder;

/// Separators of columns, with their names.
const SEPARATORS: [(u8, &str); 4] = [(b',', "commas"), (b';', "semicolons"), (b'\t', "tabs"), (BLANK, "blanks")];
/// Prefix of a line above the header that states the separator to a spreadsheet.
const TOLD: &[u8] = b"sep=";

/// The decimal sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Decimal {
    Point,
    Comma,
    /// Each number with a comma can be one of thousands.
    CommaOrThousands,
    /// The beginning of the table has whole numbers only.
    Unseen,
}

/// The format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Dialect {
    separator: u8,
    decimal: Decimal,
    order: Option<ByteOrder>,
}

/// The text of a number as Rust reads it.
pub(super) enum Digits<'t> {
    Number(Cow<'t, str>),
    /// It can be read in two ways.
    Doubtful([String; 2]),
}

impl Dialect {
    /// Finds dialect and layout from the beginning of a table, which may end in the midst of a row unless it
    /// `is_whole`. Fails if it can be separated in two ways.
    pub(super) fn of(head: &mut [u8], is_whole: bool, order: Option<ByteOrder>) -> Result<(Self, Layout), TableError> {
        let layout = match told_separator(head) {
            Some(separator) => Layout::of(head, separator, is_whole),
            None => layout(head, is_whole)?,
        };
        Ok((Self { separator: layout.separator, decimal: decimal(&layout), order }, layout))
    }

    pub(crate) fn separator(self) -> u8 {
        self.separator
    }

    /// A number with this dialect's decimal sign.
    pub(crate) fn number(self, digits: String) -> String {
        match self.decimal {
            Decimal::Comma => digits.replace('.', ","),
            Decimal::Point | Decimal::CommaOrThousands | Decimal::Unseen => digits,
        }
    }

    /// The digits of a number with a decimal point.
    pub(super) fn digits(self, text: &str) -> Digits<'_> {
        match (self.decimal, comma_number(text)) {
            (Decimal::CommaOrThousands, Some(_)) | (Decimal::Unseen, Some(Comma::Doubtful)) => {
                Digits::Doubtful([text.replace(',', "."), text.replace(',', "")])
            }
            (Decimal::Comma | Decimal::Unseen, Some(_)) => Digits::Number(text.replace(',', ".").into()),
            (Decimal::Comma, None) if is_point_number(text) => {
                Digits::Doubtful([text.to_owned(), text.replace('.', "")])
            }
            _ => Digits::Number(text.into()),
        }
    }

    /// Differences from commas between columns and points in numbers, in words.
    pub(super) fn words(self) -> Vec<String> {
        let has_commas = self.decimal == Decimal::Comma;
        let mut words = Vec::new();
        if self.separator != b',' {
            let decimal = if has_commas { ", with decimal commas" } else { "" };
            words.push(format!("columns are separated by {}{decimal}", name(self.separator)));
        } else if has_commas {
            words.push("numbers have decimal commas".to_owned());
        }
        words.extend(self.order.map(|order| {
            let order = match order {
                ByteOrder::LittleEndian => "little-endian",
                ByteOrder::BigEndian => "big-endian",
            };
            format!("the text is UTF-16, {order}")
        }));
        words
    }
}

fn name(separator: u8) -> &'static str {
    SEPARATORS.iter().find(|(byte, _)| *byte == separator).map_or("", |(_, name)| name)
}

/// The separator that a first line such as `sep=;` states. The line becomes a comment.
fn told_separator(head: &mut [u8]) -> Option<u8> {
    let (separator, end) = (*head.get(TOLD.len())?, *head.get(TOLD.len() + 1)?);
    let is_told = head.get(..TOLD.len())?.eq_ignore_ascii_case(TOLD);
    let separator =
        SEPARATORS.iter().find(|(byte, _)| *byte == separator).filter(|_| is_told && matches!(end, b'\r' | b'\n'))?;
    head.get_mut(..1)?.fill(b'#');
    Some(separator.0)
}

/// The layout of the only separator for which the header has names of columns, and each row as many cells.
///
/// Blanks separate the columns if no separator gives names. Fails if there are several.
fn layout(head: &[u8], is_whole: bool) -> Result<Layout, TableError> {
    let of = |separator: u8| Layout::of(head, separator, is_whole);
    let layouts = SEPARATORS.iter().filter(|(separator, _)| *separator != BLANK).map(|(separator, _)| of(*separator));
    let mut found: Vec<Layout> = layouts.filter(|layout| layout.columns() > 1).collect();
    if !found.iter().any(Layout::has_names) {
        // A name may have blanks, too.
        let blanks = Some(of(BLANK)).filter(|layout| layout.has_names() && layout.has_numbers());
        if blanks.is_some() || found.is_empty() {
            return Ok(blanks.unwrap_or_else(|| of(b',')));
        }
    }
    for is_likelier in [Layout::has_names, Layout::is_even] {
        if found.iter().any(is_likelier) {
            found.retain(is_likelier);
        }
    }
    if let [one, other, ..] = &found[..] {
        let [(one, columns), (other, others)] = [one, other].map(|layout| (name(layout.separator), layout.columns()));
        return Err(TableError::new(
            format!("the header can be read as {columns} columns that {one} separate, or as {others} that {other} do"),
            "leave one of them out",
        ));
    }
    Ok(found.swap_remove(0))
}

fn decimal(layout: &Layout) -> Decimal {
    let cells = || layout.rows().flatten();
    let (mut sure, mut doubtful) = (false, false);
    for comma in cells().filter_map(|cell| comma_number(cell)) {
        sure |= comma == Comma::Sure;
        doubtful |= comma == Comma::Doubtful;
    }
    if sure {
        Decimal::Comma
    } else if cells().any(|cell| is_point_number(cell)) {
        Decimal::Point
    } else if doubtful {
        Decimal::CommaOrThousands
    } else {
        Decimal::Unseen
    }
}

/// Meaning of the comma in a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Comma {
    /// It is a decimal comma.
    Sure,
    /// It can divide thousands: `1,234`.
    Doubtful,
}

/// Whether a text is a number with one comma.
fn comma_number(text: &str) -> Option<Comma> {
    let (whole, part) = text.split_once(',')?;
    let whole = whole.strip_prefix(['-', '+']).unwrap_or(whole);
    let digits = part.split(['e', 'E']).next().unwrap_or_default();
    let are_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    let is_number = are_digits(whole) && are_digits(digits) && text.replacen(',', ".", 1).parse::<f64>().is_ok();
    let is_doubtful = (1..=3).contains(&whole.len()) && !whole.starts_with('0') && part.len() == 3 && are_digits(part);
    is_number.then_some(if is_doubtful { Comma::Doubtful } else { Comma::Sure })
}

/// Whether a text is a number with either decimal sign.
pub(super) fn is_number(text: &str) -> bool {
    text.parse::<f64>().is_ok() || comma_number(text).is_some()
}

fn is_point_number(text: &str) -> bool {
    text.contains('.') && text.parse::<f64>().is_ok()
}
