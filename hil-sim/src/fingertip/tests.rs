#![allow(clippy::float_cmp, reason = "what has to be exact is tested as exact")]

use core::f64::consts::{FRAC_1_SQRT_2, TAU};

use super::{Fingertip, FingertipConfig, example_finger};
use crate::amplifier::Output;
use crate::stroke::FingerState;
use crate::world::Felt;
use frixel_felt::band_rms;

const TICK_HZ: u32 = 40_000;

/// A finger that slides along x.
struct Slide {
    fingertip: Fingertip,
    tick_hz: u32,
    x_m: f64,
}

impl Slide {
    fn new(config: FingertipConfig, seed: u64) -> Self {
        Self::at_rate(config, seed, TICK_HZ)
    }

    fn at_rate(config: FingertipConfig, seed: u64, tick_hz: u32) -> Self {
        let fingertip = Fingertip::new(config, example_finger().unwrap().into(), tick_hz, seed).unwrap();
        Self { fingertip, tick_hz, x_m: 0.01 }
    }

    fn tick(&mut self, mean_square_v2: f64, speed_m_per_s: f64) -> Felt {
        self.tick_under(mean_square_v2, speed_m_per_s, None)
    }

    fn tick_under(&mut self, mean_square_v2: f64, speed_m_per_s: f64, load_n: Option<f64>) -> Felt {
        self.x_m += speed_m_per_s / f64::from(self.tick_hz);
        let finger = FingerState { x_m: self.x_m, y_m: 0.03, speed_m_per_s: speed_m_per_s.abs() };
        self.fingertip.slide(&over(mean_square_v2), &finger, load_n)
    }
}

/// A square carrier, which has no mean.
fn over(mean_square_v2: f64) -> Output {
    Output { mean_v: 0.0, variance_v2: mean_square_v2, mean_square_v2, end_v: 0.0 }
}

/// A finger with one effect on top of the ideal ones.
fn with(effect: impl FnOnce(&mut FingertipConfig)) -> FingertipConfig {
    let mut config = FingertipConfig::IDEAL;
    effect(&mut config);
    config
}

#[test]
fn the_example_finger_has_the_friction_that_the_notes_say() {
    let contact = example_finger().unwrap();
    assert_eq!(contact.natural_friction_n(), 0.25);
    let electric_friction_n = contact.electric_friction_n(150.0);
    assert!((electric_friction_n - 0.13).abs() < 5e-4, "{electric_friction_n}");
}

/// Amplitude of the electric friction over that of its steady value, in steady sliding.
///
/// The mean square swings so that the steady electric friction is close to a sine about 10 mN.
fn gain(frequency_hz: f64, speed_m_per_s: f64, config: FingertipConfig) -> f64 {
    const PERIODS: f64 = 20.0;
    let contact = example_finger().unwrap();
    let mut slide = Slide::new(config, 1);
    let ticks_per_period = f64::from(TICK_HZ) / frequency_hz;
    let settling = (0.5 * f64::from(TICK_HZ)) as u32;
    let counted = (PERIODS * ticks_per_period) as u32;
    let middle_n = contact.electric_friction_n(100.0);
    let (mut felt, mut steady) = ([0.0; 2], [0.0; 2]);
    for tick in 0..settling + counted {
        let phase = TAU * f64::from(tick) / ticks_per_period;
        let mean_square_v2 = 1e4 * (1.0 + 0.1 * libm::sin(phase));
        let felt_n = slide.tick(mean_square_v2, speed_m_per_s).electric_friction_n;
        if tick >= settling {
            let steady_n = contact.electric_friction_n(mean_square_v2.sqrt());
            for (sums, value) in [(&mut felt, felt_n - middle_n), (&mut steady, steady_n - middle_n)] {
                sums[0] += value * libm::sin(phase);
                sums[1] += value * libm::cos(phase);
            }
        }
    }
    libm::hypot(felt[0], felt[1]) / libm::hypot(steady[0], steady[1])
}

#[test]
fn friction_has_its_half_power_point_where_it_was_measured() {
    for config in [FingertipConfig::IDEAL, with(|config| config.pre_sliding = true)] {
        for (speed_m_per_s, cutoff_hz) in [(0.02, 276.0), (0.05, 690.0), (0.1, 1380.0)] {
            let (mut low_hz, mut high_hz) = (10.0, 5000.0);
            while high_hz - low_hz > 2.0 {
                let middle_hz = 0.5 * (low_hz + high_hz);
                if gain(middle_hz, speed_m_per_s, config) > FRAC_1_SQRT_2 {
                    low_hz = middle_hz;
                } else {
                    high_hz = middle_hz;
                }
            }
            assert!((low_hz / cutoff_hz - 1.0).abs() < 0.01, "{low_hz} Hz at {speed_m_per_s} m/s");
        }
    }
}

