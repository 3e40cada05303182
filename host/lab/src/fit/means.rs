//! Means with their errors, as papers print them, as data of a fit.
//!
//! A row is the mean friction at one voltage and load, with its standard error, or with the standard deviation and the
//! number of what was averaged. The rows are fitted as the means of strokes are, weighted by their errors. Intervals
//! come from drawing each mean anew from its error (a parametric bootstrap), as if the means were independent: what
//! strokes or people have in common cannot be told from means.

use core::f64::consts::TAU;
use std::io::Read;

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

use super::contrast::StrokeMeans;
use super::error::FitError;
use super::faults::Faults;
use super::intervals::{DRAWS, Fitted};
use super::least_squares::{Measured, Observation, residuals_n};
use super::recording::Division;
use super::search::{Search, start};
use super::table::{FRICTION, LOAD, VOLTAGE, voltage_v_rms};
use super::{FittedData, Settings, rules};
use crate::bootstrap::Draws;
use crate::statistics::median;
use crate::table::{Column, Place, Reading, Row, Table, Unit};

const STANDARD_ERROR: Column = Column::new("friction_se_n", "newtons").converted(Unit::Newtons);
const STANDARD_DEVIATION: Column = Column::new("friction_sd_n", "newtons").converted(Unit::Newtons);
const NUMBER: Column = Column::new("n", "");

/// Least number of means: friction coefficient and coupling are fitted, and something must be left to judge them.
const MEANS_MIN: usize = 3;

/// Mean friction at one voltage and load.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanRow {
    /// Number of the row in its file; the header is row 1.
    pub number: u64,
    /// Drive, in volts rms.
    pub voltage_v_rms: f64,
    /// Normal force, in newtons.
    pub normal_force_n: f64,
    /// Mean friction, in newtons.
    pub friction_n: f64,
    /// Standard error of the mean, in newtons.
    pub standard_error_n: f64,
    /// How many were averaged; `None` if only the standard error is known.
    pub count: Option<f64>,
}

/// The places of the columns that state an error.
pub(super) struct Errors {
    standard_error: Option<Place>,
    standard_deviation: Option<Place>,
    number: Option<Place>,
}

impl Errors {
    /// `None` for a table without errors.
    pub(super) fn find<R: Read>(table: &mut Table<R>) -> Result<Option<Self>, FitError> {
        let errors = Self {
            standard_error: table.find(STANDARD_ERROR)?,
            standard_deviation: table.find(STANDARD_DEVIATION)?,
            number: table.find(NUMBER)?,
        };
        match (errors.standard_error, errors.standard_deviation) {
            (None, None) => Ok(None),
            (Some(_), Some(_)) => Err(FitError::TwoErrors),
            (None, Some(_)) if errors.number.is_none() => Err(FitError::DeviationWithoutNumber),
            _ => Ok(Some(errors)),
        }
    }

    /// The standard error of a row in newtons, and how many were averaged.
    fn read(&self, row: &Row) -> Result<(f64, Option<f64>), FitError> {
        let number = row.number();
        let count = self.number.map(|place| row.real(place)).transpose()?;
        if let Some(found) = count.filter(|count| !(*count >= 2.0 && count.fract() == 0.0)) {
            return Err(FitError::MeanOfTooFew { row: number, found });
        }
        let error_n = match (self.standard_error, self.standard_deviation, count) {
            (Some(place), ..) => row.real(place)?,
            (None, Some(place), Some(count)) => row.real(place)? / count.sqrt(),
            _ => return Err(FitError::DeviationWithoutNumber),
        };
        if error_n > 0.0 {
            Ok((error_n, count))
        } else {
            Err(FitError::ErrorNotPositive { row: number, found_n: error_n })
        }
    }
}

/// Reads the rows of a table that states errors.
pub(super) fn read<R: Read>(mut table: Table<R>, errors: &Errors) -> Result<Reading<Vec<MeanRow>>, FitError> {
    let (voltage, load, friction) = (table.need(VOLTAGE)?, table.need(LOAD)?, table.need(FRICTION)?);
    let mut rows = Vec::new();
    while let Some(row) = table.next_row()? {
        row.check_length()?;
        let (standard_error_n, count) = errors.read(&row)?;
        rows.push(MeanRow {
            number: row.number(),
            voltage_v_rms: voltage_v_rms(&row, voltage)?,
            normal_force_n: row.real(load)?,
            friction_n: row.real(friction)?,
            standard_error_n,
            count,
        });
    }
    let means = "the rows are means with their errors";
    let understood = table.understood().map_or(means.to_owned(), |understood| format!("{means}; {understood}"));
    Ok(Reading { value: rows, understood: Some(understood) })
}

