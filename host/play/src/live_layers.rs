//! The layers of a program while it plays: their settings, and triggers that end.

use std::time::Duration;

use frixel_layers::{Blend, Layer, Vibration};
use frixel_scene::{Clamped, LayerError, LayerSetting, LayerTitle, Program};
use thiserror::Error;

use crate::trigger::Trigger;

/// Default duration of a trigger, for a layer without pattern and bursts.
const TRIGGER: Duration = Duration::from_millis(100);

/// Why a change of layers is refused.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LiveError {
    /// There is no such layer, or it cannot be changed.
    #[error(transparent)]
    Layer(#[from] LayerError),
    /// The layer is on.
    #[error(
        "layer {layer:?} is on, and a trigger plays a layer that is off: switch it off first with `layer {layer:?} off`"
    )]
    TriggerOn {
        /// The name or number that was given.
        layer: String,
    },
    /// The layer has a gain of zero, and its blend leaves the layers below as they are then.
    #[error(
        "layer {layer:?} has a gain of 0, so a trigger would play nothing: set its gain first with `layer {layer:?} \
         gain 1`"
    )]
    TriggerSilent {
        /// The name or number that was given.
        layer: String,
    },
    /// The layer is of a kind that a trigger does not play.
    #[error("{layer:?} is {what}, so a trigger might play nothing: trigger a `vibration` or a `constant`")]
    TriggerNotFelt {
        /// The name or number that was given.
        layer: String,
        /// Description of the layer, with the way it is played.
        what: &'static str,
    },
    /// The layer plays samples, and none are streamed.
    #[error(
        "layer {layer:?} plays a stream, but none is running, so a trigger would play nothing: add `--stream FILE`"
    )]
    TriggerUnfed {
        /// The name or number that was given.
        layer: String,
    },
    /// The friction at a gain is out of reach.
    #[error("gain {gain} is refused: {clamped}{}", gain_advice(*.range))]
    GainOutOfReach {
        /// The gain that was given.
        gain: f32,
        /// The layers whose friction would be clamped.
        clamped: Clamped,
        /// Smallest and largest gain within reach; `None` if there is none.
        range: Option<(f32, f32)>,
    },
}

fn gain_advice(range: Option<(f32, f32)>) -> String {
    range.map_or(String::new(), |(least, most)| format!("; give a gain from {least} to {most}"))
}

/// A change of layers, which takes effect once the board has accepted it.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerChange {
    /// Numbers of records, from zero, each with its setting from then on.
    pub settings: Vec<(u8, LayerSetting)>,
    /// Layers that the board clamps from then on, if it did not clamp them before.
    pub clamped: Option<Clamped>,
    trigger: TriggerChange,
    /// Settings made by the host, which outlast a replacement of the program.
    sets: Chosen,
}

/// Parts of a layer's setting that the host has set, and that no longer follow the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Chosen {
    on: bool,
    gain: bool,
}

/// Effect of a change on the trigger of its layer.
#[derive(Clone, Copy, Debug, PartialEq)]
enum TriggerChange {
    Keep,
    End,
    /// A trigger begins at the first time, with the layer on, and ends at the second time.
    Begin(Duration, Duration),
    /// The trigger has switched its layer, and continues.
    GoOn(Trigger),
}

impl LayerChange {
    /// A sentence on what the board clamps from now on.
    pub fn notice(&self) -> Option<String> {
        self.clamped.as_ref().map(|clamped| format!("{clamped}; it is clamped there"))
    }
}

/// A program that plays, with the settings of its layers and the ends of its triggers.
///
/// Times are on any clock that only moves forward. A method that changes a layer returns the change for the board. The
/// settings stay the same until the player confirms that the board has accepted the change.
#[derive(Clone, Debug)]
pub struct LiveLayers {
    program: Program,
    /// One for each record.
    settings: Vec<LayerSetting>,
    /// One for each record.
    chosen: Vec<Chosen>,
    triggers: Vec<Trigger>,
}

impl LiveLayers {
    /// Creates the layers of a program that has just begun, as set in its file.
    pub fn new(program: Program) -> Self {
        let chosen = vec![Chosen::default(); program.records.len()];
        Self { settings: program.start.clone(), chosen, triggers: Vec::new(), program }
    }

