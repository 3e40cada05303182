//! The columns of a recording.

use frixel_felt::recorder::{FeltRow, FlagNames};
use serde::{Deserialize, Serialize};

use crate::fit::ORIGIN;

/// Name, unit and meaning of a column.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Field {
    /// Its name, which ends in the unit.
    pub name: String,
    /// The unit, as `mm/s`; empty for a number without one and for text.
    pub unit: String,
    /// Description for readers.
    pub meaning: String,
    /// Type of its values.
    pub kind: Kind,
}

impl Field {
    /// A column by its name, its unit, its meaning and what its values are.
    pub(crate) fn of((name, unit, meaning, kind): (&str, &str, &str, Kind)) -> Self {
        Self { name: name.to_owned(), unit: unit.to_owned(), meaning: meaning.to_owned(), kind }
    }
}

/// Type of the values of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Real numbers.
    Number,
    /// Whole numbers.
    Integer,
    /// Strings.
    Text,
}

/// The values of a column; an unknown one is `None`.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Finite numbers.
    Numbers(Vec<Option<f64>>),
    /// Whole numbers.
    Integers(Vec<Option<i32>>),
    /// Strings.
    Texts(Vec<Option<String>>),
}

impl Values {
    /// A column of this kind without values.
    pub(super) fn none(kind: Kind) -> Self {
        match kind {
            Kind::Number => Self::Numbers(Vec::new()),
            Kind::Integer => Self::Integers(Vec::new()),
            Kind::Text => Self::Texts(Vec::new()),
        }
    }

