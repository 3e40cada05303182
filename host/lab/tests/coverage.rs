//! How often the stated intervals contain what they are about.
//!
//! The quantity is what a drive of 150 V rms adds to the friction of a finger on its screen, in steady and full slip
//! under
//! the median load of the recording, without noise: the simulator measures it on each person, apart from the recording.

use frixel_hil_sim::Person;
use frixel_lab::fit::{Estimate, Fit, FitError, fit};

use super::person::{self, Law, Protocol};
use super::{settings, simulated};

/// People in the test of every change, and in the soak.
const FEW: u64 = 24;
const MANY: u64 = 200;

/// What became of the fits of many people.
#[derive(Debug, Default)]
struct Tally {
    fitted: usize,
    reasons: Vec<String>,
    /// Number of intervals that contain the truth.
    electric: usize,
    coefficient: usize,
    exponent: usize,
    /// Errors of electric friction, relative to the truth.
    errors: Vec<f64>,
    /// Measured exponents of the voltage less those of the model.
    exponents: Vec<f64>,
    /// Half-widths of its intervals, relative to the truth.
    widths: Vec<f64>,
}

fn contains(estimate: &Estimate, truth: f64) -> bool {
    (estimate.low..=estimate.high).contains(&truth)
}

impl Tally {
    fn add(&mut self, result: Result<Fit, FitError>, truth: impl Fn(f64) -> (f64, f64)) {
        match result {
            Ok(fit) => {
                let (coefficient, electric_n) = truth(fit.normal_load_n);
                self.fitted += 1;
                self.electric += usize::from(contains(&fit.electric_friction_n, electric_n));
                self.coefficient += usize::from(contains(&fit.friction_coefficient, coefficient));
                self.exponent += usize::from(contains(&fit.voltage_exponent.measured, fit.voltage_exponent.model));
                self.exponents.push(fit.voltage_exponent.measured.value - fit.voltage_exponent.model);
                let Estimate { value, low, high } = fit.electric_friction_n;
                self.errors.push(value / electric_n - 1.0);
                self.widths.push((high - low) / (2.0 * electric_n));
            }
            Err(error) => self.reasons.push(error.to_string()),
        }
    }

    fn share(&self, count: usize) -> f64 {
        count as f64 / self.fitted as f64
    }

    fn print(&self, who: &str) {
        let mean = |values: &[f64]| 100.0 * values.iter().sum::<f64>() / values.len() as f64;
        println!(
            "{who}: {} fitted, {} refused; of the 95 % intervals contain the truth: electric friction {:.3}, friction \
             coefficient {:.3}; {:.3} of the exponents' contain the model's; the exponent is off by {:+.3}, electric \
             friction by {:+.2} % on average; half-width {:.2} %",
            self.fitted,
            self.reasons.len(),
            self.share(self.electric),
            self.share(self.coefficient),
            self.share(self.exponent),
            1e-2 * mean(&self.exponents),
            mean(&self.errors),
            mean(&self.widths),
        );
        for reason in &self.reasons {
            println!("  {reason}");
        }
    }
}

/// The people of the simulator's population with these seeds.
fn people(seeds: std::ops::Range<u64>) -> Tally {
    let mut tally = Tally::default();
    for seed in seeds {
        let person = Person::drawn(seed);
        let rows = simulated::record(&person, &Protocol::default(), seed);
        tally.add(fit(rows, &settings()), |load_n| simulated::truth(&person, load_n));
    }
    tally
}

#[test]
#[ignore = "many minutes: cargo xtask soak people"]
fn intervals_cover_over_200_people() {
    let tally = people(0..MANY);
    tally.print("200 people");
    assert!((0.90..=0.98).contains(&tally.share(tally.electric)), "{}", tally.share(tally.electric));
    // Wider than 95 %: it allows for a wander over minutes that this simulator does not have.
    assert!(tally.share(tally.coefficient) >= 0.90, "{}", tally.share(tally.coefficient));
    assert!(tally.reasons.len() as u64 <= MANY / 5, "{:#?}", tally.reasons);
}

#[test]
fn intervals_cover_and_are_not_too_wide() {
    let tally = people(0..FEW);
    tally.print("a few people");
    assert!(tally.reasons.len() as u64 <= FEW / 5, "{:#?}", tally.reasons);
    // Of the people who are fitted, all but four: of 24 intervals of 95 %, five or more miss the truth once in 170
    // sets.
    for (what, count) in [("electric friction", tally.electric), ("friction coefficient", tally.coefficient)] {
        assert!(tally.fitted - count <= 4, "{what}: {count} of {}: {tally:#?}", tally.fitted);
    }
    // An interval that is always right because it is wide says nothing: half-widths are about twice the errors' rms.
    let rms = (tally.errors.iter().map(|error| error * error).sum::<f64>() / tally.fitted as f64).sqrt();
    let width = tally.widths.iter().sum::<f64>() / tally.fitted as f64;
    assert!((1.3..3.5).contains(&(width / rms)), "{width} over {rms}");
}

/// Plants whose electric friction is a square of the voltage, with two exponents of the load.
const LAWS: [Law; 2] = [Law::Power { voltage: 2.0, load: 0.5 }, Law::Power { voltage: 2.0, load: 1.0 }];

/// How many plants that break the law are refused, or have an interval that contains the truth.
fn caught(law: Law, count: u64) -> usize {
    let mut tally = Tally::default();
    for seed in 0..count {
        let person = person::Person { law, ..person::Person::drawn(seed) };
        tally.add(fit(person.record(&Protocol::default()), &settings()), |load_n| person.truth(load_n));
    }
    tally.print(&format!("{law:?}"));
    tally.reasons.len() + tally.electric
}

/// 19 of these 20 are caught. If 95 % of all are, fewer than 18 of 20 are in one set of seeds in 13; rules that catch
/// 70 % pass once in 28.
#[test]
fn plants_that_break_the_law_are_refused_or_covered() {
    let caught: usize = LAWS.into_iter().map(|law| caught(law, 10)).sum();
    assert!(caught >= 18, "{caught} of 20");
}

/// 99 and 100 of 100 are caught. Rules that catch nine of ten plants reach 96 of 100 once in 42 sets of seeds; rules
/// that catch 99 % miss it once in 290.
#[test]
#[ignore = "minutes: cargo xtask soak people"]
fn nine_of_ten_plants_that_break_the_law_are_refused_or_covered() {
    for law in LAWS {
        let caught = caught(law, 100);
        assert!(caught >= 96, "{law:?}: {caught} of 100");
    }
}

/// Recordings of few strokes, and of few strokes at the highest voltage.
#[test]
#[ignore = "minutes: cargo xtask soak people"]
fn intervals_of_few_strokes_cover() {
    let few = |strokes: usize| Protocol { strokes, ..Protocol::default() };
    let mut uneven = vec![75.0; 32];
    uneven.extend([150.0; 4]);
    let uneven = Protocol { voltages_v_rms: uneven, ..Protocol::default() };
    for (what, protocol) in [("9", few(9)), ("12", few(12)), ("4 of 36 at 150 V", uneven)] {
        let mut tally = Tally::default();
        for seed in 0..MANY {
            let person = person::Person { drift: 0.0, ..person::Person::drawn(seed) };
            tally.add(fit(person.record(&protocol), &settings()), |load_n| person.truth(load_n));
        }
        tally.print(&format!("{what} strokes"));
        assert!(tally.share(tally.electric) >= 0.89, "{what}: {}", tally.share(tally.electric));
    }
}
