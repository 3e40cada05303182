//! Fits a finger's profile to measured friction: values in, values out.
//!
//! **In**: rows of voltage (rms), normal force and friction, in strokes of a finger that slides while the drive is
//! switched on and off ([`rows`] reads them from CSV). **Out**: a [`Fit`] with the friction coefficient, the one
//! coupling
//! number that friction data identify, friction at a stated voltage, each with an interval, and the exponent of the
//! voltage, which tests the model; or a [`FitError`] that says in one sentence what was found and what to do.
//!
//! The steps, a module each: rows become strokes of steady sliding (`recording`), strokes become means that compare the
//! drive on with the drive off around it (`contrast`), the law of the contact model (`law`) is fitted to the means by
//! least squares (`least_squares`), intervals come from a bootstrap over strokes (`bootstrap`), and data that cannot be
//! trusted are refused (`rules` before the fit, `verdict` after it). Files and options are in `commands::fit`.
//!
//! # What is estimated
//!
//! - **Friction coefficient**: friction over normal load with the drive off, the mean over the strokes of the
//!   recording.
//! - **Electric friction**: what the stated voltage adds to the friction of this finger on this screen in full slip,
//!   under the median load of the recording, at the mean friction coefficient of the recording. Losses between the
//!   stated voltage and the electrode (charge leakage, amplifier gain) are part of it. Its interval covers what the
//!   model
//!   says and what a power law without any model says.

mod bootstrap;
mod contrast;
mod error;
mod law;
mod least_squares;
mod profile;
mod recording;
mod rules;
mod statistics;
mod summary;
mod table;
mod verdict;

pub use bootstrap::Estimate;
use bootstrap::{Draws, Z_95};
use contrast::{Levels, StrokeMeans, stroke_means};
pub use error::FitError;
use law::{Attraction, Coupling, REFERENCE_V_RMS};
pub use law::{CONVENTIONAL_RADIUS_M, CONVENTIONAL_STIFFNESS_PA_PER_M};
use least_squares::{Form, Measured, Observation, Solution, residuals_n, solve};
pub use profile::profile;
pub use recording::Division;
use recording::Recording;
use statistics::{mean, median, student_quantile};
pub use summary::{Summary, words};
pub use table::{Row, rows};
pub use verdict::{Exponent, Verdict};

/// Number of draws of the bootstrap.
const DRAWS: usize = 499;
/// Least share of the draws that must converge.
const CONVERGED_SHARE: f64 = 0.98;

/// Parts of a recording whose natural friction is compared.
const SIXTHS: usize = 6;

/// What to fit for.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Voltage at which electric friction is stated, in volts rms.
    pub voltage_v_rms: f64,
    /// Normal load at which it is stated, in newtons; `None` for the median load of the recording.
    pub normal_load_n: Option<f64>,
    /// Effective gap of the screen's coating, in metres: the rest of the fitted gap is the skin's.
    pub coating_gap_m: f64,
    /// Names of strokes to leave out.
    pub without: Vec<String>,
    /// Seed of the bootstrap.
    pub seed: u64,
}

/// A fitted finger.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Friction over load with the drive off.
    pub friction_coefficient: Estimate,
    /// The one number about electrode, skin and gap that friction data give, in `sqrt(N)/V^2`:
    /// `eps0/(2 g^2) sqrt(pi R/k)`.
    pub coupling_sqrt_n_per_v2: Estimate,
    /// Voltage at which electric friction is stated, in volts rms.
    pub stated_voltage_v_rms: f64,
    /// Normal load at which it is stated, in newtons.
    pub normal_load_n: f64,
    /// What the stated voltage adds to the friction, in newtons.
    pub electric_friction_n: Estimate,
    /// What the highest voltage of the data adds to the friction, in newtons.
    pub electric_friction_most_n: Estimate,
    /// Exponent of the voltage, and what it says about the model.
    pub voltage_exponent: Exponent,
    /// Exponent of the load, likewise.
    pub load_exponent: Exponent,
    /// Effective gap of coating and skin for a finger of conventional radius and stiffness, in metres.
    pub gap_m: f64,
    /// The part of the gap that is not coating, in metres.
    pub skin_gap_m: f64,
    /// Lowest and highest voltage of the data with the drive on, in volts rms.
    pub voltage_range_v_rms: (f64, f64),
    /// Smallest and largest load of the strokes, in newtons.
    pub load_range_n: (f64, f64),
    /// Number of rows that were used.
    pub rows: usize,
    /// How rows were divided into strokes.
    pub division: Division,
    /// Whether the data have times, so that starts and turns were dropped.
    pub has_time: bool,
    /// Whether the data have speeds.
    pub has_speed: bool,
    /// What was measured in each stroke, and what the fit says.
    pub strokes: Vec<StrokeResult>,
}

/// The means of a stroke beside the fit.
#[derive(Clone, Debug, PartialEq)]
pub struct StrokeResult {
    /// Name of the stroke.
    pub name: String,
    /// Friction over load with the drive off.
    pub natural_coefficient: Option<f64>,
    /// A point for each voltage of the stroke.
    pub points: Vec<Point>,
}