/// Fits laws to means. Fails if they scatter more than their errors explain.
pub(super) fn fit(rows: &[MeanRow], settings: &Settings) -> Result<FittedData, FitError> {
    let voltage_range_v_rms = check(rows)?;
    let loads = || rows.iter().map(|row| row.normal_force_n);
    let load_range_n = (loads().fold(f64::INFINITY, f64::min), loads().fold(0.0, f64::max));
    rules::check_stated_load(settings, load_range_n)?;
    let normal_load_n = settings.normal_load_n.unwrap_or_else(|| median(loads()));

    let observations: Vec<Observation> = rows.iter().map(observation).collect();
    let mut strokes: Vec<StrokeMeans> = rows.iter().zip(&observations).map(|(row, one)| stroke(row, *one)).collect();
    let mut faults = Faults::default();
    rules::check_natural(&mut strokes, &mut faults)?;
    faults.check()?;
    let begin = start(&strokes, &observations)?;
    let search = Search { voltage_v_rms: settings.voltage_v_rms, normal_load_n, start: &begin };
    let best = search.run(&observations, &begin).ok_or(FitError::NotConverged)?;
    let mut random = Normal(Pcg64::seed_from_u64(settings.seed));
    let drawn = (0..DRAWS).map(|_| observations.iter().map(|one| random.draw(one)).collect::<Vec<_>>());
    let replicates = drawn.filter_map(|drawn| search.run(&drawn, &best.contact)).collect();
    let draws = Draws::of_errors(rows.iter().map(|row| row.count.map(|count| count - 1.0)).sum());
    let fitted = Fitted::of_draws(best, replicates, draws)?;
    check_scatter(&observations, &fitted)?;
    Ok(FittedData {
        friction_coefficient: fitted.estimate(|replicate| Some(replicate.contact.friction_coefficient))?,
        fitted,
        strokes,
        observations,
        normal_load_n,
        voltage_range_v_rms,
        load_range_n,
        rows: rows.len(),
        division: Division::Means,
        has_time: false,
        has_speed: false,
        bandwidth_hz: None,
        held_out: None,
    })
}

/// Whether means can be fitted; returns the lowest and the highest voltage.
fn check(rows: &[MeanRow]) -> Result<(f64, f64), FitError> {
    if rows.len() < MEANS_MIN {
        return Err(FitError::TooFewMeans { found: rows.len(), needed: MEANS_MIN });
    }
    rules::check_load_unit(rows.iter().map(|row| row.normal_force_n))?;
    if let Some(row) = rows.iter().find(|row| row.normal_force_n <= 0.0) {
        return Err(FitError::MeanWithoutLoad { row: row.number, found_n: row.normal_force_n });
    }
    let driven = || rows.iter().map(|row| row.voltage_v_rms).filter(|voltage_v_rms| *voltage_v_rms > 0.0);
    let (low, high) = (driven().fold(f64::INFINITY, f64::min), driven().fold(0.0, f64::max));
    if high <= 0.0 {
        return Err(FitError::NoVoltage);
    }
    rules::check_voltages(low, high)
}

fn observation(row: &MeanRow) -> Observation {
    Observation {
        voltage_v_rms: row.voltage_v_rms,
        normal_load_n: row.normal_force_n,
        measured: Measured::Friction(row.friction_n),
        weight: 1.0 / row.standard_error_n,
    }
}

fn stroke(row: &MeanRow, observation: Observation) -> StrokeMeans {
    let is_natural = row.voltage_v_rms <= 0.0;
    StrokeMeans {
        name: format!("row {}", row.number),
        observations: vec![observation],
        natural_coefficient: is_natural.then(|| row.friction_n / row.normal_force_n),
        top_level: None,
    }
}

