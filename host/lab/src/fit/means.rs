//! Means with their errors, as papers print them: data for a fit.
//!
//! A row is the mean friction at one voltage and load, with its standard error, or with the standard deviation and the
//! number of averaged values. The rows are fitted as the means of strokes are, weighted by their errors. Intervals come
//! from redrawing each mean from its error (a parametric bootstrap), as if the means were independent: means do not
//! show what strokes or people have in common. An error that is known from `n` values is drawn from Student's
//! distribution with `n - 1` degrees of freedom, row by row: one number for the whole table would be too many where few
//! rows carry the estimate.

use core::f64::consts::TAU;
use std::io::Read;

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

use frixel_play::GoesOn;
use frixel_scene::brief;

use super::contrast::StrokeMeans;
use super::defects::Defects;
use super::error::{FitError, plain};
use super::intervals::{DRAWS, Fitted};
use super::least_squares::{Measured, Observation, residuals_n};
use super::recording::Division;
use super::search::{Search, start};
use super::table::{FRICTION, LOAD, VOLTAGE, check_voltage};
use super::{DataSummary, FittedData, Preparation, Settings, rules};
use crate::bootstrap::Draws;
use crate::statistics::median;
use crate::table::{Column, Place, Reading, Row, Table, Unit};

const STANDARD_ERROR: Column = Column::new("friction_se_n", "newtons").converted(Unit::NEWTONS);
const STANDARD_DEVIATION: Column = Column::new("friction_sd_n", "newtons").converted(Unit::NEWTONS);
const NUMBER: Column = Column::new("n", "");

/// Least number of means: friction coefficient and coupling are fitted, and something must be left to judge them.
const MEANS_MIN: usize = 3;

/// Standard errors of a measured force, in newtons: squares of others leave the range of numbers.
const ERRORS_N: core::ops::RangeInclusive<f64> = 1e-9..=rules::FORCE_MAX_N;

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
    /// Number of averaged values; `None` if only the standard error is known.
    pub count: Option<f64>,
}

/// The places of the columns that state an error.
pub(super) struct Errors {
    /// Standard errors, or standard deviations.
    error: Place,
    are_deviations: bool,
    number: Option<Place>,
}

impl Errors {
    /// `None` for a table without errors.
    pub(super) fn find<R: Read>(table: &mut Table<R>) -> Result<Option<Self>, FitError> {
        let (errors, deviations) = (table.find(STANDARD_ERROR)?, table.find(STANDARD_DEVIATION)?);
        let number = table.find(NUMBER)?;
        let refused = |sentence: &str| Err(FitError::Refused(sentence.to_owned()));
        match (errors, deviations) {
            (None, None) => Ok(None),
            (Some(_), Some(_)) => refused("the header has both friction_se_n and friction_sd_n: leave one of them out"),
            (None, Some(_)) if number.is_none() => refused(
                "the header has friction_sd_n and no column n: say how many were averaged in a column n, or give the \
                 standard error of the mean in friction_se_n",
            ),
            (Some(error), None) => Ok(Some(Self { error, are_deviations: false, number })),
            (None, Some(error)) => Ok(Some(Self { error, are_deviations: true, number })),
        }
    }

    /// The standard error of a row in newtons, and how many were averaged.
    fn read(&self, row: &Row) -> Result<(f64, Option<f64>), FitError> {
        let number = row.number();
        let count = self.number.map(|place| row.real(place)).transpose()?;
        if let Some(found) = count.filter(|count| !(*count >= 2.0 && count.fract() == 0.0)) {
            return Err(FitError::Refused(format!(
                "row {number}, column n: expected a whole number of at least 2, found {found}: give how many were averaged"
            )));
        }
        let error_n = row.real(self.error)? / count.filter(|_| self.are_deviations).map_or(1.0, f64::sqrt);
        if ERRORS_N.contains(&error_n) {
            return Ok((error_n, count));
        }
        Err(FitError::Refused(format!(
            "row {number}: a standard error of {} N is not plausible: expected 1 nN to 50 N; give the error of the \
             mean, or leave the row out",
            plain(error_n)
        )))
    }
}

