//! A soft finger, Eqs. (23), (29), (43), (21).

use frixel_model::SoftFinger;

use super::{Wide, attraction_of, contact_attraction, pi, voltage_of, wide};

/// Newton's steps from a first guess; two are usual.
const STEPS: usize = 60;
/// Relative size of the last step.
const SMALL: f64 = 1e-22;
/// Relative distance over which a slope is taken: 2^-40.
const SLOPE_STEP: f64 = 1.0 / (1_u64 << 40) as f64;
/// Farther from balance than this, a step is taken in logarithms.
const FAR: f64 = 1e-3;

/// A soft finger on a coating.
pub(in crate::report) struct Soft {
    radius: Wide,
    friction_coefficient: Wide,
    gap: Wide,
    /// `E R^2`.
    force: Wide,
    /// `B^(4 gamma) E/(pi R)`.
    stiffness: Wide,
    /// `4 gamma - 1`.
    exponent: Wide,
}

impl Soft {
    /// Parameters are taken for exact.
    pub(in crate::report) fn new(finger: &SoftFinger<f64>, gap_m: f64) -> Self {
        let (radius, modulus, s) = (wide(finger.radius_m), wide(finger.modulus_pa), wide(finger.stress_exponent));
        let four_gamma = wide(4.0) * &s / (wide(2.0) * &s + wide(1.0));
        Self {
            friction_coefficient: wide(finger.friction_coefficient),
            gap: wide(gap_m),
            force: &modulus * &radius * &radius,
            stiffness: wide(finger.shape_constant).powf(&four_gamma) * modulus / (pi() * &radius),
            exponent: four_gamma - wide(1.0),
            radius,
        }
    }

    /// Eq. (29) for the spring force `F_T/mu`.
    fn stiffness_at(&self, spring_force: &Wide) -> Wide {
        &self.stiffness * (&self.force / spring_force).powf(&self.exponent)
    }

    /// Contact radius squared, Eq. (21).
    fn area_at(&self, spring_force: &Wide, stiffness: &Wide) -> Wide {
        (wide(4.0) * &self.radius * spring_force / (pi() * stiffness)).sqrt()
    }

    /// What presses, by Eq. (43), over what the springs carry: it falls through one as they carry more.
    fn pressing(&self, spring_force: &Wide, attraction: &Wide, load: &Wide) -> Wide {
        let stiffness = self.stiffness_at(spring_force);
        let area = self.area_at(spring_force, &stiffness);
        let around = wide(2.0) * pi() * attraction * &self.radius * &self.gap
            / (wide(1.0) + attraction / (&self.gap * stiffness));
        (load + pi() * attraction * area + around) / spring_force
    }

    /// Electric friction at a voltage above zero, under a load of zero or more, from a first guess above zero; none when
    /// Newton's method does not arrive. The root is unique.
    pub(in crate::report) fn electric_friction_n(
        &self,
        voltage_v_rms: f64,
        normal_load_n: f64,
        guess_n: f64,
    ) -> Option<Wide> {
        let attraction = contact_attraction(&wide(voltage_v_rms), &self.gap);
        let load = wide(normal_load_n);
        let mut spring_force = wide(guess_n) / &self.friction_coefficient + &load;
        for _ in 0..STEPS {
            let pressing = self.pressing(&spring_force, &attraction, &load);
            let further = self.pressing(&(&spring_force * wide(1.0 + SLOPE_STEP)), &attraction, &load);
            // Of the logarithm of what presses over that of what the springs carry; nearly constant, between -1 and 0.
            let slope = ((further - &pressing) / &pressing).to_f64().value() / SLOPE_STEP;
            let ratio = pressing.to_f64().value();
            if (ratio - 1.0).abs() > FAR {
                spring_force *= wide(ratio.powf(-1.0 / slope));
                continue;
            }
            let step = &spring_force * (pressing - wide(1.0)) / wide(slope);
            spring_force -= &step;
            // Against the electric part, which a load may dwarf.
            let electric = &spring_force - &load;
            if (step / &electric).to_f64().value().abs() <= SMALL {
                return Some(&self.friction_coefficient * electric);
            }
        }
        None
    }

    /// Voltage for an electric friction above zero, under a load of zero or more.
    pub(in crate::report) fn voltage_v_rms(&self, electric_friction_n: f64, normal_load_n: f64) -> Wide {
        let balance = wide(electric_friction_n) / &self.friction_coefficient;
        let spring_force = &balance + wide(normal_load_n);
        let stiffness = self.stiffness_at(&spring_force);
        let area = self.area_at(&spring_force, &stiffness);
        voltage_of(&attraction_of(&balance, &area, &stiffness, &self.radius, &self.gap), &self.gap)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may fail")]
mod tests {
    use frixel_model::Finger;

    use super::*;
    use crate::report::exact::{Springs, relative_error};

    fn finger(stress_exponent: f64) -> SoftFinger<f64> {
        SoftFinger { radius_m: 8e-3, modulus_pa: 1e5, stress_exponent, shape_constant: 4.5, friction_coefficient: 0.5 }
    }

    #[test]
    fn forward_and_inverse_undo_each_other_from_any_guess() {
        for (exponent, voltage, load) in [(0.02, 1.0, 0.0), (0.3, 150.0, 0.5), (1.0, 10.0, 0.0), (1.0, 1e4, 5.0)] {
            let soft = Soft::new(&finger(exponent), 1e-5);
            let friction = soft.electric_friction_n(voltage, load, 1e-2).unwrap();
            let back = soft.voltage_v_rms(friction.to_f64().value(), load);
            assert!(relative_error(voltage, &back) < 1e-15, "{exponent}: {voltage} V under {load} N");
        }
    }

    #[test]
    fn a_stress_exponent_of_a_half_is_a_constant_stiffness() {
        let soft = Soft::new(&finger(0.5), 1e-5);
        let stiffness_pa_per_m = 4.5 * 1e5 / (std::f64::consts::PI * 8e-3);
        let springs = Finger { radius_m: 8e-3, stiffness_pa_per_m, friction_coefficient: 0.5 };
        let springs = Springs::new(&springs, 1e-5);
        let right = springs.electric_friction_n(150.0, 0.5);
        let found = soft.electric_friction_n(150.0, 0.5, 0.02).unwrap();
        assert!(relative_error(found.to_f64().value(), &right) < 1e-15);
    }
}
