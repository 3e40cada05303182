use super::{BurstTimes, LayerPerception, NEAR_THRESHOLD, Perception, Step, Verdict, weber_steps};
use crate::check::feel;
use crate::tests::{compiled, program};

fn of(layers: &str) -> Perception {
    Perception::of(&program(layers))
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
    assert_eq!(only(&perception).layer.as_str(), "layer 2 \"above\"");
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

/// On the example screen, under the example finger: 250 mN, to which the drive adds up to 130 mN.
fn on_example(layers: &str) -> Perception {
    Perception::of(&compiled(&format!("version = 2\n{layers}")))
}

/// A layer whose friction is in parts of the reach, at a place of 30 by 20 mm.
fn plate(x_mm: u32, fields: &str) -> String {
    let region = format!("region = {{ x_mm = {x_mm}, y_mm = 20, width_mm = 30, height_mm = 20 }}");
    format!("[[layer]]\n{region}\n{fields}\n")
}

#[test]
fn a_rare_burst_is_judged_while_it_lasts() {
    let vibration = |burst: &str| {
        let fields = "kind = \"vibration\"\nfrequency_hz = 80\nlow_fraction = 0.0\nhigh_fraction = 0.8\n";
        on_example(&format!("[[layer]]\n{fields}{burst}"))
    };
    let (lasting, rare) = (vibration(""), vibration("burst = { period_ms = 5000, on_ms = 100, ramp_ms = 10 }\n"));
    assert_eq!(only(&rare).contrast, only(&lasting).contrast);
    assert_eq!(only(&rare).textures, only(&lasting).textures);
    assert_eq!(only(&rare).textures[1].verdict, Verdict::Felt);
    let BurstTimes { on_ms, period_ms } = only(&rare).burst.unwrap();
    assert!((on_ms - 100.0).abs() < 1e-3 && (period_ms - 5000.0).abs() < 1e-3);
    assert_eq!(only(&lasting).burst, None);
    assert!(feel::sentence(only(&rare)).contains("; all this while a burst lasts, 100 ms of every 5000 ms"));
}

#[test]
fn a_lone_edge_is_felt_where_it_is() {
    let perception = on_example("[[layer]]\nkind = \"edge\"\nx_mm = 60\ny_mm = 40\nwidth_mm = 3\nridge_n = 0.02\n");
    let layer = only(&perception);
    assert!(layer.is_narrow && (layer.contrast.contrast_n - 0.02).abs() < 1e-5, "{layer:?}");
    assert_eq!(feel::sentence(layer), "250.0 to 270.0 mN, 0.7 Weber steps (not felt) at a narrow place in it");
    assert!(!only(&of(&grating(2.0, 20.0))).is_narrow);
}

/// A finger feels one friction along the axis, wherever it points, and the other one on its way back.
#[test]
fn a_layer_that_depends_on_the_direction_is_judged_there_and_back() {
    for angle_deg in [0, 45, 90, 200] {
        let fields = format!("kind = \"direction\"\nangle_deg = {angle_deg}\nalong_n = 0.01\nagainst_n = 0.06\n");
        let perception = on_example(&plate(50, &fields));
        let layer = only(&perception);
        assert!(layer.is_by_direction && layer.textures.is_empty(), "{layer:?}");
        let found = feel::sentence(layer);
        assert_eq!(
            found,
            "260.0 to 310.0 mN, 1.7 Weber steps (near the threshold) from one direction of the slide to the other"
        );
    }
    let velvet = "kind = \"direction\"\nalong_fraction = 0.1\nagainst_fraction = 0.9\n";
    let turned = on_example(&(plate(10, velvet) + &plate(60, &format!("{velvet}angle_deg = 90\n"))));
    assert!(turned.alike.is_empty(), "{:?}", turned.alike);
    // Stripes that are felt only against the axis.
    let stripes = "kind = \"grating\"\nwavelength_mm = 4\nlow_fraction = 0\nhigh_fraction = 0.9\n";
    let one_way = "kind = \"direction\"\nblend = \"multiply\"\nalong_factor = 0\nagainst_factor = 1\n";
    let perception = on_example(&(plate(50, stripes) + &plate(50, one_way)));
    let [stripes, one_way] = &perception.layers[..] else { panic!("{perception:?}") };
    let Step { from_n, to_n, .. } = one_way.contrast;
    assert!(from_n < 0.2501 && to_n > 0.36, "{one_way:?}");
    let amplitude_n = |layer: &LayerPerception| layer.textures.last().unwrap().amplitude_n;
    assert!((amplitude_n(one_way) / amplitude_n(stripes) - 1.0).abs() < 0.01, "{one_way:?} {stripes:?}");
}

/// A slide over a layer ends where another layer replaces it.
#[test]
fn a_layer_around_others_is_the_same_throughout() {
    let around = "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.9\n";
    let hole = "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.1\n\
                region = { shape = \"ellipse\", x_mm = 33, y_mm = 17, width_mm = 52, height_mm = 31 }\n";
    let perception = on_example(&format!("{around}{hole}"));
    for layer in &perception.layers {
        assert!(!layer.is_narrow && layer.contrast.contrast_n.abs() < 1e-9, "{layer:?}");
    }
}

/// The ridge falls off before the border of the layer: a finger feels no step there.
#[test]
fn a_ridge_has_no_step_at_its_foot() {
    let ridge = "kind = \"edge\"\nx_mm = 35\ny_mm = 30\nwidth_mm = 8\nridge_n = 0.02";
    assert_eq!(on_example(&plate(20, ridge)).steps, []);
    assert_eq!(on_example(&plate(20, "kind = \"constant\"\nabove = \"natural\"\nfriction_n = 0.02")).steps.len(), 1);
}

#[test]
fn the_rare_extremes_of_noise_are_no_narrow_place() {
    let noise = "kind = \"noise\"\nwavelength_min_mm = 2\nwavelength_max_mm = 8\nlow_fraction = 0\nhigh_fraction = 0.9";
    assert!(!only(&on_example(&plate(20, noise))).is_narrow);
    assert!(!only(&on_example(&format!("[[layer]]\n{noise}\n"))).is_narrow);
}

#[test]
fn a_layer_has_its_own_click_only() {
    let button = "kind = \"button\"\nrim_width_mm = 3\nrim_fraction = 0.2\nface_fraction = 0.1\nclick_n = 0.01";
    let edge = "kind = \"edge\"\nblend = \"add\"\nx_mm = 40\ny_mm = 30\nwidth_mm = 8\nridge_n = 0.01\nclick_n = 0.08";
    let perception = on_example(&format!("{}{}", plate(20, button), plate(20, edge)));
    let clicks_n: Vec<f64> = perception.layers.iter().map(|layer| layer.click.unwrap().contrast_n).collect();
    assert!((clicks_n[0] - 0.01).abs() < 2e-4 && (clicks_n[1] - 0.08).abs() < 2e-3, "{clicks_n:?}");
}

#[test]
fn a_click_is_judged_where_it_begins_and_within_what_the_drive_can_give() {
    let button = |face_fraction: f64| {
        let text = plate(
            20,
            &format!(
                "kind = \"button\"\nrim_width_mm = 3\nrim_fraction = 0.5\nface_fraction = {face_fraction}\n\
                 click_fraction = 0.4"
            ),
        );
        on_example(&format!("{text}[drive]\nsaturate = true\n"))
    };
    let perception = button(0.2);
    let layer = only(&perception);
    let click = layer.click.unwrap();
    let reach_n = (click.from_n - 0.25) / 0.2;
    assert!((click.contrast_n / (0.4 * reach_n) - 1.0).abs() < 0.02 && !layer.is_click_cut_off, "{layer:?}");
    let perception = button(1.0);
    let layer = only(&perception);
    assert!(layer.is_click_cut_off && layer.click.unwrap().contrast_n.abs() < 1e-4, "{layer:?}");
    assert!(feel::sentence(layer).contains("0.0 Weber steps (not felt), cut off at the most that the drive can give"));
}

#[test]
fn plates_and_buttons_of_almost_the_same_friction_are_alike() {
    let constant = |fraction: f64| format!("kind = \"constant\"\nfriction_fraction = {fraction}");
    let button = |face: f64, rim: f64| {
        format!("kind = \"button\"\nrim_width_mm = 3\nrim_fraction = {rim}\nface_fraction = {face}")
    };
    let high = 0.9;
    let alike = |one: &str, other: &str| on_example(&(plate(10, one) + &plate(60, other))).alike;
    let pair = alike(&constant(high), &constant(0.8 * high));
    assert_eq!(pair.len(), 1, "{pair:?}");
    assert!(pair[0].difference_weber_steps.unwrap() < 1.0 && pair[0].difference_db.is_none());
    assert_eq!(alike(&constant(high), &constant(high)), [], "the same layer twice is meant to be");
    assert_eq!(alike(&button(0.4, 0.8), &button(0.5, 0.8)).len(), 1);
    assert_eq!(alike(&button(0.4, 0.8), &constant(0.6)).len(), 1);
}

/// Layers that act at the same place are felt as one.
#[test]
fn layers_that_add_to_one_another_are_not_alike() {
    let constant =
        |friction_n: f64| format!("kind = \"constant\"\nabove = \"natural\"\nfriction_n = {friction_n}\nlive = true");
    let below_and_above = plate(10, &constant(0.01)) + &plate(10, &format!("{}\nblend = \"add\"", constant(0.005)));
    let perception = on_example(&below_and_above);
    assert_eq!((perception.layers.len(), perception.alike.len()), (2, 0));
}

#[test]
fn copies_of_a_layer_are_named_once() {
    let detents = "[[layer]]\nname = \"detent\"\nkind = \"edge\"\nregion = { x_mm = 10, y_mm = 20, width_mm = 4, \
         height_mm = 30 }\nrepeat = { columns = 6, dx_mm = 15 }\nx_mm = 12\ny_mm = 30\nwidth_mm = 4\nridge_n = 0.02\n";
    let lines = feel::lines(&of(detents));
    let feel: Vec<&String> = lines.iter().filter(|(name, _)| *name == "feel").map(|(_, text)| text).collect();
    assert_eq!(feel.len(), 1, "{feel:?}");
    assert!(feel[0].starts_with("layer 1.1 \"detent 1\" and 5 alike: 250."), "{feel:?}");
    assert!(!lines.iter().any(|(name, _)| *name == "alike"), "{lines:?}");
}

/// A groove with ridges on it is the same throughout, and a step or a ridge is no texture.
#[test]
fn a_layer_is_judged_without_the_layers_above_it() {
    let groove = "[[layer]]\nname = \"groove\"\nkind = \"constant\"\nfriction_fraction = 0.1\n\
                  region = { x_mm = 10, y_mm = 30, width_mm = 80, height_mm = 20 }\n";
    let detents = "[[layer]]\nname = \"detent\"\nkind = \"edge\"\nx_mm = 14\ny_mm = 40\nwidth_mm = 3\nridge_fraction = 0.8\n\
                   region = { x_mm = 10, y_mm = 30, width_mm = 8, height_mm = 20 }\nrepeat = { columns = 10, dx_mm = 8 }\n";
    let perception = on_example(&format!("{groove}{detents}"));
    let lines = feel::lines(&perception);
    let of = |kind: &str| -> Vec<&str> {
        lines.iter().filter(|(name, _)| *name == kind).map(|(_, text)| text.as_str()).collect()
    };
    assert_eq!(of("feel").len(), 2, "the ridges are the same: {lines:?}");
    assert_eq!(of("feel")[0], "layer 1 \"groove\": 263.0 mN throughout");
    assert!(of("feel")[1].starts_with("layer 2.1 \"detent 1\" and 9 alike: 263.0 to 36"), "{lines:?}");
    // The detents cover all of the groove, whose border is there all the same.
    let step = "from the bare screen to layer 1 \"groove\": 250.0 to 263.0 mN, 0.5 Weber steps (not felt)";
    assert_eq!(of("step"), [step]);

    let button = plate(20, "kind = \"button\"\nrim_width_mm = 3\nrim_fraction = 0.9\nface_fraction = 0\n");
    let perception = on_example(&button);
    assert_eq!(only(&perception).textures, []);
    let over_texture =
        grating(2.0, 20.0) + &plate(20, "kind = \"constant\"\nblend = \"multiply\"\nfriction_factor = 0.5\n");
    let over_texture = on_example(&over_texture);
    assert!(!over_texture.layers[1].textures.is_empty(), "what lies below is felt: {over_texture:?}");
}

#[test]
fn what_near_the_threshold_means_is_said_once_and_only_then() {
    let said = |high_n: f64| {
        let constant = format!("kind = \"constant\"\nabove = \"natural\"\nfriction_n = {high_n}");
        let perception = on_example(&(plate(20, &constant) + &plate(60, &constant)));
        let lines = feel::lines(&perception);
        let near = lines.into_iter().filter(|(_, text)| text.ends_with(NEAR_THRESHOLD));
        near.map(|(_, text)| text.split(": near").next().unwrap().to_owned()).collect::<Vec<String>>()
    };
    // 0.8, 1.7 and 2.7 Weber steps.
    let both =
        "the step from the bare screen to layer 1 (constant), the step from the bare screen to layer 2 (constant)";
    assert_eq!([0.02, 0.05, 0.08].map(said), [vec![], vec![both.to_owned()], vec![]]);
    // At 20 mm/s it is near the threshold.
    let fine = on_example("[[layer]]\nkind = \"grating\"\nwavelength_mm = 1\nlow_fraction = 0\nhigh_fraction = 0.2\n");
    let verdicts: Vec<Verdict> = only(&fine).textures.iter().map(|texture| texture.verdict).collect();
    assert!(verdicts.contains(&Verdict::NearThreshold) && verdicts.contains(&Verdict::Felt), "{verdicts:?}");
    assert!(!feel::lines(&fine).iter().any(|(name, _)| *name == "note"), "{:?}", feel::lines(&fine));
    assert_eq!(serde_json::to_string(&Verdict::NearThreshold).unwrap(), "\"felt_by_some\"");
}
