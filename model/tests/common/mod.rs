//! Reading the fixtures of `reference/generate.py`.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests fail as tests do")]
#![allow(dead_code, reason = "each test program uses its own part")]

use std::collections::HashMap;

use frixel_model::{Contact, ContactModel, Finger, ParameterError, Real, Slab, SoftFinger, effective_gap_m};

/// A row of a fixture, by column.
#[derive(Debug)]
pub(crate) struct Row(HashMap<String, String>);

impl Row {
    pub(crate) fn text(&self, column: &str) -> &str {
        self.0.get(column).map_or("", String::as_str)
    }

    /// A number, if the cell is filled in. Inputs are exact in f32; answers have 25 digits.
    pub(crate) fn number(&self, column: &str) -> Option<f64> {
        let text = self.text(column);
        (!text.is_empty()).then(|| text.parse().unwrap())
    }

    pub(crate) fn input<T: Real>(&self, column: &str) -> T {
        T::from_f64(self.number(column).unwrap_or(0.0))
    }

    /// Factor on the error bound of an ill-conditioned result.
    pub(crate) fn widening(&self) -> f64 {
        (self.number("condition").unwrap_or(1.0) / 12.0).max(1.0)
    }

    pub(crate) fn in_f32(&self) -> bool {
        self.text("f32") == "1"
    }

    fn gap_m<T: Real>(&self) -> Result<T, ParameterError> {
        effective_gap_m(&[Slab {
            thickness_m: self.input::<T>("coating_m"),
            relative_permittivity: self.input("permittivity"),
        }])
    }

    /// The model of the row's variant, finger, coating and load.
    pub(crate) fn model<T: Real + 'static>(&self) -> Result<Box<dyn ContactModel<T>>, ParameterError> {
        let load: T = self.input("normal_force_n");
        let gap_m = self.gap_m()?;
        if let Some(soft) = self.text("variant").strip_prefix("soft-") {
            let contact = SoftFinger {
                radius_m: self.input("radius_m"),
                modulus_pa: self.input("modulus_pa"),
                stress_exponent: self.input("stress_exponent"),
                shape_constant: self.input("shape_constant"),
                friction_coefficient: self.input("friction_coefficient"),
            }
            .on_gap(gap_m)?;
            return Ok(if soft == "lower" {
                Box::new(contact.lower_bound())
            } else {
                Box::new(contact.under_load(load)?)
            });
        }
        let finger = Finger {
            radius_m: self.input("radius_m"),
            stiffness_pa_per_m: self.input("stiffness_pa_per_m"),
            friction_coefficient: self.input("friction_coefficient"),
        };
        let contact = Contact::new(&finger, gap_m)?;
        Ok(match self.text("variant") {
            "wf-upper" | "wf-loaded" if load < T::ZERO => Box::new(contact.under_pull(-load)?),
            "wf-upper" | "wf-loaded" => Box::new(contact.under_load(load)?),
            "wf-lower" => Box::new(contact.lower_bound(load)?),
            "wf-finite" => Box::new(contact.within(self.input("outer_radius_m"), load)?),
            other => panic!("no variant {other}"),
        })
    }
}

pub(crate) fn rows(text: &str) -> Vec<Row> {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row = |line: &str| {
        let cells = line.split(',').map(str::to_owned);
        Row(header.iter().map(|&column| column.to_owned()).zip(cells).collect())
    };
    lines.map(row).collect()
}

/// Relative error of a result; infinite for NaN, and for any result but zero where zero is correct.
pub(crate) fn relative_error(found: f64, right: f64) -> f64 {
    let error = if right == 0.0 { if found == 0.0 { 0.0 } else { f64::INFINITY } } else { (found / right - 1.0).abs() };
    if error.is_nan() { f64::INFINITY } else { error }
}
