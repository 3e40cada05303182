//! The header row: the columns and their positions.

use csv::ByteRecord;

use super::error::CsvError;

pub(super) const VARIANT: &str = "variant";
pub(super) const RADIUS: &str = "radius_m";
pub(super) const STIFFNESS: &str = "stiffness_pa_per_m";
pub(super) const COATING: &str = "coating_m";
pub(super) const PERMITTIVITY: &str = "permittivity";
pub(super) const FRICTION_COEFFICIENT: &str = "friction_coefficient";
pub(super) const VOLTAGE: &str = "voltage_v";
pub(super) const NORMAL_FORCE: &str = "normal_force_n";
pub(super) const OUTER_RADIUS: &str = "outer_radius_m";
pub(super) const MODULUS: &str = "modulus_pa";
pub(super) const STRESS_EXPONENT: &str = "stress_exponent";
pub(super) const SHAPE_CONSTANT: &str = "shape_constant";
/// Total friction, and the part that the voltage adds.
pub(super) const FRICTIONS: [&str; 2] = ["friction_n", "electric_friction_n"];

/// Columns that every row needs, independent of its variant.
const COMMON: [&str; 5] = [VARIANT, RADIUS, COATING, PERMITTIVITY, FRICTION_COEFFICIENT];
/// Columns that some variants need.
const PARTICULAR: [&str; 6] = [STIFFNESS, NORMAL_FORCE, OUTER_RADIUS, MODULUS, STRESS_EXPONENT, SHAPE_CONSTANT];

/// Similarity from which one name is suggested for another, as a part of their length.
const LIKENESS: f64 = 0.7;

/// Positions of the columns that the model reads.
pub(super) struct Columns {
    places: Vec<(&'static str, usize)>,
    len: usize,
}

impl Columns {
    /// Reads a header. Fails unless it has all common columns and at least one of `given`, each at most once.
    pub(super) fn new(header: &ByteRecord, given: &[&'static str]) -> Result<Self, CsvError> {
        let names: Vec<_> = header.iter().map(|cell| String::from_utf8_lossy(cell).trim().to_owned()).collect();
        let mut places = Vec::new();
        for &column in COMMON.iter().chain(&PARTICULAR).chain(given) {
            let mut found = (0..).zip(&names).filter(|(_, name)| *name == column);
            if let Some((place, _)) = found.next() {
                if let Some((again, _)) = found.next() {
                    return Err(CsvError::ColumnTwice { column, first: place + 1, second: again + 1 });
                }
                places.push((column, place));
            }
        }
        let columns = Self { places, len: names.len() };
        let missing = COMMON.iter().copied().find(|column| !columns.has(column));
        if let Some(column) = missing {
            return Err(missing_column(&[column], &names));
        }
        if !given.iter().any(|column| columns.has(column)) {
            return Err(missing_column(given, &names));
        }
        Ok(columns)
    }

    /// Number of columns in the file, including those that the model does not read.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    pub(super) fn has(&self, column: &str) -> bool {
        self.place(column).is_some()
    }

    pub(super) fn place(&self, column: &str) -> Option<usize> {
        self.places.iter().find(|(name, _)| *name == column).map(|(_, place)| *place)
    }
}

fn missing_column(columns: &[&'static str], names: &[String]) -> CsvError {
    let likeness = |name: &str| {
        let each = columns.iter().map(|column| strsim::normalized_damerau_levenshtein(column, name));
        each.fold(0.0, f64::max)
    };
    let nearest = names
        .iter()
        .map(|name| (likeness(name), name))
        .filter(|(likeness, _)| *likeness >= LIKENESS)
        .max_by(|one, other| one.0.total_cmp(&other.0));
    CsvError::ColumnMissing { column: columns.join("` or `"), nearest: nearest.map(|(_, name)| name.clone()) }
}
