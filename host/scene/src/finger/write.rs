//! Writes a finger profile as TOML.

use std::fmt::Write;

use super::{Elasticity, Evidence, Experiment, FingerProfile};
use crate::tables::finger as table;

/// The file of a profile, one field per line.
pub(super) fn text(profile: &FingerProfile) -> String {
    let mut lines = Lines::default();
    let FingerProfile { friction_coefficient, normal_load_n, radius_mm, elasticity, skin_gap_um, evidence } = profile;
    lines.number(table::FRICTION_COEFFICIENT.name, *friction_coefficient);
    lines.number(table::NORMAL_LOAD_N.name, *normal_load_n);
    if let Elasticity::Empirical(law) = elasticity {
        lines.number(table::EXPONENT.name, law.exponent);
        lines.pairs(table::POINTS.name, &law.points);
        lines.pairs(table::INTERVALS_N.name, &law.intervals_n);
    } else {
        lines.number(table::RADIUS_MM.name, *radius_mm);
    }
    match *elasticity {
        Elasticity::Empirical(_) => {}
        Elasticity::WinklerFuss { stiffness_pa_per_m } => {
            lines.number(table::STIFFNESS_PA_PER_M.name, stiffness_pa_per_m);
        }
        Elasticity::Soft { modulus_pa, stress_exponent, shape_constant } => {
            lines.text(table::MODEL.name, "soft");
            lines.number(table::MODULUS_PA.name, modulus_pa);
            lines.number(table::STRESS_EXPONENT.name, stress_exponent);
            lines.number(table::SHAPE_CONSTANT.name, shape_constant);
        }
    }
    if !matches!(elasticity, Elasticity::Empirical(_)) {
        lines.number(table::SKIN_GAP_UM.name, *skin_gap_um);
    }
    lines.text(table::ORIGIN.name, evidence.origin().word());
    if let Some(Experiment { date, method, screen }) = evidence.experiment() {
        lines.text(table::DATE.name, date);
        lines.text(table::METHOD.name, method);
        lines.text(table::SCREEN.name, screen);
    }
    match *evidence {
        Evidence::Assumed | Evidence::Empirical { .. } => {}
        Evidence::Perceptual { threshold_v_rms, threshold_interval_v_rms, .. } => {
            lines.number(table::THRESHOLD_V_RMS.name, threshold_v_rms);
            lines.interval(table::THRESHOLD_INTERVAL_V_RMS.name, threshold_interval_v_rms);
        }
        Evidence::Measured {
            friction_coefficient_interval,
            electric_friction_interval_n,
            voltage_max_v_rms,
            normal_load_range_n,
            ..
        } => {
            lines.interval(table::FRICTION_COEFFICIENT_INTERVAL.name, friction_coefficient_interval);
            lines.interval(table::ELECTRIC_FRICTION_INTERVAL_N.name, electric_friction_interval_n);
            lines.number(table::MEASURED_VOLTAGE_MAX_V_RMS.name, voltage_max_v_rms);
            lines.interval(table::MEASURED_NORMAL_LOAD_RANGE_N.name, normal_load_range_n);
        }
    }
    lines.0
}

/// Lines of TOML. Writing to a string cannot fail.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn number(&mut self, field: &str, number: f64) {
        let _ = writeln!(self.0, "{field} = {}", written(number));
    }

    fn interval(&mut self, field: &str, [low, high]: [f64; 2]) {
        let _ = writeln!(self.0, "{field} = [{}, {}]", written(low), written(high));
    }

    fn pairs(&mut self, field: &str, pairs: &[(f64, f64)]) {
        let pairs: Vec<String> = pairs.iter().map(|&(a, b)| format!("[{}, {}]", written(a), written(b))).collect();
        let _ = writeln!(self.0, "{field} = [{}]", pairs.join(", "));
    }

    fn text(&mut self, field: &str, text: &str) {
        let _ = writeln!(self.0, "{field} = {}", toml_edit::Value::from(text));
    }
}

/// The shortest number that reads back to the same bits.
fn written(number: f64) -> String {
    let is_large = number.abs() >= 1e6 || (number.abs() > 0.0 && number.abs() < 1e-4);
    if is_large { format!("{number:e}") } else { number.to_string() }
}