/// What a voltage added to friction in a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Voltage, in volts rms.
    pub voltage_v_rms: f64,
    /// Normal load, in newtons.
    pub normal_load_n: f64,
    /// Electric friction as measured, in newtons.
    pub measured_n: f64,
    /// Measured minus fitted, in newtons.
    pub residual_n: f64,
}

impl Fit {
    /// The fitted electric friction at a voltage under the stated load, in newtons; `None` out of the model's range.
    pub fn electric_friction_at_n(&self, voltage_v_rms: f64) -> Option<f64> {
        let attraction = Attraction::Contact(Coupling(self.coupling_sqrt_n_per_v2.value));
        Some(self.friction_coefficient.value * attraction.attraction_n(voltage_v_rms, self.normal_load_n)?)
    }
}

/// One draw of strokes, fitted.
struct Replicate {
    contact: Solution,
    power: Solution,
    power_of_load: Option<Solution>,
}

/// Fits a finger to the rows of a recording.
pub fn fit(rows: Vec<Row>, settings: &Settings) -> Result<Fit, FitError> {
    rules::check_units(&rows)?;
    let recording = Recording::new(rows, &settings.without)?;
    rules::check_strokes(&recording)?;
    let levels = Levels::of(&recording);
    let voltage_range_v_rms = rules::check_levels(&levels)?;
    let strokes = stroke_means(&recording, &levels);
    let (load_median_n, load_range_n) = rules::check_loads(&recording)?;
    rules::check_natural(&strokes)?;
    rules::check_stated(settings, voltage_range_v_rms, load_range_n)?;
    let normal_load_n = settings.normal_load_n.unwrap_or(load_median_n);

    let observations: Vec<Observation> = strokes.iter().flat_map(|stroke| &stroke.observations).copied().collect();
    let start = start(&strokes, &observations)?;
    let search = Search { voltage_v_rms: settings.voltage_v_rms, normal_load_n, start: &start };
    let best = search.run(&observations, &start).ok_or(FitError::NotConverged)?;
    rules::check_slip(&strokes, &best.contact)?;

    let mut draws = Draws::new(&strokes, settings.seed);
    let replicates: Vec<Replicate> = (0..DRAWS)
        .filter_map(|_| {
            let drawn = draws.draw().into_iter().filter_map(|index| strokes.get(index));
            let drawn: Vec<Observation> = drawn.flat_map(|stroke| &stroke.observations).copied().collect();
            search.run(&drawn, &best.contact)
        })
        .collect();
    if (replicates.len() as f64) < CONVERGED_SHARE * DRAWS as f64 {
        return Err(FitError::NotConverged);
    }
    let judge = verdict::Judge { best: &best, replicates: &replicates, observations: &observations, draws: &draws };
    let voltage_exponent = judge.voltage(normal_load_n, voltage_range_v_rms.1)?;
    let load_exponent = judge.load(normal_load_n)?;

    let estimate = |value: f64, of: &dyn Fn(&Replicate) -> Option<f64>| {
        let mut values: Vec<f64> = replicates.iter().filter_map(of).collect();
        let (low, high) = draws.interval(&mut values, Z_95);
        Estimate { value, low: low.min(value), high: high.max(value) }
    };
    let electric = |voltage_v_rms: f64| {
        let of = |solution: &Solution| {
            let attraction_n = solution.attraction.attraction_n(voltage_v_rms, normal_load_n)?;
            Some(solution.friction_coefficient * attraction_n)
        };
        let value_n = of(&best.contact).ok_or(FitError::NotConverged)?;
        // What the model says less what the data say without it is a systematic error, which no draw of strokes
        // shows: the
        // interval covers what both say.
        let by_model = estimate(value_n, &|replicate| of(&replicate.contact));
        let by_power = estimate(value_n, &|replicate| of(&replicate.power));
        Ok(Estimate { low: by_model.low.min(by_power.low), high: by_model.high.max(by_power.high), ..by_model })
    };
    let coupling = coupling_of(&best.contact).ok_or(FitError::NotConverged)?;
    let gap_m = Coupling(coupling).gap_m();
    let fit = Fit {
        friction_coefficient: wandering(
            &strokes,
            estimate(best.contact.friction_coefficient, &|replicate| Some(replicate.contact.friction_coefficient)),
        ),
        coupling_sqrt_n_per_v2: estimate(coupling, &|replicate| coupling_of(&replicate.contact)),
        stated_voltage_v_rms: settings.voltage_v_rms,
        normal_load_n,
        electric_friction_n: electric(settings.voltage_v_rms)?,
        electric_friction_most_n: electric(voltage_range_v_rms.1)?,
        voltage_exponent,
        load_exponent,
        gap_m,
        skin_gap_m: gap_m - settings.coating_gap_m,
        voltage_range_v_rms,
        load_range_n,
        rows: recording.rows().count(),
        division: recording.division,
        has_time: recording.has_time,
        has_speed: recording.has_speed,
        strokes: results(&strokes, &best.contact).ok_or(FitError::NotConverged)?,
    };
    verdict::check_fit(&fit, settings)?;
    Ok(fit)
}

