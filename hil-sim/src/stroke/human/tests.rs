use super::super::{FingerState, Stroke};
use super::*;

/// Statistics of recorded strokes of a median speed: medians over the strokes.
struct Recorded {
    median_m_per_s: f64,
    duration_s: f64,
    /// Least and largest of the two reconstructions.
    fast_over_median: [f64; 2],
    /// Quartiles of the acceleration below 8 Hz, m/s^2, smooth and rough.
    smooth_m_per_s2: [f64; 2],
    rough_m_per_s2: [f64; 2],
}

const RECORDED: [Recorded; 4] = [
    Recorded {
        median_m_per_s: 0.05,
        duration_s: 1.03,
        fast_over_median: [2.3, 2.3],
        smooth_m_per_s2: [0.53, 0.67],
        rough_m_per_s2: [1.0, 1.6],
    },
    Recorded {
        median_m_per_s: 0.1,
        duration_s: 0.68,
        fast_over_median: [1.6, 1.8],
        smooth_m_per_s2: [0.66, 0.95],
        rough_m_per_s2: [1.2, 2.7],
    },
    Recorded {
        median_m_per_s: 0.2,
        duration_s: 0.80,
        fast_over_median: [1.5, 1.8],
        smooth_m_per_s2: [1.09, 1.59],
        rough_m_per_s2: [6.0, 10.7],
    },
    Recorded {
        median_m_per_s: 0.34,
        duration_s: 0.58,
        fast_over_median: [1.5, 1.6],
        smooth_m_per_s2: [1.80, 2.43],
        rough_m_per_s2: [4.4, 9.9],
    },
];
/// A screen on which few touches meet an edge.
const LARGE_M: [f64; 2] = [0.24, 0.15];
/// The screen of the example scenes.
const SMALL_M: [f64; 2] = [0.12, 0.08];
const SEEDS: usize = 24;
const SECONDS: f64 = 12.0;

/// Touches of a seed: the finger at every millisecond. The last one may be cut.
fn touches(
    reconstruction: Reconstruction,
    [width_m, height_m]: [f64; 2],
    median_m_per_s: Option<f64>,
    seed: u64,
) -> Vec<Vec<FingerState>> {
    let make = if reconstruction == Reconstruction::Smooth { Stroke::human } else { Stroke::human_rough };
    let stroke = make(width_m, height_m, SECONDS, median_m_per_s, seed).unwrap();
    let fingers: Vec<Option<FingerState>> =
        (0..(1e3 * SECONDS) as u32).map(|ms| stroke.at(1e-3 * (f64::from(ms) + 0.5))).collect();
    let touches = fingers.split(Option::is_none).filter(|touch| touch.len() > 10);
    touches.map(|touch| touch.iter().flatten().copied().collect()).collect()
}

/// The quantile `part` of the values.
fn quantile(mut values: Vec<f64>, part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[(part * (values.len() - 1) as f64) as usize]
}

fn speed_quantile(touch: &[FingerState], part: f64) -> f64 {
    quantile(touch.iter().map(|state| state.speed_m_per_s).collect(), part)
}

/// Root mean square of the acceleration of a touch below 8 Hz, from the Fourier coefficients over the touch.
fn acceleration_below_8_hz(touch: &[FingerState]) -> f64 {
    let per_s2 = 1.0 / (ROW_S * ROW_S);
    let accelerations: Vec<[f64; 2]> = touch
        .windows(3)
        .map(|states| {
            let second = |m: fn(&FingerState) -> f64| (m(&states[2]) - 2.0 * m(&states[1]) + m(&states[0])) * per_s2;
            [second(|state| state.x_m), second(|state| state.y_m)]
        })
        .collect();
    let count = accelerations.len() as f64;
    let bins = (8.0 * count * ROW_S) as u32;
    let power = |bin: u32, axis: usize| {
        let (mut re, mut im) = (0.0, 0.0);
        for (index, acceleration) in accelerations.iter().enumerate() {
            let angle = TAU * f64::from(bin) * index as f64 / count;
            re += acceleration[axis] * libm::cos(angle);
            im += acceleration[axis] * libm::sin(angle);
        }
        (if bin == 0 { 1.0 } else { 2.0 }) * (re * re + im * im) / (count * count)
    };
    (0..=bins).map(|bin| power(bin, 0) + power(bin, 1)).sum::<f64>().sqrt()
}

