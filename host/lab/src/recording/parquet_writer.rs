//! Recordings to Parquet.

use std::io::Write;
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int32Type};
use parquet::errors::Result as ParquetResult;
use parquet::file::metadata::{FileMetaData, KeyValue, ParquetMetaData, ParquetMetaDataWriter};
use parquet::file::properties::{EnabledStatistics, WriterProperties, WriterVersion};
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{SchemaDescriptor, Type};
use serde::Serialize;

use super::seal::{self, Hashed};
use super::{
    Column, Field, Kind, Metadata, ROWS_PER_GROUP, Recording, RecordingError, Values, arrow_schema, check_length,
};

/// Number of the format, in the metadata `frixel.format`.
pub(super) const FORMAT: u32 = 1;
/// Keys of the metadata.
pub(super) const KEY_FORMAT: &str = "frixel.format";
pub(super) const KEY_RECORDING: &str = "frixel.recording";
pub(super) const KEY_SCENE: &str = "frixel.scene";
pub(super) const KEY_FILES: &str = "frixel.files";
pub(super) const KEY_LATER_SCENES: &str = "frixel.later_scenes";
pub(super) const KEY_MARKERS: &str = "frixel.markers";
pub(super) const KEY_COLUMNS: &str = "frixel.columns";
/// Key of what pandas has as `DataFrame.attrs`, a JSON object.
const KEY_PANDAS: &str = "PANDAS_ATTRS";

impl Recording {
    /// Writes the recording as a Parquet file.
    pub fn write_parquet<W: Write + Send>(&self, to: W) -> Result<(), RecordingError> {
        check_length(self.rows() as u64, self.columns.len())?;
        let fields = self.columns.iter().map(|column| column.field.clone()).collect();
        let mut writer = ParquetWriter::new(to, fields)?;
        writer.write_all(&self.columns)?;
        writer.end(&self.metadata)
    }
}

/// A table that is not a recording, such as the results of a study, as a Parquet file: units and meanings are in the
/// metadata of its fields.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn table_parquet(columns: &[Column]) -> Result<Vec<u8>, RecordingError> {
    let fields: Vec<Field> = columns.iter().map(|column| column.field.clone()).collect();
    let pairs = vec![KeyValue::new(arrow_schema::KEY.to_owned(), arrow_schema::encoded(&fields, &[]))];
    let mut bytes = Vec::new();
    let mut writer = ParquetWriter::new(&mut bytes, fields)?;
    writer.write_all(columns)?;
    writer.end_with(pairs, env!("CARGO_PKG_VERSION"))?;
    drop(writer);
    Ok(bytes)
}

/// Writes a recording as Parquet, row group by row group.
///
/// After each [`Self::end`], the file is a complete Parquet file. More row groups may follow, since readers skip all
/// footers but the last. A growing file is thus lost only from the last `end` on.
pub struct ParquetWriter<W: Write + Send> {
    writer: SerializedFileWriter<Hashed<W>>,
    fields: Vec<Field>,
    rows: i64,
}

impl<W: Write + Send> ParquetWriter<W> {
    /// Begins a file with these columns.
    pub fn new(to: W, fields: Vec<Field>) -> Result<Self, RecordingError> {
        let properties = WriterProperties::builder()
            .set_writer_version(WriterVersion::PARQUET_1_0)
            .set_compression(Compression::SNAPPY)
            .set_statistics_enabled(EnabledStatistics::None)
            .set_offset_index_disabled(true)
            .build();
        let schema = schema(&fields).map_err(RecordingError::Write)?;
        let writer = SerializedFileWriter::new(Hashed::new(to), Arc::new(schema), Arc::new(properties));
        Ok(Self { writer: writer.map_err(RecordingError::Write)?, fields, rows: 0 })
    }

    /// Writes a row group: the values of each column, in the order of the fields, of equal numbers. Fails if the file
    /// would become too long to be read back; the rows so far can be read.
    pub fn write(&mut self, columns: &[Values]) -> Result<(), RecordingError> {
        let rows = columns.first().map_or(0, Values::len) as i64;
        check_length((self.rows + rows).unsigned_abs(), self.fields.len())?;
        self.write_group(columns, rows)
    }

    fn write_group(&mut self, columns: &[Values], rows: i64) -> Result<(), RecordingError> {
        self.rows += rows;
        write_group(&mut self.writer, columns).map_err(RecordingError::Write)
    }

    /// Writes whole columns, in row groups.
    fn write_all(&mut self, columns: &[Column]) -> Result<(), RecordingError> {
        let rows = columns.first().map_or(0, |column| column.values.len());
        for from in (0..rows).step_by(ROWS_PER_GROUP) {
            let end = rows.min(from + ROWS_PER_GROUP);
            let part = |column: &Column| column.values.part(from, end);
            self.write_group(&columns.iter().map(part).collect::<Vec<_>>(), (end - from) as i64)?;
        }
        Ok(())
    }

    /// Completes the file so far, with the metadata for it. [`Self::write`] may append further row groups.
    pub fn end(&mut self, metadata: &Metadata) -> Result<(), RecordingError> {
        self.end_with(pairs(metadata, &self.fields)?, &metadata.frixel)
    }

