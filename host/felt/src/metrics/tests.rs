use proptest::prelude::*;

use super::*;

const HALF_PERIOD_TICKS: u32 = 4;
const PERIOD: usize = 8;

fn sample(reference_n: f64, felt_n: f64) -> Sample {
    Sample {
        finger_down: true,
        turning: false,
        board_has_finger: Some(true),
        reference_n: Some(reference_n),
        commanded_n: Some(reference_n),
        felt_n: Some(felt_n),
        inversion_n: Some(felt_n),
        slewing: false,
        load_mismatch_n: Some(0.0),
        saturated: Some(false),
    }
}

const UP: Sample = Sample {
    finger_down: false,
    turning: false,
    board_has_finger: Some(false),
    reference_n: None,
    commanded_n: None,
    felt_n: None,
    inversion_n: None,
    slewing: false,
    load_mismatch_n: None,
    saturated: Some(false),
};

fn gather(samples: &[Sample]) -> MetricsSummary {
    let mut metrics = Metrics::new(HALF_PERIOD_TICKS);
    for sample in samples {
        metrics.add(sample);
    }
    metrics.summary(samples.len() as u64)
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1.0), "{found} is not {expected}");
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

#[test]
fn without_samples_there_is_no_metric() {
    let up = Sample { saturated: Some(true), ..UP };
    let summary = gather(&[up, up]);
    assert_eq!((summary.ticks, summary.finger_down_ticks, summary.saturated_ticks), (2, 0, Some(2)));
    assert_eq!((summary.friction_error, summary.inversion_error), (None, None));
    assert_eq!((summary.carrier_ripple_rms_n, summary.reference_range_n), (None, None));
}

/// One sample in 40 ticks, as in a board's telemetry, without the felt friction.
#[test]
fn metrics_that_need_every_tick_are_absent_when_some_are_missing() {
    let mut metrics = Metrics::new(HALF_PERIOD_TICKS);
    for reference_n in [0.26, 0.27] {
        metrics.add(&Sample { felt_n: None, ..sample(reference_n, 0.25) });
    }
    let summary = metrics.summary(41);
    assert_eq!(summary.reference_range_n, Some((0.26, 0.27)));
    assert_eq!((summary.saturated_ticks, summary.inversion_error), (None, None));
    assert_eq!((summary.friction_error, summary.carrier_ripple_rms_n), (None, None));
    assert!(metrics.summary(2).inversion_error.is_some(), "two of two ticks were seen");
}

#[test]
fn another_carrier_begins_with_empty_windows() {
    let mut metrics = Metrics::new(1);
    metrics.add(&sample(0.25, 0.35));
    metrics.set_half_period(HALF_PERIOD_TICKS);
    metrics.add(&sample(0.25, 0.25));
    let error = metrics.summary(2).friction_error.expect("an error");
    close(error.rms_n, (0.5 * 0.1_f64.powi(2)).sqrt());
}

#[test]
fn inversion_counts_only_what_is_in_reach_and_saturation_always() {
    let out = Sample { inversion_n: None, saturated: Some(true), ..sample(0.4, 0.2) };
    let summary = gather(&[out, sample(0.26, 0.261), sample(0.26, 0.258)]);
    let error = summary.inversion_error.expect("an error");
    close(error.rms_n, rms(&[0.001, -0.002]));
    close(error.max_n, 0.002);
    assert_eq!((summary.ticks, summary.saturated_ticks), (3, Some(1)));
    assert_eq!(summary.reference_range_n, Some((0.26, 0.4)));
}

#[test]
fn a_voltage_on_its_way_is_no_error_of_the_inverse() {
    let slewing = Sample { slewing: true, ..sample(0.26, 0.25) };
    let summary = gather(&[slewing, sample(0.26, 0.261), slewing, Sample { slewing: true, ..UP }]);
    close(summary.inversion_error.expect("an error").max_n, 0.001);
    assert_eq!(summary.slewing_ticks, Some(2));
}