#[test]
fn friction_takes_the_lag_s_share_of_a_step_whatever_the_tick() {
    let target_n = example_finger().unwrap().electric_friction_n(100.0);
    // 1 - 1/e after one time constant 1/(2 pi 1380 Hz), in 4 and in 400 ticks.
    for ticks in [4, 400] {
        let tick_hz = (TAU * 1380.0 * f64::from(ticks)).round();
        let mut slide = Slide::at_rate(FingertipConfig::IDEAL, 1, tick_hz as u32);
        let felt_n = (0..ticks).map(|_| slide.tick(1e4, 0.1).electric_friction_n).last().unwrap();
        assert!((felt_n / target_n - 0.632_120_558_828_557_7).abs() < 1e-4, "{felt_n} in {ticks} ticks");
    }
}

#[test]
fn a_still_finger_keeps_the_friction_it_has() {
    for config in [FingertipConfig::IDEAL, FingertipConfig { load_sd_n: 0.0, ..FingertipConfig::REALISTIC }] {
        let mut slide = Slide::new(config, 1);
        let moving = (0..100).map(|_| slide.tick(10_000.0, 0.05)).last().unwrap();
        assert!(moving.electric_friction_n > 0.0);
        for _ in 0..1000 {
            let still = slide.tick(0.0, 0.0);
            assert_eq!(still.natural_friction_n, moving.natural_friction_n);
            assert_eq!(still.electric_friction_n, moving.electric_friction_n);
        }
        assert!(slide.tick(0.0, 0.05).electric_friction_n < moving.electric_friction_n);
    }
}

#[test]
fn a_lifted_finger_feels_nothing_and_starts_afresh() {
    for (config, natural_n) in [(FingertipConfig::IDEAL, 0.25), (FingertipConfig::REALISTIC, 0.0)] {
        let mut slide = Slide::new(config, 1);
        for _ in 0..1000 {
            slide.tick(10_000.0, 0.1);
        }
        let lifted = slide.fingertip.lift(&over(0.0));
        assert_eq!((lifted.natural_friction_n, lifted.electric_friction_n), (0.0, 0.0));
        let touching = slide.tick(10_000.0, 0.0);
        assert_eq!((touching.natural_friction_n, touching.electric_friction_n), (natural_n, 0.0));
    }
}

#[test]
fn friction_without_voltage_decays_to_exactly_natural() {
    for config in [FingertipConfig::IDEAL, with(|config| config.pre_sliding = true)] {
        let mut slide = Slide::new(config, 1);
        for _ in 0..1000 {
            slide.tick(10_000.0, 0.1);
        }
        let last = (0..1000).map(|_| slide.tick(0.0, 0.1)).last().unwrap();
        assert_eq!((last.natural_friction_n, last.electric_friction_n), (0.25, 0.0));
    }
}

/// Dahl's law: natural and electric friction both begin at zero, rise over the relaxation length, and turn with the
/// motion; the drive adds nothing before the contact slips.
#[test]
fn friction_begins_with_the_first_micrometres_and_turns_with_the_motion() {
    let mut slide = Slide::new(with(|config| config.pre_sliding = true), 1);
    let steady_n = example_finger().unwrap().electric_friction_n(100.0);
    let still = slide.tick(1e4, 0.0);
    assert_eq!((still.natural_friction_n, still.electric_friction_n), (0.0, 0.0));
    // 1 mm/s is 25 nm a tick: 461 ticks are a relaxation length.
    let first = (0..461).map(|_| slide.tick(1e4, 1e-3)).last().unwrap();
    assert!((first.natural_friction_n / 0.25 - 0.632).abs() < 2e-3, "{first:?}");
    assert!((first.electric_friction_n / steady_n - 0.632).abs() < 2e-3, "{first:?}");
    let full = (0..20_000).map(|_| slide.tick(1e4, 1e-3)).last().unwrap();
    assert!((full.natural_friction_n - 0.25).abs() < 1e-9 && (full.electric_friction_n - steady_n).abs() < 1e-9);
    let turned = slide.tick(1e4, -1e-3);
    assert!(turned.natural_friction_n < -0.24 && turned.electric_friction_n < -0.9 * steady_n, "{turned:?}");
    let back = (0..20_000).map(|_| slide.tick(1e4, -1e-3)).last().unwrap();
    assert!((back.natural_friction_n - 0.25).abs() < 1e-9 && (back.electric_friction_n - steady_n).abs() < 1e-9);
}

/// Ticks a second of the tests of slow things.
const SLOW_HZ: u32 = 8_000;