    fn end_with(&mut self, pairs: Vec<KeyValue>, version: &str) -> Result<(), RecordingError> {
        let end = |writer: &mut SerializedFileWriter<Hashed<W>>| -> ParquetResult<()> {
            let schema = Arc::new(SchemaDescriptor::new(writer.schema_descr().root_schema_ptr()));
            let created_by = format!("frixel version {version}");
            let file = FileMetaData::new(1, self.rows, Some(created_by), Some(pairs), schema, None);
            let whole = ParquetMetaData::new(file, writer.flushed_row_groups().to_vec());
            let mut footer = Vec::new();
            ParquetMetaDataWriter::new(&mut footer, &whole).finish()?;
            // What is still in a buffer is hashed, too.
            writer.flush()?;
            writer.inner().seal(&mut footer);
            writer.write_all(&footer)?;
            Ok(writer.flush()?)
        };
        end(&mut self.writer).map_err(RecordingError::Write)
    }

    /// The underlying writer. A buffer may be emptied; other writes make the file unreadable.
    pub fn get_mut(&mut self) -> &mut W {
        &mut self.writer.inner_mut().to
    }
}

/// The metadata as pairs of keys and values: for readers of Parquet, and again in the Arrow schema, where pyarrow and
/// pandas look for them. The hash is last.
fn pairs(metadata: &Metadata, fields: &[Field]) -> Result<Vec<KeyValue>, RecordingError> {
    let mut pairs = vec![
        (KEY_FORMAT, FORMAT.to_string()),
        (KEY_SCENE, metadata.scene.clone()),
        (KEY_RECORDING, json(KEY_RECORDING, metadata)?),
        (KEY_MARKERS, json(KEY_MARKERS, &metadata.markers)?),
        (KEY_COLUMNS, json(KEY_COLUMNS, fields)?),
    ];
    // The first two are texts.
    let member = |(number, (key, text)): (usize, &(&'static str, String))| {
        let value = if number < 2 { json(key, text)? } else { text.clone() };
        Ok(format!("{key:?}:{value}"))
    };
    let members = pairs.iter().enumerate().map(member).collect::<Result<Vec<_>, RecordingError>>()?;
    let attributes = format!("{{{}}}", members.join(","));
    pairs.extend([
        (KEY_FILES, json(KEY_FILES, &metadata.files)?),
        (KEY_LATER_SCENES, json(KEY_LATER_SCENES, &metadata.later_scenes)?),
    ]);
    let pandas = (KEY_PANDAS, attributes.as_str());
    let in_arrow: Vec<(&str, &str)> = pairs.iter().map(|(key, text)| (*key, text.as_str())).chain([pandas]).collect();
    let schema = arrow_schema::encoded(fields, &in_arrow);
    pairs.extend([(arrow_schema::KEY, schema), (seal::KEY, seal::UNKNOWN.to_owned())]);
    Ok(pairs.into_iter().map(|(key, text)| KeyValue::new(key.to_owned(), text)).collect())
}

fn json<T: Serialize + ?Sized>(key: &'static str, value: &T) -> Result<String, RecordingError> {
    serde_json::to_string(value).map_err(|source| RecordingError::Metadata { key, source })
}

fn schema(fields: &[Field]) -> ParquetResult<Type> {
    let column = |field: &Field| -> ParquetResult<Arc<Type>> {
        let (physical, logical) = match field.kind {
            Kind::Number => (Physical::DOUBLE, None),
            Kind::Integer => (Physical::INT32, None),
            Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let column = Type::primitive_type_builder(&field.name, physical).with_repetition(Repetition::OPTIONAL);
        Ok(Arc::new(column.with_logical_type(logical).build()?))
    };
    let columns = fields.iter().map(column).collect::<ParquetResult<Vec<_>>>()?;
    Type::group_type_builder("schema").with_fields(columns).build()
}

fn write_group<W: Write + Send>(writer: &mut SerializedFileWriter<W>, columns: &[Values]) -> ParquetResult<()> {
    let mut group = writer.next_row_group()?;
    for values in columns {
        let Some(mut column) = group.next_column()? else { break };
        match values {
            Values::Numbers(values) => write_column::<DoubleType>(&mut column, values.iter().copied()),
            Values::Integers(values) => write_column::<Int32Type>(&mut column, values.iter().copied()),
            Values::Texts(values) => {
                let bytes = |text: &Option<String>| text.as_deref().map(ByteArray::from);
                write_column::<ByteArrayType>(&mut column, values.iter().map(bytes))
            }
        }?;
        column.close()?;
    }
    group.close()?;
    Ok(())
}

fn write_column<T: DataType>(
    column: &mut SerializedColumnWriter<'_>,
    values: impl ExactSizeIterator<Item = Option<T::T>>,
) -> ParquetResult<()> {
    let mut levels = Vec::with_capacity(values.len());
    let mut known = Vec::with_capacity(values.len());
    for value in values {
        levels.push(i16::from(value.is_some()));
        known.extend(value);
    }
    column.typed::<T>().write_batch(&known, Some(&levels), None)?;
    Ok(())
}