/// Fails if the means lie further from the closest power law than their errors explain, in 1 of 1,000 tables. What the
/// contact model says is judged apart.
fn check_scatter(observations: &[Observation], fitted: &Fitted) -> Result<(), FitError> {
    let residuals = residuals_n(&fitted.best.power, 1.0, observations).ok_or(FitError::NotConverged)?;
    let chi_square: f64 =
        residuals.iter().zip(observations).map(|(residual_n, one)| (residual_n * one.weight).powi(2)).sum();
    // Friction coefficient, size and exponent are fitted. The quantile is Wilson and Hilferty's.
    let freedom = observations.len() as f64 - 3.0;
    let part = 2.0 / (9.0 * freedom);
    if freedom >= 1.0 && chi_square > freedom * (1.0 - part + Z_ONE_SIDED_999 * part.sqrt()).powi(3) {
        return Err(FitError::MeansScatter { times: (chi_square / freedom).sqrt() });
    }
    Ok(())
}

/// Gaussian quantile that 99.9 % lie below.
const Z_ONE_SIDED_999: f64 = 3.090_232;

/// Gaussian random numbers.
struct Normal(Pcg64);

impl Normal {
    /// Above 0 and at most 1.
    fn uniform(&mut self) -> f64 {
        ((self.0.next_u64() >> 11) + 1) as f64 / (1_u64 << 53) as f64
    }

