//! The largest electric friction of a scene.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use frixel_layers::{
    Blend, Button, Click, Edge, Grating, Layer, Point, Record, Region, Speed, Stream, Wave, electric_friction_max_n,
};
use frixel_testkit::{HEADER, constant, record};

fn largest_n(records: &[Record], points: &[Point]) -> f32 {
    electric_friction_max_n(&HEADER, records, points).unwrap()
}

/// Asserts that the friction stored in the header is at most 1 % above the bound, and never below it.
#[track_caller]
fn assert_largest(records: &[Record], expected_n: f32) {
    let found_n = largest_n(records, &[]);
    assert!(found_n >= expected_n && found_n <= 1.01 * expected_n, "{found_n} for {expected_n}");
}

#[test]
fn a_scene_that_asks_for_nothing_has_the_bound_zero() {
    assert_eq!(largest_n(&[], &[]).to_bits(), 0);
    assert!(largest_n(&[constant(-0.02)], &[]) <= 0.0);
}

#[test]
fn layers_count_as_they_are_blended() {
    let over = |blend, gain, friction_n| Record { blend, gain, ..constant(friction_n) };
    for (above, both_n) in [
        (over(Blend::Replace, 1.0, 0.004), 0.004),
        (over(Blend::Add, 1.0, 0.006), 0.016),
        (over(Blend::Add, -1.0, 0.006), 0.004),
        (over(Blend::Multiply, 0.5, 0.5), 0.0025),
        (over(Blend::Max, 2.0, 0.01), 0.02),
        (over(Blend::Max, 1.0, 0.001), 0.01),
    ] {
        assert_largest(&[constant(0.01), above], both_n);
        let part = Record { region: Region::Rectangle { x_m: 0.0, y_m: 0.0, width_m: 0.01, height_m: 0.01 }, ..above };
        assert_largest(&[constant(0.01), part], both_n.max(0.01));
    }
}

#[test]
fn layers_side_by_side_do_not_add_up() {
    let beside = |x_m| Record {
        region: Region::Rectangle { x_m, y_m: 0.0, width_m: 0.01, height_m: 0.1 },
        blend: Blend::Add,
        ..constant(0.006)
    };
    assert_largest(&[beside(0.01), beside(0.03), beside(0.05)], 0.006);
}

#[test]
fn an_ellipse_leaves_the_corners_of_its_rectangle() {
    let region =
        Region::Ellipse { x_m: 0.0, y_m: 0.0, width_m: HEADER.screen_width_m, height_m: HEADER.screen_height_m };
    assert_largest(&[constant(0.01), Record { region, ..constant(0.002) }], 0.01);
}

#[test]
fn a_click_comes_on_top() {
    let click = Click { height_n: 0.004, decay_s: 0.02 };
    let edge = Edge { x_m: 0.05, y_m: 0.05, angle_turns: 0.0, width_m: 0.01, level_n: 0.0, ridge_n: 0.006, click };
    assert_largest(&[record(Layer::Edge(edge))], 0.01);
    let button = Button { rim_width_m: 1e-3, rim_n: 0.006, face_n: 0.001, click };
    let region = Region::Rectangle { x_m: 0.0, y_m: 0.0, width_m: 0.01, height_m: 0.01 };
    assert_largest(&[Record { region, ..record(Layer::Button(button)) }], 0.01);
}

/// A stream stays within its two numbers, and may be absent.
#[test]
fn a_stream_comes_and_goes() {
    let stream = record(Layer::Stream(Stream { low_n: 0.002, high_n: 0.006 }));
    assert_largest(&[constant(0.003), stream], 0.006);
    assert_largest(&[constant(0.01), stream], 0.01);
}

#[test]
fn a_curve_counts_by_its_largest_point() {
    let points = [(9.0, 9.0), (0.0, 0.5), (0.1, 2.0), (0.2, 1.0)].map(|(x, y)| Point { x, y });
    let curve = Record { blend: Blend::Multiply, ..record(Layer::Speed(Speed { first: 1, count: 3 })) };
    let found_n = largest_n(&[constant(0.01), curve], &points);
    assert!((0.02..0.0202).contains(&found_n), "{found_n}");
}

#[test]
fn unbounded_parameters_give_no_bound() {
    let grating = Grating {
        wave: Wave::Sine,
        cycles_per_m_x: 0.0,
        cycles_per_m_y: 0.0,
        phase_turns: 0.0,
        trough_n: f32::NEG_INFINITY,
        crest_n: f32::INFINITY,
        drift_hz: 0.0,
    };
    let endless = record(Layer::Grating(grating));
    assert_eq!(electric_friction_max_n(&HEADER, &[endless], &[]), None);
    let huge = constant(f32::MAX);
    assert_eq!(electric_friction_max_n(&HEADER, &[huge, Record { blend: Blend::Add, ..huge }], &[]), None);
}
