//! Reference solutions of the paper's equations with 80 digits, computed by `model/reference/report.py`. The report
//! compares the model with them.

use frixel_model::{ContactModel, PulledContact, Real};
use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::ReportError;

const PLANE: &str = include_str!("plane.csv");
const PULLED: &str = include_str!("pulled.csv");
const SOFT: &str = include_str!("soft.csv");

/// Cells per decade of the plane.
pub(super) const CELLS_PER_DECADE: i32 = 3;
/// Range of the attraction `q` in the plane, in decades.
pub(super) const Q_DECADES: (i32, i32) = (-12, 12);

/// The centre of a cell of the plane of attraction and load.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct PlaneRow {
    /// Lower end of the cell in `n`, in units of 1/[`CELLS_PER_DECADE`] of a decade; absent without a load.
    pub(super) n_cell: Option<i32>,
    /// Lower end of the cell in `q`, in units of 1/[`CELLS_PER_DECADE`] of a decade.
    pub(super) q_cell: i32,
    voltage_v: f64,
    normal_force_n: f64,
    electric_friction_n: f64,
    electric_friction_n_rest: f64,
    given_electric_friction_n: f64,
    answer_voltage_v: f64,
    answer_voltage_v_rest: f64,
}

/// Cells per decade of the plane of a finger that is pulled off.
pub(super) const PULLED_CELLS_PER_DECADE: i32 = 2;

/// The centre of a cell of the plane of attraction and distance from pull-off. Its numbers are exact in f64.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct PulledRow {
    /// Lower end of the cell in the part of the pull-off load that is missing, in units of
    /// 1/[`PULLED_CELLS_PER_DECADE`] of a decade.
    pub(super) part_cell: i32,
    /// Lower end of the cell in `q`, in the same units.
    pub(super) q_cell: i32,
    pub(super) voltage_v: f64,
    pub(super) normal_force_n: f64,
    friction_n: f64,
    friction_n_rest: f64,
    given_friction_n: f64,
    answer_voltage_v: f64,
    answer_voltage_v_rest: f64,
}

impl PulledRow {
    /// Relative errors of friction in total from voltage, and of voltage from friction in total.
    pub(super) fn errors(&self, model: &PulledContact<f64>) -> Result<(f64, f64), ReportError> {
        let friction_n = model.state(self.voltage_v)?.friction_n;
        let voltage_v_rms = model.voltage_for_friction(self.given_friction_n)?;
        let forward = Answer(self.friction_n, self.friction_n_rest).relative_error(friction_n);
        Ok((forward, Answer(self.answer_voltage_v, self.answer_voltage_v_rest).relative_error(voltage_v_rms)))
    }
}

/// A soft finger at one voltage.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct SoftRow {
    pub(super) stress_exponent: f64,
    voltage_v: f64,
    normal_force_n: f64,
    electric_friction_n: f64,
    electric_friction_n_rest: f64,
    given_electric_friction_n: f64,
    answer_voltage_v: f64,
    answer_voltage_v_rest: f64,
}

/// Inputs that are exact in f32, with their reference solutions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Answers {
    pub(super) voltage_v_rms: f64,
    pub(super) normal_load_n: f64,
    electric_friction_n: Answer,
    given_electric_friction_n: f64,
    given_voltage_v_rms: Answer,
}

/// A reference solution as the nearest f64 and the remainder.
#[derive(Clone, Copy, Debug)]
struct Answer(f64, f64);

impl Answer {
    /// Relative error of `found` against the reference; infinite if `found` is not finite.
    fn relative_error(self, found: f64) -> f64 {
        let Self(nearest, rest) = self;
        // `found - nearest` is exact when both are close.
        if found.is_finite() { (((found - nearest) - rest) / nearest).abs() } else { f64::INFINITY }
    }
}

impl Answers {
    /// Relative errors of electric friction from voltage, and of voltage from electric friction.
    pub(super) fn errors<T: Real>(&self, model: &impl ContactModel<T>) -> Result<(f64, f64), ReportError> {
        let friction_n = model.state(T::from_f64(self.voltage_v_rms))?.electric_friction_n;
        let voltage_v_rms = model.voltage_for_electric_friction(T::from_f64(self.given_electric_friction_n))?;
        let forward = self.electric_friction_n.relative_error(friction_n.into());
        Ok((forward, self.given_voltage_v_rms.relative_error(voltage_v_rms.into())))
    }
}

macro_rules! answers {
    ($row:ty) => {
        impl $row {
            /// The inputs and the reference solutions of this row.
            pub(super) fn answers(&self) -> Answers {
                Answers {
                    voltage_v_rms: self.voltage_v,
                    normal_load_n: self.normal_force_n,
                    electric_friction_n: Answer(self.electric_friction_n, self.electric_friction_n_rest),
                    given_electric_friction_n: self.given_electric_friction_n,
                    given_voltage_v_rms: Answer(self.answer_voltage_v, self.answer_voltage_v_rest),
                }
            }
        }
    };
}

answers!(PlaneRow);
answers!(SoftRow);

/// All cells of the plane in order of increasing load, followed by those without a load.
pub(super) fn plane() -> Result<Vec<PlaneRow>, csv::Error> {
    rows(PLANE)
}

/// All cells of a finger that is pulled off, in order of increasing distance from pull-off.
pub(super) fn pulled() -> Result<Vec<PulledRow>, csv::Error> {
    rows(PULLED)
}

/// The rows of the soft finger, without a load and then with one, in order of exponent and then of voltage.
pub(super) fn soft() -> Result<Vec<SoftRow>, csv::Error> {
    rows(SOFT)
}

fn rows<R: DeserializeOwned>(text: &str) -> Result<Vec<R>, csv::Error> {
    csv::Reader::from_reader(text.as_bytes()).deserialize().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_resolved_below_the_last_bit() {
        let answer = Answer(1.0, 1e-17);
        assert!((answer.relative_error(1.0) - 1e-17).abs() < 1e-30);
        assert!((answer.relative_error(1.0 + f64::EPSILON) - (f64::EPSILON - 1e-17)).abs() < 1e-30);
        assert!(answer.relative_error(f64::NAN).is_infinite());
    }
}
