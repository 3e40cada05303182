//! Fits a finger's profile to measured friction: values in, values out.
//!
//! **In**: rows of voltage (rms), normal force and friction, in strokes of a finger that slides while the drive is
//! switched on and off ([`rows`] reads them from CSV). **Out**: a [`Fit`] with the friction coefficient, the one
//! coupling number that friction data identify, friction at a stated voltage, each with an interval, and the exponent
//! of the voltage, which tests the model; or a [`FitError`] that says in one sentence what was found and what to do.
//!
//! The steps, a module each: rows become strokes of steady sliding (`recording`), strokes become means that compare the
//! drive on with the drive off around it (`contrast`), the law of the contact model (`law`) is fitted to the means by
//! least squares (`search`, `least_squares`), its error is measured in held-out strokes (`held_out`), intervals come
//! from a bootstrap over strokes (`intervals`), and data that cannot be trusted are refused (`rules` before the fit,
//! `verdict` after it). A finger that contradicts the model has a law of its own instead (`empirical`): a power of the
//! voltage, or else points (`measured_points`).
//!
//! # Estimates
//!
//! - **Friction coefficient**: friction over normal load with the drive off, the mean over the strokes of the
//!   recording.
//! - **Electric friction**: what the stated voltage adds to the friction of this finger on this screen in full slip,
//!   under the median load of the recording, at the mean friction coefficient of the recording. Losses between the
//!   stated voltage and the electrode (charge leakage, amplifier gain) are part of it. Its interval covers both the
//!   estimate of the model and that of a power law without a model.

mod contrast;
mod copies;
mod data_summary;
mod defects;
mod empirical;
mod error;
mod held_out;
mod intervals;
mod law;
mod least_squares;
mod means;
mod measured_points;
mod preparation;
mod profile;
mod recording;
mod rules;
mod search;
mod sensor;
mod summary;
mod table;
pub(crate) mod turns;
mod verdict;
mod zero;

use frixel_hil_sim::Board;
use frixel_model::{Carrier, Ripple, Waveform};
use frixel_play::{GoesOn, TO_THE_END};

pub use crate::bootstrap::Estimate;
use contrast::{Edges, Levels, Phases, StrokeMeans};
pub use data_summary::DataSummary;
use defects::Defects;
pub use defects::{DefectiveStroke, StrokeDefect};
pub use empirical::{EmpiricalFit, HeldOutError, VoltageLaw, fit_empirical};
pub use error::FitError;
pub use held_out::HeldOut;
use intervals::{Fitted, wandering};
use law::{Attraction, CONVENTIONAL_RADIUS_M, CONVENTIONAL_STIFFNESS_PA_PER_M, Coupling};
use least_squares::{Observation, Solution, residuals_n};
pub use means::MeanRow;
pub use measured_points::MeasuredPoint;
pub use preparation::Preparation;
pub use profile::profile;
pub use recording::Division;
use recording::Recording;
pub(crate) use recording::STROKE_MIN_S;
pub(crate) use rules::FORCE_MAX_N;
use search::{Replicate, Search, attraction_of, coupling_of, start};
pub(crate) use sensor::ROWS_HZ_MIN;
pub use summary::words;
pub(crate) use table::{COLUMNS, ORIGIN, is_simulated};
pub use table::{Data, Row, data, rows};
pub use verdict::{Exponent, Verdict};
pub use zero::SensorZero;

/// Settings of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Voltage at which electric friction is stated, in volts rms.
    pub voltage_v_rms: f64,
    /// Normal load at which it is stated, in newtons; `None` for the median load of the recording.
    pub normal_load_n: Option<f64>,
    /// Effective gap of the screen's coating, in metres: the rest of the fitted gap is the skin's.
    pub coating_gap_m: f64,
    /// Ripple of the carrier under which friction was measured.
    pub ripple: Ripple,
    /// Names of strokes to leave out.
    pub without: Vec<String>,
    /// Seed of the bootstrap.
    pub seed: u64,
}

/// Lowest and highest carrier frequency of a measurement, in Hz.
pub const CARRIERS_HZ: [f64; 2] = [125.0, 5e3];

/// Ripple of the carrier of a measurement, with a frequency within [`CARRIERS_HZ`] and the edges of the reference
/// board.
pub fn measured_ripple(waveform: Waveform, carrier_hz: f64) -> Ripple {
    let Board { tick_hz, limits, .. } = &Board::SIMULATOR;
    let half_period_ticks = (0.5 * f64::from(*tick_hz) / carrier_hz).round() as u32;
    Carrier::new(waveform, half_period_ticks, *tick_hz, limits.edge_time_constant_s).ripple()
}

