//! A finger on Winkler-Fuss springs, Eqs. (43), (21).

use frixel_model::Finger;

use super::{Wide, attraction_of, contact_attraction, pi, voltage_of, wide};

/// A Winkler-Fuss finger on a coating.
pub(in crate::report) struct Springs {
    radius: Wide,
    stiffness: Wide,
    friction_coefficient: Wide,
    gap: Wide,
}

impl Springs {
    /// Parameters are taken for exact.
    pub(in crate::report) fn new(finger: &Finger<f64>, gap_m: f64) -> Self {
        Self {
            radius: wide(finger.radius_m),
            stiffness: wide(finger.stiffness_pa_per_m),
            friction_coefficient: wide(finger.friction_coefficient),
            gap: wide(gap_m),
        }
    }

    /// Electric friction at a voltage above zero, under a load of zero or more.
    pub(in crate::report) fn electric_friction_n(&self, voltage_v_rms: f64, normal_load_n: f64) -> Wide {
        let attraction = contact_attraction(&wide(voltage_v_rms), &self.gap);
        let load = wide(normal_load_n);
        // pi k/(4 R) a^4 - pi sigma0 a^2 - around - F_N = 0.
        let around = wide(2.0) * pi() * &attraction * &self.radius * &self.gap
            / (wide(1.0) + &attraction / (&self.gap * &self.stiffness));
        let square = pi() * &self.stiffness / (wide(4.0) * &self.radius);
        let linear = pi() * &attraction;
        let root = (&linear * &linear + wide(4.0) * &square * (around + &load)).sqrt();
        let area = (linear + root) / (wide(2.0) * &square);
        &self.friction_coefficient * (square * &area * &area - load)
    }

    /// Voltage for an electric friction above zero, under a load of zero or more.
    pub(in crate::report) fn voltage_v_rms(&self, electric_friction_n: f64, normal_load_n: f64) -> Wide {
        let balance = wide(electric_friction_n) / &self.friction_coefficient;
        let spring_force = &balance + wide(normal_load_n);
        let area = (wide(4.0) * &self.radius * spring_force / (pi() * &self.stiffness)).sqrt();
        voltage_of(&attraction_of(&balance, &area, &self.stiffness, &self.radius, &self.gap), &self.gap)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::exact::relative_error;

    #[test]
    fn forward_and_inverse_undo_each_other_and_know_the_limits() {
        let finger = Finger { radius_m: 8e-3, stiffness_pa_per_m: 1.8e7, friction_coefficient: 0.5 };
        let springs = Springs::new(&finger, 1e-5);
        for (voltage, load) in [(1e-3, 0.0), (1.0, 0.5), (150.0, 0.0), (1e6, 1e3)] {
            let friction = springs.electric_friction_n(voltage, load);
            // The friction is rounded to f64 on the way.
            let back = springs.voltage_v_rms(friction.to_f64().value(), load);
            assert!(relative_error(voltage, &back) < 1e-16, "{voltage} V under {load} N");
        }
        // 2 pi mu R g sigma0, and Eq. (42).
        let sigma0 = |voltage: f64| 0.5 * 8.854_187_818_8e-12 * (voltage / 1e-5).powi(2);
        let small = 2.0 * std::f64::consts::PI * 0.5 * 8e-3 * 1e-5 * sigma0(1e-6);
        assert!(relative_error(small, &springs.electric_friction_n(1e-6, 0.0)) < 1e-6);
        let large = 0.5 * 4.0 * std::f64::consts::PI * 8e-3 / 1.8e7 * sigma0(1e9).powi(2);
        assert!(relative_error(large, &springs.electric_friction_n(1e9, 0.0)) < 1e-6);
    }
}
