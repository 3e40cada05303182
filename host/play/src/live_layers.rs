//! The layers of a program while it plays: their settings, and triggers that end.

use std::time::Duration;

use frixel_layers::{Blend, Layer, Vibration};
use frixel_scene::{Clamped, LayerError, LayerSetting, LayerTitle, Program};
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
    /// What the host sets, and keeps when another program follows.
    sets: Chosen,
}

/// Which parts of a layer's setting the host has set, so that they do not follow the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Chosen {
    on: bool,
    gain: bool,
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
    /// One for each record.
    chosen: Vec<Chosen>,
    /// Records to switch off, and when.
    triggered: Vec<(u8, Duration)>,
}

impl LiveLayers {
    /// A program that has just begun: its layers are as the file sets them.
    pub fn new(program: Program) -> Self {
        let chosen = vec![Chosen::default(); program.records.len()];
        Self { settings: program.start.clone(), chosen, triggered: Vec::new(), program }
    }

    /// A program that follows this one. Of its live layers, those that this program has, too, keep what the host has set
    /// of them, and their triggers; all others are as the file sets them. A layer without a name is the same if it has
    /// the same number and kind.
    ///
    /// If the drive cannot give what the gains ask for that the host has set, all are those of the file: the second value
    /// says so.
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
            let trigger = self.triggered.iter().find(|(triggered, _)| usize::from(*triggered) == before);
            match trigger {
                Some((_, ends_at)) if had.on || !setting.on => {
                    setting.on = true;
                    next.triggered.push((record, *ends_at));
                }
                _ if had.on => setting.on = was.on,
                _ => {}
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
        if let Some(gain) = gain
            && let Some(clamped) = self.clamped_once_all_are_on(&changed)
        {
            let range = program.gains_in_reach(record, &all_on(&changed));
            return Err(LiveError::GainOutOfReach { gain, clamped, range });
        }
        // A layer that is switched by hand stays as it is when its trigger ends.
        let trigger = if on.is_some() { TriggerChange::End } else { TriggerChange::Keep };
        let sets = Chosen { on: on.is_some(), gain: gain.is_some() };
        Ok(LayerChange { record, setting, clamped, trigger, sets })
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
        Ok(LayerChange { record, setting, clamped, trigger, sets: Chosen::default() })
    }

    /// Switches off the layer of a trigger that has ended by `now`; `None` if no trigger has ended. The change carries no
    /// notice: the board clamps what it clamped before the trigger.
    pub(crate) fn end_trigger(&self, now: Duration) -> Option<LayerChange> {
        let (record, _) = *self.triggered.iter().find(|(_, ends_at)| *ends_at <= now)?;
        let setting = LayerSetting { on: false, ..self.setting(record) };
        Some(LayerChange { record, setting, clamped: None, trigger: TriggerChange::End, sets: Chosen::default() })
    }

    /// Takes over a change that the board has taken.
    pub fn apply(&mut self, change: &LayerChange) {
        let LayerChange { record, setting, trigger, sets, .. } = *change;
        if let Some(current) = self.settings.get_mut(usize::from(record)) {
            *current = setting;
        }
        if let Some(chosen) = self.chosen.get_mut(usize::from(record)) {
            *chosen = Chosen { on: chosen.on || sets.on, gain: chosen.gain || sets.gain };
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

    /// The settings of all records of the program.
    pub(crate) fn settings(&self) -> &[LayerSetting] {
        &self.settings
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

fn all_on(settings: &[LayerSetting]) -> Vec<LayerSetting> {
    settings.iter().map(|setting| LayerSetting { on: true, ..*setting }).collect()
}

#[cfg(test)]
mod tests;
