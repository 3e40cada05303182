use std::collections::BTreeMap;

use frixel_hil_sim::RigConfig;
use frixel_scene::{Scene, compile};

use super::*;

const SPEED_M_PER_S: f64 = 0.08;

const PLATE: &str = "[[layer]]\nkind = \"constant\"\nregion = { x_mm = 40, y_mm = 0, width_mm = 30, height_mm = 80 }\n\
                     above = \"natural\"\nfriction_n = 0.1\n";
const STRIPES: &str = "[[layer]]\nkind = \"grating\"\nregion = { x_mm = 40, y_mm = 0, width_mm = 40, height_mm = 80 }\n\
                       wavelength_mm = 8\nlow_n = 0.03\nhigh_n = 0.1\n";
const WEAVE: &str = "[[layer]]\nkind = \"grating\"\nwavelength_mm = 1\nlow_n = 0.0\nhigh_n = 0.05\n";

fn program(layers: &[&str]) -> Program {
    let text = format!("version = 1\n{}", layers.concat());
    let rig = RigConfig::default();
    let scene = Scene::parse(&text, "noticed.toml", &BTreeMap::<String, Vec<u8>>::new()).unwrap();
    compile(&scene, &rig.board.limits, rig.board.tick_hz).unwrap()
}

/// A finger that slides along a row, over a display that plays the place where the finger was `late_s` ago with a gain.
fn slide(program: &Program, gain: f64, late_s: f64) -> Noticing {
    let reference = Reference::new(program);
    slide_over(program, |t_s| gain * reference.electric_friction_n(0.005 + SPEED_M_PER_S * (t_s - late_s), 0.041))
}

/// A finger that slides along a row, over a display that gives an electric friction at each time.
fn slide_over(program: &Program, felt_electric_n: impl Fn(f64) -> f64) -> Noticing {
    let reference = Reference::new(program);
    let natural_n = program.reach.natural_friction_n;
    let sample = |number: u32| {
        let t_s = f64::from(number) / crate::fidelity::SAMPLE_HZ;
        let electric_n = |t_s: f64| reference.electric_friction_n(0.005 + SPEED_M_PER_S * t_s, 0.041);
        FidelitySample {
            t_s,
            x_m: 0.005 + SPEED_M_PER_S * t_s,
            y_m: 0.041,
            speed_m_per_s: Some(SPEED_M_PER_S),
            reference_n: natural_n + electric_n(t_s),
            felt_n: natural_n + felt_electric_n(t_s),
            natural_n,
            is_driven: true,
        }
    };
    let mut noticing = Noticing::new(program);
    noticing.add(&(0..5200).map(sample).collect::<Vec<_>>());
    noticing
}

#[test]
fn a_plate_has_a_step_onto_it_and_no_contrast() {
    let program = program(&[PLATE]);
    let noticing = slide(&program, 1.0, 0.0);
    let [plate] = noticing.layers()[..] else { panic!("{:?}", noticing.layers()) };
    assert!(plate.is_flat && plate.contrast.weber_steps.abs() < 1e-9, "{plate:?}");
    assert_eq!((plate.verdict(), plate.texture), (Verdict::NotFelt, None));
    let [border] = noticing.borders()[..] else { panic!("{:?}", noticing.borders()) };
    assert_eq!((border.sides, border.layers), ([None, Some(0)], [0, 1]));
    let natural_n = program.reach.natural_friction_n;
    let scenes = Step::new(natural_n, natural_n + 0.1);
    assert!((border.step.weber_steps / scenes.weber_steps - 1.0).abs() < 0.01, "{border:?}");
    assert_eq!(border.step.verdict, Verdict::Felt);
}

/// The contrast of the stripes is the same as before the play, and the step from the bare screen is not in it.
#[test]
fn a_layer_has_the_contrast_that_a_check_gives_it() {
    let program = program(&[STRIPES]);
    let checked = crate::perception::Perception::of(&program, &frixel_hil_sim::TouchConfig::REALISTIC).layers[0]
        .contrast
        .weber_steps;
    let contrast = |gain, late_s| slide(&program, gain, late_s).layers()[0].contrast.weber_steps;
    assert!((contrast(1.0, 0.0) / checked - 1.0).abs() < 0.03, "{} of {checked}", contrast(1.0, 0.0));
    assert!((contrast(1.0, 0.02) / checked - 1.0).abs() < 0.03, "a delay takes nothing: {}", contrast(1.0, 0.02));
    assert!((0.4..0.65).contains(&(contrast(0.5, 0.0) / checked)), "{}", contrast(0.5, 0.0));
    assert_eq!(slide(&program, 0.0, 0.0).layers()[0].verdict(), Verdict::NotFelt);
}