/// Statistics of the touches of many seeds: medians over the touches.
struct Found {
    median_m_per_s: f64,
    duration_s: f64,
    fast_over_median: f64,
    acceleration_m_per_s2: f64,
}

fn found(reconstruction: Reconstruction, median_m_per_s: f64) -> Found {
    let whole = |seed| {
        let mut touches = touches(reconstruction, LARGE_M, Some(median_m_per_s), seed);
        touches.pop();
        touches
    };
    let touches: Vec<Vec<FingerState>> = HUMAN_TEST_SEEDS.take(SEEDS).flat_map(whole).collect();
    let median =
        |value: &dyn Fn(&[FingerState]) -> f64| quantile(touches.iter().map(|touch| value(touch)).collect(), 0.5);
    Found {
        median_m_per_s: median(&|touch| speed_quantile(touch, 0.5)),
        duration_s: median(&|touch| ROW_S * touch.len() as f64),
        fast_over_median: median(&|touch| speed_quantile(touch, 0.95) / speed_quantile(touch, 0.5)),
        acceleration_m_per_s2: median(&acceleration_below_8_hz),
    }
}

/// Checks the medians of touches against the recorded ones. The recordings have no quartiles of speed percentiles and
/// durations, so a tolerance of a tenth of the recorded range is allowed.
fn check(reconstruction: Reconstruction, recorded: &Recorded) {
    let Recorded { median_m_per_s, duration_s, fast_over_median: [least, most], .. } = *recorded;
    let found = found(reconstruction, median_m_per_s);
    let [lower, upper] =
        if reconstruction == Reconstruction::Smooth { recorded.smooth_m_per_s2 } else { recorded.rough_m_per_s2 };
    let line = format!(
        "{reconstruction:?} at {median_m_per_s} m/s: median {:.3}, {:.2} m/s^2, 95 % {:.2}, {:.2} s",
        found.median_m_per_s, found.acceleration_m_per_s2, found.fast_over_median, found.duration_s
    );
    println!("{line}");
    assert!((found.median_m_per_s / median_m_per_s - 1.0).abs() < 0.05, "{line}");
    assert!((lower..=upper).contains(&found.acceleration_m_per_s2), "{line}");
    assert!((0.9 * least..=1.1 * most).contains(&found.fast_over_median), "{line}");
    assert!((0.9..1.1).contains(&(found.duration_s / duration_s)), "{line}");
}

#[test]
fn touches_have_the_statistics_of_recorded_ones() {
    for reconstruction in [Reconstruction::Smooth, Reconstruction::Rough] {
        for recorded in &RECORDED {
            check(reconstruction, recorded);
        }
    }
}

#[test]
fn people_have_the_median_speeds_of_the_recorded_ones() {
    let median = |seed| speed_quantile(&touches(Reconstruction::Smooth, LARGE_M, None, seed).concat(), 0.5);
    let medians: Vec<f64> = HUMAN_TEST_SEEDS.take(60).map(median).collect();
    let (least, most) = medians.iter().fold((f64::MAX, 0.0_f64), |(a, b), median| (a.min(*median), b.max(*median)));
    assert!(least > 0.9 * 0.048 && least < 0.070, "{least}");
    assert!(most < 1.1 * 0.436 && most > 0.35, "{most}");
}

