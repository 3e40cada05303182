use super::{LayerPerception, Perception, Step, Verdict, weber_steps};
use crate::tests::{HEAD, compile_text};

fn of(layers: &str) -> Perception {
    Perception::of(&compile_text(&format!("{HEAD}{layers}")).unwrap())
}

fn only(perception: &Perception) -> &LayerPerception {
    assert_eq!(perception.layers.len(), 1, "{perception:?}");
    &perception.layers[0]
}

/// A grating along x over the whole screen, mN above natural friction.
fn grating(wavelength_mm: f64, high_mn: f64) -> String {
    let high_n = 1e-3 * high_mn;
    format!(
        "[[layer]]\nkind = \"grating\"\nwavelength_mm = {wavelength_mm}\nabove = \"natural\"\nlow_n = 0.0\nhigh_n = {high_n}\n"
    )
}

#[test]
fn a_grating_is_a_sine_at_speed_over_wavelength() {
    let perception = of(&grating(1.25, 20.0));
    let layer = only(&perception);
    let speeds: Vec<f64> = layer.textures.iter().map(|texture| texture.speed_mm_per_s).collect();
    assert_eq!(speeds, [20.0, 50.0, 100.0]);
    for texture in &layer.textures {
        let frequency_hz = texture.speed_mm_per_s / 1.25;
        assert!((texture.frequency_hz / frequency_hz - 1.0).abs() < 0.03, "{texture:?}");
        assert!((texture.amplitude_n / 10e-3 - 1.0).abs() < 0.03, "{texture:?}");
    }
    // The 5th and 95th percentile of a sine are at 0.988 of its amplitude.
    assert!((layer.contrast.contrast_n / 19.75e-3 - 1.0).abs() < 0.01, "{layer:?}");
}

#[test]
fn a_fine_grating_is_smaller_behind_the_lag() {
    let perception = of(&grating(0.2, 20.0));
    let slow = only(&perception).textures.first().unwrap();
    let wave_number_per_mm = std::f64::consts::TAU / 0.2;
    let gain = 1.0 / libm::hypot(1.0, wave_number_per_mm / (std::f64::consts::TAU * 13.8));
    assert!((slow.amplitude_n / (gain * 10e-3) - 1.0).abs() < 0.03, "{slow:?}, gain {gain}");
}

#[test]
fn a_coarse_grating_is_judged_as_a_step_and_a_fast_one_as_a_texture() {
    let perception = of(&grating(20.0, 26.0));
    let coarse = only(&perception);
    assert!(coarse.textures.is_empty(), "{coarse:?}");
    assert_eq!(coarse.contrast.verdict, Verdict::NotFelt);
    let perception = of(&grating(1.0, 26.0));
    assert_eq!(only(&perception).textures.last().unwrap().verdict, Verdict::Felt);
}

#[test]
fn a_border_has_the_step_between_the_mean_frictions_of_its_sides() {
    let pad = |x_mm: u32, friction_n: f64| {
        format!(
            "[[layer]]\nkind = \"constant\"\nregion = {{ shape = \"rectangle\", x_mm = {x_mm}, y_mm = 20, width_mm = 30, \
             height_mm = 30 }}\nfriction_n = {friction_n}\n"
        )
    };
    let perception = of(&(pad(20, 0.26) + &pad(50, 0.275)));
    let steps: Vec<(bool, Step)> = perception.steps.iter().map(|step| (step.from.is_none(), step.step)).collect();
    let near =
        |step: &Step, from_n: f64, to_n: f64| (step.from_n - from_n).abs() < 1e-6 && (step.to_n - to_n).abs() < 1e-6;
    assert_eq!(steps.len(), 3, "{perception:?}");
    assert!(steps.iter().any(|(bare, step)| *bare && near(step, 0.25, 0.26)), "{steps:?}");
    assert!(steps.iter().any(|(bare, step)| *bare && near(step, 0.25, 0.275)), "{steps:?}");
    let (_, between) = steps.iter().find(|(bare, _)| !bare).unwrap();
    assert!(near(between, 0.26, 0.275), "{between:?}");
    assert!((between.weber_steps - weber_steps(0.26, 0.275)).abs() < 1e-4);
}

#[test]
fn a_hidden_layer_is_not_judged() {
    let hidden = "[[layer]]\nname = \"below\"\nkind = \"constant\"\nlive = true\nfriction_n = 0.26\n";
    let above = "[[layer]]\nname = \"above\"\nkind = \"constant\"\nlive = true\nfriction_n = 0.27\n";
    let perception = of(&format!("{hidden}{above}"));
    assert_eq!(only(&perception).layer, "layer 2 \"above\"");
}

#[test]
fn textures_of_almost_the_same_voltage_and_frequency_are_alike() {
    let half = |x_mm: u32, wavelength_mm: f64, high_n: f64| {
        format!(
            "[[layer]]\nkind = \"grating\"\nwavelength_mm = {wavelength_mm}\nabove = \"natural\"\nlow_n = 0.0\n\
             high_n = {high_n}\nregion = {{ shape = \"rectangle\", x_mm = {x_mm}, y_mm = 0, width_mm = 60, height_mm = 110 \
             }}\n"
        )
    };
    let alike = |other: String| of(&(half(0, 1.0, 0.026) + &other)).alike.len();
    assert_eq!(alike(half(60, 1.1, 0.024)), 1);
    assert_eq!(alike(half(60, 1.1, 0.018)), 0);
    assert_eq!(alike(half(60, 2.0, 0.024)), 0);
    assert_eq!(alike(half(60, 1.0, 0.026)), 0, "the same texture twice is meant to be");
}

#[test]
fn a_vibration_is_said_to_need_a_sliding_finger() {
    let vibration =
        "[[layer]]\nkind = \"vibration\"\nfrequency_hz = 80\nlow_n = 0.0\nhigh_n = 0.02\nabove = \"natural\"\n";
    let perception = of(vibration);
    assert_eq!(perception.notes.len(), 1);
    let texture = only(&perception).textures.last().unwrap();
    assert!((texture.frequency_hz - 80.0).abs() < 1.0, "{texture:?}");
    assert!(of(&grating(1.0, 20.0)).notes.is_empty());
}
