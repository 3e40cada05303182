//! The tables of a study: columns with units, as CSV and as Parquet, and the files that hold them.

use std::fmt::Write;

use frixel_chart::DrawError;
use thiserror::Error;

use super::cell::LayerResult;
use super::parameter::Value;
use super::picture;
use super::study::{Group, LayerShare, Study};
use crate::recording::{Column, Field, Kind, RecordingError, Values, table_parquet};
use crate::score::{interval, metric_keys, quoted};
use crate::statistics::mean;

/// Why the results of a study cannot be written.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The picture cannot be drawn.
    #[error("the picture of a study cannot be drawn ({0})")]
    Picture(#[from] DrawError),
    /// A table exceeds the limits of a recording.
    #[error("a table of a study cannot be stored: {0}")]
    Table(#[from] RecordingError),
}

impl Study {
    /// A row for each group and layer: the share of the fingers that notice it, with its interval.
    fn layers(&self) -> Vec<Column> {
        let of_group = |group| Group::layers(group).into_iter().map(move |share| (group, share));
        let rows: Vec<(&Group, LayerShare)> = self.groups.iter().flat_map(of_group).collect();
        let shares = || rows.iter().map(|(_, share)| share);
        let verdicts = || shares().map(|share| share.simulated_fingers);
        let mut columns = self.of_groups(rows.iter().map(|(group, _)| *group));
        columns.extend([
            texts("layer", "number and name of the layer", shares().map(|share| share.layer.clone())),
            wholes("simulated_fingers", "simulated fingers that touched it", verdicts().map(|count| count.touched)),
            wholes("felt", "fingers that notice it", verdicts().map(|count| count.felt)),
            wholes("maybe", "fingers near the threshold", verdicts().map(|count| count.maybe)),
            wholes("not_felt", "fingers that do not notice it", verdicts().map(|count| count.not_felt)),
            wholes("unknown", "fingers that no study covers", verdicts().map(|count| count.unknown)),
            numbers("felt_share", "", "share of fingers that notice it", shares().map(|share| Some(share.felt_share))),
            numbers(
                "felt_share_low",
                "",
                "lower end of its 95 % interval",
                shares().map(|share| Some(share.interval[0])),
            ),
            numbers(
                "felt_share_high",
                "",
                "upper end of its 95 % interval",
                shares().map(|share| Some(share.interval[1])),
            ),
            contrasts("median of the felt contrast within the layer", shares().map(|share| share.contrast_weber_steps)),
        ]);
        columns
    }

    /// A row for each finger and layer.
    fn fingers(&self) -> Vec<Column> {
        let mut rows = Vec::new();
        for group in &self.groups {
            for finger in &group.fingers {
                rows.extend(finger.layers.iter().map(|layer| (group, finger, layer)));
            }
        }
        let mut columns = self.of_groups(rows.iter().map(|(group, ..)| *group));
        let layers = || rows.iter().map(|(.., layer): &(_, _, &LayerResult)| *layer);
        columns.extend([
            wholes(
                "simulated_person",
                "number of the person",
                rows.iter().map(|(_, finger, _)| finger.person as usize),
            ),
            numbers(
                "moisture",
                "standard deviations",
                "moisture of the skin, from the middle of the population",
                rows.iter().map(|(_, finger, _)| Some(finger.moisture)),
            ),
            texts("layer", "number and name of the layer", layers().map(|layer| layer.layer.clone())),
            texts("verdict", "whether the finger notices it", layers().map(|layer| layer.verdict.key().to_owned())),
            contrasts("felt contrast within the layer", layers().map(|layer| layer.contrast_weber_steps)),
        ]);
        columns
    }

    /// A row for each group and number of a score: its mean over the fingers, with the interval.
    fn numbers(&self) -> Vec<Column> {
        let mut rows = Vec::new();
        for group in &self.groups {
            for key in metric_keys() {
                let values: Vec<f64> =
                    group.fingers.iter().filter_map(|finger| finger.means.get(key).copied()).collect();
                if !values.is_empty() {
                    let ends = interval(&values);
                    rows.push((group, key, values.len(), mean(values.into_iter()), ends));
                }
            }
        }
        let mut columns = self.of_groups(rows.iter().map(|(group, ..)| *group));
        let ends = |end: usize| rows.iter().map(move |(.., ends)| ends.and_then(|ends| ends.get(end).copied()));
        columns.extend([
            texts("number", "name of the number, as in score.csv", rows.iter().map(|(_, key, ..)| (*key).to_owned())),
            wholes("simulated_fingers", "simulated fingers that have it", rows.iter().map(|(_, _, count, ..)| *count)),
            numbers("mean", "", "its mean, in the unit of the number", rows.iter().map(|(.., mean, _)| Some(*mean))),
            numbers("mean_low", "", "lower end of its 95 % interval", ends(0)),
            numbers("mean_high", "", "upper end of its 95 % interval", ends(1)),
        ]);
        columns
    }

    /// The files of the results, each with its name: tables as CSV and as Parquet, and the picture. Equal results give
    /// equal bytes.
    pub fn files(&self) -> Result<Vec<(&'static str, Vec<u8>)>, StudyError> {
        let (layers, fingers, numbers) = (self.layers(), self.fingers(), self.numbers());
        Ok(vec![
            ("layers.csv", csv(&layers).into_bytes()),
            ("fingers.csv", csv(&fingers).into_bytes()),
            ("numbers.csv", csv(&numbers).into_bytes()),
            ("layers.parquet", table_parquet(&layers)?),
            ("fingers.parquet", table_parquet(&fingers)?),
            ("numbers.parquet", table_parquet(&numbers)?),
            ("sweep.svg", picture::svg(self)?.into_bytes()),
        ])
    }

    /// The columns that say which group a row is of.
    fn of_groups<'g>(&self, rows: impl Iterator<Item = &'g Group>) -> Vec<Column> {
        let rows: Vec<&Group> = rows.collect();
        let screens = rows.iter().map(|group| group.screen.clone()).collect();
        let mut columns = vec![
            texts("scene", "scene file", rows.iter().map(|group| group.scene.clone())),
            column("screen", "", "screen in place of the scene's own", Values::Texts(screens)),
            texts("touch", "touch source", rows.iter().map(|group| group.touch.clone())),
        ];
        for path in self.paths() {
            let values = values(rows.iter().map(|group| group.parameters.get(path)).collect());
            columns.push(column(path, "", "field of the scene, whose name ends in its unit", values));
        }
        columns
    }
}

