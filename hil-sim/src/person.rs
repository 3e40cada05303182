//! People: fingers drawn from a population.

use frixel_model::{Contact, Finger, LoadedContact, ParameterError};

use crate::fingertip::FingertipConfig;
use crate::random::{Purpose, Random};
use crate::world::OwnFinger;

/// Largest distance of a person from the middle of the population, in standard deviations.
const DRAW_LIMIT: f64 = 2.5;

/// A person, with individual finger parameters.
///
/// Assumed throughout: the directions are published, the magnitudes are not measured. One number, the moisture, changes
/// friction coefficient, gap and leakage together. Moist skin slides less easily than dry skin, needs more voltage for
/// the same effect, and has a smaller impedance (arXiv 2409.16936). The remaining differences are random.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Person {
    /// Moisture of the skin, in standard deviations from the middle of the population.
    pub moisture: f64,
    /// Radius, stiffness and friction coefficient of the finger.
    pub finger: Finger<f64>,
    /// Effective gap of skin and air, in addition to the coating's, m.
    pub skin_gap_m: f64,
    /// Normal load of the person's finger, N.
    pub normal_load_n: f64,
    /// Effects of the finger beyond the contact model.
    pub fingertip: FingertipConfig,
}

impl Person {
    /// Draws the person of a seed.
    ///
    /// The middle is the example finger: a friction coefficient of 0.5, a skin gap of 4.74 um, 8 mm, 18 MPa/m, 0.5 N.
    ///
    /// ```
    /// use frixel_hil_sim::Person;
    ///
    /// let person = Person::drawn(7);
    /// assert_eq!(person, Person::drawn(7));
    /// let contact = person.contact(0.26e-6).expect("every person has a contact");
    /// assert!(contact.electric_friction_n(150.0) > 0.02);
    /// ```
    #[must_use]
    pub fn drawn(seed: u64) -> Self {
        let mut random = Random::new(seed, Purpose::Person);
        let mut draw = || random.gaussian_within(DRAW_LIMIT);
        let moisture = draw();
        let mut around =
            |middle: f64, by_moisture: f64, spread: f64| middle * libm::exp(by_moisture * moisture + spread * draw());
        let finger = Finger {
            friction_coefficient: around(0.5, 0.4, 0.15),
            radius_m: around(8e-3, 0.0, 0.1),
            stiffness_pa_per_m: around(18e6, 0.0, 0.2),
        };
        let skin_gap_m = around(4.74e-6, 0.2, 0.15);
        let normal_load_n = around(0.5, 0.0, 0.2);
        let leakage_hz = around(250.0, 0.5, 0.2);
        let usual = FingertipConfig::REALISTIC;
        let fingertip = FingertipConfig {
            // Both were measured at 0.53 N, and are proportional to the load and to the friction.
            load_sd_n: usual.load_sd_n * normal_load_n / 0.53,
            noise_rms_n: usual.noise_rms_n * finger.friction_coefficient * normal_load_n / (0.5 * 0.53),
            load_exponent: 0.15 * draw(),
            leakage_hz,
            ..usual
        };
        Self { moisture, finger, skin_gap_m, normal_load_n, fingertip }
    }

    /// The contact of this finger with a screen whose coating has an effective gap (thickness over permittivity), in m.
    pub fn contact(&self, coating_gap_m: f64) -> Result<LoadedContact<f64>, ParameterError> {
        Contact::new(&self.finger, self.skin_gap_m + coating_gap_m)?.under_load(self.normal_load_n)
    }

    /// The person's finger on such a screen, for [`WorldOptions`](crate::WorldOptions).
    pub fn own_finger(&self, coating_gap_m: f64) -> Result<OwnFinger, ParameterError> {
        Ok(OwnFinger { law: self.contact(coating_gap_m)?.into(), fingertip: self.fingertip })
    }
}

#[cfg(test)]
mod tests {
    use super::Person;

    /// Correlation of two properties of 500 people.
    fn correlation(first: fn(&Person) -> f64, second: fn(&Person) -> f64) -> f64 {
        let pairs: Vec<(f64, f64)> =
            (0..500).map(Person::drawn).map(|person| (first(&person), second(&person))).collect();
        let count = pairs.len() as f64;
        let (a, b) = pairs.iter().fold((0.0, 0.0), |(a, b), pair| (a + pair.0 / count, b + pair.1 / count));
        let moment = |f: fn((f64, f64)) -> f64| pairs.iter().map(|pair| f((pair.0 - a, pair.1 - b))).sum::<f64>();
        moment(|(x, y)| x * y) / (moment(|(x, _)| x * x) * moment(|(_, y)| y * y)).sqrt()
    }

    #[test]
    fn moisture_moves_coefficient_gap_and_leakage_together() {
        for property in [
            |person: &Person| person.finger.friction_coefficient,
            |person: &Person| person.skin_gap_m,
            |person: &Person| person.fingertip.leakage_hz,
        ] {
            let found = correlation(|person| person.moisture, property);
            assert!(found > 0.7, "{found}");
        }
        assert!(correlation(|person| person.moisture, |person| person.normal_load_n).abs() < 0.15);
    }

    #[test]
    fn the_exponent_of_the_load_has_either_sign_and_everybody_has_a_contact() {
        let people: Vec<Person> = (0..500).map(Person::drawn).collect();
        let negative = people.iter().filter(|person| person.fingertip.load_exponent < 0.0).count();
        assert!((200..=300).contains(&negative), "{negative}");
        for person in people {
            let contact = person.contact(0.26e-6).unwrap();
            let share = contact.electric_friction_n(150.0) / contact.natural_friction_n();
            assert!((0.05..3.0).contains(&share), "{person:?}: {share}");
        }
    }
}
