//! The layers of a program while it plays: their settings, and triggers that end.

use std::time::Duration;

use frixel_layers::{Layer, Vibration};
use thiserror::Error;

use super::layer_map::LayerError;
use super::live_change::{Clamped, LayerSetting};
use super::program::Program;

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
    /// A gain leads out of reach.
    #[error("gain {gain} is refused: {clamped}{}", gain_advice(*.range))]
    GainOutOfReach {
        /// The gain that was given.
        gain: f32,
        /// What would be clamped.
        clamped: Clamped,
        /// The least and the largest gain that can be reached; `None` if there is none.
        range: Option<(f32, f32)>,
    },
}

fn gain_advice(range: Option<(f32, f32)>) -> String {
    range.map_or(String::new(), |(least, most)| format!("; give a gain from {least} to {most}"))
}

/// A change that the host has to send to the board.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerChange {
    /// Number of the record, from zero.
    pub record: u8,
    /// Its setting from now on.
    pub setting: LayerSetting,
    /// What the board clamps from now on, if it did not before.
    pub clamped: Option<Clamped>,
}

impl LayerChange {
    /// A sentence on what the board clamps from now on.
    pub fn notice(&self) -> Option<String> {
        self.clamped.as_ref().map(|clamped| format!("{clamped}; it is clamped there"))
    }
}

/// The settings of a program's layers while it plays, and when triggers end. Times are on any clock that only goes
/// forward.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LiveLayers {
    /// One for each record.
    settings: Vec<LayerSetting>,
    /// Records to switch off, and when.
    triggered: Vec<(u8, Duration)>,
}

impl LiveLayers {
    /// The layers of a program that has just begun: all are on, with their gains in the file.
    pub fn new(program: &Program) -> Self {
        let setting = |record: &frixel_layers::Record| LayerSetting { on: true, gain: record.gain };
        Self { settings: program.records.iter().map(setting).collect(), triggered: Vec::new() }
    }

    /// Switches a layer, or changes its gain; `None` leaves as it is.
    ///
    /// # Errors
    ///
    /// An unknown layer, one that cannot be changed, and a gain that leads out of reach in a scene that does not
    /// saturate and is no draft. Nothing is changed then.
    pub fn change(
        &mut self,
        program: &Program,
        layer: &str,
        on: Option<bool>,
        gain: Option<f32>,
    ) -> Result<LayerChange, LiveError> {
        let record = program.layers.record(layer)?;
        let before = program.clamped_with(&self.settings);
        let mut changed = self.settings.clone();
        let setting = set(&mut changed, record, on, gain);
        let clamped = program.clamped_with(&changed).filter(|clamped| before.as_ref() != Some(clamped));
        let is_strict = !program.saturates && !program.is_draft();
        if let (Some(gain), Some(clamped), true) = (gain, &clamped, is_strict) {
            let range = program.gains_in_reach(record, &changed);
            return Err(LiveError::GainOutOfReach { gain, clamped: clamped.clone(), range });
        }
        self.settings = changed;
        if on.is_some() {
            // A layer that is switched by hand stays as it is when its trigger ends.
            self.triggered.retain(|(triggered, _)| *triggered != record);
        }
        Ok(LayerChange { record, setting, clamped })
    }

    /// Switches a layer that is off on at the time `now`, until `duration` later.
    ///
    /// # Errors
    ///
    /// An unknown layer, one that cannot be changed, one that is on, and one whose bursts the trigger may miss.
    pub fn trigger(
        &mut self,
        program: &Program,
        layer: &str,
        now: Duration,
        duration: Duration,
    ) -> Result<LayerChange, LiveError> {
        let record = program.layers.record(layer)?;
        let is_on = self.settings.get(usize::from(record)).is_some_and(|setting| setting.on);
        let is_triggered = self.triggered.iter().any(|(triggered, _)| *triggered == record);
        if is_on && !is_triggered {
            return Err(LiveError::TriggerOn { layer: layer.to_owned() });
        }
        let (duration_s, vibration) =
            (duration.as_secs_f64(), program.records.get(usize::from(record)).map(|record| &record.layer));
        if let Some(Layer::Vibration(Vibration { burst, .. })) = vibration
            && duration_s <= f64::from(burst.period_s - burst.on_s)
        {
            let (period_ms, duration_ms) = (1e3 * f64::from(burst.period_s), 1e3 * duration_s);
            return Err(LiveError::TriggerBetweenBursts { layer: layer.to_owned(), period_ms, duration_ms });
        }
        self.triggered.retain(|(triggered, _)| *triggered != record);
        self.triggered.push((record, now.saturating_add(duration)));
        let setting = set(&mut self.settings, record, Some(true), None);
        Ok(LayerChange { record, setting, clamped: None })
    }

    /// Switches off the layer of a trigger that has ended by `now`; `None` if there is none left.
    pub fn end_trigger(&mut self, now: Duration) -> Option<LayerChange> {
        let index = self.triggered.iter().position(|(_, ends_at)| *ends_at <= now)?;
        let (record, _) = self.triggered.swap_remove(index);
        let setting = set(&mut self.settings, record, Some(false), None);
        Some(LayerChange { record, setting, clamped: None })
    }

    /// The layers that are off, by their index from the bottom.
    pub fn off(&self) -> Vec<usize> {
        self.settings.iter().enumerate().filter(|(_, setting)| !setting.on).map(|(layer, _)| layer).collect()
    }

    /// When the next trigger ends.
    pub fn next_end(&self) -> Option<Duration> {
        self.triggered.iter().map(|(_, ends_at)| *ends_at).min()
    }
}

/// Changes the setting of a record, and returns it.
fn set(settings: &mut [LayerSetting], record: u8, on: Option<bool>, gain: Option<f32>) -> LayerSetting {
    // A record of the program has a setting.
    let mut nothing = LayerSetting { on: true, gain: 1.0 };
    let setting = settings.get_mut(usize::from(record)).unwrap_or(&mut nothing);
    *setting = LayerSetting { on: on.unwrap_or(setting.on), gain: gain.unwrap_or(setting.gain) };
    *setting
}
