use std::f64::consts::TAU;

use super::*;

const SPEED_M_PER_S: f64 = 0.1;

/// A driven finger at a constant speed.
fn sample(reference_n: f64, felt_n: f64) -> FidelitySample {
    FidelitySample {
        speed_m_per_s: Some(SPEED_M_PER_S),
        reference_n,
        felt_n,
        natural_n: 0.3,
        is_driven: true,
        ..FidelitySample::default()
    }
}

/// The score of two seconds; `at` makes a sample from the time.
fn scored_of(at: impl Fn(f64) -> FidelitySample) -> Fidelity {
    let samples: Vec<_> = (0..8000).map(|number| at(f64::from(number) / SAMPLE_HZ)).collect();
    Fidelity::of(&samples).unwrap()
}

/// A finger over a grating of 10 Hz and 20 mN; `felt_n` makes the felt friction from the time.
fn scored(felt_n: impl Fn(f64) -> f64) -> Fidelity {
    scored_of(|t_s| sample(grating_n(t_s), felt_n(t_s)))
}

fn grating_n(t_s: f64) -> f64 {
    0.3 + 0.02 * libm::sin(TAU * 10.0 * t_s)
}

#[test]
fn a_display_without_fault_is_perfect() {
    let fidelity = scored(grating_n);
    for zero in [fidelity.error, fidelity.error_below_40_hz, fidelity.delay_ms] {
        assert_eq!(zero, Some(0.0), "{fidelity:?}");
    }
    let Fidelity { correlation, correlation_below_40_hz, contrast_kept, peak_rate_kept, .. } = fidelity;
    for one in [correlation, correlation_below_40_hz, contrast_kept, peak_rate_kept] {
        assert!((one.unwrap() - 1.0).abs() < 1e-12, "{fidelity:?}");
    }
    assert!(fidelity.spurious_over_noise_db.is_none_or(|db| db < -100.0), "{fidelity:?}");
}

#[test]
fn a_delay_is_found_in_ms_and_mm() {
    let fidelity = scored(|t_s| grating_n(t_s - 0.015));
    assert!((fidelity.delay_ms.unwrap() - 15.0).abs() <= 0.25, "{fidelity:?}");
    assert!((fidelity.delay_mm.unwrap() - 1.5).abs() <= 0.03, "{fidelity:?}");
    // |1 - e^(i w T)| = 2 sin(w T / 2), against the sine itself.
    let expected = 2.0 * libm::sin(std::f64::consts::PI * 10.0 * 0.015);
    assert!((fidelity.error_below_40_hz.unwrap() / expected - 1.0).abs() < 0.02, "{fidelity:?}");
    assert!((fidelity.correlation_below_40_hz.unwrap() - libm::cos(TAU * 10.0 * 0.015)).abs() < 0.01, "{fidelity:?}");
}

#[test]
fn half_of_the_contrast_is_half() {
    let fidelity = scored(|t_s| 0.3 + 0.5 * (grating_n(t_s) - 0.3));
    assert!((fidelity.contrast_kept.unwrap() - 0.5).abs() < 0.01, "{fidelity:?}");
    assert!((fidelity.peak_rate_kept.unwrap() - 0.5).abs() < 1e-6, "{fidelity:?}");
    assert!((fidelity.snr_below_40_hz_db.unwrap() - 6.02).abs() < 0.1, "{fidelity:?}");
    // An rms of 10 mN / sqrt(2) is 0.214 fractions of 0.11 times 0.3 N.
    assert!((fidelity.error_weber - 0.01 / 2.0_f64.sqrt() / 0.033).abs() < 0.01, "{fidelity:?}");
}

#[test]
fn force_that_the_scene_does_not_have_is_spurious() {
    let fidelity = scored(|t_s| grating_n(t_s) + 0.004 * libm::sin(TAU * 150.0 * t_s));
    assert!((fidelity.spurious_40_to_400_hz_n / (0.004 / 2.0_f64.sqrt()) - 1.0).abs() < 0.01, "{fidelity:?}");
    assert!(fidelity.error_below_40_hz.unwrap() < 1e-3, "{fidelity:?}");
}

/// The same texture of 150 Hz, a quarter of a period late: phase is not perceived.
#[test]
fn a_texture_out_of_phase_is_an_error_and_not_spurious() {
    let texture = |t_s: f64, late: f64| 0.3 + 0.004 * libm::sin(TAU * (150.0 * t_s - late));
    let fidelity = scored_of(|t_s| sample(texture(t_s, 0.0), texture(t_s, 0.25)));
    assert!(fidelity.spurious_40_to_400_hz_n < 1e-4, "{fidelity:?}");
    assert!((fidelity.snr_above_40_hz_db.unwrap() + 3.01).abs() < 0.1, "{fidelity:?}");
}

