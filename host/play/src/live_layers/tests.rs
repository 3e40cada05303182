use std::collections::BTreeMap;

use frixel_control::Board;
use frixel_scene::{Scene, compile};

use super::*;

/// The simulator's board, with a drive that adds some 0.13 N.
fn program_of(text: &str) -> Program {
    let text = format!("version = 1\n{text}");
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
        let change = self.0.change(layer, on, gain)?;
        Ok(self.take(change))
    }

    fn trigger(&mut self, layer: &str, now: Duration, duration_s: f64) -> Result<LayerChange, LiveError> {
        let change = self.0.trigger(layer, now, Some(duration_s))?;
        Ok(self.take(change))
    }

    fn take(&mut self, change: LayerChange) -> LayerChange {
        for (record, setting) in &change.settings {
            self.0.apply(*record, *setting, &change);
        }
        change
    }

    /// What triggers switch by a time: each record, and whether it is on from then on.
    fn switch(&mut self, now: Duration) -> Vec<(u8, bool)> {
        let mut switched = Vec::new();
        while let Some((record, change)) = self.0.next_switch(now) {
            let change = self.take(change);
            switched.extend(change.settings.iter().map(|(_, setting)| (record, setting.on)));
        }
        switched
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
    assert_eq!(layers.0.next_switch_at(), Some(ms(300)));
    layers.trigger("ping", ms(250), 0.1).expect("it is triggered");
    assert_eq!(layers.0.next_switch_at(), Some(ms(350)));
    assert_eq!(layers.0.next_switch(ms(340)), None);
    let (_, ended) = layers.0.next_switch(ms(350)).expect("it has ended");
    assert!(!ended.settings[0].1.on && layers.0.next_switch_at() == Some(ms(350)), "the board has not taken it");
    assert_eq!(layers.switch(ms(350)), [(0, false)]);
    assert_eq!(layers.0.next_switch_at(), None);
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
            format!("{layer:?} is {what}, so a trigger might play nothing: trigger a `vibration` or a `constant`");
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
        "layer \"ping\" has a gain of 0, so a trigger would play nothing: set its gain first with `layer \"ping\" gain \
         1`"
    );
    // Other blends cut the layers below out, or silence them.
    for blend in ["replace", "multiply"] {
        let mask = if blend == "replace" { "above = \"natural\"\nfriction_n = 0.05" } else { "friction_factor = 0.5" };
        let mask =
            format!("[[layer]]\nname = \"mask\"\nkind = \"constant\"\nblend = \"{blend}\"\nlive = true\n{mask}\n");
        let mut layers = Taking::new(&format!("{}{mask}", layer("wood", "")));
        layers.change("mask", Some(false), Some(0.0)).expect("it is in reach");
        let trigger = layers.trigger("mask", ms(0), 0.1);
        assert!(trigger.is_ok_and(|change| change.settings[0].1.on), "{blend}");
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
    assert!(refused.to_string().ends_with("give a gain from -1 to 1.62"), "{refused}");
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
    assert_eq!(after.next_switch(ms(300)).map(|(record, _)| record), Some(3));
    // A trigger is no switch: what it played starts as the file says once another program follows.
    let (ended, _) = {
        let mut before = before;
        assert_eq!(before.switch(ms(300)), [(1, false)]);
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

#[test]
fn a_trigger_without_a_time_lasts_its_pattern_or_its_burst() {
    let off = "start = \"off\"\n";
    let buzz = "[[layer]]\nname = \"buzz\"\nkind = \"vibration\"\nfrequency_hz = 90\nlow_n = 0\nhigh_n = 0.01\nblend = \"add\"\n\
                live = true\nburst = { period_ms = 900, on_ms = 400 }\n";
    let mut layers = Taking::new(&format!(
        "{}{buzz}{off}{}",
        layer("beats", &format!("pattern_ms = [100, 50, 200]\n{off}")),
        layer("ping", off)
    ));
    for (layer, lasts) in [("beats", 350), ("buzz", 400), ("ping", 100)] {
        let change = layers.0.trigger(layer, ms(1_000), None).expect("it is off");
        assert_eq!(change.trigger, TriggerChange::Begin(ms(1_000), ms(1_000 + lasts)), "{layer}");
    }
    let change = layers.0.trigger("beats", ms(0), None).expect("it is off");
    layers.take(change);
    for (at, on) in [(100, false), (150, true)] {
        assert_eq!((layers.switch(ms(at - 1)), layers.switch(ms(at))), (vec![], vec![(0, on)]), "{at}");
    }
    // Another one begins the pattern anew, and the whole of it is played.
    layers.trigger("beats", ms(160), 0.35).expect("it is triggered");
    for (at, on) in [(260, false), (310, true), (510, false)] {
        assert_eq!((layers.switch(ms(at - 1)), layers.switch(ms(at))), (vec![], vec![(0, on)]), "{at}");
    }
    assert_eq!(layers.0.next_switch_at(), None);
}

#[test]
fn the_name_of_a_repeated_layer_is_that_of_all_its_copies() {
    let keys = "region = { x_mm = 0, y_mm = 0, width_mm = 9, height_mm = 9 }\nrepeat = { columns = 3, dx_mm = 20 }\n";
    let mut layers = Taking::new(&layer("key", keys));
    layers.change("key", Some(false), None).expect("they are live");
    assert_eq!(layers.0.off(), [0, 1, 2]);
    layers.change("key 2", Some(true), Some(0.5)).expect("it is live");
    assert_eq!(layers.0.off(), [0, 2]);
    let refused = layers.trigger("key", ms(0), 0.1).expect_err("one of them is on").to_string();
    assert!(refused.starts_with("layer \"key\" is on"), "{refused}");
    layers.change("1.2", Some(false), None).expect("it is live");
    layers.trigger("1", ms(0), 0.1).expect("all are off");
    assert_eq!((layers.0.off(), layers.0.setting(1).gain), (vec![], 0.5));
    assert_eq!(layers.switch(ms(100)), [(0, false), (1, false), (2, false)]);
    let refused = layers.change("key", None, Some(9.0)).expect_err("it is out of reach").to_string();
    assert!(refused.ends_with("give a gain from 0 to 2.6") || refused.contains("give a gain from"), "{refused}");
}
