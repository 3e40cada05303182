//! Recipes: what is known of data sets that a person must download, and how their columns become data of a fit.
//!
//! A recipe is a file of `host/lab/recipes`. It states what was seen of the data set; what nobody here has seen is
//! called unseen. Its ranges are what the data set's own description says: numbers outside of them are in another unit.

use core::f64::consts::SQRT_2;
use std::fmt::Write as _;
use std::io::Read;

use serde::Deserialize;
use thiserror::Error;

use super::table::{FRICTION, LOAD, SPEED, STROKE, TIME, VOLTAGE};
use crate::statistics::quantile;
use crate::table::{Column, Place, Reading, Table, TableError, Unit};

/// How far a number may be outside of a range that a description states in round numbers, as a factor.
const MARGIN: f64 = 1.25;
/// The part of the loads and speeds that may be smaller than the one that is compared with a range: a finger also
/// rests, turns and lands.
const TYPICAL_PART: f64 = 0.9;
const VOLTAGE_PEAK: Column = Column::new("voltage_v_peak", "volts, peak of a sine").converted(Unit::Volts);

const FILES: [(&str, &str); 4] = [
    ("4tu-08aa3d2d", include_str!("../../recipes/4tu-08aa3d2d.toml")),
    ("4tu-d9f05363", include_str!("../../recipes/4tu-d9f05363.toml")),
    ("dryad-9ghx3ffgp", include_str!("../../recipes/dryad-9ghx3ffgp.toml")),
    ("sens3", include_str!("../../recipes/sens3.toml")),
];

/// What is known of a data set, and how its columns become data of a fit.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// Its name.
    #[serde(default)]
    pub name: String,
    title: String,
    source: String,
    licence: String,
    seen: String,
    says: String,
    names_in_files: String,
    /// Why the data set cannot be fitted; `None` if it can.
    no_fit: Option<String>,
    voltage: Option<Voltage>,
    normal_force: Option<Load>,
    speed: Option<Speed>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Voltage {
    column: VoltageColumn,
    /// Lowest and highest voltage above zero.
    range: Option<[f64; 2]>,
    why: String,
}

#[derive(Clone, Copy, Debug, Deserialize)]
enum VoltageColumn {
    #[serde(rename = "voltage_v_rms")]
    Rms,
    /// The peak of a sine.
    #[serde(rename = "voltage_v_peak")]
    Peak,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Load {
    range_n: [f64; 2],
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Speed {
    range_mm_s: [f64; 2],
}

/// Why a recipe cannot be used.
#[derive(Debug, Error)]
pub enum RecipeError {
    /// There is no such recipe.
    #[error("there is no recipe {0:?}: take one of\n{list}", list = list())]
    Unknown(String),
    /// The data set has nothing to fit.
    #[error("there is no fit of this data set: {0}")]
    NoFit(String),
    /// The file is no table of the columns that are needed.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A voltage is outside of what the data set has.
    #[error(
        "row {row}, column {column}: {found} is outside of what the recipe says, 0 to {high}: name the column with the \
         unit that it has, or check that the file is of that data set"
    )]
    VoltageOutOfRange {
        /// Number of the row.
        row: u64,
        /// The column.
        column: String,
        /// The voltage, in the unit of the recipe.
        found: f64,
        /// Highest voltage.
        high: f64,
    },
    /// Loads or speeds are outside of what the data set has.
    #[error(
        "column {column}: nine of ten numbers are up to {found} without their sign, outside of what the recipe says, \
         {low} to {high}: name the column with the unit that it has, or check that the file is of that data set"
    )]
    OutOfRange {
        /// The column.
        column: String,
        /// The number that nine of ten do not exceed, in the unit of the recipe.
        found: f64,
        /// Lowest number.
        low: f64,
        /// Highest number.
        high: f64,
    },
}

impl VoltageColumn {
    fn column(self) -> Column {
        match self {
            Self::Rms => VOLTAGE,
            Self::Peak => VOLTAGE_PEAK,
        }
    }

    fn v_rms(self, found_v: f64) -> f64 {
        match self {
            Self::Rms => found_v,
            Self::Peak => found_v / SQRT_2,
        }
    }
}

/// All recipes.
pub fn recipes() -> impl Iterator<Item = Recipe> {
    // A test reads each file.
    FILES.iter().filter_map(|(name, text)| Some(Recipe { name: (*name).to_owned(), ..toml::from_str(text).ok()? }))
}

/// The names and titles of all recipes, a line each.
pub fn list() -> String {
    let lines: Vec<String> = recipes().map(|recipe| format!("  {:<16} {}", recipe.name, recipe.title)).collect();
    lines.join("\n")
}

