//! The layers of a program while it plays: their settings, and triggers that end.

use std::time::Duration;

use frixel_layers::{Blend, Layer, Record, Vibration};
use frixel_scene::{Clamped, LayerError, LayerSetting, Program};
use thiserror::Error;

/// Why layers are not changed as a host asks.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LiveError {
    /// There is no such layer, or it cannot be changed.
    #[error(transparent)]
    Layer(#[from] LayerError),
    /// The layer is on.
    #[error(
        "layer {layer:?} is on, and a trigger plays a layer that is off: switch it off first, by `layer {layer:?} off`"
    )]
    TriggerOn {
        /// The name or number that was given.
        layer: String,
    },
    /// The layer may be silent for the whole trigger.
    #[error(
        "layer {layer:?} comes in bursts, one every {period_ms:.0} ms, so that a trigger of {duration_ms:.0} ms may be \
         silent: leave `burst` out in the file, or trigger it for {period_ms:.0} ms or more"
    )]
    TriggerBetweenBursts {
        /// The name or number that was given.
        layer: String,
        /// From one burst to the next, ms.
        period_ms: f64,
        /// Of the trigger, ms.
        duration_ms: f64,
    },
    /// The layer has a gain of zero, and its blend leaves the layers below as they are then.
    #[error(
        "layer {layer:?} has a gain of 0 and adds nothing, so that a trigger plays nothing: give it one first, by \
         `layer {layer:?} gain 1`"
    )]
    TriggerSilent {
        /// The name or number that was given.
        layer: String,
    },
    /// The layer is of a kind that a trigger does not play.
    #[error("{layer:?} is {what}, so that a trigger may play nothing: trigger a `vibration` or a `constant`")]
    TriggerNotFelt {
        /// The name or number that was given.
        layer: String,
        /// What is played by something else than a trigger.
        what: &'static str,
    },
    /// The layer plays samples, and none are streamed.
    #[error(
        "layer {layer:?} plays what is streamed, and nothing is, so that a trigger plays nothing: give `--stream FILE`"
    )]
    TriggerUnfed {
        /// The name or number that was given.
        layer: String,
    },
    /// A gain leads out of reach.
    #[error("gain {gain} is refused: {clamped}{}", gain_advice(*.range))]
    GainOutOfReach {
        /// The gain that was given.
        gain: f32,
        /// The layers whose friction would be clamped.
        clamped: Clamped,
        /// The least and the largest gain that can be reached; `None` if there is none.
        range: Option<(f32, f32)>,
    },
}

fn gain_advice(range: Option<(f32, f32)>) -> String {
    range.map_or(String::new(), |(least, most)| format!("; give a gain from {least} to {most}"))
}

/// A change of a layer that the board has to take before it counts; see [`LiveLayers::apply`].
#[derive(Clone, Debug, PartialEq)]
pub struct LayerChange {
    /// Number of the record, from zero.
    pub record: u8,
    /// Its setting from then on.
    pub setting: LayerSetting,
    /// What the board clamps from then on, if it did not before.
    pub clamped: Option<Clamped>,
    trigger: TriggerChange,
}

/// What a change does to the trigger of its layer.
#[derive(Clone, Copy, Debug, PartialEq)]
enum TriggerChange {
    Keep,
    End,
    /// The layer is switched off at this time.
    Until(Duration),
}

impl LayerChange {
    /// A sentence on what the board clamps from now on.
    pub fn notice(&self) -> Option<String> {
        self.clamped.as_ref().map(|clamped| format!("{clamped}; it is clamped there"))
    }
}

/// A program that plays, with the settings of its layers, and when triggers end. Times are on any clock that only goes
/// forward.
///
/// A method that changes a layer returns the change for the board, and the settings stay as they are until
/// [`Self::apply`] is told that the board has taken it.
#[derive(Clone, Debug)]
pub struct LiveLayers {
    program: Program,
    /// One for each record.
    settings: Vec<LayerSetting>,
    /// Records to switch off, and when.
    triggered: Vec<(u8, Duration)>,
}

