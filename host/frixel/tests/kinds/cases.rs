//! One scene for each form of a layer, each region and each blend, with its expected friction.

use frixel_testkit::samples::{Formula, along_deg, samples, sine, turn};

use super::expected::{At, Expected, hill};

/// A finger's way over the screen, mm.
#[derive(Clone, Copy)]
pub enum Path {
    /// At 100 mm/s.
    Steady((f64, f64), (f64, f64)),
    /// Minimum jerk in 1.2 s.
    Person((f64, f64), (f64, f64)),
}

pub struct Case {
    pub name: &'static str,
    pub layers: &'static str,
    pub path: Path,
    /// Electric friction at a place in mm, mN, where nothing else plays a part.
    pub of_place: Option<fn(f64, f64) -> f64>,
    /// Electric friction, mN; not used for a case with a friction of the place.
    pub expected: fn(&mut Expected, At) -> f64,
    /// How far the library's evaluation may be away, mN: it begins with frictions rounded to `f32`.
    pub agreement_mn: f64,
    /// It jumps, so that places and times that round may lie on the other side.
    pub jumps: bool,
    /// How far what is felt may be away, as a part of the reachable range.
    pub bound: f64,
    /// Ticks after which the scene repeats itself; 1 where time plays no part.
    pub repeats_after_ticks: usize,
}

const ACROSS: Path = Path::Steady((5.0, 30.0), (115.0, 45.0));

const CASE: Case = Case {
    name: "",
    layers: "",
    path: ACROSS,
    of_place: None,
    expected: |_, _| 0.0,
    agreement_mn: 2e-4,
    jumps: false,
    bound: 0.0,
    repeats_after_ticks: 1,
};

pub fn all() -> Vec<Case> {
    [of_samples(), pictures(), borders(), in_time(), regions(), blends()].into_iter().flatten().collect()
}

/// The formulas of the samples, of kinds whose friction depends on the place alone.
fn of_samples() -> Vec<Case> {
    let case = |formula: &Formula| {
        let &Formula { name, toml: layers, stroke_mm: [from, to], friction_mn, jumps, bound } = formula;
        Case { name, layers, path: Path::Steady(from, to), of_place: Some(friction_mn), jumps, bound, ..CASE }
    };
    samples().flat_map(|sample| sample.formulas).map(case).collect()
}

fn pictures() -> Vec<Case> {
    vec![
        Case {
            name: "bitmap, held",
            layers: "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 40\ny_mm = 10\n\
                     width_mm = 40\n\
                     pitch_mm = 2\nblack_n = 0.026\nwhite_n = 0.002\n\
                     region = { x_mm = 20, y_mm = 0, width_mm = 80, height_mm = 80 }",
            expected: |scene, at| {
                let level = scene.level((at.x - 40.0) / 2.0, (at.y - 10.0) / 2.0, false);
                if (20.0..100.0).contains(&at.x) { 26.0 - 24.0 * level } else { 0.0 }
            },
            jumps: true,
            bound: 0.0169,
            ..CASE
        },
        Case {
            name: "bitmap, bare glass to the most",
            layers: "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\npitch_mm = 2\n\
                     region = { x_mm = 0, y_mm = 0, width_mm = 120, height_mm = 80 }",
            expected: |scene, at| scene.range * scene.level(at.x / 2.0, at.y / 2.0, false),
            bound: 0.0069,
            ..CASE
        },
        Case {
            name: "bitmap, tiled and turned",
            layers: "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 20\ny_mm = 0\n\
                     width_mm = 61\nheight_mm = 66\n\
                     pitch_mm = 2\nangle_deg = 20\ntiled = true\nwhite_n = 0.026",
            expected: |scene, at| {
                // 31 (30.5, rounded) by 33 samples, turned about the middle.
                let (x, y) = (at.x - 50.5, at.y - 33.0);
                let (u, v) = (along_deg(x, y, 20.0) + 30.5, along_deg(x, y, 110.0) + 33.0);
                26.0 * scene.level(u / 61.0 * 31.0, v / 2.0, true)
            },
            bound: 0.0044,
            ..CASE
        },
        Case {
            name: "bitmap, turned",
            layers: "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 35\ny_mm = 15\n\
                     width_mm = 50\nheight_mm = 50\n\
                     pitch_mm = 2\nangle_deg = -15\nwhite_n = 0.026",
            expected: |scene, at| {
                let (x, y) = (at.x - 60.0, at.y - 40.0);
                let (u, v) = (along_deg(x, y, -15.0) + 25.0, along_deg(x, y, 75.0) + 25.0);
                let inside = (0.0..50.0).contains(&u) && (0.0..50.0).contains(&v);
                if inside { 26.0 * scene.level(u / 2.0, v / 2.0, false) } else { 0.0 }
            },
            jumps: true,
            bound: 0.0147,
            ..CASE
        },
    ]
}

