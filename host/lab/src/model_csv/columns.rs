//! The columns that the model reads.

use std::io::Read;

use crate::table::{Column, Place, Table, TableError, Unit};

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
const COMMON: [Column; 5] = [
    Column::new(VARIANT, ""),
    Column::new(RADIUS, "metres").converted(Unit::METRES),
    Column::new(COATING, "metres").converted(Unit::METRES),
    Column::new(PERMITTIVITY, ""),
    Column::new(FRICTION_COEFFICIENT, ""),
];
/// Columns that some variants need.
const PARTICULAR: [Column; 6] = [
    Column::new(STIFFNESS, "pascals per metre"),
    Column::new(NORMAL_FORCE, "newtons").converted(Unit::NEWTONS),
    Column::new(OUTER_RADIUS, "metres").converted(Unit::METRES),
    Column::new(MODULUS, "pascals"),
    Column::new(STRESS_EXPONENT, ""),
    Column::new(SHAPE_CONSTANT, ""),
];

/// Places of the columns that the model reads.
pub(super) struct Columns(Vec<(&'static str, Place)>);

impl Columns {
    /// Fails unless the table has all common columns and at least one of `given`, each at most once.
    pub(super) fn new<R: Read>(table: &mut Table<R>, given: &[Column]) -> Result<Self, TableError> {
        let mut places = Vec::new();
        for column in COMMON.iter().chain(&PARTICULAR).chain(given) {
            places.extend(table.find(*column)?.map(|place| (column.name, place)));
        }
        for column in COMMON {
            table.need(column)?;
        }
        let columns = Self(places);
        let is_given = given.iter().any(|column| columns.place(column.name).is_some());
        if is_given { Ok(columns) } else { Err(table.missing(given)) }
    }

    pub(super) fn place(&self, column: &str) -> Option<Place> {
        self.0.iter().find(|(name, _)| *name == column).map(|(_, place)| *place)
    }
}
