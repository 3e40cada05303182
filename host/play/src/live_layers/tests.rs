use std::collections::BTreeMap;

use frixel_control::Board;
use frixel_scene::{Scene, compile};

use super::*;

/// The simulator's board, with a drive that adds some 0.13 N.
fn program_of(text: &str) -> Program {
    let text = format!("version = 2\n{text}");
    let scene = Scene::parse(&text, "live.toml", &BTreeMap::new()).expect("it is a scene");
    compile(&scene, &Board::SIMULATOR.limits, 40_000).expect("it compiles")
}

fn layer(name: &str, more: &str) -> String {
    format!(
        "[[layer]]\nname = \"{name}\"\nkind = \"constant\"\nabove = \"natural\"\nfriction_n = 0.05\nblend = \"add\"\n\
         live = true\n{more}"
    )
}

/// The layers of a scene on a board that takes every change.
struct Taking(LiveLayers);

impl Taking {
    fn new(text: &str) -> Self {
        Self(LiveLayers::new(program_of(text)))
    }

    fn change(&mut self, layer: &str, on: Option<bool>, gain: Option<f32>) -> Result<LayerChange, LiveError> {
        self.0.change(layer, on, gain).inspect(|change| self.0.apply(change))
    }

    fn trigger(&mut self, layer: &str, now: Duration, duration_s: f64) -> Result<LayerChange, LiveError> {
        self.0.trigger(layer, now, duration_s).inspect(|change| self.0.apply(change))
    }
}

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

#[test]
fn a_second_trigger_does_not_shorten_the_first() {
    let mut layers = Taking::new(&layer("ping", ""));
    layers.change("ping", Some(false), None).expect("it is live");
    layers.trigger("ping", ms(0), 0.3).expect("it is off");
    layers.trigger("ping", ms(50), 0.1).expect("it is triggered");
    assert_eq!(layers.0.next_end(), Some(ms(300)));
    layers.trigger("ping", ms(250), 0.1).expect("it is triggered");
    assert_eq!(layers.0.next_end(), Some(ms(350)));
    assert_eq!(layers.0.end_trigger(ms(340)), None);
    let ended = layers.0.end_trigger(ms(350)).expect("it has ended");
    assert!(!ended.setting.on && layers.0.next_end() == Some(ms(350)), "the board has not taken it");
    layers.0.apply(&ended);
    assert_eq!(layers.0.next_end(), None);
}

#[test]
fn a_trigger_of_a_layer_that_time_does_not_play_is_refused() {
    let edge = "[[layer]]\nname = \"bump\"\nkind = \"edge\"\nx_mm = 60\ny_mm = 40\nwidth_mm = 4\nridge_n = 0.01\nlive = true\n";
    let speed =
        "[[layer]]\nname = \"soft\"\nkind = \"speed\"\nspeeds_mm_per_s = [20, 150]\nfactors = [0.3, 1]\nlive = true\n";
    let mut layers = Taking::new(&format!("{edge}{speed}"));
    for (layer, what) in [
        ("bump", "an edge, which is felt where a finger crosses it"),
        ("soft", "a curve of speed, which changes what lies below it"),
    ] {
        layers.change(layer, Some(false), None).expect("it is live");
        let refused = layers.trigger(layer, ms(0), 0.1).expect_err("nothing would be felt").to_string();
        let sentence =
            format!("{layer:?} is {what}, so that a trigger may play nothing: trigger a `vibration` or a `constant`");
        assert_eq!(refused, sentence);
    }
}

#[test]
fn a_trigger_of_no_gain_is_refused() {
    let mut layers = Taking::new(&layer("ping", ""));
    layers.change("ping", Some(false), Some(0.0)).expect("it is in reach");
    let refused = layers.trigger("ping", ms(0), 0.1).expect_err("nothing would be felt");
    assert_eq!(
        refused.to_string(),
        "layer \"ping\" has a gain of 0 and adds nothing, so that a trigger plays nothing: give it one first, by \
         `layer \"ping\" gain 1`"
    );
    // Other blends cut the layers below out, or silence them.
    for blend in ["replace", "multiply"] {
        let mask = if blend == "replace" { "above = \"natural\"\nfriction_n = 0.05" } else { "friction_factor = 0.5" };
        let mask =
            format!("[[layer]]\nname = \"mask\"\nkind = \"constant\"\nblend = \"{blend}\"\nlive = true\n{mask}\n");
        let mut layers = Taking::new(&format!("{}{mask}", layer("wood", "")));
        layers.change("mask", Some(false), Some(0.0)).expect("it is in reach");
        let trigger = layers.trigger("mask", ms(0), 0.1);
        assert!(trigger.is_ok_and(|change| change.setting.on), "{blend}");
    }
}