/// What all searches share.
struct Search<'s> {
    /// Voltage and load at which friction is stated.
    voltage_v_rms: f64,
    normal_load_n: f64,
    start: &'s Solution,
}

impl Search<'_> {
    /// Fits the contact model and the power laws to observations.
    fn run(&self, observations: &[Observation], near: &Solution) -> Option<Replicate> {
        let weighted: Vec<_> = observations.iter().map(|observation| self.weighted(observation)).collect();
        let contact = solve(Form::Contact, &weighted, near).or_else(|| solve(Form::Contact, &weighted, self.start))?;
        let reference_load_n = self.normal_load_n;
        let load_exponent = verdict::load_exponent_of(&contact, reference_load_n)?;
        let power = Solution {
            friction_coefficient: contact.friction_coefficient,
            attraction: Attraction::Power {
                reference_n: contact.attraction.attraction_n(REFERENCE_V_RMS, reference_load_n)?,
                voltage_exponent: 2.0,
                load_exponent,
                reference_load_n,
            },
        };
        let power_of_load = solve(Form::PowerOfLoad { reference_load_n }, observations, &power);
        let power = solve(Form::Power { load_exponent, reference_load_n }, observations, &power)?;
        Some(Replicate { contact, power, power_of_load })
    }

    /// Gives observations more weight the closer they are to the stated voltage. A model that is a little wrong is then
    /// right where friction is stated, at the cost of a tenth more noise.
    fn weighted(&self, observation: &Observation) -> Observation {
        if observation.voltage_v_rms <= 0.0 {
            return *observation;
        }
        let ratio = observation.voltage_v_rms / self.voltage_v_rms;
        let closeness = ratio.min(1.0 / ratio);
        Observation { weight: observation.weight * closeness * closeness, ..*observation }
    }
}

/// The interval of the friction coefficient, widened to what its slow wander leaves open.
///
/// Natural friction wanders for minutes, with a power that rises towards low frequencies, so that strokes beside each
/// other are not independent. Sixths of the recording show how far it wanders: the interval is at least Student's for
/// their means.
fn wandering(strokes: &[StrokeMeans], estimate: Estimate) -> Estimate {
    let coefficients: Vec<f64> = strokes.iter().filter_map(|stroke| stroke.natural_coefficient).collect();
    let parts: Vec<f64> =
        coefficients.chunks(coefficients.len().div_ceil(SIXTHS)).map(|part| mean(part.iter().copied())).collect();
    let count = parts.len() as f64;
    let centre = mean(parts.iter().copied());
    let variance = parts.iter().map(|part| (part - centre) * (part - centre)).sum::<f64>() / (count - 1.0);
    let room = student_quantile(Z_95, count - 1.0) * (variance / count).sqrt();
    Estimate {
        low: estimate.low.min(estimate.value - room),
        high: estimate.high.max(estimate.value + room),
        ..estimate
    }
}

fn coupling_of(solution: &Solution) -> Option<f64> {
    match solution.attraction {
        Attraction::Contact(coupling) => Some(coupling.0),
        Attraction::Power { .. } => None,
    }
}

/// A finger to start the search from: the median friction coefficient, and the coupling that the highest voltages have.
fn start(strokes: &[StrokeMeans], observations: &[Observation]) -> Result<Solution, FitError> {
    let friction_coefficient = median(strokes.iter().filter_map(|stroke| stroke.natural_coefficient));
    let top_v_rms = observations.iter().map(|one| one.voltage_v_rms).fold(0.0, f64::max);
    let top = || observations.iter().filter(|one| one.voltage_v_rms > 0.9 * top_v_rms);
    let attraction_n = median(top().map(|one| attraction_of(one, friction_coefficient)));
    if !(attraction_n > 0.0) {
        return Err(FitError::NoElectricFriction { found_n: friction_coefficient * attraction_n });
    }
    let load_n = median(top().map(|one| one.normal_load_n));
    let coupling = Coupling::of_attraction(attraction_n, top_v_rms, load_n);
    Ok(Solution { friction_coefficient, attraction: Attraction::Contact(coupling) })
}

fn attraction_of(observation: &Observation, friction_coefficient: f64) -> f64 {
    match observation.measured {
        Measured::Attraction(attraction_n) => attraction_n,
        Measured::Friction(friction_n) => friction_n / friction_coefficient - observation.normal_load_n,
    }
}

fn results(strokes: &[StrokeMeans], solution: &Solution) -> Option<Vec<StrokeResult>> {
    let coefficient = solution.friction_coefficient;
    strokes
        .iter()
        .map(|stroke| {
            let residuals = residuals_n(solution, coefficient, &stroke.observations)?;
            let points = stroke.observations.iter().zip(residuals).filter(|(one, _)| one.voltage_v_rms > 0.0);
            let points = points.map(|(one, residual_n)| Point {
                voltage_v_rms: one.voltage_v_rms,
                normal_load_n: one.normal_load_n,
                measured_n: coefficient * attraction_of(one, coefficient),
                residual_n,
            });
            Some(StrokeResult {
                name: stroke.name.clone(),
                natural_coefficient: stroke.natural_coefficient,
                points: points.collect(),
            })
        })
        .collect()
}
