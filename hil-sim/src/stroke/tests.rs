#![allow(clippy::float_cmp, reason = "what has to be exact is tested as exact")]

use proptest::prelude::*;

use super::{FingerState, Point, Stroke, StrokeError};

const LEFT: Point = Point { x_m: 0.01, y_m: 0.02 };
const RIGHT: Point = Point { x_m: 0.09, y_m: 0.08 };
/// Between `LEFT` and `RIGHT`.
const LENGTH_M: f64 = 0.1;

fn at(stroke: &Stroke, t_s: f64) -> FingerState {
    stroke.at(t_s).unwrap_or_else(|| panic!("finger up at {t_s} s"))
}

fn distance_m(a: FingerState, b: FingerState) -> f64 {
    libm::hypot(a.x_m - b.x_m, a.y_m - b.y_m)
}

fn assert_close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "{found}, expected {expected}");
}

/// Asserts that the reported speed is the distance covered over the time it takes, and that the speed never jumps.
fn assert_speed_is_the_rate_of_the_place(stroke: &Stroke, from_s: f64, to_s: f64) {
    const STEPS: u32 = 20_000;
    let step_s = (to_s - from_s) / f64::from(STEPS);
    let mut fastest: f64 = 0.0;
    for step in 1..STEPS {
        let t_s = from_s + step_s * f64::from(step);
        let (before, now, after) = (at(stroke, t_s - 0.5 * step_s), at(stroke, t_s), at(stroke, t_s + 0.5 * step_s));
        let found = distance_m(before, after) / step_s;
        fastest = fastest.max(found);
        assert!((found - now.speed_m_per_s).abs() < 2e-4, "{found} against {} at {t_s} s", now.speed_m_per_s);
    }
    assert!(fastest > 0.05, "nothing moved");
}

#[test]
fn the_finger_is_up_before_the_start_and_after_the_end() {
    let stroke = Stroke::constant_speed(LEFT, RIGHT, 0.1).unwrap();
    let rows = Stroke::through(&[(0.5, Some(LEFT)), (1.0, Some(RIGHT))]).unwrap();
    for (stroke, times_s) in [(&stroke, [-1e-9, 1.000_001]), (&rows, [0.499_999, 1.000_001])] {
        for t_s in times_s {
            assert_eq!(stroke.at(t_s), None);
        }
        assert_eq!(stroke.at(f64::NAN), None);
    }
}

#[test]
fn minimum_jerk_rests_at_its_ends_and_is_fastest_in_the_middle() {
    let duration_s = 0.8;
    let stroke = Stroke::minimum_jerk(LEFT, RIGHT, duration_s).unwrap();
    for (t_s, place, speed_m_per_s) in
        [(0.0, LEFT, 0.0), (0.4, Point { x_m: 0.05, y_m: 0.05 }, 1.875 * LENGTH_M / duration_s), (0.8, RIGHT, 0.0)]
    {
        let state = at(&stroke, t_s);
        assert_close(state.x_m, place.x_m);
        assert_close(state.y_m, place.y_m);
        assert_close(state.speed_m_per_s, speed_m_per_s);
    }
    let fastest = (0..=1000).map(|ms| at(&stroke, 0.0008 * f64::from(ms)).speed_m_per_s).fold(0.0, f64::max);
    assert_close(fastest, 1.875 * LENGTH_M / duration_s);
    assert_speed_is_the_rate_of_the_place(&stroke, 0.0, duration_s);
}

#[test]
fn a_loop_repeats_with_a_pause_for_ever() {
    let stroke = Stroke::constant_speed(LEFT, RIGHT, 0.1).unwrap().looped(0.25).unwrap();
    assert_eq!(stroke.duration_s(), f64::INFINITY);
    for round in [0.0, 1.0, 1e6] {
        let start_s = 1.25 * round;
        assert!(
            distance_m(at(&stroke, start_s + 0.5), FingerState { x_m: 0.05, y_m: 0.05, speed_m_per_s: 0.1 }) < 1e-9
        );
        assert_eq!(stroke.at(start_s + 1.1), None);
    }
    assert_eq!(stroke.at(-0.1), None);
    let error = Stroke::still(LEFT, 1.0).unwrap().looped(-1.0).unwrap_err();
    assert_eq!(error.to_string(), "stroke: pause_s must be from 0 to 10, found -1");
}

#[test]
fn a_sweep_explores_the_screen() {
    let (width_m, height_m, duration_s) = (0.1, 0.06, 30.0);
    let stroke = Stroke::sweep(width_m, height_m, duration_s).unwrap();
    assert_speed_is_the_rate_of_the_place(&stroke, 0.0, duration_s);
    let states: Vec<_> = (0..=30_000).map(|ms| at(&stroke, 1e-3 * f64::from(ms))).collect();
    let least = |value: fn(&FingerState) -> f64| states.iter().map(value).fold(f64::INFINITY, f64::min);
    let most = |value: fn(&FingerState) -> f64| states.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
    assert_close(least(|state| state.x_m), 0.01);
    assert_close(least(|state| state.y_m), 0.006);
    assert!((most(|state| state.x_m) - 0.09).abs() < 1e-6);
    assert!((most(|state| state.y_m) - 0.054).abs() < 1e-6);
    let mean_m_per_s = states.iter().map(|state| state.speed_m_per_s).sum::<f64>() / states.len() as f64;
    assert!((mean_m_per_s - 0.1).abs() < 0.005, "{mean_m_per_s}");
    // Slightly oblique: more than a degree, less than eleven.
    for pair in states.windows(2) {
        let (dx, dy) = ((pair[1].x_m - pair[0].x_m).abs(), (pair[1].y_m - pair[0].y_m).abs());
        if dx > 1e-5 {
            assert!(dy / dx > 0.02 && dy / dx < 0.19, "{}", dy / dx);
        }
    }
}