fn borders() -> Vec<Case> {
    vec![
        Case {
            name: "edge",
            layers: "[[layer]]\nkind = \"edge\"\nx_mm = 60\ny_mm = 40\nangle_deg = 20\nwidth_mm = 12\n\
                     ridge_n = 0.015\nclick_n = 0.01\nclick_ms = 60",
            expected: |scene, at| {
                let away = along_deg(at.x - 60.0, at.y - 40.0, 20.0);
                15.0 * hill(away, 12.0) + scene.click_on_change(away >= 0.0, at, 10.0, 0.06)
            },
            bound: 0.005,
            ..CASE
        },
        Case {
            name: "edge, a well",
            layers: "[[layer]]\nkind = \"constant\"\nabove = \"natural\"\nfriction_n = 0.02\n[[layer]]\n\
                     kind = \"edge\"\nx_mm = 50\ny_mm = 0\nwidth_mm = 20\nridge_n = -0.015",
            expected: |_, at| 20.0 - 15.0 * hill(at.x - 50.0, 20.0),
            bound: 0.0033,
            ..CASE
        },
        Case {
            name: "button, rectangle",
            layers: "[[layer]]\nkind = \"button\"\nrim_width_mm = 8\nrim_n = 0.02\nface_n = 0.005\nclick_n = 0.006\n\
                     click_ms = 100\n\
                     region = { x_mm = 40, y_mm = 15, width_mm = 40, height_mm = 40 }",
            expected: |scene, at| {
                let depth = (20.0 - (at.x - 60.0).abs()).min(20.0 - (at.y - 35.0).abs());
                let inside = (40.0..80.0).contains(&at.x) && (15.0..55.0).contains(&at.y);
                let click = scene.click_on_entry(inside, at, 6.0, 0.1);
                if inside { 5.0 + 15.0 * hill(depth - 4.0, 8.0) + click } else { 0.0 }
            },
            bound: 0.0234,
            ..CASE
        },
        Case {
            name: "button, ellipse",
            layers: "[[layer]]\nkind = \"button\"\nrim_width_mm = 8\nrim_n = 0.02\nface_n = 0.005\n\
                     region = { shape = \"ellipse\", x_mm = 30, y_mm = 15, width_mm = 60, height_mm = 40 }",
            expected: |_, at| {
                let depth = 20.0 * (1.0 - (((at.x - 60.0) / 30.0).powi(2) + ((at.y - 35.0) / 20.0).powi(2)).sqrt());
                if depth >= 0.0 { 5.0 + 15.0 * hill(depth - 4.0, 8.0) } else { 0.0 }
            },
            bound: 0.0097,
            ..CASE
        },
    ]
}