/// Outlines cut the screen into many cells, each of which is searched.
#[test]
fn the_gain_of_a_texture_in_an_outline_is_judged() {
    let circles = "[[layer]]\nname = \"wood\"\nkind = \"grating\"\nabove = \"natural\"\nwavelength_mm = 1.3\n\
         low_n = 0.0\nhigh_n = 0.05\nlive = true\n\
         region = { shape = \"ellipse\", x_mm = 5, y_mm = 10, width_mm = 30, height_mm = 30 }\n\
         repeat = { columns = 3, dx_mm = 32 }\n";
    let mut layers = Taking::new(circles);
    layers.change("1.2", None, Some(2.0)).expect("it is in reach");
    let refused = layers.change("1.2", None, Some(4.0)).expect_err("it is out of reach").to_string();
    assert!(refused.starts_with("gain 4 is refused: layer 1.2 \"wood 2\" would ask for up to 0.2"), "{refused}");
}

/// A layer that is off is not clamped, but may be switched on.
#[test]
fn a_gain_is_judged_as_if_all_layers_were_on() {
    let text = format!("{}{}", layer("A", ""), layer("B", ""));
    let mut layers = Taking::new(&text);
    layers.change("A", Some(false), None).expect("it is live");
    layers.change("B", Some(false), None).expect("it is live");
    let before = layers.0.settings.clone();
    let refused = layers.change("B", None, Some(2.0)).expect_err("with A it is out of reach");
    assert!(refused.to_string().starts_with("gain 2 is refused: layer 1 \"A\" and layer 2 \"B\" would"), "{refused}");
    assert!(refused.to_string().ends_with("give a gain from -1 to 1.59"), "{refused}");
    assert_eq!(layers.0.settings, before);
    for layer in ["A", "B"] {
        let on = layers.change(layer, Some(true), None).expect("it is live");
        assert_eq!(on.notice(), None);
    }
    // With `saturate` it is taken, and the notice comes when it is felt.
    let mut layers = Taking::new(&format!("[drive]\nsaturate = true\n{text}"));
    let change = layers.change("B", Some(false), Some(5.0)).expect("it is clamped");
    assert_eq!(change.notice(), None);
    let on = layers.change("B", Some(true), None).expect("it is clamped");
    assert!(on.notice().is_some_and(|notice| notice.ends_with("it is clamped there")));
    layers.change("B", Some(false), None).expect("it is live");
    let triggered = layers.trigger("B", ms(0), 0.1).expect("it is off");
    assert_eq!(triggered.notice(), on.notice());
}

/// A layer has its name in both programs, or else its number and kind.
#[test]
fn a_program_that_follows_keeps_what_was_set() {
    let low = |name: &str, more: &str| layer(name, more).replace("0.05", "0.01");
    let off = |name: &str| low(name, "start = \"off\"\n");
    let unnamed = low("", "").replace("name = \"\"\n", "");
    let mut before = Taking::new(&format!("{unnamed}{}{}", off("A"), low("B", "")));
    before.change("1", Some(false), None).expect("it is live");
    before.change("B", None, Some(0.5)).expect("it is in reach");
    before.trigger("A", ms(0), 0.3).expect("it is off");
    let next = program_of(&format!("{unnamed}{}{}{}", low("B", "gain = 0.2\n"), off("C"), off("A")));
    let (after, dropped) = before.0.followed_by(next);
    assert_eq!((after.off(), dropped), (vec![0, 2], None), "only what was switched, and what starts off, is off");
    assert!((after.setting(1).gain - 0.5).abs() < 1e-6);
    assert_eq!(after.end_trigger(ms(300)).map(|ended| ended.record), Some(3));
    // A trigger is no switch: what it played starts as the file says once another program follows.
    let (ended, _) = {
        let mut before = before;
        let end = before.0.end_trigger(ms(300)).expect("it has ended");
        before.0.apply(&end);
        before.0.followed_by(program_of(&low("A", "")))
    };
    assert_eq!(ended.off(), Vec::<usize>::new());
}

#[test]
fn gains_that_lead_out_of_reach_in_the_next_program_are_dropped_and_said() {
    let mut before = Taking::new(&layer("A", ""));
    before.change("A", Some(false), Some(2.0)).expect("it is in reach");
    let (after, dropped) = before.0.followed_by(program_of(&layer("A", "").replace("0.05", "0.1")));
    assert_eq!(after.setting(0), LayerSetting { on: false, gain: 1.0 }, "it is off all the same");
    assert!(dropped.is_some_and(|clamped| clamped.to_string().contains("up to 0.2 N")));
}