impl LiveLayers {
    /// A program that has just begun: all layers are on, with their gains in the file.
    pub fn new(program: Program) -> Self {
        let setting = |record: &Record| LayerSetting { on: true, gain: record.gain };
        Self { settings: program.records.iter().map(setting).collect(), triggered: Vec::new(), program }
    }

    /// The program.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The program, whose layers are in any setting.
    pub(crate) fn into_program(self) -> Program {
        self.program
    }

    /// Switches a layer, or changes its gain; `None` leaves as it is.
    ///
    /// # Errors
    ///
    /// An unknown layer, one that cannot be changed, and a gain that leads out of reach, now or once all layers are on,
    /// in a scene that does not saturate and is no draft.
    pub fn change(&self, layer: &str, on: Option<bool>, gain: Option<f32>) -> Result<LayerChange, LiveError> {
        let program = &self.program;
        let record = program.layers.record(layer)?;
        let (changed, setting) = self.changed(record, on, gain);
        let clamped = self.newly_clamped(&changed);
        if let Some(gain) = gain.filter(|_| !program.saturates && !program.is_draft()) {
            // A layer that is off may be switched on later.
            let all_on: Vec<LayerSetting> =
                changed.iter().map(|setting| LayerSetting { on: true, ..*setting }).collect();
            if let Some(clamped) = program.clamped_with(&all_on) {
                let range = program.gains_in_reach(record, &all_on);
                return Err(LiveError::GainOutOfReach { gain, clamped, range });
            }
        }
        // A layer that is switched by hand stays as it is when its trigger ends.
        let trigger = if on.is_some() { TriggerChange::End } else { TriggerChange::Keep };
        Ok(LayerChange { record, setting, clamped, trigger })
    }

    /// Switches a layer that is off on at the time `now`, until `duration_s` seconds later. If it is triggered already,
    /// it is switched off at the later of both ends.
    ///
    /// # Errors
    ///
    /// An unknown layer, one that cannot be changed, an edge or a curve of speed, one that is on, one that plays nothing
    /// because its gain is zero, and one whose bursts the trigger may miss.
    pub fn trigger(&self, layer: &str, now: Duration, duration_s: f64) -> Result<LayerChange, LiveError> {
        let record = self.program.layers.record(layer)?;
        let played = self.program.records.get(usize::from(record));
        let what = match played.map(|record| &record.layer) {
            Some(Layer::Edge(_)) => Some("an edge, which is felt where a finger crosses it"),
            Some(Layer::Speed(_)) => Some("a curve of speed, which changes what lies below it"),
            _ => None,
        };
        if let Some(what) = what {
            return Err(LiveError::TriggerNotFelt { layer: layer.to_owned(), what });
        }
        let (changed, setting) = self.changed(record, Some(true), None);
        let was_on = self.setting(record).on;
        let triggered_until =
            self.triggered.iter().find(|(triggered, _)| *triggered == record).map(|(_, ends_at)| *ends_at);
        if was_on && triggered_until.is_none() {
            return Err(LiveError::TriggerOn { layer: layer.to_owned() });
        }
        let adds = played.is_some_and(|record| matches!(record.blend, Blend::Add | Blend::Max));
        if adds && setting.gain.abs() <= 0.0 {
            return Err(LiveError::TriggerSilent { layer: layer.to_owned() });
        }
        if let Some(Layer::Vibration(Vibration { burst, .. })) = played.map(|record| &record.layer)
            && duration_s <= f64::from(burst.period_s - burst.on_s)
        {
            let (period_ms, duration_ms) = (1e3 * f64::from(burst.period_s), 1e3 * duration_s);
            return Err(LiveError::TriggerBetweenBursts { layer: layer.to_owned(), period_ms, duration_ms });
        }
        let duration = Duration::try_from_secs_f64(duration_s).unwrap_or(Duration::MAX);
        let ends_at = now.saturating_add(duration);
        let trigger = TriggerChange::Until(triggered_until.map_or(ends_at, |until| until.max(ends_at)));
        let clamped = self.newly_clamped(&changed);
        Ok(LayerChange { record, setting, clamped, trigger })
    }