fn in_time() -> Vec<Case> {
    vec![
        Case {
            name: "vibration",
            layers: "[[layer]]\nkind = \"vibration\"\nfrequency_hz = 80\nlow_n = 0.002\nhigh_n = 0.022",
            expected: |_, at| 2.0 + 20.0 * sine(80.0 * at.t),
            agreement_mn: 1e-3,
            bound: 0.0195,
            repeats_after_ticks: 500,
            ..CASE
        },
        Case {
            name: "vibration in bursts",
            layers: "[[layer]]\nkind = \"vibration\"\nfrequency_hz = 50\nlow_n = 0.002\nhigh_n = 0.022\n\
                     burst = { period_ms = 40, on_ms = 30, ramp_ms = 10 }",
            expected: |_, at| {
                let begun = turn(at.t / 0.04) * 0.04;
                let envelope = (begun.min(0.03 - begun) / 0.01).clamp(0.0, 1.0);
                2.0 + 20.0 * envelope * sine(50.0 * at.t)
            },
            agreement_mn: 1e-3,
            bound: 0.009,
            repeats_after_ticks: 1_600,
            ..CASE
        },
        Case {
            name: "square vibration",
            layers: "[[layer]]\nkind = \"vibration\"\nwave = \"square\"\nfrequency_hz = 50\nlow_n = 0.002\n\
                     high_n = 0.022",
            expected: |_, at| if turn(50.0 * at.t) < 0.5 { 22.0 } else { 2.0 },
            jumps: true,
            bound: 0.0452,
            repeats_after_ticks: 800,
            ..CASE
        },
        Case {
            // 20 waves a second, along the finger's way: it passes 20 waves less than of a grating at rest.
            name: "drifting grating",
            layers: "[[layer]]\nkind = \"grating\"\nwavelength_mm = 5\ndrift_mm_per_s = 100\nangle_deg = 30\n\
                     low_n = 0.002\nhigh_n = 0.022",
            expected: |_, at| 2.0 + 20.0 * sine((along_deg(at.x, at.y, 30.0) - 100.0 * at.t) / 5.0),
            agreement_mn: 1e-3,
            bound: 0.0415,
            repeats_after_ticks: 2_000,
            ..CASE
        },
        Case {
            name: "drifting rings, inwards",
            layers: "[[layer]]\nkind = \"rings\"\nx_mm = 50\ny_mm = 20\nwavelength_mm = 5\ndrift_mm_per_s = -50\n\
                     low_n = 0.002\nhigh_n = 0.022",
            expected: |_, at| 2.0 + 20.0 * sine(((at.x - 50.0).hypot(at.y - 20.0) + 50.0 * at.t) / 5.0),
            agreement_mn: 1e-3,
            bound: 0.0347,
            repeats_after_ticks: 4_000,
            ..CASE
        },
        Case {
            name: "speed",
            layers: "[[layer]]\nkind = \"constant\"\nabove = \"natural\"\nfriction_n = 0.02\n[[layer]]\n\
                     kind = \"speed\"\n\
                     speeds_mm_per_s = [20, 80, 140]\nfactors = [0.2, 1.2, 0.7]",
            path: Path::Person((5.0, 30.0), (115.0, 45.0)),
            expected: |_, at| {
                let factor = match at.speed {
                    speed if speed < 20.0 => 0.2,
                    speed if speed < 80.0 => 0.2 + (speed - 20.0) / 60.0,
                    speed if speed < 140.0 => 1.2 - 0.5 * (speed - 80.0) / 60.0,
                    _ => 0.7,
                };
                20.0 * factor
            },
            bound: 0.0531,
            ..CASE
        },
        Case {
            name: "direction",
            layers: "[[layer]]\nkind = \"direction\"\nangle_deg = 30\nalong_n = 0.024\nagainst_n = 0.002",
            path: Path::Person((5.0, 30.0), (115.0, 45.0)),
            expected: |_, at| 2.0 + 22.0 * part_along(110.0, 15.0, at.speed, 30.0),
            bound: 0.0275,
            ..CASE
        },
        Case {
            // The finger slides against the axis.
            name: "direction, one-way stripes",
            layers: "[[layer]]\nkind = \"grating\"\nwavelength_mm = 12\nlow_n = 0\nhigh_n = 0.024\n[[layer]]\n\
                     kind = \"direction\"\nblend = \"multiply\"\nangle_deg = -170\nalong_factor = 0.25\nagainst_factor = 1",
            path: Path::Person((5.0, 30.0), (115.0, 45.0)),
            expected: |_, at| 24.0 * sine(at.x / 12.0) * (1.0 - 0.75 * part_along(110.0, 15.0, at.speed, -170.0)),
            bound: 0.0266,
            ..CASE
        },
        Case {
            // Nothing is streamed: the layer is as if it were not there.
            name: "stream, silent",
            layers: "[[layer]]\nkind = \"constant\"\nabove = \"natural\"\nfriction_n = 0.012\n\
                     [[layer]]\nkind = \"stream\"\nlow_n = 0.002\nhigh_n = 0.022",
            expected: |_, _| 12.0,
            bound: 0.0006,
            ..CASE
        },
    ]
}