/// A fitted finger.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Friction over load with the drive off.
    pub friction_coefficient: Estimate,
    /// The only number about electrode, skin and gap that friction data determine, in `sqrt(N)/V^2`: `eps0/(2 g^2)
    /// sqrt(pi R/k)`.
    pub coupling_sqrt_n_per_v2: Estimate,
    /// Ripple of the carrier of the measurement. Electric frictions are means under it.
    pub ripple: Ripple,
    /// Voltage at which electric friction is stated, in volts rms.
    pub stated_voltage_v_rms: f64,
    /// Electric friction at the stated voltage, in newtons.
    pub electric_friction_n: Estimate,
    /// Electric friction at the highest voltage of the data, in newtons.
    pub electric_friction_most_n: Estimate,
    /// Exponent of the voltage, and its verdict on the model.
    pub voltage_exponent: Exponent,
    /// Exponent of the load, likewise.
    pub load_exponent: Exponent,
    /// Effective gap of coating and skin for a finger of conventional radius and stiffness, in metres.
    pub gap_m: f64,
    /// The part of the gap that is not coating, in metres.
    pub skin_gap_m: f64,
    /// The data, and the load at which friction is stated.
    pub data: DataSummary,
    /// Errors in held-out strokes; `None` for means, and if a fit without one stroke does not converge.
    pub held_out: Option<HeldOut>,
    /// Measured and fitted values of each stroke.
    pub strokes: Vec<StrokeResult>,
}

/// The means of a stroke, with the fitted values.
#[derive(Clone, Debug, PartialEq)]
pub struct StrokeResult {
    /// Name of the stroke.
    pub name: String,
    /// Friction over load with the drive off.
    pub natural_coefficient: Option<f64>,
    /// A point for each voltage of the stroke.
    pub points: Vec<Point>,
}

/// Electric friction at one voltage in a stroke.
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
        let attraction = Attraction::Contact(Coupling(self.coupling_sqrt_n_per_v2.value), self.ripple);
        Some(self.friction_coefficient.value * attraction.attraction_n(voltage_v_rms, self.data.normal_load_n)?)
    }
}

/// Laws fitted to a recording or to means, before any of them is judged.
struct FittedData {
    fitted: Fitted,
    strokes: Vec<StrokeMeans>,
    observations: Vec<Observation>,
    data: DataSummary,
    /// Widest half-interval in [`sensor::check_settled`], as a part of electric friction. Zero for means.
    settling_error: f64,
    held_out: Option<HeldOut>,
}

impl FittedData {
    fn of(data: Data, settings: &Settings, goes_on: GoesOn<'_>) -> Result<Self, FitError> {
        let fitted = match data {
            Data::Recording(rows) => Self::of_recording(rows, settings, goes_on),
            Data::Means(rows) => means::fit(&rows, settings, goes_on),
        };
        if goes_on().is_break() { Err(FitError::Interrupted) } else { fitted }
    }

    fn of_recording(rows: Vec<Row>, settings: &Settings, goes_on: GoesOn<'_>) -> Result<Self, FitError> {
        table::check_numbers(&rows)?;
        let is_simulated = rows.iter().any(|row| row.is_simulated);
        let (rows, rows_without_time) = recording::with_times(rows)?;
        let (rows, sensor_zero) = zero::taken_from(rows);
        let mut defects = Defects::default();
        let fitted = Self::of_strokes_without(&mut defects, rows, settings, goes_on);
        // A defective stroke may be the cause of what else is wrong.
        defects.check()?;
        if matches!(fitted, Err(FitError::TooFew(_))) {
            // Those that were left out are missing.
            defects.refuse()?;
        }
        let mut fitted = fitted?;
        fitted.data.preparation =
            Preparation { left_out: defects.defective, sensor_zero, rows_without_time, is_simulated };
        Ok(fitted)
    }