    /// A mean drawn anew from its error.
    fn draw(&mut self, mean: &Observation) -> Observation {
        let size = (-2.0 * libm::log(self.uniform())).sqrt();
        let error_n = size * libm::cos(TAU * self.uniform()) / mean.weight;
        let measured = match mean.measured {
            Measured::Friction(friction_n) => Measured::Friction(friction_n + error_n),
            Measured::Attraction(attraction_n) => Measured::Attraction(attraction_n + error_n),
        };
        Observation { measured, ..*mean }
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use rand_pcg::Pcg64;
    use rand_pcg::rand_core::SeedableRng;

    use super::super::{Coupling, Data, Fit, Settings, Verdict, data, fit_data, words};
    use super::{FitError, Measured, Normal, Observation};
    use crate::bootstrap::Estimate;
    use crate::fit::law::Attraction;

    const COEFFICIENT: f64 = 0.5;
    const ERROR_N: f64 = 4e-3;

    fn settings() -> Settings {
        Settings { voltage_v_rms: 150.0, normal_load_n: None, coating_gap_m: 1e-6 / 3.9, without: Vec::new(), seed: 1 }
    }

    fn truth_n(voltage_v_rms: f64, load_n: f64) -> f64 {
        let coupling = Coupling::of_attraction(0.26, 150.0, 0.5);
        let law = Attraction::Contact(coupling);
        let attraction_n = if voltage_v_rms > 0.0 { law.attraction_n(voltage_v_rms, load_n).unwrap() } else { 0.0 };
        COEFFICIENT * (load_n + attraction_n)
    }

    /// A table of four voltages, with errors drawn from a seed or none, and times an error that is not stated.
    fn table(seed: Option<u64>, scale: f64, loads_n: &[f64]) -> String {
        let mut random = Normal(Pcg64::seed_from_u64(seed.unwrap_or_default()));
        let mut text = String::from("voltage_v_rms;normal_force_n;friction_mn;friction_sd_mn;n\n");
        for (voltage_v_rms, load_n) in
            [0.0, 75.0, 106.0, 150.0].into_iter().flat_map(|v| loads_n.iter().map(move |n| (v, *n)))
        {
            let exact_n = truth_n(voltage_v_rms, load_n);
            let exact = Observation {
                voltage_v_rms,
                normal_load_n: load_n,
                measured: Measured::Friction(0.0),
                weight: 1.0 / ERROR_N,
            };
            let Measured::Friction(error_n) = random.draw(&exact).measured else { panic!() };
            let drawn_mn = 1e3 * (exact_n + if seed.is_some() { scale * error_n } else { 0.0 });
            writeln!(text, "{voltage_v_rms};{load_n};{drawn_mn:.4};{:.1};16", 4e3 * ERROR_N).unwrap();
        }
        text.replace('.', ",")
    }

    fn fitted(text: &str) -> Result<Fit, FitError> {
        fit_data(data(text.as_bytes())?.value, &settings())
    }

    #[test]
    fn means_without_an_error_give_the_finger_that_made_them() {
        let text = table(None, 1.0, &[0.5]);
        let reading = data(text.as_bytes()).unwrap();
        assert!(
            matches!(&reading.value, Data::Means(rows) if rows.len() == 4 && (rows[0].standard_error_n - ERROR_N).abs() < 1e-12)
        );
        assert!(reading.understood.unwrap().starts_with("the rows are means with their errors; read `friction_sd_mn`"));
        let fit = fitted(&text).unwrap();
        let electric_n = truth_n(150.0, 0.5) - truth_n(0.0, 0.5);
        assert!((fit.friction_coefficient.value / COEFFICIENT - 1.0).abs() < 1e-3, "{:?}", fit.friction_coefficient);
        assert!((fit.electric_friction_n.value / electric_n - 1.0).abs() < 2e-3, "{:?}", fit.electric_friction_n);
        assert_eq!(fit.load_exponent.verdict, Verdict::None);
        let said = words(&fit, "example");
        for part in
            ["4 means with their errors", "the loads were too alike", "all loads are equal", "what they have in common"]
        {
            assert!(said.contains(part), "{part}: {said}");
        }
    }

    /// How many of these tables are fitted, and how many of the intervals contain the truth.
    fn covered(tables: u64) -> (u32, u32) {
        let electric_n = truth_n(150.0, 0.5) - truth_n(0.0, 0.5);
        let fits = (0..tables).filter_map(|seed| fitted(&table(Some(seed), 1.0, &[0.4, 0.5, 0.6])).ok());
        fits.map(|fit| fit.electric_friction_n).fold((0, 0), |(fits, covered), Estimate { low, high, .. }| {
            (fits + 1, covered + u32::from((low..=high).contains(&electric_n)))
        })
    }

    #[test]
    #[ignore = "half a minute: cargo xtask soak people"]
    fn intervals_of_600_tables_contain_the_truth() {
        let (fits, covered) = covered(600);
        println!("means: {covered} of {fits} intervals contain the truth");
        let share = f64::from(covered) / f64::from(fits);
        assert!(fits >= 588 && (0.93..=0.97).contains(&share), "{covered} of {fits}");
    }

    #[test]
    fn intervals_come_from_the_stated_errors() {
        let (fits, covered) = covered(60);
        assert!(fits >= 58, "{fits}");
        // 95 %, less 1.8 standard errors.
        assert!(covered * 100 >= 90 * fits, "{covered} of {fits}");
        let wide = fitted(&table(None, 1.0, &[0.5])).unwrap().electric_friction_n;
        let narrow = fitted(&table(None, 1.0, &[0.5, 0.5, 0.5, 0.5])).unwrap().electric_friction_n;
        let ratio = (wide.high - wide.low) / (narrow.high - narrow.low);
        assert!((1.8..2.2).contains(&ratio), "four tables in one have half the interval: {ratio}");
    }

    #[test]
    fn means_that_scatter_more_than_their_errors_are_refused() {
        let refused = (0..20).filter(|seed| {
            matches!(fitted(&table(Some(*seed), 4.0, &[0.4, 0.5, 0.6])), Err(FitError::MeansScatter { times }) if times > 2.0)
        });
        assert!(refused.count() >= 15);
    }

    #[test]
    fn what_is_no_table_of_means_is_refused_by_what_is_wrong() {
        let header = "voltage_v_rms,normal_force_n,friction_n";
        for (text, said) in [
            (format!("{header},friction_sd_n\n"), "no column n"),
            (format!("{header},friction_sd_n,friction_se_n,n\n"), "leave one of them out"),
            (format!("{header},friction_se_n,n\n0,0.5,0.2,0.01,1\n"), "row 2, column n: expected a whole number"),
            (format!("{header},friction_se_n\n0,0.5,0.2,0\n"), "row 2: the standard error of 0 N"),
            (format!("{header},friction_se_n\n0,0.5,0.2,0.01\n"), "1 means are too few"),
            (
                format!("{header},friction_se_n\n10,0.5,0.2,0.01\n75,0.5,0.2,0.01\n150,0.5,0.2,0.01\n"),
                "no row has a voltage of zero",
            ),
            (format!("{header},friction_se_n\n0,500,200,1\n75,500,220,1\n150,500,330,1\n"), "looks like millinewtons"),
        ] {
            let found = fitted(&text).unwrap_err().to_string();
            assert!(found.contains(said), "{found}");
        }
    }
}
