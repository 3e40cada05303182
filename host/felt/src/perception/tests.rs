use frixel_hil_sim::TouchConfig;

use super::{BurstTimes, LayerPerception, MAYBE, Over, Perception, Step, Verdict, weber_steps};
use crate::check::feel;
use crate::tests::{compiled, program};

fn of(layers: &str) -> Perception {
    Perception::of(&program(layers), &TouchConfig::REALISTIC)
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
    Perception::of(&compiled(&format!("version = 1\n{layers}")), &TouchConfig::REALISTIC)
}

/// A layer whose friction is in parts of the reach, at a place of 30 by 20 mm.
fn plate(x_mm: u32, fields: &str) -> String {
    let region = format!("region = {{ x_mm = {x_mm}, y_mm = 20, width_mm = 30, height_mm = 20 }}");
    format!("[[layer]]\n{region}\n{fields}\n")
}

/// A rare burst is as strong as a lasting vibration, and a touch may miss it.
#[test]
fn a_rare_burst_is_judged_while_it_lasts() {
    let vibration = |burst: &str| {
        let fields = "kind = \"vibration\"\nfrequency_hz = 80\nlow_fraction = 0.0\nhigh_fraction = 0.8\n";
        on_example(&format!("[[layer]]\n{fields}{burst}"))
    };
    let (lasting, rare) = (vibration(""), vibration("burst = { period_ms = 5000, on_ms = 100, ramp_ms = 10 }\n"));
    assert_eq!(only(&rare).contrast, only(&lasting).contrast);
    for (rare, lasting) in only(&rare).textures.iter().zip(&only(&lasting).textures) {
        assert_eq!((rare.frequency_hz, rare.amplitude_n), (lasting.frequency_hz, lasting.amplitude_n));
        assert_eq!((rare.verdict, lasting.verdict), (Verdict::NearThreshold, Verdict::Felt));
    }
    assert!(!only(&rare).textures.is_empty());
    let BurstTimes { on_ms, period_ms } = only(&rare).burst.unwrap();
    assert!((on_ms - 100.0).abs() < 1e-3 && (period_ms - 5000.0).abs() < 1e-3);
    assert_eq!(only(&lasting).burst, None);
    let said = feel::sentence(only(&rare));
    assert!(said.starts_with("maybe: ") && said.ends_with("; all this while a burst lasts, 100 ms of every 5000 ms"));
    assert!(said.contains("too rare: a pause of 4.9 s, and a touch of 1 s may fall within it"), "{said}");
}

#[test]
fn a_lone_edge_is_felt_where_it_is() {
    let perception = on_example("[[layer]]\nkind = \"edge\"\nx_mm = 60\ny_mm = 40\nwidth_mm = 3\nridge_n = 0.02\n");
    let layer = only(&perception);
    assert!(layer.is_narrow && (layer.contrast.contrast_n - 0.02).abs() < 1e-5, "{layer:?}");
    assert_eq!(
        feel::sentence(layer),
        "not felt: 250 to 270 mN at a narrow place in it, 0.7 Weber steps: not felt as a step"
    );
    assert!(!only(&of(&grating(2.0, 20.0))).is_narrow);
}

