use std::io::Cursor;
use std::sync::Arc;

use frixel_felt::recorder::{FeltRow, MarkedEvent, Marker};
use frixel_play::TO_THE_END;
use frixel_wire::fault::Flags;

use super::*;
use crate::stroke_file::StrokeFile;

/// Rows in which every column has known and unknown values.
fn rows(count: u32) -> Vec<FeltRow> {
    let row = |row: u32| {
        let known = |value: f64| (!row.is_multiple_of(3)).then_some(value);
        let t_s = 1e-3 * f64::from(row + 1);
        FeltRow {
            t_s,
            x_mm: known(10.0 + 0.1 * t_s),
            felt_n: known(0.25 + 1e-9 * f64::from(row)),
            electrode_v_rms: Some(f64::NAN),
            dac_code: (row % 2 == 1).then_some(-5 - (row % 100) as i16),
            flags: (row % 4 == 1).then_some(Flags::SATURATED.with(Flags::STILL)),
            ..FeltRow::default()
        }
    };
    (0..count).map(row).collect()
}

fn metadata(is_simulated: bool) -> Metadata {
    let files: [(&str, &[u8]); 2] = [("stroke", b"t_s,x_mm,y_mm\n"), ("scene/brick.png", &[0x89, 0xff])];
    Metadata {
        frixel: "0.1.0".to_owned(),
        rig: "sim".to_owned(),
        is_simulated,
        tick_hz: 40_000,
        ticks_per_row: 40,
        participant: Some("P07".to_owned()),
        play: serde_json::json!({ "seed": u64::MAX, "seconds": 0.1 + 0.2 }),
        scene: "version = 1\n".to_owned(),
        files: SourceFile::all(files.map(|(name, bytes)| (name.to_owned(), bytes))),
        later_scenes: vec![LaterScene {
            t_s: 0.5,
            scene: "version = 1\n# later\n".to_owned(),
            is_refused: true,
            files: SourceFile::all([("part.toml".to_owned(), b"version = 1\n".as_slice())]),
        }],
        markers: vec![
            Marker { ticks: 0, t_s: 0.0, event: MarkedEvent::SceneBegan },
            Marker {
                ticks: 1234,
                t_s: 0.03085,
                event: MarkedEvent::LayerChanged { layer: "layer 1 \"OK\"".to_owned(), on: true, gain: 0.1 },
            },
        ],
        ..Metadata::default()
    }
}

fn recording(count: u32) -> Recording {
    Recording::of_rows(metadata(true), &rows(count))
}

fn bytes(recording: &Recording) -> Vec<u8> {
    let mut bytes = Vec::new();
    recording.write_parquet(&mut bytes).unwrap();
    bytes
}

#[test]
fn what_is_written_is_read_and_the_bytes_are_the_same_each_time() {
    for count in [0, 1, ROWS_PER_GROUP as u32 + 7] {
        let written = recording(count);
        let first = bytes(&written);
        assert_eq!(first, bytes(&written));
        let read = Recording::read_parquet(first, TO_THE_END).unwrap();
        assert_eq!(read, written);
        assert_eq!((read.rows(), read.first_difference(&written)), (count as usize, None));
    }
    let read = Recording::read_parquet(bytes(&recording(3)), TO_THE_END).unwrap();
    let texts = Values::Texts(vec![None, Some("saturated+still".to_owned()), None]);
    assert_eq!(read.column("flags").unwrap().values, texts);
    assert_eq!(
        read.column("electrode_v_rms").unwrap().values,
        Values::Numbers(vec![None; 3]),
        "not a number is unknown"
    );
}

/// A unit stands in the name as well, so that it is there in a table without metadata.
#[test]
fn every_number_has_a_unit_and_every_column_a_meaning() {
    for Field { name, unit, meaning, kind } in play_fields() {
        assert!(!meaning.is_empty(), "{name}");
        let ending = name.rsplit_once('_').map_or("", |(_, ending)| ending);
        assert_eq!(unit.is_empty(), kind != Kind::Number, "{name}");
        assert!(
            unit.is_empty() || name.contains("_v_rms") || unit.to_lowercase().ends_with(ending),
            "{name} in {unit}"
        );
    }
}

/// What reads tables reads recordings, to the last bit.
#[test]
fn a_recording_is_a_stroke_and_its_table_has_every_digit() {
    let written = recording(100);
    let text = String::from_utf8(written.to_csv()).unwrap();
    assert_eq!(text.lines().nth(2), Some("0.002,10.0002,,,,,0.250000001,,,,-6,saturated+still"));
    let places: Vec<FeltRow> = rows(100).into_iter().map(|row| FeltRow { y_mm: row.x_mm, ..row }).collect();
    let bytes = bytes(&Recording::of_rows(metadata(true), &places));
    let read = StrokeFile::read(bytes.as_slice()).unwrap();
    assert_eq!((read.ignored_columns.len(), read.understood), (0, None));
    let row = &places[50];
    let x_m = row.x_mm.map(|x_mm| (x_mm / 1e3).to_bits());
    assert_eq!(read.stroke.at(row.t_s).map(|finger| finger.x_m.to_bits()), x_m);
    let error = StrokeFile::read(&bytes[..bytes.len() - 1]).unwrap_err().to_string();
    assert!(error.contains("its end is missing"), "{error}");
}