impl Recipe {
    /// The recipe of this name.
    pub fn named(name: &str) -> Result<Self, RecipeError> {
        recipes().find(|recipe| recipe.name == name).ok_or_else(|| RecipeError::Unknown(name.to_owned()))
    }

    /// What is known of the data set, in lines of `key: value`.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines = vec![
            ("source", self.source.clone()),
            ("licence", self.licence.clone()),
            ("what was seen", self.seen.clone()),
            ("what it says", self.says.clone()),
            ("columns in its files", self.names_in_files.clone()),
        ];
        if let Some(why) = &self.no_fit {
            lines.push(("no fit", why.clone()));
            return lines;
        }
        if let Some(Voltage { column, range, why }) = &self.voltage {
            let column = column.column();
            let range = range.map_or(String::new(), |[low, high]| format!(", {low} to {high}, and 0 without drive"));
            lines.push(("name the voltage", format!("`{}`, {}{range}: {why}", column.name, column.unit)));
        }
        let range = |range: Option<[f64; 2]>| range.map_or(String::new(), |[low, high]| format!(", {low} to {high}"));
        let load = range(self.normal_force.as_ref().map(|load| load.range_n));
        lines.push(("name the load", format!("`{}`, {}{load}", LOAD.name, LOAD.unit)));
        lines.push(("name the friction", format!("`{}`, {}", FRICTION.name, FRICTION.unit)));
        let speed = range(self.speed.as_ref().map(|speed| speed.range_mm_s));
        lines.push((
            "if there are",
            format!("`{}`, {}; `{}`; `{}`, {}{speed}", TIME.name, TIME.unit, STROKE.name, SPEED.name, SPEED.unit),
        ));
        lines
    }

    /// Makes the table that a fit reads of a file of the data set, row for row. Fails if the data set has nothing to
    /// fit, a column is missing, or a number is in another unit.
    pub fn table(&self, input: impl Read) -> Result<Reading<String>, RecipeError> {
        let Some(voltage) = self.voltage.as_ref().filter(|_| self.no_fit.is_none()) else {
            return Err(RecipeError::NoFit(self.no_fit.clone().unwrap_or_default()));
        };
        let mut table = Table::new(input)?;
        let peak = voltage.column;
        let load_range = self.normal_force.as_ref().map(|load| load.range_n);
        let speed_range = self.speed.as_ref().map(|speed| speed.range_mm_s);
        let voltage_max = voltage.range.map(|[_, high]| high);
        let (voltage, load) = (table.need(peak.column())?, table.need(LOAD)?);
        let mut columns = vec![(VOLTAGE.name, voltage), (LOAD.name, load), (FRICTION.name, table.need(FRICTION)?)];
        let mut typical: Vec<Typical> = load_range.map(|range| Typical::new(load, range)).into_iter().collect();
        for (column, range) in [(TIME, None), (SPEED, speed_range)] {
            let Some(place) = table.find(column)? else { continue };
            columns.push((column.name, place));
            typical.extend(range.map(|range| Typical::new(place, range)));
        }
        let stroke = table.find(STROKE)?;
        let names = columns.iter().map(|(name, _)| *name).chain(stroke.map(|_| STROKE.name));
        let mut text = names.collect::<Vec<_>>().join(",");
        let understood = table.understood();
        let mut line = 1;
        while let Some(row) = table.next_row()? {
            row.check_length()?;
            // Rows keep their numbers.
            while line < row.number() {
                text.push('\n');
                line += 1;
            }
            let mut cells = Vec::new();
            for (name, place) in &columns {
                let found = row.real(*place)?;
                if let Some(high) = voltage_max.filter(|high| *place == voltage && found.abs() > high * MARGIN) {
                    let (row, column) = (row.number(), row.column(*place));
                    return Err(RecipeError::VoltageOutOfRange { row, column, found, high });
                }
                cells.push(if *name == VOLTAGE.name { peak.v_rms(found) } else { found }.to_string());
            }
            for column in &mut typical {
                column.sizes.push(row.real(column.place)?.abs());
            }
            cells.extend(stroke.map(|stroke| format!("\"{}\"", row.text(stroke).replace('"', "\"\""))));
            let _ = write!(text, "{}", cells.join(","));
        }
        text.push('\n');
        for column in typical {
            column.check(table.names())?;
        }
        Ok(Reading { value: text, understood })
    }
}

/// The numbers of a column, without their signs, whose typical one a description states.
struct Typical {
    place: Place,
    range: [f64; 2],
    sizes: Vec<f64>,
}

impl Typical {
    fn new(place: Place, range: [f64; 2]) -> Self {
        Self { place, range, sizes: Vec::new() }
    }