/// Reads the rows of a table that states errors.
pub(super) fn read<R: Read>(mut table: Table<R>, errors: &Errors) -> Result<Reading<Vec<MeanRow>>, FitError> {
    let (voltage, load, friction) = (table.need(VOLTAGE)?, table.need(LOAD)?, table.need(FRICTION)?);
    let mut rows = Vec::new();
    while let Some(row) = table.next_row()? {
        row.check_length()?;
        let (standard_error_n, count) = errors.read(&row)?;
        let voltage_v_rms = row.real(voltage)?;
        check_voltage(row.number(), voltage_v_rms)?;
        rows.push(MeanRow {
            number: row.number(),
            voltage_v_rms,
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
pub(super) fn fit(rows: &[MeanRow], settings: &Settings, goes_on: GoesOn<'_>) -> Result<FittedData, FitError> {
    if let Some(stroke) = settings.without.first() {
        return Err(FitError::Refused(format!(
            "--without {}: a table of means has no strokes: delete the row of the mean to leave out",
            brief(stroke)
        )));
    }
    let voltage_range_v_rms = check(rows)?;
    let loads = || rows.iter().map(|row| row.normal_force_n);
    let load_range_n = (loads().fold(f64::INFINITY, f64::min), loads().fold(0.0, f64::max));
    rules::check_stated_load(settings, load_range_n)?;
    let normal_load_n = settings.normal_load_n.unwrap_or_else(|| median(loads()));

    let observations: Vec<Observation> = rows.iter().map(observation).collect();
    let mut strokes: Vec<StrokeMeans> = rows.iter().zip(&observations).map(|(row, one)| stroke(row, *one)).collect();
    let mut defects = Defects::default();
    rules::check_natural(&mut strokes, &mut defects)?;
    defects.check()?;
    let ripple = settings.ripple;
    let begin = start(&strokes, &observations, ripple)?;
    let search = Search { voltage_v_rms: settings.voltage_v_rms, normal_load_n, ripple, start: &begin, goes_on };
    let best = search.run(&observations, &begin).ok_or(FitError::NotConverged)?;
    let mut random = RandomErrors(Pcg64::seed_from_u64(settings.seed));
    let freedoms: Vec<Option<f64>> = rows.iter().map(|row| row.count.map(|count| count - 1.0)).collect();
    let mut drawn = || -> Vec<Observation> {
        observations.iter().zip(&freedoms).map(|(one, freedom)| random.drawn(one, *freedom)).collect()
    };
    let goes_on = (0..DRAWS).take_while(|_| (search.goes_on)().is_continue());
    let replicates = goes_on.filter_map(|_| search.run(&drawn(), &best.contact)).collect();
    let fitted = Fitted::of_draws(best, replicates, Draws::of_errors())?;
    check_scatter(&observations, &freedoms, &fitted)?;
    let data = DataSummary {
        normal_load_n,
        voltage_range_v_rms,
        load_range_n,
        rows: rows.len(),
        division: Division::Means,
        has_time: false,
        has_speed: false,
        bandwidth_hz: None,
        preparation: Preparation::default(),
    };
    Ok(FittedData { fitted, strokes, observations, data, settling_error: 0.0, held_out: None })
}

/// Checks that means can be fitted. Returns the lowest and the highest voltage.
fn check(rows: &[MeanRow]) -> Result<(f64, f64), FitError> {
    let found = rows.len();
    if found < MEANS_MIN {
        return Err(FitError::TooFew(format!(
            "{found} means are too few: at least {MEANS_MIN} are needed, one at 0 V and two at other voltages"
        )));
    }
    rules::check_load_unit(rows.iter().map(|row| row.normal_force_n))?;
    if let Some(row) = rows.iter().find(|row| row.normal_force_n <= 0.0) {
        return Err(FitError::Refused(format!(
            "row {}, column normal_force_n: {} N is not a valid load: it must be above 0; give the mean normal force \
             of that row",
            row.number,
            plain(row.normal_force_n)
        )));
    }
    let driven = || rows.iter().map(|row| row.voltage_v_rms).filter(|voltage_v_rms| *voltage_v_rms > 0.0);
    let (low, high) = (driven().fold(f64::INFINITY, f64::min), driven().fold(0.0, f64::max));
    rules::check_voltages((high > 0.0).then_some((low, high)))
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

/// Fails if the means lie further from the closest power law than their errors explain, in 1 of 1,000 tables. The
/// verdict on the contact model is separate.
fn check_scatter(observations: &[Observation], freedoms: &[Option<f64>], fitted: &Fitted) -> Result<(), FitError> {
    let residuals = residuals_n(&fitted.best.power, 1.0, observations).ok_or(FitError::NotConverged)?;
    let errors = residuals.iter().zip(observations).map(|(residual_n, one)| residual_n * one.weight);
    let chi_square: f64 = errors.zip(freedoms).map(|(error, freedom)| gaussian_square(error, *freedom)).sum();
    // Friction coefficient, size and exponent are fitted. The quantile is Wilson and Hilferty's.
    let freedom = observations.len() as f64 - 3.0;
    let part = 2.0 / (9.0 * freedom);
    if freedom >= 1.0 && chi_square > freedom * (1.0 - part + Z_ONE_SIDED_999 * part.sqrt()).powi(3) {
        let times = (chi_square / freedom).sqrt();
        return Err(FitError::Refused(format!(
            "the means lie {times:.1} times their stated errors from the closest power law, which happens by chance in \
             fewer than 1 of 1,000 tables: check that errors are standard errors, that voltages are rms, and that all \
             rows are of the same fingers; if so, electric friction follows no power of the voltage: write its points \
             into a profile (docs/design/scenes.md, \"Empirical fingers\")"
        )));
    }
    Ok(())
}

/// The square of the Gaussian number that is as probable as an error in units of its standard error with these degrees
/// of freedom (Wallace 1959, doi:10.1214/aoms/1177706095).
fn gaussian_square(error: f64, freedom: Option<f64>) -> f64 {
    let Some(freedom) = freedom else { return error * error };
    let scale = (8.0 * freedom + 1.0) / (8.0 * freedom + 3.0);
    scale * scale * freedom * libm::log1p(error * error / freedom)
}

/// Gaussian quantile that 99.9 % lie below.
const Z_ONE_SIDED_999: f64 = 3.090_232;

/// Random errors of means.
struct RandomErrors(Pcg64);

impl RandomErrors {
    /// Above 0 and at most 1.
    fn uniform(&mut self) -> f64 {
        ((self.0.next_u64() >> 11) + 1) as f64 / (1_u64 << 53) as f64
    }

    /// An error in units of its standard error: Student's with these degrees of freedom, Gaussian for `None` (Bailey
    /// 1994, doi:10.1090/S0025-5718-1994-1219701-3, in the form of Box and Muller).
    fn error(&mut self, freedom: Option<f64>) -> f64 {
        let logarithm = libm::log(self.uniform());
        let square = match freedom {
            Some(freedom) => freedom * libm::expm1(-2.0 * logarithm / freedom),
            None => -2.0 * logarithm,
        };
        square.sqrt() * libm::cos(TAU * self.uniform())
    }

    /// A mean drawn anew from its error.
    fn drawn(&mut self, mean: &Observation, freedom: Option<f64>) -> Observation {
        let error_n = self.error(freedom) / mean.weight;
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
    use std::ops::ControlFlow;
    use std::sync::atomic::{AtomicU32, Ordering};

    use frixel_play::TO_THE_END;
    use rand_pcg::Pcg64;
    use rand_pcg::rand_core::SeedableRng;

    use super::super::{Coupling, Data, Fit, Settings, Verdict, data, fit_data, words};
    use super::{FitError, RandomErrors, gaussian_square};
    use crate::bootstrap::Estimate;
    use crate::fit::law::Attraction;

    const COEFFICIENT: f64 = 0.5;
    const ERROR_N: f64 = 4e-3;

    fn settings() -> Settings {
        Settings {
            voltage_v_rms: 150.0,
            normal_load_n: None,
            coating_gap_m: 1e-6 / 3.9,
            ripple: frixel_model::Ripple::NONE,
            without: Vec::new(),
            seed: 1,
        }
    }

    fn truth_n(voltage_v_rms: f64, load_n: f64) -> f64 {
        let coupling = Coupling::of_attraction(0.26, 150.0, 0.5);
        let law = Attraction::Contact(coupling, frixel_model::Ripple::NONE);
        let attraction_n = if voltage_v_rms > 0.0 { law.attraction_n(voltage_v_rms, load_n).unwrap() } else { 0.0 };
        COEFFICIENT * (load_n + attraction_n)
    }

    /// A table of four voltages, of means of `count` values that are drawn from a seed, or without an error. Its means
    /// are off by `scale` times what the deviations of the values explain.
    fn table(seed: Option<u64>, scale: f64, count: u32, loads_n: &[f64]) -> String {
        let mut random = RandomErrors(Pcg64::seed_from_u64(seed.unwrap_or_default()));
        let number = f64::from(count);
        let mut text = String::from("voltage_v_rms;normal_force_n;friction_mn;friction_sd_mn;n\n");
        for (voltage_v_rms, load_n) in
            [0.0, 75.0, 106.0, 150.0].into_iter().flat_map(|v| loads_n.iter().map(move |n| (v, *n)))
        {
            let deviation_n = ERROR_N * number.sqrt();
            let (mut error_n, mut spread_n) = (0.0, deviation_n);
            if seed.is_some() {
                let values: Vec<f64> = (0..count).map(|_| deviation_n * random.error(None)).collect();
                error_n = values.iter().sum::<f64>() / number;
                let squares: f64 = values.iter().map(|value| (value - error_n).powi(2)).sum();
                spread_n = (squares / (number - 1.0)).sqrt();
            }
            let mean_mn = 1e3 * (truth_n(voltage_v_rms, load_n) + scale * error_n);
            writeln!(text, "{voltage_v_rms};{load_n};{mean_mn:.4};{:.4};{count}", 1e3 * spread_n).unwrap();
        }
        text.replace('.', ",")
    }

    fn fitted(text: &str) -> Result<Fit, FitError> {
        fit_data(data(text.as_bytes())?.value, &settings(), TO_THE_END)
    }

    #[test]
    fn means_without_an_error_give_the_finger_that_made_them() {
        let text = table(None, 1.0, 16, &[0.5]);
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
    fn covered(tables: u64, count: u32, loads_n: &[f64]) -> (u32, u32) {
        let electric_n = truth_n(150.0, 0.5) - truth_n(0.0, 0.5);
        let fits = (0..tables).filter_map(|seed| fitted(&table(Some(seed), 1.0, count, loads_n)).ok());
        fits.map(|fit| fit.electric_friction_n).fold((0, 0), |(fits, covered), Estimate { low, high, .. }| {
            (fits + 1, covered + u32::from((low..=high).contains(&electric_n)))
        })
    }

    #[test]
    #[ignore = "minutes: cargo xtask soak people"]
    fn intervals_of_600_tables_contain_the_truth() {
        for (count, loads_n) in [(16, &[0.4, 0.5, 0.6][..]), (5, &[0.4, 0.5, 0.6]), (16, &[0.5]), (5, &[0.5])] {
            let (fits, covered) = covered(600, count, loads_n);
            let share = f64::from(covered) / f64::from(fits);
            // Tables are independent.
            let room = 1.96 * (share * (1.0 - share) / f64::from(fits)).sqrt();
            println!(
                "means of {count} at {} loads: {covered} of {fits} intervals contain the truth: {:.1} % ({:.1} to {:.1})",
                loads_n.len(),
                100.0 * share,
                100.0 * (share - room).max(0.0),
                100.0 * (share + room).min(1.0)
            );
            assert!(fits >= 588 && (0.93..=0.99).contains(&share), "{covered} of {fits}");
        }
    }

    #[test]
    fn intervals_come_from_the_stated_errors() {
        let (fits, covered) = covered(60, 16, &[0.4, 0.5, 0.6]);
        assert!(fits >= 58, "{fits}");
        // 95 %, less 1.8 standard errors.
        assert!(covered * 100 >= 90 * fits, "{covered} of {fits}");
        let wide = fitted(&table(None, 1.0, 16, &[0.5])).unwrap().electric_friction_n;
        let narrow = fitted(&table(None, 1.0, 16, &[0.5, 0.5, 0.5, 0.5])).unwrap().electric_friction_n;
        let ratio = (wide.high - wide.low) / (narrow.high - narrow.low);
        assert!((1.8..2.2).contains(&ratio), "four tables in one have half the interval: {ratio}");
    }

    /// Student's quantiles for 1 to 60 degrees of freedom, from the printed tables (Abramowitz and Stegun, table
    /// 26.10).
    #[test]
    fn errors_of_few_values_are_students() {
        for (freedom, quantile) in [(2.0, 4.303), (4.0, 2.776), (10.0, 2.228), (60.0, 2.000)] {
            let mut random = RandomErrors(Pcg64::seed_from_u64(1));
            let beyond = (0..40_000).filter(|_| random.error(Some(freedom)).abs() > quantile).count();
            // 5 % of 40,000, and 4 standard deviations.
            assert!((1826..=2174).contains(&beyond), "{freedom}: {beyond}");
            let gaussian = gaussian_square(quantile, Some(freedom)).sqrt();
            assert!((gaussian / 1.96 - 1.0).abs() < 0.03, "{freedom}: {gaussian}");
        }
    }

    /// The interval rests on the rows without and with the highest voltage, not on all of the table.
    #[test]
    fn intervals_are_wider_where_errors_come_from_few_values() {
        let width = |count| {
            let Estimate { low, high, .. } = fitted(&table(None, 1.0, count, &[0.5])).unwrap().electric_friction_n;
            high - low
        };
        let ratio = width(5) / width(100);
        assert!((1.15..1.45).contains(&ratio), "{ratio}");
    }

    #[test]
    fn means_that_scatter_more_than_their_errors_are_refused() {
        let refused = (0..20).filter(|seed| {
            let error = fitted(&table(Some(*seed), 4.0, 16, &[0.4, 0.5, 0.6])).err().map(|error| error.to_string());
            let times = error.as_ref().and_then(|said| said.strip_prefix("the means lie ")?.split(' ').next());
            times.is_some_and(|times| times.parse::<f64>().unwrap() > 2.0)
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
            (format!("{header},friction_se_n\n0,0.5,0.2,0\n"), "row 2: a standard error of 0 N"),
            (format!("{header},friction_se_n\n0,0.5,0.2,1e300\n"), "row 2: a standard error of 1e300 N"),
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

    #[test]
    fn a_fit_ends_when_its_caller_says_so() {
        let data = data(table(None, 1.0, 16, &[0.5]).as_bytes()).unwrap().value;
        let asked = AtomicU32::new(0);
        let goes_on = || match asked.fetch_add(1, Ordering::Relaxed) {
            ..10 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        };
        assert!(matches!(fit_data(data, &settings(), &goes_on), Err(FitError::Interrupted)));
    }

    #[test]
    fn a_mean_is_not_left_out_as_a_stroke() {
        let settings = Settings { without: vec!["3".to_owned()], ..settings() };
        let data = data(table(None, 1.0, 16, &[0.5]).as_bytes()).unwrap().value;
        let said = fit_data(data, &settings, TO_THE_END).unwrap_err().to_string();
        assert!(said.contains("--without 3") && said.contains("delete the row"), "{said}");
    }

    #[test]
    fn an_interval_that_is_too_wide_says_what_narrows_that_of_means() {
        let header = "voltage_v_rms,normal_force_n,friction_n,friction_se_n";
        let text = format!("{header}\n0,0.5,0.25,0.02\n75,0.5,0.272,0.02\n150,0.5,0.35,0.02\n");
        let said = fitted(&text).unwrap_err().to_string();
        assert!(said.contains("wider than") && said.contains("means of more values"), "{said}");
    }
}