    /// Fits the laws to the strokes without defects; the others are added to `defects`.
    fn of_strokes_without(
        defects: &mut Defects,
        rows: Vec<Row>,
        settings: &Settings,
        goes_on: GoesOn<'_>,
    ) -> Result<Self, FitError> {
        rules::check_units(&rows)?;
        let mut recording = Recording::new(rows, &settings.without, defects)?;
        let (load_median_n, load_range_n) = rules::check_loads(&mut recording, defects);
        rules::check_strokes(&recording)?;
        let levels = Levels::of(&recording);
        let voltage_range_v_rms = rules::check_voltages(levels.range_v_rms())?;
        rules::check_carrier(&recording, &levels)?;
        let phases = Phases::of(&recording, &levels);
        rules::check_phases(&phases)?;
        let used = phases.means(&Edges::USED);
        let mut strokes = used.clone();
        rules::check_natural(&mut strokes, defects)?;
        rules::check_forces(&recording)?;
        let bandwidth_hz = sensor::check_bandwidth(&phases)?;
        let settling_error = sensor::check_settled(&phases, &used)?;
        rules::check_stated_load(settings, load_range_n)?;
        let normal_load_n = settings.normal_load_n.unwrap_or(load_median_n);

        let observations: Vec<Observation> = strokes.iter().flat_map(|stroke| &stroke.observations).copied().collect();
        let ripple = settings.ripple;
        let start = start(&strokes, &observations, ripple)?;
        let search = Search { voltage_v_rms: settings.voltage_v_rms, normal_load_n, ripple, start: &start, goes_on };
        let best = search.run(&observations, &start).ok_or(FitError::NotConverged)?;
        rules::check_slip(&strokes, &best.power, defects);
        rules::check_top(&strokes, voltage_range_v_rms.1)?;
        // The search for intervals takes longest.
        defects.check()?;
        let held_out = HeldOut::of(&search, &strokes, &best);
        let fitted = Fitted::new(best, &search, &strokes, settings.seed)?;
        let data = DataSummary {
            normal_load_n,
            voltage_range_v_rms,
            load_range_n,
            rows: recording.rows().count(),
            division: recording.division,
            has_time: recording.has_time,
            has_speed: recording.has_speed,
            bandwidth_hz,
            preparation: Preparation::default(),
        };
        Ok(Self { fitted, strokes, observations, data, settling_error, held_out })
    }

    /// Friction over load with the drive off, by one of the laws.
    fn friction_coefficient(&self, law: impl Fn(&Replicate) -> &Solution) -> Result<Estimate, FitError> {
        let estimate = self.fitted.estimate(|replicate| Some(law(replicate).friction_coefficient))?;
        Ok(if self.data.division == Division::Means { estimate } else { wandering(&self.strokes, estimate) })
    }
}

/// Fits the contact model to a recording or to means. When `goes_on` breaks, the fit fails with
/// [`FitError::Interrupted`].
pub fn fit_data(data: Data, settings: &Settings, goes_on: GoesOn<'_>) -> Result<Fit, FitError> {
    judged(&FittedData::of(data, settings, goes_on)?, settings)
}

/// Fits the contact model to the rows of a recording.
pub fn fit(rows: Vec<Row>, settings: &Settings) -> Result<Fit, FitError> {
    fit_data(Data::Recording(rows), settings, TO_THE_END)
}

/// The fit of the contact model. Fails if the data contradict it.
fn judged(fitted_data: &FittedData, settings: &Settings) -> Result<Fit, FitError> {
    let FittedData { fitted, observations, data, .. } = fitted_data;
    let DataSummary { normal_load_n, voltage_range_v_rms: (_, voltage_max_v_rms), .. } = *data;
    rules::check_stated_voltage(settings, voltage_max_v_rms)?;
    let judge = verdict::Judge { fitted, observations };
    let voltage_exponent = judge.voltage(normal_load_n, voltage_max_v_rms)?;
    let load_exponent = judge.load(normal_load_n)?;
    let coupling = fitted.estimate(|replicate| coupling_of(&replicate.contact))?;
    let gap_m = Coupling(coupling.value).gap_m();
    let fit = Fit {
        friction_coefficient: fitted_data.friction_coefficient(|replicate| &replicate.contact)?,
        coupling_sqrt_n_per_v2: coupling,
        ripple: settings.ripple,
        stated_voltage_v_rms: settings.voltage_v_rms,
        electric_friction_n: fitted.electric_friction_n(settings.voltage_v_rms, normal_load_n)?,
        electric_friction_most_n: fitted.electric_friction_n(voltage_max_v_rms, normal_load_n)?,
        voltage_exponent,
        load_exponent,
        gap_m,
        skin_gap_m: gap_m - settings.coating_gap_m,
        data: data.clone(),
        held_out: fitted_data.held_out,
        strokes: results(&fitted_data.strokes, &fitted.best.contact).ok_or(FitError::NotConverged)?,
    };
    verdict::check_estimates(data, &fit.strokes, &fit.friction_coefficient, &fit.electric_friction_n)?;
    sensor::check_settling_error(fitted_data.settling_error)?;
    verdict::check_gap(&fit, settings)?;
    Ok(fit)
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