    /// Switches off the layer of a trigger that has ended by `now`; `None` if no trigger has ended. The change carries no
    /// notice: the board clamps what it clamped before the trigger.
    pub(crate) fn end_trigger(&self, now: Duration) -> Option<LayerChange> {
        let (record, _) = *self.triggered.iter().find(|(_, ends_at)| *ends_at <= now)?;
        let setting = LayerSetting { on: false, ..self.setting(record) };
        Some(LayerChange { record, setting, clamped: None, trigger: TriggerChange::End })
    }

    /// Takes over a change that the board has taken.
    pub fn apply(&mut self, change: &LayerChange) {
        let LayerChange { record, setting, trigger, .. } = *change;
        if let Some(current) = self.settings.get_mut(usize::from(record)) {
            *current = setting;
        }
        if trigger != TriggerChange::Keep {
            self.forget_trigger(record);
        }
        if let TriggerChange::Until(ends_at) = trigger {
            self.triggered.push((record, ends_at));
        }
    }

    /// Ends a trigger whose end the board refuses.
    pub(crate) fn forget_trigger(&mut self, record: u8) {
        self.triggered.retain(|(triggered, _)| *triggered != record);
    }

    /// The setting of a record of the program.
    pub(crate) fn setting(&self, record: u8) -> LayerSetting {
        self.settings.get(usize::from(record)).copied().unwrap_or(LayerSetting { on: true, gain: 1.0 })
    }

    /// The layers that are off, by their index from the bottom.
    pub fn off(&self) -> Vec<usize> {
        self.settings.iter().enumerate().filter(|(_, setting)| !setting.on).map(|(layer, _)| layer).collect()
    }

    /// When the next trigger ends.
    pub(crate) fn next_end(&self) -> Option<Duration> {
        self.triggered.iter().map(|(_, ends_at)| *ends_at).min()
    }

    /// Returns a copy of all settings in which a record has another one, and that one.
    fn changed(&self, record: u8, on: Option<bool>, gain: Option<f32>) -> (Vec<LayerSetting>, LayerSetting) {
        let before = self.setting(record);
        let setting = LayerSetting { on: on.unwrap_or(before.on), gain: gain.unwrap_or(before.gain) };
        let mut changed = self.settings.clone();
        if let Some(before) = changed.get_mut(usize::from(record)) {
            *before = setting;
        }
        (changed, setting)
    }

    /// The layers that the board clamps with these settings; `None` if it already clamps the same ones in the same way.
    fn newly_clamped(&self, changed: &[LayerSetting]) -> Option<Clamped> {
        let clamped = self.program.clamped_with(changed)?;
        (self.program.clamped_with(&self.settings).as_ref() != Some(&clamped)).then_some(clamped)
    }
}

#[cfg(test)]
mod tests {
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
        let speed = "[[layer]]\nname = \"soft\"\nkind = \"speed\"\nspeeds_mm_per_s = [20, 150]\nfactors = [0.3, 1]\nlive = true\n";
        let mut layers = Taking::new(&format!("{edge}{speed}"));
        for (layer, what) in [
            ("bump", "an edge, which is felt where a finger crosses it"),
            ("soft", "a curve of speed, which changes what lies below it"),
        ] {
            layers.change(layer, Some(false), None).expect("it is live");
            let refused = layers.trigger(layer, ms(0), 0.1).expect_err("nothing would be felt").to_string();
            let sentence = format!(
                "{layer:?} is {what}, so that a trigger may play nothing: trigger a `vibration` or a `constant`"
            );
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
            let mask =
                if blend == "replace" { "above = \"natural\"\nfriction_n = 0.05" } else { "friction_factor = 0.5" };
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
        assert!(
            refused.to_string().starts_with("gain 2 is refused: layer 1 \"A\" and layer 2 \"B\" would"),
            "{refused}"
        );
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
}
