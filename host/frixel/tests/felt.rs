//! What a finger feels of a texture, on strokes of people and with every effect of the plant: the goals for each class
//! of touch source.
//!
//! The reference is the scene at the finger's true place, through the same finger, load and noise. Where a goal is out
//! of reach, the case says how far.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::collections::BTreeMap;

use frixel::score::samples;
use frixel_felt::fidelity::Fidelity;
use frixel_hil_sim::{RigConfig, Stroke, TouchConfig};
use frixel_lab::score::Trial;
use frixel_scene::{Program, Scene, compile};

/// Error from 0 to 400 Hz over the rms of the reference's changes, landing and end of a touch included, correlation, and
/// spurious force between 40 and 400 Hz: a finger's own noise, measured as 4.5 mN from 10 to 1000 Hz, of which a 1/f
/// spectrum has 3.2 mN from 40 to 400 Hz. The goal is the larger, until the noise of that band is better known.
const GOAL: Held = Held { ratio_max: 0.25, correlation_min: 0.9, spurious_max_n: 4.5e-3 };
const SECONDS: f64 = 8.5;
/// Swing of the texture: nearly all that the finger below has at 150 V.
const SWING_N: f64 = 0.11;

#[derive(Clone, Copy)]
struct Held {
    ratio_max: f64,
    correlation_min: f64,
    spurious_max_n: f64,
}

impl Held {
    fn holds(&self, felt: &Felt) -> bool {
        felt.ratio <= self.ratio_max
            && felt.correlation >= self.correlation_min
            && felt.spurious_n <= self.spurious_max_n
    }
}

/// What was felt on a stroke, or on several: root mean squares and the mean correlation.
#[derive(Clone, Copy, Debug)]
struct Felt {
    ratio: f64,
    correlation: f64,
    spurious_n: f64,
}

impl Felt {
    fn over(plays: &[Fidelity]) -> Self {
        let count = plays.len() as f64;
        let mean = |value: &dyn Fn(&Fidelity) -> f64| plays.iter().map(value).sum::<f64>() / count;
        Self {
            ratio: mean(&|play| play.error.unwrap().powi(2)).sqrt(),
            correlation: mean(&|play| play.correlation.unwrap()),
            spurious_n: mean(&|play| play.spurious_40_to_400_hz_n.powi(2)).sqrt(),
        }
    }
}

/// A touch source, and the smallest feature that it is to be good for.
#[derive(Clone, Copy)]
struct Class {
    rate_hz: f64,
    latency_s: f64,
    wavelength_mm: f64,
}

const SLOW: Class = Class { rate_hz: 100.0, latency_s: 10e-3, wavelength_mm: 10.0 };
const MEDIUM: Class = Class { rate_hz: 200.0, latency_s: 5e-3, wavelength_mm: 5.0 };
const FAST: Class = Class { rate_hz: 500.0, latency_s: 3e-3, wavelength_mm: 2.0 };

/// Class, median speed of the stroke in mm/s, and what is held: the goal, or how far it is missed.
///
/// What misses it is latency: at a median of 200 mm/s a hand turns within 50 ms with accelerations of 3 m/s^2, and 20
/// ms of these are 0.6 mm. At 100 mm/s on an ideal plant, `frixel report` has an error of 0.22 for the board's filter
/// with 100 reports a second, 0.19 for the best of 15 tunings chosen with hindsight, and 0.06 for a smoother that sees
/// later reports. No bound has been computed at 200 mm/s.
const CASES: [(Class, f64, Held); 9] = [
    (SLOW, 50.0, GOAL),
    (SLOW, 100.0, Held { ratio_max: 0.32, spurious_max_n: 5e-3, ..GOAL }),
    (SLOW, 200.0, Held { ratio_max: 0.70, correlation_min: 0.74, spurious_max_n: 10e-3 }),
    (MEDIUM, 50.0, GOAL),
    (MEDIUM, 100.0, GOAL),
    (MEDIUM, 200.0, Held { ratio_max: 0.55, correlation_min: 0.84, spurious_max_n: 6e-3 }),
    (FAST, 50.0, GOAL),
    (FAST, 100.0, GOAL),
    (FAST, 200.0, Held { ratio_max: 0.47, correlation_min: 0.88, ..GOAL }),
];

/// Every effect of the plant, with a touch source of a class that loses one report in eight and bunches one in thirty.
fn rig(class: &Class) -> RigConfig {
    let mut rig = RigConfig::default();
    rig.world = rig.world.realistic();
    rig.world.touch = TouchConfig {
        rate_hz: class.rate_hz,
        latency_s: class.latency_s,
        jitter_rms_s: 0.05 / class.rate_hz,
        step_m: 0.0,
        pause_rate_hz: 0.0,
        pause_max_s: 0.0,
        ..TouchConfig::REALISTIC
    };
    rig
}

