//! The columns as an Arrow schema, which has a place for the unit of a column; Parquet's own schema has none.
//!
//! Readers that are built on Arrow (pyarrow, pandas, R, MATLAB) look for it in the metadata of a Parquet file. It is an
//! encapsulated message of the Arrow IPC format: <https://arrow.apache.org/docs/format/Columnar.html>, with the tables
//! of `Schema.fbs` and `Message.fbs`.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flatbuffers::{
    FlatBufferBuilder, ForwardsUOffset, TableFinishedWIPOffset, UnionWIPOffset, VOffsetT, Vector, WIPOffset,
};

use super::{Field, Kind};

/// Key of the schema in the metadata.
pub(super) const KEY: &str = "ARROW:schema";

/// `MetadataVersion.V5`.
const VERSION: i16 = 4;
/// `MessageHeader.Schema`.
const HEADER_SCHEMA: u8 = 1;
/// `Type.Int`, `Type.FloatingPoint`, `Type.Utf8`.
const TYPE_INT: u8 = 2;
const TYPE_FLOATING_POINT: u8 = 3;
const TYPE_UTF8: u8 = 5;
/// `Precision.DOUBLE`.
const DOUBLE: i16 = 2;
/// Begins a message that is aligned to eight bytes.
const CONTINUATION: [u8; 4] = [0xff; 4];

type Table = WIPOffset<TableFinishedWIPOffset>;

/// The schema of these columns with this metadata, in base64.
pub(super) fn encoded(fields: &[Field], metadata: &[(&str, &str)]) -> String {
    let mut builder = FlatBufferBuilder::new();
    let metadata = pairs(&mut builder, metadata);
    let fields: Vec<Table> = fields.iter().map(|column| field(&mut builder, column)).collect();
    let fields = builder.create_vector(&fields);
    let table = builder.start_table();
    builder.push_slot_always(slot(1), fields);
    builder.push_slot_always(slot(2), metadata);
    let schema = builder.end_table(table);
    let table = builder.start_table();
    builder.push_slot_always(slot(0), VERSION);
    builder.push_slot_always(slot(1), HEADER_SCHEMA);
    builder.push_slot_always(slot(2), union(schema));
    let message = builder.end_table(table);
    builder.finish_minimal(message);

    let mut message = builder.finished_data().to_vec();
    message.resize(message.len().next_multiple_of(8), 0);
    let bytes = [&CONTINUATION[..], &(message.len() as u32).to_le_bytes(), &message].concat();
    STANDARD.encode(bytes)
}

/// A `Field` with its unit and meaning as metadata.
fn field(builder: &mut FlatBufferBuilder<'_>, column: &Field) -> Table {
    let name = builder.create_string(&column.name);
    let texts = [("unit", column.unit.as_str()), ("meaning", column.meaning.as_str())];
    let known: Vec<(&str, &str)> = texts.into_iter().filter(|(_, value)| !value.is_empty()).collect();
    let pairs = pairs(builder, &known);
    let children = builder.create_vector::<Table>(&[]);
    let (number, of_type) = of_kind(builder, column.kind);
    let table = builder.start_table();
    builder.push_slot_always(slot(0), name);
    builder.push_slot_always(slot(1), true);
    builder.push_slot_always(slot(2), number);
    builder.push_slot_always(slot(3), union(of_type));
    builder.push_slot_always(slot(5), children);
    builder.push_slot_always(slot(6), pairs);
    builder.end_table(table)
}

/// A list of `KeyValue`.
fn pairs<'b>(
    builder: &mut FlatBufferBuilder<'b>,
    texts: &[(&str, &str)],
) -> WIPOffset<Vector<'b, ForwardsUOffset<TableFinishedWIPOffset>>> {
    let pair = |(key, value): &(&str, &str)| {
        let (key, value) = (builder.create_string(key), builder.create_string(value));
        let table = builder.start_table();
        builder.push_slot_always(slot(0), key);
        builder.push_slot_always(slot(1), value);
        builder.end_table(table)
    };
    let pairs: Vec<Table> = texts.iter().map(pair).collect();
    builder.create_vector(&pairs)
}

/// The number of a type, and its table.
fn of_kind(builder: &mut FlatBufferBuilder<'_>, kind: Kind) -> (u8, Table) {
    let table = builder.start_table();
    let number = match kind {
        Kind::Number => {
            builder.push_slot_always(slot(0), DOUBLE);
            TYPE_FLOATING_POINT
        }
        Kind::Integer => {
            builder.push_slot_always(slot(0), 32_i32);
            builder.push_slot_always(slot(1), true);
            TYPE_INT
        }
        Kind::Text => TYPE_UTF8,
    };
    (number, builder.end_table(table))
}

fn union(table: Table) -> WIPOffset<UnionWIPOffset> {
    table.as_union_value()
}

/// The place of a table's field by its number.
const fn slot(number: VOffsetT) -> VOffsetT {
    4 + 2 * number
}