/// The power of a texture is felt in whatever phase, and that of a weak one is its own.
#[test]
fn a_texture_is_felt_as_far_as_its_power_is() {
    let program = program(&[WEAVE]);
    let texture = |gain, late_s| slide(&program, gain, late_s).layers()[0].texture.unwrap();
    let whole = texture(1.0, 0.005);
    assert!((whole.frequency_hz - 80.0).abs() < 4.0 && (whole.amplitude_n - 0.025).abs() < 1e-3, "{whole:?}");
    assert!((texture(0.2, 0.0).amplitude_n / whole.amplitude_n - 0.2).abs() < 0.01);
    // What a display adds is no texture of the scene.
    assert!((texture(3.0, 0.0).amplitude_n / whole.amplitude_n - 1.0).abs() < 0.01);
}

/// A texture above a plate is no contrast of the plate, and stripes below count where the layer shows them.
#[test]
fn a_layer_has_no_contrast_of_those_above_it() {
    let program = program(&[PLATE, &WEAVE.replace("high_n = 0.05", "high_n = 0.01\nblend = \"add\"")]);
    let layers = slide(&program, 1.0, 0.0).layers();
    let [plate, weave] = &layers[..] else { panic!("{layers:?}") };
    assert!(plate.contrast.weber_steps.abs() < 1e-9 && plate.texture.is_none() && plate.level.is_none(), "{plate:?}");
    assert!(weave.texture.is_some() && weave.level.is_some(), "{weave:?}");
}

/// A slide has one friction, and the slide back another, which no way of 50 mm shows.
#[test]
fn directions_are_compared_between_slides() {
    let velvet = "[[layer]]\nkind = \"direction\"\nabove = \"natural\"\nalong_n = 0.01\nagainst_n = 0.1\n";
    let program = program(&[velvet]);
    let natural_n = program.reach.natural_friction_n;
    let noticed = |plays: &[f64], along_n: f64, against_n: f64| {
        let mut noticing = Noticing::new(&program);
        for side in plays {
            let sample = |number: u32| {
                let t_s = f64::from(number) / crate::fidelity::SAMPLE_HZ;
                FidelitySample {
                    t_s,
                    x_m: 0.06 + side * SPEED_M_PER_S * (t_s - 0.5),
                    y_m: 0.04,
                    speed_m_per_s: Some(SPEED_M_PER_S),
                    reference_n: natural_n + if *side > 0.0 { 0.01 } else { 0.1 },
                    felt_n: natural_n + if *side > 0.0 { along_n } else { against_n },
                    natural_n,
                    is_driven: true,
                }
            };
            noticing.add(&(0..4000).map(sample).collect::<Vec<_>>());
        }
        noticing.layers()[0]
    };
    let checked = crate::perception::Perception::of(&program, &frixel_hil_sim::TouchConfig::REALISTIC).layers[0]
        .contrast
        .weber_steps;
    let whole = noticed(&[1.0, -1.0, 1.0], 0.01, 0.1).contrast.weber_steps;
    assert!((whole / checked - 1.0).abs() < 0.01, "{whole} of {checked}");
    assert!(noticed(&[1.0, -1.0], 0.04, 0.07).contrast.weber_steps < 0.5 * checked);
    // A display that knows no direction, the other one, and a finger that slides one way only.
    for (plays, along_n, against_n) in [([1.0, -1.0], 0.05, 0.05), ([1.0, -1.0], 0.1, 0.01), ([1.0, 1.0], 0.01, 0.1)] {
        assert_eq!(noticed(&plays, along_n, against_n).verdict(), Verdict::NotFelt, "{plays:?}");
    }
}

/// A late display has the level of a plate, and a bar that is as narrow as a fingertip resolves has none.
#[test]
fn a_level_is_that_inside_a_layer() {
    let bar = |x_mm: u32, width_mm: u32| {
        format!(
            "[[layer]]\nkind = \"constant\"\nregion = {{ x_mm = {x_mm}, y_mm = 0, width_mm = {width_mm}, height_mm = 80 }}\n\
             above = \"natural\"\nfriction_n = 0.1\n"
        )
    };
    let program =
        program(&[&bar(20, 1), &bar(22, 1), &bar(24, 1), &bar(26, 1), &bar(28, 1), &bar(30, 1), &bar(50, 20)]);
    let layers = slide(&program, 1.0, 0.02).layers();
    let plate = layers.last().and_then(|layer| layer.level).unwrap();
    assert!((plate.felt_n - plate.scene_n).abs() < 1e-9, "{plate:?}");
    assert!(layers.iter().rev().skip(1).all(|bar| bar.level.is_none()), "{layers:?}");
}

#[test]
fn what_was_not_driven_is_not_judged() {
    let program = program(&[PLATE]);
    let mut noticing = Noticing::new(&program);
    let sample = FidelitySample { x_m: 0.05, y_m: 0.04, speed_m_per_s: Some(0.1), ..FidelitySample::default() };
    let samples = vec![sample; 4000];
    noticing.add(&samples);
    assert!(noticing.layers().is_empty() && noticing.borders().is_empty());
    assert!(!noticing.changes_along(&samples), "one place");
    let outside = FidelitySample { x_m: 0.03, ..sample };
    assert!(noticing.changes_along(&[[sample; 10], [outside; 10]].concat()));
}
