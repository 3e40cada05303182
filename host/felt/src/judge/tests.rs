//! Tests the judge on displays without a board: each renders an earlier place of the finger, with a gain.

use std::convert::Infallible;
use std::ops::ControlFlow;

use frixel_hil_sim::{Point, Stroke};
use frixel_scene::Program;
use frixel_scene::reference::{Context, Reference, direction_of};

use super::{Advice, Judgement, LayerVerdict, Reason, Verdict, in_play, judge};
use crate::TO_THE_END;
use crate::check::feel;
use crate::fidelity::{FidelitySample, SAMPLE_HZ};
use crate::tests::compiled;

const STRIPES: &str = "[[layer]]\nkind = \"grating\"\nwavelength_mm = 12\nlow_fraction = 0\nhigh_fraction = 0.9\n";
const WEAVE: &str = "[[layer]]\nkind = \"grating\"\nwavelength_mm = 1\nlow_fraction = 0\nhigh_fraction = 0.4\n";

/// A display with a delay and a gain below 1.
#[derive(Clone, Copy)]
struct Display {
    gain: f64,
    late_s: f64,
}

const FAULTLESS: Display = Display { gain: 1.0, late_s: 0.0 };

impl Display {
    fn play(self, program: &Program, stroke: &Stroke) -> Vec<FidelitySample> {
        let reference = Reference::at_start(program);
        let natural_n = program.reach.natural_friction_n;
        let electric_n = |t_s: f64| {
            let [now, before] = [t_s, (t_s - 1e-4).max(0.0)].map(|t_s| stroke.at(t_s.max(0.0)).unwrap());
            let direction = direction_of([now.x_m - before.x_m, now.y_m - before.y_m]);
            let (x_m, y_m, speed_m_per_s) = (now.x_m, now.y_m, now.speed_m_per_s);
            let context = Context { x_m, y_m, t_s, speed_m_per_s, direction, ..Context::default() };
            reference.electric_friction_at_n(&context).clamp(0.0, program.reach.electric_friction_max_n)
        };
        let sample = |number: u32| {
            let t_s = f64::from(number) / SAMPLE_HZ;
            let state = stroke.at(t_s)?;
            Some(FidelitySample {
                t_s,
                x_m: state.x_m,
                y_m: state.y_m,
                speed_m_per_s: Some(state.speed_m_per_s),
                reference_n: natural_n + electric_n(t_s),
                felt_n: natural_n + self.gain * electric_n(t_s - self.late_s),
                natural_n,
                is_driven: true,
            })
        };
        (0..).map_while(sample).collect()
    }

    fn judged(self, layers: &str) -> Judgement {
        let program = compiled(&format!("version = 1\n{layers}"));
        let play = &mut |program: &Program, stroke: &Stroke| Ok::<_, Infallible>(self.play(program, stroke));
        judge(&program, Advice::Omitted, play).unwrap()
    }

    fn only(self, layers: &str) -> LayerVerdict {
        let mut judgement = self.judged(layers);
        assert_eq!(judgement.layers.len(), 1, "{judgement:?}");
        judgement.layers.remove(0)
    }
}

fn plate(x_mm: u32, fields: &str) -> String {
    format!("[[layer]]\n{fields}\nregion = {{ x_mm = {x_mm}, y_mm = 20, width_mm = 30, height_mm = 20 }}\n")
}

#[test]
fn a_plate_has_a_step_onto_it_and_no_contrast() {
    let found = FAULTLESS.only(&plate(40, "kind = \"constant\"\nfriction_fraction = 0.9"));
    let border = found.border.clone().unwrap();
    assert!(found.is_flat && found.contrast.weber_steps.abs() < 1e-9 && found.texture.is_none(), "{found:?}");
    assert!(border.from.is_none() && (border.step.weber_steps / 3.68 - 1.0).abs() < 0.03, "{border:?}");
    assert_eq!((found.verdict, &found.reasons[..]), (Verdict::Felt, &[][..]));
}

#[test]
fn a_contrast_is_felt_as_far_as_it_is_played() {
    let steps = |gain, late_s| Display { gain, late_s }.only(STRIPES).contrast.weber_steps;
    let whole = steps(1.0, 0.0);
    assert!((3.2..3.7).contains(&whole), "{whole}");
    assert!((steps(1.0, 0.02) / whole - 1.0).abs() < 0.03, "a delay takes nothing");
    assert!((0.4..0.65).contains(&(steps(0.5, 0.0) / whole)));
    assert_eq!(Display { gain: 0.0, late_s: 0.0 }.only(STRIPES).verdict, Verdict::NotFelt);
}

#[test]
fn a_texture_is_felt_as_far_as_its_power_is_played() {
    let texture = |gain, late_s| Display { gain, late_s }.only(WEAVE).texture.unwrap();
    let whole = texture(1.0, 0.005);
    assert!((texture(0.2, 0.0).amplitude_n / whole.amplitude_n - 0.2).abs() < 0.01);
    // Friction added by a display is not a texture of the scene.
    assert!((texture(3.0, 0.0).amplitude_n / whole.amplitude_n - 1.0).abs() < 0.01);
}

#[test]
fn directions_are_compared_there_and_back() {
    for angle_deg in [0, 90, 200] {
        let velvet = format!("kind = \"direction\"\nangle_deg = {angle_deg}\nalong_n = 0.01\nagainst_n = 0.1");
        let velvet = plate(40, &velvet);
        let steps = |gain| Display { gain, late_s: 0.0 }.only(&velvet).contrast.weber_steps;
        let whole = steps(1.0);
        assert!((whole / 2.85 - 1.0).abs() < 0.05 && steps(0.3) < 0.4 * whole, "{whole}");
    }
}