#[test]
fn touches_land_and_lift_within_the_screen_and_few_turn() {
    let [width_m, height_m] = SMALL_M;
    for reconstruction in [Reconstruction::Smooth, Reconstruction::Rough] {
        for median_m_per_s in [0.05, 0.1, 0.2, 0.4] {
            let touches: Vec<Vec<FingerState>> = HUMAN_TEST_SEEDS
                .take(SEEDS)
                .flat_map(|seed| touches(reconstruction, SMALL_M, Some(median_m_per_s), seed))
                .collect();
            let mut states = touches.iter().flatten();
            assert!(states.all(|at| at.x_m > 0.0 && at.x_m < width_m && at.y_m > 0.0 && at.y_m < height_m));
            let per_s = touches.len() as f64 / (SEEDS as f64 * SECONDS);
            assert!(per_s > 0.5 && per_s < 2.5, "{per_s} touches a second at {median_m_per_s}");
            let starts = touches.iter().map(|touch| touch[0]);
            let left = starts.filter(|start| start.x_m < 0.5 * width_m).count() as f64 / touches.len() as f64;
            assert!((0.35..0.65).contains(&left), "{left} of the touches land on the left at {median_m_per_s}");
        }
    }
    let turned = |touch: &&Vec<FingerState>| {
        let way_m: f64 = touch.iter().map(|state| ROW_S * state.speed_m_per_s).sum();
        let (first, last) = (touch[0], touch[touch.len() - 1]);
        libm::hypot(last.x_m - first.x_m, last.y_m - first.y_m) < 0.7 * way_m
    };
    let touches: Vec<Vec<FingerState>> = HUMAN_TEST_SEEDS
        .take(SEEDS)
        .flat_map(|seed| touches(Reconstruction::Smooth, SMALL_M, Some(0.1), seed))
        .collect();
    let share = touches.iter().filter(turned).count() as f64 / touches.len() as f64;
    assert!((0.03..0.15).contains(&share), "{share} of the touches turn");
}

#[test]
fn people_have_tremor_at_8_to_12_hz() {
    let mut random = Random::new(3, Purpose::HumanStroke);
    let wave = Wave::drawn(&mut random, TREMOR_HZ);
    assert!(wave.sines.iter().all(|(hz, _)| (8.0..12.0).contains(hz)));
    let mean_square = (0..30_000).map(|ms| wave.at(1e-3 * f64::from(ms)).powi(2)).sum::<f64>() / 30_000.0;
    assert!((mean_square - 1.0).abs() < 0.1, "{mean_square}");
    // At the slowest, the finger trembles more than it wanders.
    let accelerations = |reconstruction| acceleration_from_8_hz(&touches(reconstruction, LARGE_M, Some(0.02), 1)[0]);
    // 2 axes of 0.1 mm at about 10 Hz.
    let expected = 2.0_f64.sqrt() * TREMOR_RMS_M * (TAU * 10.0).powi(2);
    assert!(
        (accelerations(Reconstruction::Smooth) / expected - 1.0).abs() < 0.4,
        "{}, {expected}",
        accelerations(Reconstruction::Smooth)
    );
}

fn acceleration_from_8_hz(touch: &[FingerState]) -> f64 {
    let per_s2 = 1.0 / (ROW_S * ROW_S);
    let total = touch.windows(3).map(|states| {
        let second = |m: fn(&FingerState) -> f64| (m(&states[2]) - 2.0 * m(&states[1]) + m(&states[0])) * per_s2;
        second(|state| state.x_m).powi(2) + second(|state| state.y_m).powi(2)
    });
    let count = (touch.len() - 2) as f64;
    (total.sum::<f64>() / count - acceleration_below_8_hz(touch).powi(2)).sqrt()
}

#[test]
fn a_human_stroke_comes_from_its_seed_and_has_the_speed_of_its_places() {
    let stroke = |seed| Stroke::human(0.12, 0.08, 5.0, Some(0.1), seed).unwrap();
    let at = |seed, t_s| stroke(seed).at(t_s).unwrap();
    assert_eq!(at(1, 0.234), at(1, 0.234));
    assert_ne!(at(1, 0.234), at(2, 0.234));
    let (before, after) = (at(1, 0.234_2), at(1, 0.234_7));
    let way_m = libm::hypot(after.x_m - before.x_m, after.y_m - before.y_m);
    assert!((way_m / 0.5e-3 - before.speed_m_per_s).abs() < 1e-9);
    assert!((stroke(1).duration_s() - 5.0).abs() < 1e-9, "{}", stroke(1).duration_s());
    let message = |duration_s, median| Stroke::human(0.12, 0.08, duration_s, median, 1).unwrap_err().to_string();
    assert_eq!(
        message(601.0, None),
        "stroke: duration_s must be above 0.001 and at most 600 for a human stroke, found 601"
    );
    assert_eq!(message(1.0, Some(-0.1)), "stroke: median speed in m/s must be finite and above 0, found -0.1");
    assert_eq!(message(1.0, Some(10.5)), "stroke: median speed in m/s must be at most 10, found 10.5");
}
