//! Recordings from Parquet.

use std::panic::{AssertUnwindSafe, catch_unwind};

use bytes::Bytes;
use frixel_play::GoesOn;
use frixel_scene::{FileKind, brief};
use parquet::basic::Type as Physical;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::{FooterTail, ParquetMetaData, ParquetMetaDataReader};
use parquet::file::reader::{FileReader, SerializedFileReader};
use serde::de::DeserializeOwned;

use super::parquet_writer::{
    FORMAT, KEY_COLUMNS, KEY_FILES, KEY_FORMAT, KEY_LATER_SCENES, KEY_MARKERS, KEY_RECORDING, KEY_SCENE,
};
use super::{Column, Field, Kind, Metadata, Recording, RecordingError, Values, claims, seal};

pub use frixel_scene::PARQUET as MAGIC;

/// Bytes of a footer's length and of the last bytes behind it.
const TAIL_BYTES: usize = 8;
/// Most ends of a footer, from the last on, that are tried where the end is missing. In one that was cut off the first
/// of them is whole, unless a value has the same bytes.
const FOOTERS_MAX: u32 = 16;
/// Most bytes of all texts: the flags of a play take some 10 a row.
const TEXTS_MAX_BYTES: u64 = 256 << 20;

impl Recording {
    /// Reads a Parquet file that [`ParquetWriter`](super::ParquetWriter) has written. If the writer of the file was
    /// killed, reads the complete part. Fails as [`RecordingError::Interrupted`] once `goes_on` breaks.
    pub fn read_parquet(bytes: impl Into<Bytes>, goes_on: GoesOn<'_>) -> Result<Self, RecordingError> {
        let bytes: Bytes = bytes.into();
        // The decoders of pages check what they read by assertions.
        catch_unwind(AssertUnwindSafe(|| read(&bytes, goes_on))).unwrap_or_else(|_| {
            Err(RecordingError::Damaged(ParquetError::General("its pages do not match their headers".to_owned())))
        })
    }
}

fn read(bytes: &Bytes, goes_on: GoesOn<'_>) -> Result<Recording, RecordingError> {
    if bytes.is_empty() {
        return Err(RecordingError::refused("it is empty: give a recording that `frixel play --record` has written"));
    }
    if !bytes.starts_with(MAGIC) {
        let sentence = "it is not a Parquet file: give a recording that `frixel play --record` has written";
        let wrong = FileKind::Recording.check(bytes).err();
        return Err(RecordingError::refused(wrong.map_or(sentence.to_owned(), |wrong| wrong.to_string())));
    }
    let (whole, footer) = whole_part(bytes)?;
    let is_cut_off = whole.len() < bytes.len();
    let file = SerializedFileReader::new(whole.clone()).map_err(RecordingError::Damaged)?;
    let (metadata, fields) = metadata_of(file.metadata())?;
    if !seal::is_whole(&whole, footer) {
        return Err(RecordingError::refused(
            "its hash does not match its content: it is damaged, or another program has rewritten it; take another \
             copy, or record again",
        ));
    }
    claims::check_pages(&whole, file.metadata())?;
    let mut text_bytes = 0;
    let columns = fields.into_iter().enumerate().map(|(index, field)| {
        let values = values(&file, index, &field, &mut text_bytes)?;
        if goes_on().is_break() { Err(RecordingError::Interrupted) } else { Ok(Column { field, values }) }
    });
    let columns = columns.collect::<Result<Vec<_>, RecordingError>>()?;
    if columns.len() != file.metadata().file_metadata().schema_descr().num_columns() {
        return Err(RecordingError::other_columns());
    }
    Ok(Recording { metadata, columns, is_cut_off })
}

/// Whether a file is a recording of a person, by its last bytes: `8 + N` of them at least, where `N` is the
/// little-endian number in the first four of the last eight.
pub(super) fn is_footer_of_person(end: &[u8]) -> bool {
    let metadata = || {
        let encoded = end.get(footer_start(end).ok()?..end.len().checked_sub(TAIL_BYTES)?)?;
        claims::check_footer(encoded).ok()?;
        metadata_of(&ParquetMetaDataReader::decode_metadata(encoded).ok()?).ok()
    };
    let metadata = catch_unwind(metadata).unwrap_or_default();
    metadata.is_some_and(|(metadata, _)| !metadata.is_simulated)
}

/// Where the footer begins whose last bytes these are.
pub(super) fn footer_start(bytes: &[u8]) -> ParquetResult<usize> {
    let tail = bytes.last_chunk().ok_or_else(|| ParquetError::EOF("it has no footer".to_owned()))?;
    let len = FooterTail::try_new(tail)?.metadata_length();
    let start = bytes.len().checked_sub(TAIL_BYTES).and_then(|end| end.checked_sub(len));
    start.ok_or_else(|| ParquetError::EOF("its footer is longer than the file".to_owned()))
}