fn regions() -> Vec<Case> {
    vec![
        Case {
            name: "rectangle, fraction",
            layers: "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.75\n\
                     region = { x_mm = 30, y_mm = 20, width_mm = 50, height_mm = 30 }",
            expected: |scene, at| if (30.0..80.0).contains(&at.x) { 0.75 * scene.range } else { 0.0 },
            jumps: true,
            bound: 0.0172,
            ..CASE
        },
        Case {
            name: "ellipse",
            layers: "[[layer]]\nkind = \"constant\"\nabove = \"natural\"\nfriction_n = 0.02\n\
                     region = { shape = \"ellipse\", x_mm = 30, y_mm = 20, width_mm = 50, height_mm = 30 }",
            expected: |_, at| {
                let inside = ((at.x - 55.0) / 25.0).powi(2) + ((at.y - 35.0) / 15.0).powi(2) <= 1.0;
                if inside { 20.0 } else { 0.0 }
            },
            jumps: true,
            bound: 0.0122,
            ..CASE
        },
        Case {
            // The left part of a square of two polygons, which together under one finger would take too long.
            name: "polygon",
            layers: "[[layer]]\nkind = \"constant\"\nblend = \"add\"\nfriction_n = 0.02\n\
                     region = { shape = \"polygon\", points_mm = [[20, 10], [90, 10], [60, 40], [70, 70], [20, 70]] }",
            expected: |_, at| if (20.0..polygon_cut(at.y)).contains(&at.x) { 20.0 } else { 0.0 },
            jumps: true,
            bound: 0.0374,
            ..CASE
        },
        Case {
            // And the right part.
            name: "polygon beside it",
            layers: "[[layer]]\nkind = \"constant\"\nblend = \"add\"\nfriction_n = 0.01\n\
                     region = { shape = \"polygon\", points_mm = [[90, 10], [110, 10], [110, 70], [70, 70], \
                     [60, 40]] }",
            expected: |_, at| if (polygon_cut(at.y)..110.0).contains(&at.x) { 10.0 } else { 0.0 },
            jumps: true,
            bound: 0.0207,
            ..CASE
        },
    ]
}

fn blends() -> Vec<Case> {
    vec![
        Case {
            name: "add",
            layers: "[[layer]]\nkind = \"grating\"\nwavelength_mm = 12\nlow_n = 0\nhigh_n = 0.012\n\
                     [[layer]]\nkind = \"grating\"\nblend = \"add\"\nwavelength_mm = 7\nlow_n = 0\nhigh_n = 0.006\n\
                     gain = 2",
            expected: |_, at| 12.0 * sine(at.x / 12.0) + 12.0 * sine(at.x / 7.0),
            bound: 0.0214,
            ..CASE
        },
        Case {
            name: "replace",
            layers: "[[layer]]\nkind = \"constant\"\nfriction_n = 0.9\n\
                     [[layer]]\nkind = \"grating\"\nwavelength_mm = 12\nlow_n = 0\nhigh_n = 0.012",
            expected: |_, at| 12.0 * sine(at.x / 12.0),
            bound: 0.0111,
            ..CASE
        },
        Case {
            name: "multiply",
            layers: "[[layer]]\nkind = \"grating\"\nwavelength_mm = 12\nlow_n = 0.01\nhigh_n = 0.02\n\
                     [[layer]]\nkind = \"grating\"\nblend = \"multiply\"\nwavelength_mm = 30\nlow_factor = 0.5\n\
                     high_factor = 1.25\ngain = 1.1",
            expected: |_, at| (10.0 + 10.0 * sine(at.x / 12.0)) * 1.1 * (0.5 + 0.75 * sine(at.x / 30.0)),
            bound: 0.0106,
            ..CASE
        },
        Case {
            name: "multiply by an edge",
            layers: "[[layer]]\nkind = \"constant\"\nabove = \"natural\"\nfriction_n = 0.012\n\
                     [[layer]]\nkind = \"edge\"\nblend = \"multiply\"\nx_mm = 60\ny_mm = 0\nwidth_mm = 20\n\
                     ridge_factor = 2",
            expected: |_, at| 12.0 * (1.0 + hill(at.x - 60.0, 20.0)),
            bound: 0.0027,
            ..CASE
        },
        Case {
            name: "max",
            layers: "[[layer]]\nkind = \"constant\"\nabove = \"natural\"\nfriction_n = 0.012\n\
                     [[layer]]\nkind = \"grating\"\nblend = \"max\"\nwavelength_mm = 15\nlow_n = 0\nhigh_n = 0.024",
            expected: |_, at| (24.0 * sine(at.x / 15.0)).max(12.0),
            bound: 0.0119,
            ..CASE
        },
    ]
}

/// The weight from 0 to 1 of the friction along an axis, for a finger on a way over the screen, at a speed in mm/s.
fn part_along(right: f64, down: f64, speed: f64, axis_deg: f64) -> f64 {
    let cosine = along_deg(right, down, axis_deg) / right.hypot(down);
    0.5 + 0.5 * cosine * (speed / 20.0).min(1.0)
}

/// From (90, 10) to (60, 40), and on to (70, 70): where two polygons meet, in mm.
fn polygon_cut(y: f64) -> f64 {
    if y < 40.0 { 100.0 - y } else { 60.0 + (y - 40.0) / 3.0 }
}