/// A finger feels one friction along the axis, wherever it points, and the other one on its way back.
#[test]
fn a_layer_that_depends_on_the_direction_is_judged_there_and_back() {
    for angle_deg in [0, 45, 90, 200] {
        let fields = format!("kind = \"direction\"\nangle_deg = {angle_deg}\nalong_n = 0.01\nagainst_n = 0.06\n");
        let perception = on_example(&plate(50, &fields));
        let layer = only(&perception);
        assert!(layer.over == Over::Direction && layer.textures.is_empty(), "{layer:?}");
        let found = feel::sentence(layer);
        let (verdict, text) = found.split_once(": ").unwrap();
        assert_eq!(verdict, "maybe");
        assert!(
            text.contains("260 to 310 mN from one direction of the slide to the other, 1.7 Weber steps"),
            "{found}"
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
    let said = feel::sentence(layer);
    assert!(said.contains("; click of it not felt: "), "{said}");
    assert!(
        said.ends_with("0.0 Weber steps: not felt as a step, cut off at the most that the drive can give"),
        "{said}"
    );
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
    assert_eq!(alike(&button(0.4, 0.8), &constant(0.6)), [], "another kind is told by its form");
    let wide = button(0.5, 0.8).replace("rim_width_mm = 3", "rim_width_mm = 6");
    assert_eq!(alike(&button(0.4, 0.8), &wide), [], "a rim is told by its width");
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
    assert_eq!(lines.len(), 1, "{lines:?}");
    assert_eq!(lines[0].0, "not felt");
    assert!(lines[0].1.starts_with("layer 1.1 \"detent 1\" and 5 alike: 250 to 2"), "{lines:?}");
}

/// Of a dial with twelve ticks, each turned, and four keys.
#[test]
fn copies_that_are_turned_are_one_group() {
    let tick = |number: f64| {
        let angle = number * std::f64::consts::TAU / 12.0;
        let (x_mm, y_mm) = (60.0 + 30.0 * angle.cos(), 40.0 + 30.0 * angle.sin());
        format!(
            "[[layer]]\nkind = \"edge\"\nx_mm = {x_mm:.3}\ny_mm = {y_mm:.3}\nangle_deg = {}\nwidth_mm = 8\nridge_fraction = 0.8\n\
             region = {{ shape = \"ellipse\", x_mm = {:.3}, y_mm = {:.3}, width_mm = 12, height_mm = 12 }}\n",
            30.0 * number,
            x_mm - 6.0,
            y_mm - 6.0
        )
    };
    let ticks: String = (0..12).map(|number| tick(number.into())).collect();
    let other = "[[layer]]\nkind = \"edge\"\nx_mm = 60\ny_mm = 40\nwidth_mm = 8\nridge_fraction = 0.7\n\
                 region = { x_mm = 50, y_mm = 30, width_mm = 20, height_mm = 20 }\n";
    let alike = on_example(&(ticks + other)).alike;
    assert_eq!(alike.len(), 1, "{alike:?}");
    assert_eq!(alike[0].copies, [11, 0]);
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
    let texts: Vec<&str> = lines.iter().map(|(_, text)| text.as_str()).collect();
    // The detents cover all of the groove, whose border is there all the same.
    let groove = "layer 1 \"groove\": 250 to 263 mN from the bare screen, 0.5 Weber steps: not felt as a step";
    assert_eq!((lines[0].0, texts[0]), ("not felt", groove));
    assert!(texts[1].starts_with("layer 2.1 \"detent 1\" and 9 alike: 263 to 36"), "{lines:?}");
    assert_eq!(lines.len(), 3, "the ridges are the same: {lines:?}");

    let button = plate(20, "kind = \"button\"\nrim_width_mm = 3\nrim_fraction = 0.9\nface_fraction = 0\n");
    let perception = on_example(&button);
    assert_eq!(only(&perception).textures, []);
    let over_texture =
        grating(2.0, 20.0) + &plate(20, "kind = \"constant\"\nblend = \"multiply\"\nfriction_factor = 0.5\n");
    let over_texture = on_example(&over_texture);
    assert!(!over_texture.layers[1].textures.is_empty(), "what lies below is felt: {over_texture:?}");
}

#[test]
fn what_maybe_means_is_said_once_and_only_then() {
    let said = |high_n: f64| {
        let constant = format!("kind = \"constant\"\nabove = \"natural\"\nfriction_n = {high_n}");
        let perception = on_example(&(plate(20, &constant) + &plate(60, &constant)));
        let lines = feel::lines(&perception);
        let notes = lines.iter().filter(|(_, text)| text == MAYBE).count();
        (lines[0].0, notes)
    };
    // 0.8, 1.7 and 2.7 Weber steps.
    assert_eq!([0.02, 0.05, 0.08].map(said), [("not felt", 0), ("maybe", 1), ("felt", 0)]);
    // At 20 mm/s it is near the threshold.
    let fine = on_example("[[layer]]\nkind = \"grating\"\nwavelength_mm = 1\nlow_fraction = 0\nhigh_fraction = 0.2\n");
    let verdicts: Vec<Verdict> = only(&fine).textures.iter().map(|texture| texture.verdict).collect();
    assert!(verdicts.contains(&Verdict::NearThreshold) && verdicts.contains(&Verdict::Felt), "{verdicts:?}");
    assert_eq!(only(&fine).verdict, Verdict::Felt);
    assert!(!feel::lines(&fine).iter().any(|(name, _)| *name == "note"), "{:?}", feel::lines(&fine));
    assert_eq!(serde_json::to_string(&Verdict::NearThreshold).unwrap(), "\"felt_by_some\"");
}

/// The layers of what designers wrote who believed that anything strong is felt, and what is said of it.
#[test]
fn what_is_too_small_slow_short_or_rare_is_not_called_felt() {
    let key = |size_mm: f64| {
        let region = format!("region = {{ x_mm = 60, y_mm = 40, width_mm = {size_mm}, height_mm = {size_mm} }}");
        format!("[[layer]]\n{region}\nkind = \"constant\"\nfriction_fraction = 0.9\n")
    };
    let layer = |fields: &str| format!("[[layer]]\n{fields}\n");
    let grating = |fields: &str| layer(&format!("kind = \"grating\"\nlow_fraction = 0\nhigh_fraction = 0.9\n{fields}"));
    let edge = |fields: &str| layer(&format!("kind = \"edge\"\nx_mm = 60\ny_mm = 40\nridge_fraction = 0.9\n{fields}"));
    let vibration =
        |fields: &str| layer(&format!("kind = \"vibration\"\nlow_fraction = 0\nhigh_fraction = 0.9\n{fields}"));
    let hundred = "too small for a touch source of 100 reports a second";
    for (layers, verdict, said) in [
        (key(1.0), Verdict::NotFelt, hundred),
        (key(1.5), Verdict::NotFelt, hundred),
        (key(3.0), Verdict::NearThreshold, hundred),
        (key(10.0), Verdict::Felt, "250 to 367 mN from the bare screen, 3.7 Weber steps"),
        (edge("width_mm = 0.3"), Verdict::NotFelt, hundred),
        (edge("width_mm = 4"), Verdict::NearThreshold, hundred),
        (edge("width_mm = 10"), Verdict::Felt, "within it, 3.7 Weber steps"),
        (grating("wavelength_mm = 120\nwave = \"saw\""), Verdict::NearThreshold, "too slow a slope: 1."),
        (grating("wavelength_mm = 300\nwave = \"saw\""), Verdict::NotFelt, "too slow a slope: 0."),
        (grating("wavelength_mm = 40"), Verdict::Felt, "within it, 3.6 Weber steps"),
        (grating("wavelength_mm = 4"), Verdict::Felt, "25 Hz when slid at 100 mm/s, felt from about 7.6 mN, 2.5 to 23"),
        (vibration("frequency_hz = 1000"), Verdict::Unknown, "Hz when slid at"),
        (vibration("frequency_hz = 0.01"), Verdict::NotFelt, "in time"),
        (vibration("frequency_hz = 3"), Verdict::Felt, "in time, 3."),
        (
            vibration("frequency_hz = 80\nburst = { period_ms = 60000, on_ms = 1, ramp_ms = 0 }"),
            Verdict::NotFelt,
            "too short: 1 ms, and 2 ms would do",
        ),
        (
            layer("kind = \"stream\"\nabove = \"zero\"\nlow_n = 0.26\nhigh_n = 0.35"),
            Verdict::Unknown,
            "what is streamed moves it between 260 and 350 mN",
        ),
        (
            layer("kind = \"constant\"\nfriction_fraction = 0.9")
                + &layer("kind = \"speed\"\nspeeds_mm_per_s = [20, 100]\nfactors = [0, 1]"),
            Verdict::Felt,
            "250 to 367 mN from 20 to 100 mm/s, 3.7 Weber steps",
        ),
    ] {
        let perception = on_example(&layers);
        let layer = perception.layers.last().unwrap();
        let text = feel::sentence(layer);
        assert_eq!(layer.verdict, verdict, "{layers}{text}");
        assert!(text.contains(said), "{layers}{text}");
    }
}

#[test]
fn a_faster_touch_source_plays_smaller_elements() {
    let dot = "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.9\n\
               region = { x_mm = 60, y_mm = 40, width_mm = 2.5, height_mm = 2.5 }\n";
    let verdict = |rate_hz| {
        let touch = TouchConfig { rate_hz, ..TouchConfig::REALISTIC };
        only(&Perception::of(&compiled(&format!("version = 1\n{dot}")), &touch)).verdict
    };
    assert_eq!([100.0, 200.0, 500.0].map(verdict), [Verdict::NotFelt, Verdict::Felt, Verdict::Felt]);
}

/// A texture that is slower than 10 Hz is felt as steps, and no harmonic of it is told.
#[test]
fn a_slow_square_wave_has_no_texture() {
    let perception = on_example(
        "[[layer]]\nkind = \"grating\"\nwavelength_mm = 50\nwave = \"square\"\nlow_fraction = 0\nhigh_fraction = 0.9\n",
    );
    let said = feel::sentence(only(&perception));
    assert!(said.starts_with("felt: ") && !said.contains("Hz"), "{said}");
}

#[test]
fn beside_what_is_felt_nothing_less_sure_is_told() {
    let button = plate(20, "kind = \"button\"\nrim_width_mm = 3\nrim_fraction = 0.9\nface_fraction = 0.6\n");
    let lines = feel::lines(&on_example(&button));
    assert_eq!(lines.len(), 1, "{lines:?}");
    assert!(lines[0].0 == "felt" && !lines[0].1.contains("too small"), "{lines:?}");
}

/// The one who asks is at a terminal of 80 by 40 characters, which wraps what is longer.
#[test]
fn many_layers_fit_a_terminal() {
    let layer = |number: usize| {
        let (x_mm, y_mm) = (3 + 19 * (number % 6), 1 + 11 * (number / 6));
        format!(
            "[[layer]]\nname = \"pad {number}\"\nkind = \"constant\"\nfriction_fraction = {}\n\
             region = {{ x_mm = {x_mm}, y_mm = {y_mm}, width_mm = 14, height_mm = 9 }}\n",
            0.1 + 0.02 * number as f64
        )
    };
    let layers: String = (0..37).map(layer).collect();
    let program = compiled(&format!("version = 1\n{layers}"));
    let lines = feel::lines(&Perception::of(&program, &TouchConfig::REALISTIC));
    let rows: usize = lines.iter().map(|(_, text)| (19 + text.chars().count()).div_ceil(80)).sum();
    assert!(rows <= 27, "{rows} rows beside those of costs: {lines:#?}");
    let counted: String = lines.iter().filter(|(name, _)| *name == "more").map(|(_, text)| text.as_str()).collect();
    assert!(counted.contains("felt"), "{lines:#?}");
}

/// On the example finger, on a screen of this size.
fn on_screen(width_mm: u32, height_mm: u32, layers: &str) -> Perception {
    on_example(&format!("[screen]\nwidth_mm = {width_mm}\nheight_mm = {height_mm}\n{layers}"))
}

#[test]
fn a_plate_across_a_long_and_narrow_screen_is_felt_at_its_ends() {
    let plate = "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.9\n\
                 region = { x_mm = 0, y_mm = 500, width_mm = 5, height_mm = 100 }\n";
    let perception = on_screen(5, 2000, plate);
    let border = only(&perception).border.clone().unwrap();
    assert_eq!((border.from, border.step.verdict), (None, Verdict::Felt), "{perception:?}");
}

#[test]
fn a_ridge_is_found_wherever_it_lies_on_a_long_screen() {
    let ridge = "[[layer]]\nkind = \"edge\"\nx_mm = 1500\ny_mm = 10\nwidth_mm = 12\nridge_fraction = 0.9\n";
    let perception = on_screen(2000, 20, ridge);
    let contrast = only(&perception).contrast;
    assert_eq!(contrast.verdict, Verdict::Felt, "{contrast:?}");
    assert!((contrast.weber_steps / weber_steps(0.25, 0.25 + 0.9 * 0.12999) - 1.0).abs() < 0.01, "{contrast:?}");
}

#[test]
fn a_layer_that_joins_those_below_is_not_felt_by_their_contrast() {
    let ridge = |x_mm: u32, fraction: f64, blend: &str| {
        format!(
            "[[layer]]\nkind = \"edge\"\nblend = \"{blend}\"\nx_mm = {x_mm}\ny_mm = 40\nwidth_mm = 12\n\
             ridge_fraction = {fraction}\n"
        )
    };
    for blend in ["add", "max"] {
        let perception = on_example(&(ridge(30, 0.9, blend) + &ridge(90, 0.05, blend)));
        let verdicts: Vec<Verdict> = perception.layers.iter().map(|layer| layer.verdict).collect();
        assert_eq!(verdicts, [Verdict::Felt, Verdict::NotFelt], "{blend}: {perception:#?}");
    }
}

#[test]
fn a_plate_that_joins_a_texture_has_none_itself() {
    let perception = on_example(
        "[[layer]]\nkind = \"vibration\"\nfrequency_hz = 120\nlow_fraction = 0\nhigh_fraction = 0.9\n\
         [[layer]]\nkind = \"constant\"\nblend = \"max\"\nfriction_fraction = 0.9\n",
    );
    assert_eq!(perception.layers[1].textures, [], "{perception:?}");
}

#[test]
fn a_narrow_gap_between_plates_is_not_felt() {
    let half = |x_mm: f64| {
        format!(
            "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.9\n\
             region = {{ x_mm = {x_mm}, y_mm = 0, width_mm = 59.5, height_mm = 80 }}\n"
        )
    };
    let perception = on_screen(120, 80, &(half(0.0) + &half(60.5)));
    for layer in &perception.layers {
        assert_eq!(layer.verdict, Verdict::NotFelt, "{perception:?}");
        assert!(feel::sentence(layer).contains("too small"), "{}", feel::sentence(layer));
    }
}

/// The step onto its region is that of the border.
#[test]
fn stripes_of_a_region_are_as_fine_as_those_of_a_screen() {
    let stripes = "[[layer]]\nkind = \"grating\"\nwavelength_mm = 2\nlow_fraction = 0\nhigh_fraction = 0.95\n";
    let region = "region = { x_mm = 20, y_mm = 20, width_mm = 80, height_mm = 40 }\n";
    let [whole, part] = [stripes.to_owned(), format!("{stripes}{region}")].map(|layers| on_example(&layers));
    let verdicts = [&whole, &part].map(|perception| only(perception).contrast.verdict);
    assert_eq!(verdicts, [Verdict::NotFelt; 2], "{part:?}");
}

/// Too few places of the screen lie on both sides of its border.
#[test]
fn a_small_corner_is_not_said_to_fill_the_screen() {
    let corner = "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.9\n\
                  region = { x_mm = 119.5, y_mm = 79.5, width_mm = 0.5, height_mm = 0.5 }\n";
    let perception = on_screen(120, 80, corner);
    let said = feel::sentence(only(&perception));
    assert_eq!(said, "not felt: 367 mN throughout, without a border that is felt");
}