    /// Returns the layers of a program that replaces this one.
    ///
    /// Live layers that exist in both programs keep the settings made by the host, and their triggers; all others are
    /// as set in the file. A layer without a name is the same if it has the same number and kind.
    ///
    /// If the drive cannot reach the friction with the gains set by the host, all gains are those of the file, and the
    /// second value states why.
    pub(crate) fn followed_by(&self, program: Program) -> (Self, Option<Clamped>) {
        let mut next = Self::new(program);
        let titles = (0..).zip(&next.program.titles).filter(|(record, _)| next.program.layers.is_live(*record));
        for (record, title) in titles {
            let is_same = |other: &LayerTitle| other.name_or_title() == title.name_or_title();
            let Some(before) = self.program.titles.iter().position(is_same) else { continue };
            let (Some(setting), Some(chosen), Some(was), Some(had)) = (
                next.settings.get_mut(usize::from(record)),
                next.chosen.get_mut(usize::from(record)),
                self.settings.get(before),
                self.chosen.get(before),
            ) else {
                continue;
            };
            *chosen = *had;
            if had.gain {
                setting.gain = was.gain;
            }
            let trigger = self.triggers.iter().find(|trigger| usize::from(trigger.record) == before);
            let trigger = trigger.filter(|_| had.on || !setting.on);
            next.triggers.extend(trigger.map(|trigger| Trigger { record, ..*trigger }));
            if had.on || trigger.is_some() {
                setting.on = was.on;
            }
        }
        let dropped = next.clamped_once_all_are_on(&next.settings).filter(|_| next.chosen.iter().any(|had| had.gain));
        if dropped.is_some() {
            for ((setting, chosen), start) in next.settings.iter_mut().zip(&mut next.chosen).zip(&next.program.start) {
                (setting.gain, chosen.gain) = (start.gain, false);
            }
        }
        (next, dropped)
    }

    /// The program.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Switches a layer, or changes its gain; `None` leaves either unchanged. The name of a layer with `repeat` stands
    /// for all its copies.
    ///
    /// # Errors
    ///
    /// Fails for an unknown layer, for a layer that cannot be changed, and for a gain whose friction is out of reach,
    /// now or once all layers are on. A scene that saturates and a draft take any gain.
    pub fn change(&self, layer: &str, on: Option<bool>, gain: Option<f32>) -> Result<LayerChange, LiveError> {
        let program = &self.program;
        let records = program.layers.records(layer)?;
        let changed = self.changed(&records, on, gain);
        let clamped = self.newly_clamped(&changed);
        if let Some(gain) = gain
            && let Some(clamped) = self.clamped_once_all_are_on(&changed)
        {
            let range = program.gains_in_reach(&records, &all_on(&changed));
            return Err(LiveError::GainOutOfReach { gain, clamped, range });
        }
        // A layer that is switched by hand stays as it is when its trigger ends.
        let trigger = if on.is_some() { TriggerChange::End } else { TriggerChange::Keep };
        let sets = Chosen { on: on.is_some(), gain: gain.is_some() };
        Ok(LayerChange { settings: of_records(&records, &changed), clamped, trigger, sets })
    }

    /// Switches on a layer that is off, and off again `duration_s` seconds later.
    ///
    /// The trigger begins at the time `now`, and follows the pattern of the layer if it has one. Without a duration, it
    /// ends after its pattern or its first burst, or else after 0.1 s. If the layer is already triggered, its pattern
    /// or its bursts start over, and it ends at the later of both ends. The name of a layer with `repeat` stands for
    /// all its copies.
    ///
    /// # Errors
    ///
    /// Fails for an unknown layer, a layer that cannot be changed, an edge or a curve of speed, a layer that is on, and
    /// a layer that plays nothing because its gain is zero.
    pub fn trigger(&self, layer: &str, now: Duration, duration_s: Option<f64>) -> Result<LayerChange, LiveError> {
        let records = self.program.layers.records(layer)?;
        for record in &records {
            self.check_trigger(layer, *record)?;
        }
        let changed = self.changed(&records, Some(true), None);
        let given = duration_s.map(|duration_s| Duration::try_from_secs_f64(duration_s).unwrap_or(Duration::MAX));
        let own = || records.first().map_or(TRIGGER, |first| self.own_duration(*first));
        let trigger = TriggerChange::Begin(now, now.saturating_add(given.unwrap_or_else(own)));
        let clamped = self.newly_clamped(&changed);
        // Bursts begin when their layer is switched on.
        let again = of_records(&records, &self.settings).into_iter().filter(|(_, setting)| setting.on);
        let off = again.map(|(record, setting)| (record, LayerSetting { on: false, ..setting }));
        let settings = off.chain(of_records(&records, &changed)).collect();
        Ok(LayerChange { settings, clamped, trigger, sets: Chosen::default() })
    }

    fn check_trigger(&self, layer: &str, record: u8) -> Result<(), LiveError> {
        let layer = || layer.to_owned();
        let played = self.program.records.get(usize::from(record));
        let what = match played.map(|record| &record.layer) {
            Some(Layer::Edge(_)) => Some("an edge, which is felt where a finger crosses it"),
            Some(Layer::Speed(_)) => Some("a curve of speed, which changes what lies below it"),
            _ => None,
        };
        if let Some(what) = what {
            return Err(LiveError::TriggerNotFelt { layer: layer(), what });
        }
        let setting = self.setting(record);
        if setting.on && !self.triggers.iter().any(|trigger| trigger.record == record) {
            return Err(LiveError::TriggerOn { layer: layer() });
        }
        let adds = played.is_some_and(|record| matches!(record.blend, Blend::Add | Blend::Max));
        if adds && setting.gain.abs() <= 0.0 {
            return Err(LiveError::TriggerSilent { layer: layer() });
        }
        Ok(())
    }