    /// Adds the value of a cell of a table; false if it is none.
    pub(super) fn push(&mut self, cell: &str) -> bool {
        let is_known = match self {
            Self::Numbers(values) => {
                values.push(cell.parse().ok().filter(|number: &f64| number.is_finite()));
                values.last().is_some_and(Option::is_some)
            }
            Self::Integers(values) => {
                values.push(cell.parse().ok());
                values.last().is_some_and(Option::is_some)
            }
            Self::Texts(values) => {
                values.push((!cell.is_empty()).then(|| cell.to_owned()));
                true
            }
        };
        is_known || cell.is_empty()
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(values) => values.len(),
            Self::Integers(values) => values.len(),
            Self::Texts(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether a value is that of another column, bit by bit.
    pub(super) fn is_same(&self, other: &Self, row: usize) -> bool {
        let bits = |values: &[Option<f64>]| values.get(row).map(|value| value.map(f64::to_bits));
        match (self, other) {
            (Self::Numbers(one), Self::Numbers(other)) => bits(one) == bits(other),
            (Self::Integers(one), Self::Integers(other)) => one.get(row) == other.get(row),
            (Self::Texts(one), Self::Texts(other)) => one.get(row) == other.get(row),
            _ => false,
        }
    }

    /// A value for people; empty if it is unknown.
    pub(crate) fn text(&self, row: usize) -> String {
        match self {
            Self::Numbers(values) => {
                values.get(row).copied().flatten().map_or_else(String::new, |value| value.to_string())
            }
            Self::Integers(values) => {
                values.get(row).copied().flatten().map_or_else(String::new, |value| value.to_string())
            }
            Self::Texts(values) => values.get(row).cloned().flatten().unwrap_or_default(),
        }
    }

    /// The values of some rows.
    pub(super) fn part(&self, from: usize, to: usize) -> Self {
        match self {
            Self::Numbers(values) => Self::Numbers(values.get(from..to).unwrap_or_default().to_vec()),
            Self::Integers(values) => Self::Integers(values.get(from..to).unwrap_or_default().to_vec()),
            Self::Texts(values) => Self::Texts(values.get(from..to).unwrap_or_default().to_vec()),
        }
    }
}

/// How a column is taken from the rows of a play.
enum Source {
    Number(fn(&FeltRow) -> Option<f64>),
    Integer(fn(&FeltRow) -> Option<i32>),
    Text(fn(&FeltRow) -> Option<String>),
}

/// Column that `felt.csv` adds for a person's play.
pub(super) const PARTICIPANT: &str = "participant";
/// Name, unit, meaning and source of each column of a play.
const PLAY: [(&str, &str, &str, Source); 12] = [
    ("t_s", "s", "time since the scene began to play, at the end of the row", Source::Number(|row| Some(row.t_s))),
    ("x_mm", "mm", "the finger's place from the left edge of the screen", Source::Number(|row| row.x_mm)),
    ("y_mm", "mm", "the finger's place from the top edge of the screen", Source::Number(|row| row.y_mm)),
    ("speed_mm_s", "mm/s", "the finger's sliding speed", Source::Number(|row| row.speed_mm_s)),
    (
        "reference_n",
        "N",
        "the reference: friction of the scene, mean over the row",
        Source::Number(|row| row.reference_n),
    ),
    ("commanded_n", "N", "friction that the board commanded, mean over the row", Source::Number(|row| row.commanded_n)),
    ("felt_n", "N", "friction that a simulated finger felt, mean over the row", Source::Number(|row| row.felt_n)),
    ("natural_n", "N", "the part of it without the drive, mean over the row", Source::Number(|row| row.natural_n)),
    ("electrode_v_rms", "V", "rms voltage on a simulated electrode", Source::Number(|row| row.electrode_v_rms)),
    ("voltage_v_rms", "V", "rms voltage of the envelope, as last reported", Source::Number(|row| row.voltage_v_rms)),
    ("dac_code", "", "the last code that went to the DAC", Source::Integer(|row| row.dac_code.map(i32::from))),
    (
        "flags",
        "",
        "every flag that the board reported, joined by +",
        Source::Text(|row| row.flags.map(|flags| FlagNames(flags).to_string())),
    ),
];

/// The columns of a stroke that `frixel board record` writes.
pub fn stroke_fields() -> Vec<Field> {
    let fields = [
        ("t_s", "s", "time since the first touch", Kind::Number),
        ("x_mm", "mm", "the finger's place from the left edge of the screen", Kind::Number),
        ("y_mm", "mm", "the finger's place from the top edge of the screen", Kind::Number),
    ];
    fields.map(Field::of).into()
}

/// The columns of a calibration.
pub fn calibration_fields(is_simulated: bool) -> Vec<Field> {
    let fields = [
        ("time_s", "s", "time on the board's clock", Kind::Number),
        ("stroke", "", "name of the stroke", Kind::Text),
        ("voltage_v_rms", "V", "rms voltage of the envelope", Kind::Number),
        ("normal_force_n", "N", "force of the finger on the screen", Kind::Number),
        ("friction_n", "N", "friction that the sensor measured", Kind::Number),
        ("speed_mm_s", "mm/s", "the finger's sliding speed", Kind::Number),
        (ORIGIN.name, "", "evidence for the forces: `assumed` of a simulated finger", Kind::Text),
    ];
    fields.into_iter().filter(|(name, ..)| is_simulated || *name != ORIGIN.name).map(Field::of).collect()
}

/// Whether a column is one of `felt.csv` or of a recording of a play.
pub(crate) fn is_play_column(name: &str) -> bool {
    name == PARTICIPANT || PLAY.iter().any(|(column, ..)| *column == name)
}

/// The columns of a play.
pub fn play_fields() -> Vec<Field> {
    let kind = |source: &Source| match source {
        Source::Number(_) => Kind::Number,
        Source::Integer(_) => Kind::Integer,
        Source::Text(_) => Kind::Text,
    };
    let field = |(name, unit, meaning, source): &(&'static str, &'static str, &'static str, Source)| {
        Field::of((name, unit, meaning, kind(source)))
    };
    PLAY.iter().map(field).collect()
}

/// The values of rows of a play, in the order of [`play_fields`]. A number that is not finite is unknown.
pub fn play_values(rows: &[FeltRow]) -> Vec<Values> {
    let values = |(.., source): &(&str, &str, &str, Source)| match source {
        Source::Number(of) => {
            Values::Numbers(rows.iter().map(|row| of(row).filter(|value| value.is_finite())).collect())
        }
        Source::Integer(of) => Values::Integers(rows.iter().map(of).collect()),
        Source::Text(of) => Values::Texts(rows.iter().map(of).collect()),
    };
    PLAY.iter().map(values).collect()
}