/// The file up to its last whole footer, which is all of it unless its writer was killed, and where the footer begins.
fn whole_part(bytes: &Bytes) -> Result<(Bytes, usize), RecordingError> {
    let read = |end: usize| {
        let part = bytes.slice(..end);
        let start = footer_start(&part).map_err(RecordingError::Damaged)?;
        claims::check_footer(part.get(start..end - TAIL_BYTES).unwrap_or_default())?;
        let parsed = ParquetMetaDataReader::new().parse_and_finish(&part);
        parsed.map(|_| (part, start)).map_err(RecordingError::Damaged)
    };
    // A file that ends as a whole one has lost nothing there: no other footer stands in for one that is damaged.
    let is_cut = !bytes.ends_with(MAGIC) || bytes.len() < MAGIC.len() + TAIL_BYTES;
    let error = match read(bytes.len()) {
        Err(RecordingError::Damaged(error)) if is_cut => error,
        other => return other,
    };
    let mut end = bytes.len();
    let mut tried = 0;
    // A file shorter than this has no footer.
    while let Some(at) = bytes.get(MAGIC.len()..end).and_then(|part| part.windows(4).rposition(|four| four == MAGIC)) {
        end = at + 2 * MAGIC.len();
        match read(end) {
            Err(RecordingError::Damaged(_)) => {}
            other => return other,
        }
        end -= 1;
        tried += 1;
        if tried == FOOTERS_MAX {
            return Err(RecordingError::Damaged(error));
        }
    }
    Err(RecordingError::refused(
        "its end is missing, and with it the description of the rest: take a complete copy, or record again",
    ))
}

fn metadata_of(file: &ParquetMetaData) -> Result<(Metadata, Vec<Field>), RecordingError> {
    let pairs = file.file_metadata().key_value_metadata();
    let text = |key: &str| {
        let pair = pairs.into_iter().flatten().find(|pair| pair.key == key);
        pair.and_then(|pair| pair.value.as_deref())
    };
    let Some(format) = text(KEY_FORMAT) else {
        let sentence =
            "it is a Parquet file without frixel's metadata: give one that `frixel play --record` has written";
        return Err(RecordingError::refused(sentence));
    };
    if format != FORMAT.to_string() {
        let found = brief(format);
        let sentence = format!("it has format {found}, and this frixel reads format {FORMAT}: update frixel");
        return Err(RecordingError::refused(sentence));
    }
    let metadata = Metadata {
        scene: text(KEY_SCENE).unwrap_or_default().to_owned(),
        files: json(KEY_FILES, text(KEY_FILES))?,
        later_scenes: json(KEY_LATER_SCENES, text(KEY_LATER_SCENES))?,
        markers: json(KEY_MARKERS, text(KEY_MARKERS))?,
        ..json(KEY_RECORDING, text(KEY_RECORDING))?
    };
    Ok((metadata, json(KEY_COLUMNS, text(KEY_COLUMNS))?))
}

fn json<T: DeserializeOwned>(key: &'static str, text: Option<&str>) -> Result<T, RecordingError> {
    serde_json::from_str(text.unwrap_or_default()).map_err(|source| RecordingError::Metadata { key, source })
}

/// The values of a column over all row groups.
fn values(
    file: &SerializedFileReader<Bytes>,
    index: usize,
    field: &Field,
    text_bytes: &mut u64,
) -> Result<Values, RecordingError> {
    let described = file.metadata().file_metadata().schema_descr().columns().get(index).cloned();
    let physical = match field.kind {
        Kind::Number => Physical::DOUBLE,
        Kind::Integer => Physical::INT32,
        Kind::Text => Physical::BYTE_ARRAY,
    };
    let is_same = |column: &parquet::schema::types::ColumnDescPtr| {
        column.name() == field.name && column.physical_type() == physical && column.max_def_level() == 1
    };
    if !described.is_some_and(|column| is_same(&column)) {
        return Err(RecordingError::other_columns());
    }
    let mut values = Values::none(field.kind);
    for group in 0..file.num_row_groups() {
        read_group(file, group, index, &mut values, text_bytes).map_err(RecordingError::Damaged)?;
    }
    Ok(values)
}

fn read_group(
    file: &SerializedFileReader<Bytes>,
    group: usize,
    index: usize,
    values: &mut Values,
    text_bytes: &mut u64,
) -> ParquetResult<()> {
    let group = file.get_row_group(group)?;
    let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
    match (group.get_column_reader(index)?, values) {
        (ColumnReader::DoubleColumnReader(column), Values::Numbers(values)) => {
            values.extend(read_column(column, rows)?);
        }
        (ColumnReader::Int32ColumnReader(column), Values::Integers(values)) => {
            values.extend(read_column(column, rows)?);
        }
        (ColumnReader::ByteArrayColumnReader(column), Values::Texts(values)) => {
            let texts = read_column(column, rows)?;
            // The values of a dictionary share their bytes, and texts do not.
            *text_bytes += texts.iter().flatten().map(|text| text.len() as u64).sum::<u64>();
            if *text_bytes > TEXTS_MAX_BYTES {
                return Err(ParquetError::General(format!("its strings have more than {TEXTS_MAX_BYTES} bytes")));
            }
            for bytes in texts {
                let text = bytes.map(|bytes| bytes.as_utf8().map(str::to_owned)).transpose()?;
                values.push(text);
            }
        }
        _ => return Err(ParquetError::General("a column has another type than its description".to_owned())),
    }
    Ok(())
}

/// The values of a column in one row group; an absent one is `None`.
fn read_column<T: DataType>(mut column: ColumnReaderImpl<T>, rows: usize) -> ParquetResult<Vec<Option<T::T>>> {
    let (mut levels, mut known) = (Vec::new(), Vec::new());
    let mut read = 0;
    while read < rows {
        let (records, ..) = column.read_records(rows - read, Some(&mut levels), None, &mut known)?;
        if records == 0 {
            return Err(ParquetError::EOF(format!("{read} of {rows} rows are there")));
        }
        read += records;
    }
    let mut known = known.into_iter();
    Ok(levels.into_iter().map(|level| if level == 0 { None } else { known.next() }).collect())
}