#[test]
fn copies_are_judged_once() {
    let keys = "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.9\nrepeat = { columns = 3, dx_mm = 30 }\n\
                region = { x_mm = 12, y_mm = 20, width_mm = 14, height_mm = 10 }\n";
    let program = compiled(&format!("version = 1\n{keys}"));
    let mut plays = 0;
    let play = &mut |program: &Program, stroke: &Stroke| {
        plays += 1;
        Ok::<_, Infallible>(FAULTLESS.play(program, stroke))
    };
    let judgement = judge(&program, Advice::Omitted, play).unwrap();
    assert_eq!((judgement.layers.len(), plays), (3, 3));
    let lines = feel::lines(&judgement);
    assert!(lines.len() == 1 && lines[0].1.starts_with("layer 1.1 (constant) and 2 alike: "), "{lines:?}");
}

#[test]
fn rare_and_short_bursts_have_their_reasons() {
    let vibration = |burst: &str| {
        let fields = "[[layer]]\nkind = \"vibration\"\nfrequency_hz = 80\nlow_fraction = 0.0\nhigh_fraction = 0.8\n";
        FAULTLESS.only(&format!("{fields}{burst}"))
    };
    let (lasting, rare) = (vibration(""), vibration("burst = { period_ms = 5000, on_ms = 100, ramp_ms = 10 }\n"));
    assert_eq!((lasting.verdict, rare.verdict), (Verdict::Felt, Verdict::Maybe));
    // The pauses are perceived too: a burst fills less than the integration time of touch.
    let [lasting_n, rare_n] = [&lasting, &rare].map(|found| found.texture.unwrap().amplitude_n);
    assert!((0.6..0.95).contains(&(rare_n / lasting_n)), "{rare_n} of {lasting_n}");
    assert!(matches!(rare.reasons[..], [Reason::TooRare { .. }]), "{rare:?}");
    let said = feel::sentence(&rare);
    assert!(said.contains("in bursts of 100 ms, one every 5000 ms; too rare: a pause of 4.9 s"), "{said}");
}

#[test]
fn plates_of_almost_the_same_friction_are_alike() {
    let constant = |fraction: f64| format!("kind = \"constant\"\nfriction_fraction = {fraction}");
    let alike = |one: f64, other: f64| {
        FAULTLESS.judged(&(plate(10, &constant(one)) + &plate(60, &constant(other)))).alike.len()
    };
    assert_eq!([alike(0.9, 0.75), alike(0.9, 0.2), alike(0.9, 0.9)], [1, 0, 0]);
}

#[test]
fn a_hidden_layer_is_not_judged() {
    let constant =
        |fraction: f64| format!("[[layer]]\nkind = \"constant\"\nlive = true\nfriction_fraction = {fraction}\n");
    assert_eq!(FAULTLESS.judged(&(constant(0.2) + &constant(0.4))).layers.len(), 1);
}

/// The output is for a terminal of 80 by 40 characters, which wraps longer lines.
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
    let lines = feel::lines(&FAULTLESS.judged(&(0..37).map(layer).collect::<String>()));
    let rows: usize = lines.iter().map(|(_, text)| (19 + text.chars().count()).div_ceil(80)).sum();
    assert!(rows <= 27, "{rows} rows beside those of costs: {lines:#?}");
    let counted: String = lines.iter().filter(|(name, _)| *name == "more").map(|(_, text)| text.as_str()).collect();
    assert!(counted.contains("felt"), "{lines:#?}");
}

#[test]
fn a_play_is_judged_by_its_own_strokes() {
    let plates = |left: &str| {
        let right = plate(80, "kind = \"constant\"\nfriction_fraction = 0.9");
        compiled(&format!("version = 1\n{}{right}", plate(40, left)))
    };
    let left = "kind = \"constant\"\nfriction_fraction = 0.9";
    let stroke = Stroke::constant_speed(Point { x_m: 0.03, y_m: 0.03 }, Point { x_m: 0.075, y_m: 0.03 }, 0.07).unwrap();
    let layers = |display: Display, left: &str| {
        let program = plates(left);
        in_play(&program, &display.play(&program, &stroke), TO_THE_END).unwrap()
    };
    let verdicts = |layers: Vec<LayerVerdict>| -> Vec<(String, Verdict)> {
        layers.into_iter().map(|found| (found.layer.to_string(), found.verdict)).collect()
    };
    let felt = verdicts(layers(FAULTLESS, left));
    assert_eq!(felt, [("layer 1 (constant)".to_owned(), Verdict::Felt)], "the right one was not touched");
    let forced_to_zero = verdicts(layers(Display { gain: 0.0, late_s: 0.0 }, left));
    assert_eq!(forced_to_zero, [("layer 1 (constant)".to_owned(), Verdict::NotFelt)]);
    assert_eq!(layers(FAULTLESS, &format!("{left}\nlive = true\nstart = \"off\"")), []);
    let program = plates(left);
    let still: Vec<FidelitySample> = FAULTLESS
        .play(&program, &stroke)
        .iter()
        .map(|sample| FidelitySample { speed_m_per_s: Some(0.0), natural_n: 0.0, ..*sample })
        .collect();
    assert_eq!(in_play(&program, &still, TO_THE_END), Some(vec![]), "a finger that rests feels nothing");
    assert_eq!(in_play(&program, &FAULTLESS.play(&program, &stroke), &|| ControlFlow::Break(())), None);
}