    /// Default duration of a trigger of this record.
    fn own_duration(&self, record: u8) -> Duration {
        let pattern = self.pattern(record);
        if !pattern.is_empty() {
            return pattern.iter().sum();
        }
        match self.program.records.get(usize::from(record)).map(|record| &record.layer) {
            Some(Layer::Vibration(Vibration { burst, .. })) if burst.on_s > 0.0 => {
                Duration::from_micros((1e6 * f64::from(burst.on_s)).round() as u64)
            }
            _ => TRIGGER,
        }
    }

    /// The next switch that a trigger makes by `now`, with its record; `None` if there is none. The change has no
    /// notice: the board already clamped the same layers at the trigger's begin or before.
    pub(crate) fn next_switch(&self, now: Duration) -> Option<(u8, LayerChange)> {
        let trigger = *self.triggers.iter().find(|trigger| trigger.next_at <= now)?;
        let (next, on) = trigger.switched(self.pattern(trigger.record));
        let settings = vec![(trigger.record, LayerSetting { on, ..self.setting(trigger.record) })];
        let change = next.map_or(TriggerChange::End, TriggerChange::GoOn);
        Some((trigger.record, LayerChange { settings, clamped: None, trigger: change, sets: Chosen::default() }))
    }

    /// Applies the setting of a record in a change, once the board has accepted it.
    pub(crate) fn apply(&mut self, record: u8, setting: LayerSetting, change: &LayerChange) {
        let LayerChange { trigger, sets, .. } = change;
        if let Some(current) = self.settings.get_mut(usize::from(record)) {
            *current = setting;
        }
        if let Some(chosen) = self.chosen.get_mut(usize::from(record)) {
            *chosen = Chosen { on: chosen.on || sets.on, gain: chosen.gain || sets.gain };
        }
        let next = match *trigger {
            TriggerChange::Keep => return,
            TriggerChange::End => None,
            TriggerChange::GoOn(next) => Some(next),
            TriggerChange::Begin(now, ends_at) => {
                let running = self.triggers.iter().find(|trigger| trigger.record == record);
                let ends_at = running.map_or(ends_at, |running| running.ends_at.max(ends_at));
                Some(Trigger::new(record, now, ends_at, self.pattern(record)))
            }
        };
        self.forget_trigger(record);
        self.triggers.extend(next);
    }

    /// Ends a trigger without a change, because the board refuses it.
    pub(crate) fn forget_trigger(&mut self, record: u8) {
        self.triggers.retain(|trigger| trigger.record != record);
    }

    fn pattern(&self, record: u8) -> &[Duration] {
        self.program.patterns.get(usize::from(record)).map_or(&[], Vec::as_slice)
    }

    /// The setting of a record of the program.
    pub(crate) fn setting(&self, record: u8) -> LayerSetting {
        self.settings.get(usize::from(record)).copied().unwrap_or(LayerSetting { on: true, gain: 1.0 })
    }

    /// The settings of all records of the program.
    pub(crate) fn settings(&self) -> &[LayerSetting] {
        &self.settings
    }

    /// The layers that are off, by their index from the bottom.
    pub fn off(&self) -> Vec<usize> {
        self.settings.iter().enumerate().filter(|(_, setting)| !setting.on).map(|(layer, _)| layer).collect()
    }

    /// When a trigger switches its layer next.
    pub(crate) fn next_switch_at(&self) -> Option<Duration> {
        self.triggers.iter().map(|trigger| trigger.next_at).min()
    }

    /// Returns a copy of all settings, with `on` and `gain` changed for some records.
    fn changed(&self, records: &[u8], on: Option<bool>, gain: Option<f32>) -> Vec<LayerSetting> {
        let mut changed = self.settings.clone();
        for record in records {
            if let Some(setting) = changed.get_mut(usize::from(*record)) {
                *setting = LayerSetting { on: on.unwrap_or(setting.on), gain: gain.unwrap_or(setting.gain) };
            }
        }
        changed
    }

    /// The layers that would be clamped once all are on, since a layer that is off may be switched on later; `None` if
    /// the program may be clamped.
    fn clamped_once_all_are_on(&self, settings: &[LayerSetting]) -> Option<Clamped> {
        let may_clamp = self.program.saturates || self.program.is_draft();
        if may_clamp { None } else { self.program.clamped_with(&all_on(settings)) }
    }

    /// The layers that the board clamps with these settings; `None` if it already clamps the same ones in the same way.
    fn newly_clamped(&self, changed: &[LayerSetting]) -> Option<Clamped> {
        let clamped = self.program.clamped_with(changed)?;
        (self.program.clamped_with(&self.settings).as_ref() != Some(&clamped)).then_some(clamped)
    }
}

/// Returns some records, each with its setting.
fn of_records(records: &[u8], settings: &[LayerSetting]) -> Vec<(u8, LayerSetting)> {
    records.iter().filter_map(|record| Some((*record, *settings.get(usize::from(*record))?))).collect()
}

fn all_on(settings: &[LayerSetting]) -> Vec<LayerSetting> {
    settings.iter().map(|setting| LayerSetting { on: true, ..*setting }).collect()
}

#[cfg(test)]
mod tests;