/// Natural friction of a finger at a speed, tick by tick.
fn natural_n(config: FingertipConfig, seed: u64, speed_m_per_s: f64, seconds: u32) -> Vec<f64> {
    let mut slide = Slide::at_rate(config, seed, SLOW_HZ);
    (0..seconds * SLOW_HZ).map(|_| slide.tick(0.0, speed_m_per_s).natural_friction_n).collect()
}

#[test]
fn the_noise_has_the_power_that_was_measured() {
    let config = with(|config| (config.noise_rms_n, config.pre_sliding) = (4.5e-3, true));
    let rms_n = |runs: &[Vec<f64>], from_hz, to_hz| {
        let squares: f64 = runs.iter().map(|run| band_rms(run, SLOW_HZ, from_hz..to_hz).powi(2)).sum();
        (squares / runs.len() as f64).sqrt()
    };
    let runs =
        |speed_m_per_s| -> Vec<Vec<f64>> { (1..=4).map(|seed| natural_n(config, seed, speed_m_per_s, 33)).collect() };
    let measured = runs(0.04);
    let measured_n = rms_n(&measured, 10.0, 1000.0);
    assert!((measured_n / 4.5e-3 - 1.0).abs() < 0.05, "{measured_n}");
    // 1/f: the same power in every octave, until the relaxation length takes it away at 550 Hz.
    let octaves_n = [10.0, 20.0, 40.0, 80.0, 160.0].map(|hz| rms_n(&measured, hz, 2.0 * hz));
    let mean_n = octaves_n.iter().sum::<f64>() / octaves_n.len() as f64;
    assert!(octaves_n.iter().all(|octave_n| (octave_n / mean_n - 1.0).abs() < 0.2), "{octaves_n:?}");
    // At other speeds the same, in time.
    for speed_m_per_s in [0.1, 0.2] {
        let octave_n = rms_n(&runs(speed_m_per_s), 40.0, 80.0);
        assert!((octave_n / mean_n - 1.0).abs() < 0.25, "{octave_n}, {mean_n}");
    }
}

#[test]
fn a_still_finger_has_no_noise_and_a_fast_one_only_finite_noise() {
    let config = with(|config| config.noise_rms_n = 4.5e-3);
    let still_n = natural_n(config, 1, 0.0, 1);
    assert!(still_n.iter().all(|friction_n| *friction_n == still_n[0]));
    assert!(natural_n(config, 1, 10.0, 1).iter().all(|friction_n| (friction_n - 0.25).abs() < 0.1));
}

#[test]
fn friction_follows_the_load_and_the_coefficients_power_law() {
    for (exponent, expected_n) in [(0.0, 0.3), (-0.3, 0.3 * 1.2_f64.powf(-0.3)), (0.5, 0.3 * 1.2_f64.powf(0.5))] {
        let config = with(|config| config.load_exponent = exponent);
        let mut slide = Slide::new(config, 1);
        let last = (0..4000).map(|_| slide.tick_under(2500.0, 0.1, Some(0.6))).last().unwrap();
        assert!((last.natural_friction_n - expected_n).abs() < 1e-12, "{exponent}: {last:?}");
        let profile = example_finger().unwrap();
        let loaded_n = profile.contact().under_load(0.6).unwrap().electric_friction_n(50.0);
        let electric_n = loaded_n * expected_n / 0.3;
        assert!((last.electric_friction_n - electric_n).abs() < 1e-12, "{exponent}: {last:?}");
        // What a reference of the profile's load is multiplied by.
        let gain = electric_n / profile.electric_friction_n(50.0);
        assert!((last.slip.electric_gain / gain - 1.0).abs() < 1e-9, "{exponent}: {last:?}");
    }
}

#[test]
fn a_finger_that_makes_no_sense_is_refused_by_name() {
    let refused =
        |config| Fingertip::new(config, example_finger().unwrap().into(), TICK_HZ, 1).unwrap_err().to_string();
    for (config, message) in [
        (with(|config| config.relaxation_length_m = -1.0), "finger relaxation_length_m must be from 0 to 10, found -1"),
        (with(|config| config.load_sd_n = f64::NAN), "finger load_sd_n must be from 0 to 10, found NaN"),
        (with(|config| config.load_exponent = 3.0), "finger load_exponent must be from -2 to 2, found 3"),
        (with(|config| config.noise_rms_n = 11.0), "finger noise_rms_n must be from 0 to 10, found 11"),
        (with(|config| config.leakage_hz = -1.0), "finger leakage_hz must be from 0 to 10,000, found -1"),
    ] {
        assert_eq!(refused(config), message);
    }
}