#[test]
fn the_load_mismatch_is_apart_from_the_friction_error() {
    let pressed = |load_mismatch_n| Sample { load_mismatch_n: Some(load_mismatch_n), ..sample(0.26, 0.26) };
    let summary = gather(&[pressed(0.01), pressed(-0.03), UP]);
    close(summary.load_mismatch.expect("a mismatch").rms_n, rms(&[0.01, -0.03]));
    close(summary.load_mismatch.expect("a mismatch").max_n, 0.03);
    close(summary.friction_error.expect("an error").max_n, 0.0);
}

#[test]
fn a_window_starts_anew_with_each_touch() {
    let mut samples = vec![sample(0.25, 0.35); 3 * PERIOD];
    samples.push(UP);
    samples.extend([sample(0.25, 0.25); 5]);
    let error = gather(&samples).friction_error.expect("an error");
    let expected = (f64::from(3 * 8) * 0.1 * 0.1 / f64::from(3 * 8 + 5)).sqrt();
    close(error.rms_n, expected);
}

#[test]
fn hours_do_not_wear_the_sums() {
    // A large value leaves a rounding error in a running sum. The error must not persist.
    let mut metrics = Metrics::new(HALF_PERIOD_TICKS);
    for tick in 0..1_000_000_u32 {
        let value = if tick % 1000 == 0 { 1e9 } else { 1e-9 };
        metrics.add(&sample(0.0, value));
    }
    let mut later = metrics.clone();
    later.friction_error = Spread::default();
    for _ in 0..100 {
        later.add(&sample(0.0, 1e-9));
    }
    close(1e9 * later.summary(0).friction_error.expect("an error").rms_n, 1.0);
}

proptest! {
    #[test]
    fn windows_are_the_means_they_say(felt in prop::collection::vec(0.2..0.3f64, 1..60)) {
        let samples: Vec<_> = felt.iter().map(|felt_n| sample(0.25, *felt_n)).collect();
        let summary = gather(&samples);
        let mean = |window: &[f64]| window.iter().sum::<f64>() / window.len() as f64;
        let errors: Vec<f64> =
            (0..felt.len()).map(|last| mean(&felt[(last + 1).saturating_sub(PERIOD)..=last]) - 0.25).collect();
        let error = summary.friction_error.expect("an error");
        prop_assert!((error.rms_n - rms(&errors)).abs() < 1e-15);
        prop_assert!((error.max_n - errors.iter().fold(0.0, |max, error| error.abs().max(max))).abs() < 1e-15);
        let ripples: Vec<f64> = felt
            .windows(PERIOD + 1)
            .map(|window| window[PERIOD / 2] - 0.5 * (mean(&window[..PERIOD]) + mean(&window[1..])))
            .collect();
        match summary.carrier_ripple_rms_n {
            Some(ripple_n) => prop_assert!((ripple_n - rms(&ripples)).abs() < 1e-15),
            None => prop_assert!(ripples.is_empty()),
        }
    }
}

#[test]
fn friction_before_the_first_touch_report_is_no_error_and_is_counted_apart() {
    let unreported = |reference_n| Sample { board_has_finger: Some(false), ..sample(reference_n, 0.25) };
    let touch = [unreported(0.4), unreported(0.4), sample(0.25, 0.25), unreported(0.251), sample(0.25, 0.25)];
    let summary = gather(&[&touch[..], &[UP], &touch[..2]].concat());
    assert_eq!(summary.unreported_ticks, 4);
    // A board that loses the finger later in the touch makes errors.
    let error = summary.friction_error.unwrap();
    assert!((0.0..0.002).contains(&error.max_n) && error.max_n > 0.0, "{error:?}");
    let unknown = Sample { board_has_finger: None, ..sample(0.4, 0.25) };
    assert_eq!(gather(&[unknown]).friction_error, None);
}