/// The values of a field: whole numbers, else numbers, else words.
fn values(values: Vec<Option<&Value>>) -> Values {
    let known = || values.iter().flatten();
    let whole = |value: &Value| match value {
        Value::Whole(number) => i32::try_from(*number).ok(),
        _ => None,
    };
    if known().all(|value| whole(value).is_some()) {
        Values::Integers(values.into_iter().map(|value| value.and_then(whole)).collect())
    } else if known().all(|value| value.number().is_some()) {
        Values::Numbers(values.into_iter().map(|value| value.and_then(Value::number)).collect())
    } else {
        Values::Texts(values.into_iter().map(|value| value.map(ToString::to_string)).collect())
    }
}

fn texts(name: &str, meaning: &str, values: impl Iterator<Item = String>) -> Column {
    column(name, "", meaning, Values::Texts(values.map(Some).collect()))
}

fn wholes(name: &str, meaning: &str, values: impl Iterator<Item = usize>) -> Column {
    column(name, "", meaning, Values::Integers(values.map(|value| i32::try_from(value).ok()).collect()))
}

fn numbers(name: &str, unit: &str, meaning: &str, values: impl Iterator<Item = Option<f64>>) -> Column {
    column(name, unit, meaning, Values::Numbers(values.collect()))
}

fn contrasts(meaning: &str, values: impl Iterator<Item = f64>) -> Column {
    numbers("contrast_weber_steps", "Weber steps", meaning, values.map(Some))
}

