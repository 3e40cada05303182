//! Writes a finger profile as TOML.

use std::fmt::{Display, Write};

use super::{Elasticity, Evidence, Experiment, FingerProfile};
use crate::grammar::FieldSpec;
use crate::tables::finger as table;

/// The file of a profile, one field per line.
pub(super) fn text(profile: &FingerProfile) -> String {
    let mut lines = Lines::default();
    let FingerProfile { friction_coefficient, normal_load_n, radius_mm, elasticity, skin_gap_um, evidence } = profile;
    lines.number(&table::FRICTION_COEFFICIENT, *friction_coefficient);
    lines.number(&table::NORMAL_LOAD_N, *normal_load_n);
    if let Elasticity::Empirical(law) = elasticity {
        lines.number(&table::EXPONENT, law.exponent);
        lines.pairs(&table::POINTS, &law.points);
        lines.pairs(&table::INTERVALS_N, &law.intervals_n);
    } else {
        lines.number(&table::RADIUS_MM, *radius_mm);
    }
    match *elasticity {
        Elasticity::Empirical(_) => {}
        Elasticity::WinklerFuss { stiffness_pa_per_m } => {
            lines.number(&table::STIFFNESS_PA_PER_M, stiffness_pa_per_m);
        }
        Elasticity::Soft { modulus_pa, stress_exponent, shape_constant } => {
            lines.text(&table::MODEL, "soft");
            lines.number(&table::MODULUS_PA, modulus_pa);
            lines.number(&table::STRESS_EXPONENT, stress_exponent);
            lines.number(&table::SHAPE_CONSTANT, shape_constant);
        }
    }
    if !matches!(elasticity, Elasticity::Empirical(_)) {
        lines.number(&table::SKIN_GAP_UM, *skin_gap_um);
    }
    lines.text(&table::ORIGIN, evidence.origin().word());
    if let Some(Experiment { date, method, screen }) = evidence.experiment() {
        lines.text(&table::DATE, date);
        lines.text(&table::METHOD, method);
        lines.text(&table::SCREEN, screen);
    }
    match *evidence {
        Evidence::Assumed | Evidence::Empirical { .. } => {}
        Evidence::Perceptual { threshold_v_rms, threshold_interval_v_rms, .. } => {
            lines.number(&table::THRESHOLD_V_RMS, threshold_v_rms);
            lines.interval(&table::THRESHOLD_INTERVAL_V_RMS, threshold_interval_v_rms);
        }
        Evidence::Measured {
            friction_coefficient_interval,
            electric_friction_interval_n,
            voltage_max_v_rms,
            normal_load_range_n,
            ..
        } => {
            lines.interval(&table::FRICTION_COEFFICIENT_INTERVAL, friction_coefficient_interval);
            lines.interval(&table::ELECTRIC_FRICTION_INTERVAL_N, electric_friction_interval_n);
            lines.number(&table::MEASURED_VOLTAGE_MAX_V_RMS, voltage_max_v_rms);
            lines.interval(&table::MEASURED_NORMAL_LOAD_RANGE_N, normal_load_range_n);
        }
    }
    lines.0
}

/// Lines of TOML. Writing to a string cannot fail.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn add(&mut self, field: &FieldSpec, value: impl Display) {
        let _ = writeln!(self.0, "{} = {value}", field.name);
    }

    fn number(&mut self, field: &FieldSpec, number: f64) {
        self.add(field, written(number));
    }

    fn interval(&mut self, field: &FieldSpec, [low, high]: [f64; 2]) {
        self.add(field, pair((low, high)));
    }

    fn pairs(&mut self, field: &FieldSpec, pairs: &[(f64, f64)]) {
        let pairs: Vec<String> = pairs.iter().copied().map(pair).collect();
        self.add(field, format_args!("[{}]", pairs.join(", ")));
    }

    fn text(&mut self, field: &FieldSpec, text: &str) {
        self.add(field, toml_edit::Value::from(text));
    }
}

fn pair((one, other): (f64, f64)) -> String {
    format!("[{}, {}]", written(one), written(other))
}

/// The shortest number that reads back to the same bits.
fn written(number: f64) -> String {
    let is_large = number.abs() >= 1e6 || (number.abs() > 0.0 && number.abs() < 1e-4);
    if is_large { format!("{number:e}") } else { number.to_string() }
}