#[test]
fn a_table_is_a_recording_if_its_cells_are_what_its_columns_say() {
    let read = |csv: &str| Recording::of_csv(metadata(true), csv.as_bytes(), stroke_fields());
    let whole = read("y_mm,t_s,x_mm,note\n3,0.005,2,a\n,0.010,,b\n").unwrap();
    assert_eq!(whole.column("x_mm").unwrap().values, Values::Numbers(vec![Some(2.0), None]));
    assert_eq!((whole.rows(), whole.columns.len()), (2, 3));
    for wrong in ["t_s,x_mm\n", "t_s,x_mm,y_mm\n0,one,2\n", "t_s,x_mm,y_mm\n0,inf,2\n", "t_s,x_mm,y_mm\n0,1\n"] {
        assert!(read(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn the_first_difference_is_the_first_row() {
    let one = recording(100);
    let mut other = one.clone();
    let Values::Numbers(felt) = &mut other.columns[6].values else { panic!("numbers") };
    felt[50] = felt[50].map(|felt_n| f64::from_bits(felt_n.to_bits() + 1));
    let Values::Numbers(x) = &mut other.columns[1].values else { panic!("numbers") };
    x[70] = None;
    let cell = one.first_difference(&other).unwrap();
    assert!(cell.starts_with("row 51, column felt_n: "), "{cell}");
    let shorter = recording(99);
    assert_eq!(one.first_difference(&shorter).as_deref(), Some("100 rows in the file, 99 played"));
    let columns = one.first_difference(&Recording { columns: Vec::new(), ..one.clone() }).unwrap();
    assert!(columns.starts_with("the columns are , and not t_s, x_mm, "), "{columns}");
}

/// A file that grows: after each end it is whole, and what follows is lost alone.
#[test]
fn a_writer_that_is_killed_loses_the_last_row_group() {
    let all = rows(300);
    let mut writer = ParquetWriter::new(Vec::new(), play_fields()).unwrap();
    let mut ends = vec![];
    for hundred in all.chunks(100) {
        writer.write(&play_values(hundred)).unwrap();
        writer.end(&metadata(false)).unwrap();
        ends.push(writer.get_mut().len());
    }
    let bytes = std::mem::take(writer.get_mut());
    let [first, second, third] = ends[..] else { panic!("{ends:?}") };
    assert_eq!(third, bytes.len());
    for (len, rows, is_cut_off) in [
        (first, 100, false),
        (first + 1, 100, true),
        (second - 5, 100, true),
        (second, 200, false),
        (third, 300, false),
    ] {
        let read = Recording::read_parquet(bytes[..len].to_vec(), TO_THE_END).unwrap();
        assert_eq!((read.rows(), read.is_cut_off), (rows, is_cut_off), "{len} bytes");
        let whole = Recording { is_cut_off, ..Recording::of_rows(metadata(false), &all[..rows]) };
        assert_eq!(read, whole, "{len} bytes");
    }
    let truncated = Recording::read_parquet(bytes[..first - 1].to_vec(), TO_THE_END).unwrap_err().to_string();
    assert!(truncated.contains("its end is missing"), "{truncated}");
    assert!(is_known(&bytes) && is_known(&bytes[..first]) && !is_known(&bytes[..first - 1]));
}

/// Whether a file with these bytes is a recording of a person.
fn is_known(bytes: &[u8]) -> bool {
    is_of_person(Cursor::new(bytes)).unwrap_or(false)
}

#[test]
fn a_recording_of_a_person_is_known_by_its_content() {
    for (text, what) in [
        ("t_s,x_mm,y_mm\n0,1,2\n", "a stroke"),
        ("\u{feff}\"t_s\";\"x_mm\";\"y_mm\"\r\n0,0;1,0;2,0\r\n", "as a spreadsheet saves it"),
        ("time_s,stroke,voltage_v_rms,normal_force_n,friction_n\n", "friction"),
        ("Sensor 7\nvoltage_v_rms\tnormal_force_n\tFriction [mN]\n0\t0.5\t250\n", "as an instrument writes it"),
        ("voltage_v_rms,normal_force_n,friction_n,finger_origin\n9,0.5,0.2,measured\n", "friction of known origin"),
        ("t_s,x_cm,y_cm\n0,1,2\n", "a stroke in centimetres"),
        ("t_s,x_mm,y_mm,speed_mm_s,felt_n,flags,participant\n", "a play of a person"),
        ("{\"rig\":\"board\",\"simulated\":false}\n", "its summary"),
        ("[finger]\norigin=\"perceptual\"\n", "what a person felt"),
    ] {
        assert!(is_known(text.as_bytes()), "{what}");
    }
    let simulated = [
        "t_s,x_mm,y_mm,speed_mm_s,felt_n,flags\n",
        "{\"rig\":\"sim\",\"simulated\":true}\n",
        "voltage_v_rms,normal_force_n,friction_n,finger_origin\n9,0.5,0.2,assumed\n",
    ];
    for text in simulated.into_iter().chain(["PAR1", "PAR1\u{7f}\u{7f}\u{7f}\u{7f}PAR1", ""]) {
        assert!(!is_known(text.as_bytes()), "{text}");
    }
}

/// A recording without a known end stops where it could not be read back, and what it has so far is whole.
#[test]
fn a_recording_that_becomes_too_long_ends_readable() {
    let field = play_fields().into_iter().find(|field| field.kind == Kind::Integer).unwrap();
    let mut writer = ParquetWriter::new(Vec::new(), vec![field]).unwrap();
    writer.write(&[Values::Integers(vec![None; 5])]).unwrap();
    let error = writer.write(&[Values::Integers(vec![None; 10_000_000])]).unwrap_err().to_string();
    assert!(error.contains("it would have 10000005 rows of 1 columns, and at most 10000000"), "{error}");
    writer.end(&metadata(true)).unwrap();
    assert_eq!(Recording::read_parquet(std::mem::take(writer.get_mut()), TO_THE_END).unwrap().rows(), 5);
}

#[test]
fn what_is_no_recording_is_refused_with_what_to_do() {
    let own = bytes(&recording(10));
    assert!(!is_known(&own), "it is simulated");
    let foreign = {
        let schema = parquet::schema::types::Type::group_type_builder("schema").build().unwrap();
        let writer = parquet::file::writer::SerializedFileWriter::new(Vec::new(), schema.into(), Arc::default());
        writer.unwrap().into_inner().unwrap()
    };
    let replaced = |from: &str, to: &str| {
        let at = own.windows(from.len()).rposition(|part| part == from.as_bytes()).unwrap();
        [&own[..at], to.as_bytes(), &own[at + to.len()..]].concat()
    };
    let format = own.windows(13).rposition(|part| part == b"frixel.format").unwrap();
    // The key is followed by the head and the length of the value.
    let value = format + 13 + 2;
    assert_eq!(own[value], b'1');
    let newer = [&own[..value], b"2", &own[value + 1..]].concat();
    let sealed = |bytes: Vec<u8>| {
        let footer = parquet_reader::footer_start(&bytes).unwrap();
        seal::sealed(bytes, footer)
    };
    let cases: [(Vec<u8>, &str); 9] = [
        (Vec::new(), "it is empty"),
        (b"t_s,x_mm\n".to_vec(), "not a Parquet file"),
        (own[..own.len() - 1].to_vec(), "its end is missing"),
        (b"PAR1".to_vec(), "its end is missing"),
        (foreign, "without frixel's metadata"),
        (newer, "format 2, and this frixel reads format 1"),
        (replaced("\"is_simulated\":true", "\"is_simulated\":1234"), "`frixel.recording` cannot be read"),
        (sealed(replaced("\"name\":\"felt_n\"", "\"name\":\"melt_n\"")), "differ from those in its metadata"),
        (replaced("\"participant\":\"P07\"", "\"participant\":\"P08\""), "its hash does not match its content"),
    ];
    for (bytes, says) in cases {
        let error = Recording::read_parquet(bytes, TO_THE_END).unwrap_err().to_string();
        assert!(error.contains(says) && error.contains(": "), "{says}: {error}");
    }
}

/// Bytes that are wrong anywhere are an error, also where the hash is that of the wrong bytes, and no panic.
#[test]
fn a_damaged_file_is_refused() {
    let own = bytes(&recording(20));
    let footer = parquet_reader::footer_start(&own).unwrap();
    for at in 0..own.len() {
        let mut damaged = own.clone();
        damaged[at] ^= 1 << (at % 8);
        assert!(Recording::read_parquet(damaged.clone(), TO_THE_END).is_err(), "byte {at} of {}", own.len());
        assert!(Recording::read_parquet(own[..at].to_vec(), TO_THE_END).is_err());
        if at < footer {
            let _ = Recording::read_parquet(seal::sealed(damaged, footer), TO_THE_END);
        }
    }
}

/// A file that is cut off has a whole footer among its last ends, and one with thousands is no such file. A file that
/// ends with a footer is not cut off, so that no other one stands in for it.
#[test]
fn few_ends_of_a_file_are_tried() {
    let own = bytes(&recording(20));
    let end = [&[0x15; 40][..], &40_u32.to_le_bytes(), parquet_reader::MAGIC].concat();
    let with =
        |ends: usize, rest: &[u8]| Recording::read_parquet([&own, &*end.repeat(ends), rest].concat(), TO_THE_END);
    assert!(with(15, b"P").unwrap().is_cut_off);
    for (ends, rest) in [(16, &b"P"[..]), (20_000, b"P"), (1, b""), (15, b"")] {
        let error = with(ends, rest).unwrap_err().to_string();
        assert!(error.contains("its Parquet data cannot be read"), "{error}");
    }
}