fn program(rig: &RigConfig, wavelength_mm: f64) -> Program {
    let text = format!(
        "version = 1\n\
         [screen]\nwidth_mm = 120\nheight_mm = 80\n\
         [coating]\nthickness_um = 5\npermittivity = 1\n\
         [finger]\nradius_mm = 8\nstiffness_pa_per_m = 1.8e7\nfriction_coefficient = 0.5\nnormal_load_n = 0.5\n\
         [[layer]]\nkind = \"grating\"\nwavelength_mm = {wavelength_mm}\nlow_n = 0.0\nhigh_n = {SWING_N}\n"
    );
    let scene = Scene::parse(&text, "the texture", &BTreeMap::new()).unwrap();
    compile(&scene, &rig.board.limits, rig.board.tick_hz).unwrap()
}

fn play(rig: &RigConfig, program: &Program, speed_mm_s: f64, seed: u64) -> Fidelity {
    let stroke = Stroke::human(0.12, 0.08, SECONDS, Some(1e-3 * speed_mm_s), seed).unwrap();
    let trial = Trial { stroke_name: format!("human {seed}"), stroke, seed, finger: None };
    Fidelity::of(&samples(program, rig, &trial).unwrap()).unwrap()
}

fn felt(class: &Class, speed_mm_s: f64, seed: u64, change: impl FnOnce(&mut Program)) -> Felt {
    let rig = rig(class);
    let mut program = program(&rig, class.wavelength_mm);
    change(&mut program);
    Felt::over(&[play(&rig, &program, speed_mm_s, seed)])
}

fn mean(class: &Class, speed_mm_s: f64, seeds: std::ops::RangeInclusive<u64>) -> Felt {
    let rig = rig(class);
    let program = program(&rig, class.wavelength_mm);
    Felt::over(&seeds.map(|seed| play(&rig, &program, speed_mm_s, seed)).collect::<Vec<_>>())
}

fn hold(seeds: &std::ops::RangeInclusive<u64>) {
    let mut failed = Vec::new();
    for (class, speed_mm_s, held) in CASES {
        let found = mean(&class, speed_mm_s, seeds.clone());
        let line = format!(
            "{} Hz, {} mm at {speed_mm_s} mm/s: error {:.2}, correlation {:.3}, spurious {:.1} mN",
            class.rate_hz,
            class.wavelength_mm,
            found.ratio,
            found.correlation,
            1e3 * found.spurious_n
        );
        println!("{line}");
        if !held.holds(&found) {
            failed.push(line);
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn textures_are_felt_within_the_goals() {
    hold(&(1..=4));
}

#[test]
#[ignore = "takes minutes: cargo xtask soak strokes"]
fn textures_are_felt_within_the_goals_on_many_strokes() {
    hold(&(1..=24));
}

/// Makes a touch source another one.
type Change = fn(&mut TouchConfig);

/// Prints the tables of `docs/touch.md`.
#[test]
#[ignore = "takes minutes: cargo xtask soak strokes"]
fn tables_of_source_and_feature_size() {
    for class in [SLOW, MEDIUM, FAST] {
        for wavelength_mm in [2.0, 5.0, 10.0, 20.0] {
            let cells = [50.0, 100.0, 200.0].map(|speed_mm_s| {
                let found = mean(&Class { wavelength_mm, ..class }, speed_mm_s, 1..=6);
                // A mean over seeds is no better than its worst would be good: every number is one.
                assert!(found.ratio.is_finite() && found.correlation.abs() <= 1.0, "{found:?}");
                format!("{:.2} / {:.2}, {:.1} mN", found.ratio, found.correlation, 1e3 * found.spurious_n)
            });
            println!("| {} Hz | {wavelength_mm} mm | {} |", class.rate_hz, cells.join(" | "));
        }
    }
    let changes: [(&str, Change); 4] = [
        ("as above", |_| {}),
        ("nothing lost", |touch| (touch.lost_share, touch.bunched_share) = (0.0, 0.0)),
        ("pixel steps of 0.18 mm", |touch| touch.step_m = 0.18e-3),
        ("a pause in ten seconds", |touch| (touch.pause_rate_hz, touch.pause_max_s) = (0.1, 0.12)),
    ];
    for (name, change) in changes {
        let ratios = [SLOW, MEDIUM, FAST].map(|class| {
            let mut rig = rig(&class);
            change(&mut rig.world.touch);
            let program = program(&rig, class.wavelength_mm);
            let plays: Vec<Fidelity> = (1..=6).map(|seed| play(&rig, &program, 100.0, seed)).collect();
            format!("{:.2}", Felt::over(&plays).ratio)
        });
        println!("| {name} | {} |", ratios.join(" | "));
    }
}

/// The checks above see an output that is not there: a volt gives less than a millionth of a newton.
#[test]
fn an_output_forced_to_zero_misses_every_goal() {
    for class in [SLOW, MEDIUM, FAST] {
        let found = felt(&class, 50.0, 1, |program| program.header.voltage_max_v_rms = 1.0);
        assert!(found.ratio > 0.9 && !(found.correlation > 0.9), "{found:?}");
    }
}

#[test]
fn without_prediction_every_goal_is_missed() {
    for class in [SLOW, MEDIUM, FAST] {
        for speed_mm_s in [50.0, 100.0] {
            let found = felt(&class, speed_mm_s, 1, |program| program.header.prediction = false);
            assert!(found.ratio > GOAL.ratio_max && !GOAL.holds(&found), "{found:?}");
        }
    }
}
