//! The world around a simulated or emulated board: which effects it has, and whose finger is in it.

use crate::commands::error::of_finger;
use crate::output::{Effects, WorldReport};
use anyhow::Result;
use frixel_hil_sim::{Person, Stroke, TouchConfig, World, WorldConfig};
use frixel_model::LoadedContact;
use frixel_scene::Scene;

use super::PlayArgs;

/// The world that the options of a play describe.
#[derive(Clone, Debug)]
pub(super) struct SimulatedWorld {
    effects: Effects,
    person: Option<DrawnPerson>,
    /// The touch source, if it is not that of the effects.
    touch: Option<TouchConfig>,
}

/// A person drawn from the population, with their contact with the scene's screen.
#[derive(Clone, Debug)]
struct DrawnPerson {
    seed: u64,
    person: Person,
    contact: LoadedContact<f64>,
}

impl SimulatedWorld {
    /// Reads the options.
    pub(super) fn new(args: &PlayArgs, scene: &Scene) -> Result<Self> {
        let draw = |seed: u64| -> Result<DrawnPerson> {
            let coating_gap_m = 1e-6 * scene.screen().coating_gap_um();
            let person = Person::drawn(seed);
            let contact = person.contact(coating_gap_m).map_err(of_finger)?;
            Ok(DrawnPerson { seed, person, contact })
        };
        let (effects, person) = (args.effects(), args.finger_seed.map(draw).transpose()?);
        Ok(Self { effects, person, touch: args.touch.source(effects == Effects::None)? })
    }

    /// The configuration of this world; `config` has the rates of the board.
    pub(super) fn config(&self, config: WorldConfig) -> WorldConfig {
        if self.effects == Effects::None {
            return WorldConfig { touch: self.touch.unwrap_or(config.touch), ..config };
        }
        let realistic = config.realistic();
        let touch = self.touch.unwrap_or(realistic.touch);
        let fingertip = self.person.as_ref().map_or(realistic.fingertip, |drawn| drawn.person.fingertip);
        let leaks = self.effects == Effects::All;
        WorldConfig { fingertip: if leaks { fingertip } else { fingertip.without_leakage() }, touch, ..realistic }
    }

    /// Puts the drawn person's finger into the world, if there is one.
    pub(super) fn set_finger(&self, world: &mut World) {
        if let Some(drawn) = &self.person {
            world.set_own_finger(drawn.contact);
        }
    }

    /// Whether the simulated finger is more than the scene's finger in steady sliding under its load, so that the
    /// reference is meant for it.
    pub(super) fn has_own_reference(&self, stroke: &Stroke) -> bool {
        self.effects != Effects::None || self.person.is_some() || stroke.has_loads()
    }

    /// What the report says about this world.
    pub(super) fn report(&self) -> WorldReport {
        let touch_source = (&self.config(WorldConfig::IDEAL).touch).into();
        WorldReport { effects: self.effects, touch_source, finger_seed: self.person.as_ref().map(|drawn| drawn.seed) }
    }
}