proptest! {
    #[test]
    fn a_sweep_stays_on_any_screen_at_a_human_pace_for_any_time(
        width_m in 0.01..1.0_f64,
        height_m in 0.01..1.0_f64,
        duration_s in prop_oneof![0.001..1.0_f64, 1.0..1e5_f64],
    ) {
        let stroke = Stroke::sweep(width_m, height_m, duration_s).unwrap();
        prop_assert_eq!(stroke.duration_s(), duration_s);
        for step in 0..=500 {
            let state = at(&stroke, duration_s * (f64::from(step) / 500.0));
            prop_assert!(state.x_m > 0.09 * width_m && state.x_m < 0.91 * width_m);
            prop_assert!(state.y_m > 0.09 * height_m && state.y_m < 0.91 * height_m);
            prop_assert!(state.speed_m_per_s <= 1.875 * 0.134, "{}", state.speed_m_per_s);
        }
        let end = at(&stroke, duration_s);
        prop_assert!(end.speed_m_per_s < 1e-6);
    }

    /// Linear interpolation, found by looking through all rows instead of by slot.
    #[test]
    fn rows_are_joined_by_straight_lines(
        rows in prop::collection::vec((1e-4..1.0_f64, -10.0..10.0_f64, -10.0..10.0_f64), 2..40),
        // Skewed, so that many rows crowd into one slot.
        power in 1..6_i32,
        share in 0.0..1.0_f64,
    ) {
        let mut t_s = 0.0;
        let rows: Vec<_> = rows.into_iter().map(|(step_s, x_mm, y_mm)| {
            t_s += step_s.powi(power) + 1e-6;
            (t_s, x_mm, y_mm)
        }).collect();
        let place = |(t_s, x_mm, y_mm): &(f64, f64, f64)| (*t_s, Some(Point { x_m: 1e-3 * x_mm, y_m: 1e-3 * y_mm }));
        let stroke = Stroke::through(&rows.iter().map(place).collect::<Vec<_>>()).unwrap();
        prop_assert_eq!(stroke.duration_s(), t_s);
        for pair in rows.windows(2) {
            let ((t0, x0, y0), (t1, x1, y1)) = (pair[0], pair[1]);
            let state = at(&stroke, t0 + share * (t1 - t0));
            prop_assert!((state.x_m - 1e-3 * (x0 + share * (x1 - x0))).abs() < 1e-9);
            prop_assert!((state.y_m - 1e-3 * (y0 + share * (y1 - y0))).abs() < 1e-9);
            let speed_m_per_s = 1e-3 * libm::hypot(x1 - x0, y1 - y0) / (t1 - t0);
            prop_assert!((at(&stroke, t0).speed_m_per_s - speed_m_per_s).abs() <= 1e-9 * speed_m_per_s);
        }
    }
}

#[test]
fn numbers_that_make_no_stroke_are_refused_by_name() {
    let message = |result: Result<Stroke, StrokeError>| result.unwrap_err().to_string();
    assert_eq!(
        message(Stroke::constant_speed(LEFT, RIGHT, 0.0)),
        "stroke: speed_m_per_s must be finite and above 0, found 0"
    );
    assert_eq!(
        message(Stroke::constant_speed(LEFT, LEFT, 0.1)),
        "stroke: length of the stroke in m must be finite and above 0, found 0"
    );
    assert_eq!(
        message(Stroke::minimum_jerk(LEFT, Point { x_m: f64::NAN, y_m: 0.0 }, 1.0)),
        "stroke: length of the stroke in m must be finite, found NaN"
    );
    assert_eq!(
        message(Stroke::minimum_jerk(LEFT, RIGHT, f64::INFINITY)),
        "stroke: duration_s must be finite and above 0, found inf"
    );
    assert_eq!(
        message(Stroke::sweep(0.1, -0.1, 1.0)),
        "stroke: screen height in m must be finite and above 0, found -0.1"
    );
}

#[test]
fn a_motion_goes_through_its_places() {
    let place = |x_m: f64| Some(Point { x_m, y_m: 0.02 });
    let stroke =
        Stroke::through(&[(0.0, place(0.0)), (0.5, place(0.1)), (0.6, None), (0.7, place(0.0)), (1.0, place(0.03))])
            .unwrap();
    assert!((stroke.at(0.25).unwrap().x_m - 0.05).abs() < 1e-12);
    assert!(stroke.at(0.55).is_none() && stroke.at(0.65).is_none());
    assert!((stroke.at(0.9).unwrap().speed_m_per_s - 0.1).abs() < 1e-12);
    for wrong in [[(0.0, place(0.0)), (0.0, place(0.1))], [(-1.0, place(0.0)), (0.0, place(0.1))]] {
        assert!(Stroke::through(&wrong).unwrap_err().to_string().contains("0 or later, and rising"));
    }
}
