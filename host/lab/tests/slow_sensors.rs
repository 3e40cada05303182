//! A force sensor that is too slow is seen, and one that is fast enough is not refused.

use frixel_hil_sim::Person;
use frixel_lab::fit::{Fit, FitError, fit};

use super::filters::Filter;
use super::person::Protocol;
use super::simulated;
use super::tally::settings;

/// People who are measured with each sensor.
const PEOPLE: u64 = 8;

/// The fits of people with a sensor of one pole, with every `step`th row of what it measures.
fn fits(cutoff_hz: f64, step: usize) -> Vec<Result<Fit, FitError>> {
    let protocol = Protocol { strokes: 24, ..Protocol::default() };
    let of = |seed| {
        let rows = simulated::record(&Person::drawn(seed), &protocol, seed);
        fit(Filter::OnePole(cutoff_hz).apply(&rows).into_iter().step_by(step).collect(), &settings())
    };
    (0..PEOPLE).map(of).collect()
}

fn refused(fits: &[Result<Fit, FitError>]) -> usize {
    fits.iter().filter(|fit| matches!(fit, Err(FitError::NotSettled(_)))).count()
}

#[test]
fn below_80_hz_sensors_are_refused() {
    for (cutoff_hz, step) in [(80.0, 1), (80.0, 2), (80.0, 4), (30.0, 1), (15.0, 2)] {
        let fits = fits(cutoff_hz, step);
        assert_eq!(refused(&fits), PEOPLE as usize, "{cutoff_hz} Hz, every {step}: {fits:#?}");
    }
    let message = fits(40.0, 1).remove(0).unwrap_err().to_string();
    assert!(message.contains("the force sensor is too slow") && message.contains("at least 200 Hz"), "{message}");
}

#[test]
fn from_200_hz_on_sensors_are_not_refused() {
    for (cutoff_hz, step) in [(200.0, 1), (200.0, 2), (200.0, 4), (1000.0, 1), (1000.0, 4)] {
        let fits = fits(cutoff_hz, step);
        assert!(fits.iter().all(Result::is_ok), "{cutoff_hz} Hz, every {step}: {fits:#?}");
    }
}