fn column(name: &str, unit: &str, meaning: &str, values: Values) -> Column {
    let kind = match values {
        Values::Numbers(_) => Kind::Number,
        Values::Integers(_) => Kind::Integer,
        Values::Texts(_) => Kind::Text,
    };
    Column { field: Field::of((name, unit, meaning, kind)), values }
}

/// Columns as CSV, with strings in quotes; unknown values are empty cells.
fn csv(columns: &[Column]) -> String {
    let names = columns.iter().map(|column| {
        let name = &column.field.name;
        let is_plain = name.chars().all(|character| character.is_ascii_alphanumeric() || character == '_');
        if is_plain { name.clone() } else { quoted(name) }
    });
    let mut text = names.collect::<Vec<_>>().join(",") + "\n";
    let rows = columns.first().map_or(0, |column| column.values.len());
    for row in 0..rows {
        let cells = columns.iter().map(|column| match &column.values {
            Values::Texts(texts) => texts.get(row).and_then(Option::as_deref).map_or(String::new(), quoted),
            numbers => numbers.text(row),
        });
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}", cells.collect::<Vec<_>>().join(","));
    }
    text
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use bytes::Bytes;
    use frixel_felt::judge::Verdict;
    use parquet::file::reader::{FileReader, SerializedFileReader};

    use super::*;
    use crate::sweep::{CellResult, LayerResult};

    fn study() -> Study {
        let value = |voltage: &Value, load: f64, wave: &str| {
            let pairs =
                [("drive.v", voltage.clone()), ("load_n", Value::Number(load)), ("w", Value::Word(wave.to_owned()))];
            BTreeMap::from(pairs.map(|(path, value)| (path.to_owned(), value)))
        };
        let result = |person, parameters, verdict| CellResult {
            cell: String::new(),
            scene: "a \"b\".toml".to_owned(),
            parameters,
            screen: None,
            touch: "100".to_owned(),
            person,
            moisture: 0.1 + 0.2,
            voltage_v_rms: 150.0,
            layers: vec![LayerResult { layer: "layer 1".to_owned(), table: 1, verdict, contrast_weber_steps: 1.5 }],
            means: BTreeMap::from([("error".to_owned(), 0.25)]),
        };
        let (low, high) = (Value::Whole(100), Value::Whole(150));
        Study::new([
            result(1, value(&low, 2.0, "sine"), Verdict::Felt),
            result(2, value(&low, 2.0, "sine"), Verdict::NotFelt),
            result(1, value(&high, 0.5, "saw"), Verdict::Unknown),
        ])
    }

    #[test]
    fn a_field_of_whole_numbers_is_whole_and_a_word_is_text() {
        let lines = csv(&study().fingers());
        let rows: Vec<&str> = lines.lines().collect();
        assert_eq!(
            rows[0],
            "scene,screen,touch,\"drive.v\",load_n,w,simulated_person,moisture,layer,verdict,contrast_weber_steps"
        );
        let row = "\"a \"\"b\"\".toml\",,\"100\",100,2,\"sine\",2,0.30000000000000004,\"layer 1\",\"not_felt\",1.5";
        assert_eq!(rows[2], row);
        let kinds: Vec<Kind> = study().fingers().iter().map(|column| column.field.kind).skip(3).take(3).collect();
        assert_eq!(kinds, [Kind::Integer, Kind::Number, Kind::Text]);
    }

    /// One finger has no interval of a mean.
    #[test]
    fn parquet_has_the_rows_of_the_csv() {
        for (columns, rows) in [(study().layers(), 2), (study().fingers(), 3), (study().numbers(), 2)] {
            let file = SerializedFileReader::new(Bytes::from(table_parquet(&columns).unwrap())).unwrap();
            let read: Vec<String> = file.get_row_iter(None).unwrap().map(|row| row.unwrap().to_string()).collect();
            assert_eq!((read.len(), csv(&columns).lines().count()), (rows, rows + 1));
            assert!(read[0].contains("drive.v: 100, load_n: 2.0, w: \"sine\""), "{}", read[0]);
        }
        let numbers = csv(&study().numbers());
        assert!(numbers.ends_with("150,0.5,\"saw\",\"error\",1,0.25,,\n"), "{numbers}");
    }
}