    /// Fails if the column is in another unit than that of the range.
    fn check(mut self, names: &[String]) -> Result<(), RecipeError> {
        self.sizes.sort_by(f64::total_cmp);
        let found = quantile(&self.sizes, TYPICAL_PART);
        let [low, high] = self.range;
        if self.sizes.is_empty() || (low / MARGIN..=high * MARGIN).contains(&found) {
            return Ok(());
        }
        let column = self.place.name_in(names).to_owned();
        Err(RecipeError::OutOfRange { column, found, low, high })
    }
}

/// The page of the documents that lists the recipes.
pub fn page() -> String {
    let mut page = String::from(
        "# Recipes for data that a person downloads\n\n\
         What is known here of published data sets, from their own descriptions; *unseen* is what nobody here has seen. Nothing of them is\n\
         part of frixel. This page is made of the files in `host/lab/recipes`; `frixel fit --recipe NAME` prints a part of it.\n\n\
         To fit a file, look at its columns, name them as the recipe says ([Tables](outputs.md#tables) has the units that a name may state), and type\n\n    \
         frixel fit FILE.csv --recipe NAME -o finger.toml\n\n\
         Voltages above what the description says, and loads and speeds of which nine of ten are outside of it, are refused, with a margin of a\n\
         quarter: they are in another unit, or of other data.\n",
    );
    for recipe in recipes() {
        let _ = write!(page, "\n## `{}`\n\n{}.\n\n| | |\n|---|---|\n", recipe.name, recipe.title);
        for (key, value) in recipe.lines() {
            let _ = writeln!(page, "| {key} | {value} |");
        }
    }
    page
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::super::rows;
    use super::{FILES, Recipe, RecipeError, recipes};

    fn made(name: &str, text: &str) -> Result<String, RecipeError> {
        Ok(Recipe::named(name)?.table(text.as_bytes())?.value)
    }

    #[test]
    fn each_file_is_a_recipe_that_is_found_by_its_name() {
        for (name, text) in FILES {
            toml::from_str::<Recipe>(text).unwrap();
            assert_eq!(Recipe::named(name).unwrap().name, name);
        }
        assert_eq!(recipes().count(), FILES.len());
        let unknown = Recipe::named("4tu").unwrap_err().to_string();
        assert!(FILES.iter().all(|(name, _)| unknown.contains(name)), "{unknown}");
    }

    #[test]
    fn peaks_of_a_sine_become_volts_rms_in_the_same_rows() {
        let text = "voltage_v_peak;normal_force_mn;friction_n;stroke\n\n150;500;0,25;a\n0;500;0,2;\"b;\"\n";
        let made = made("4tu-08aa3d2d", text).unwrap();
        let rows = rows(made.as_bytes()).unwrap().value;
        assert_eq!((rows[0].number, rows[1].number), (3, 4));
        assert!((rows[0].voltage_v_rms - 106.066).abs() < 1e-3);
        assert_eq!((rows[0].normal_force_n, rows[0].friction_n, rows[1].voltage_v_rms), (0.5, 0.25, 0.0));
        assert_eq!(rows[1].stroke.as_deref(), Some("b;"));
    }

    #[test]
    fn a_finger_that_turns_rests_and_lands_is_of_the_data_set() {
        let mut text = String::from("voltage_v_rms,normal_force_n,friction_n,speed_mm_s\n");
        for (load, speed) in [(0.0, 0.0), (1.9, 3.0)].into_iter().chain([(0.4, -50.0); 30]) {
            writeln!(text, "100,{load},0.2,{speed}").unwrap();
        }
        assert_eq!(made("4tu-d9f05363", &text).unwrap().lines().count(), 33);
    }

    #[test]
    fn wrong_units_are_refused() {
        for (name, text, said) in [
            (
                "4tu-08aa3d2d",
                "voltage_v_peak,normal_force_n,friction_n\n150000,0.5,0.2\n",
                "row 2, column voltage_v_peak: 150000 is outside",
            ),
            (
                "4tu-08aa3d2d",
                "voltage_v_rms,normal_force_n,friction_n\n106,0.5,0.2\n",
                "the header has no column voltage_v_peak",
            ),
            (
                "4tu-d9f05363",
                "voltage_v_rms,normal_force_n,friction_n\n100,200,100\n",
                "column normal_force_n: nine of ten numbers are up to 200 ",
            ),
            (
                "4tu-d9f05363",
                "voltage_v_rms,normal_force_n,friction_n,speed_mm_s\n100,0.4,0.2,0.05\n",
                "column speed_mm_s: nine of ten numbers are up to 0.05 ",
            ),
            ("dryad-9ghx3ffgp", "", "there is no electric friction to fit"),
            ("sens3", "", "no voltage is part of it"),
        ] {
            let found = made(name, text).unwrap_err().to_string();
            assert!(found.contains(said), "{found}");
        }
    }
}