/// Natural friction that changes by more than the grating, and is independent of a display without output.
#[test]
fn natural_friction_makes_no_display_look_faithful() {
    let fidelity = scored_of(|t_s| {
        let natural_n = 0.3 + 0.1 * libm::sin(TAU * 3.0 * t_s);
        FidelitySample { natural_n, ..sample(natural_n + grating_n(t_s) - 0.3, natural_n) }
    });
    assert!((fidelity.error_below_40_hz.unwrap() - 1.0).abs() < 1e-9, "{fidelity:?}");
    assert!(fidelity.correlation_below_40_hz.unwrap().abs() < 1e-12, "{fidelity:?}");
    assert!(fidelity.contrast_weber_steps.abs() < 1e-12, "{fidelity:?}");
    assert!(fidelity.contrast_kept.unwrap().abs() < 1e-12, "{fidelity:?}");
}

#[test]
fn a_flat_output_keeps_no_contrast_and_a_short_touch_has_no_score() {
    let flat = scored(|_| 0.25);
    assert!(flat.contrast_kept.unwrap().abs() < 1e-12 && flat.error_below_40_hz.unwrap() > 0.99, "{flat:?}");
    assert_eq!(flat.delay_ms, None, "{flat:?}");
    // 50 mN too little, and the rms of the grating.
    let rms_n = 0.05_f64.hypot(0.02 / 2.0_f64.sqrt());
    assert!((flat.error_weber / (rms_n / 0.033) - 1.0).abs() < 0.01, "{flat:?}");
    assert_eq!(Fidelity::of(&[FidelitySample::default(); 100]), None);
}

/// A finger at rest, or a source that loses reports, makes no contrast: the drive is off.
#[test]
fn what_faults_take_is_no_contrast_and_is_an_error() {
    let fidelity = scored_of(|t_s| {
        let is_driven = (5.0 * t_s).fract() >= 0.25;
        FidelitySample { is_driven, ..sample(0.35, if is_driven { 0.35 } else { 0.3 }) }
    });
    assert!(fidelity.contrast_weber_steps.abs() < 1e-12, "{fidelity:?}");
    // A quarter of the time, 50 mN are missing, nearly all of it below 40 Hz.
    assert!((fidelity.error_weber / (0.025 / (WEBER_FRACTION * 0.35)) - 1.0).abs() < 0.03, "{fidelity:?}");
}

/// A plate is uniform, so there are no ratios to its changes.
#[test]
fn a_ratio_without_a_denominator_is_absent() {
    let fidelity = scored_of(|t_s| sample(0.35 + 1e-9 * (t_s * SAMPLE_HZ % 2.0), 0.35));
    let Fidelity { error, correlation, contrast_kept, delay_ms, peak_rate_kept, snr_below_40_hz_db, .. } = fidelity;
    let ratios = [error, correlation, contrast_kept, delay_ms, peak_rate_kept, snr_below_40_hz_db];
    assert_eq!(ratios, [None; 6], "{fidelity:?}");
}

/// Friction missing at the start of a touch counts as much as friction missing later.
#[test]
fn a_landing_counts_as_much_as_the_middle() {
    let missing = |from: f64| scored(move |t_s| if (from..from + 0.1).contains(&t_s) { 0.3 } else { grating_n(t_s) });
    let (landing, middle) = (missing(0.0).error.unwrap(), missing(1.0).error.unwrap());
    assert!((landing / middle - 1.0).abs() < 0.02 && middle > 0.2, "{landing}, {middle}");
}

/// A gain at 60 Hz does not compensate a loss at 150 Hz.
#[test]
fn a_third_octave_that_lost_power_makes_up_for_none_that_grew() {
    let wave_n = |t_s: f64, frequency_hz: f64| 0.3 + 0.004 * libm::sin(TAU * frequency_hz * t_s);
    let fidelity = scored_of(|t_s| sample(wave_n(t_s, 150.0), wave_n(t_s, 60.0)));
    assert!((fidelity.spurious_40_to_400_hz_n / (0.004 / 2.0_f64.sqrt()) - 1.0).abs() < 0.01, "{fidelity:?}");
    let noise_n = natural_noise_amplitude_n(60.0);
    let expected_db = decibels((0.004 / noise_n).powi(2));
    assert!((fidelity.spurious_over_noise_db.unwrap() - expected_db).abs() < 0.1, "{fidelity:?}");
}
