//! A play on the simulator, as its options describe it.

use std::ops::ControlFlow;

use frixel_hil_sim::{Person, RigConfig, Stroke, StrokeError, TouchConfig, WorldConfig};
use frixel_model::{FrictionLaw, ParameterError};
use frixel_play::Feed;
use frixel_scene::{CompileError, Program, Scene};
use thiserror::Error;

use super::play_options::{PlayOptions, StrokeOptionsError};
use crate::default_stroke::{REPEAT_PAUSE_S, default_stroke};
use crate::simulation::{Play, Simulated, Simulation, SimulationError, play_while, simulate_by};

/// Why options describe no play.
#[derive(Debug, Error)]
pub enum PreparedPlayError {
    /// Rows are not a whole number of ticks apart.
    #[error("rows_per_s divides {tick_hz} evenly, found {found}")]
    RowRate {
        /// Rows a second.
        found: u32,
        /// Ticks a second.
        tick_hz: u32,
    },
    /// The options describe no stroke.
    #[error(transparent)]
    Stroke(#[from] StrokeOptionsError),
    /// The scene's screen has no default stroke, or it cannot be repeated.
    #[error("no stroke can be generated for this scene's screen: {0}")]
    DefaultStroke(#[from] StrokeError),
    /// The scene's screen is not known without its own finger.
    #[error(transparent)]
    Screen(#[from] CompileError),
    /// The contact model refuses the person on this screen.
    #[error("the contact model rejects the finger of this person: {0}")]
    Person(#[from] ParameterError),
}

/// A play on the simulator, with all that it needs beside its program.
#[derive(Clone, Debug)]
pub struct PreparedPlay {
    /// Board, world, stroke, duration and seed.
    pub simulation: Simulation,
    /// The finger of a person whom the board does not know.
    own_finger: Option<FrictionLaw>,
    /// Whether the reference is meant for the simulated finger, which is more than the scene's in steady sliding.
    through_finger: bool,
}

impl PreparedPlay {
    /// The play of `program`, which was compiled from `scene` for the simulated board. `stroke` is that of a file, and
    /// `touch` the touch source, where the options name one.
    pub fn new(
        options: &PlayOptions,
        scene: &Scene,
        program: &Program,
        stroke: Option<Stroke>,
        touch: Option<TouchConfig>,
    ) -> Result<Self, PreparedPlayError> {
        let mut rig = RigConfig::default();
        let tick_hz = rig.board.tick_hz;
        if options.rows_hz == 0 || !tick_hz.is_multiple_of(options.rows_hz) {
            return Err(PreparedPlayError::RowRate { found: options.rows_hz, tick_hz });
        }
        let header = &program.header;
        let screen_m = [header.screen_width_m.into(), header.screen_height_m.into()];
        let seconds = options.seconds.or(options.stream_s);
        let stroke = match stroke {
            Some(stroke) => Some(stroke),
            None => options.stroke.generated(screen_m, seconds, options.seed)?,
        };
        let stroke = stroke.map_or_else(|| default_stroke(program, seconds), Ok)?;
        let seconds = seconds.unwrap_or(stroke.duration_s());
        let is_repeated = options.seconds.is_none() && stroke.duration_s() < seconds;
        let stroke = if is_repeated { stroke.looped(REPEAT_PAUSE_S)? } else { stroke };
        let drawn = |seed| {
            let person = Person::drawn(seed);
            let contact = person.contact(1e-6 * scene.screen().coating_gap_um())?;
            Ok::<_, PreparedPlayError>((person, contact))
        };
        let person = options.finger_seed.map(drawn).transpose()?;
        rig.world = world(options, rig.world, person.as_ref().map(|(person, _)| person), touch);
        // A draft may take longer than a board has time for.
        rig.board.limits.tick_cycles_max = u32::MAX;
        let through_finger = !options.ideal || person.is_some() || stroke.has_loads();
        let ticks_per_row = tick_hz / options.rows_hz;
        let simulation = Simulation { rig, stroke, seconds, seed: options.seed, ticks_per_row };
        Ok(Self { simulation, own_finger: person.map(|(_, contact)| contact.into()), through_finger })
    }

    /// Plays it. `goes_on` is asked many times a second of the play; when it breaks, the record ends there.
    pub fn run(
        &self,
        program: &Program,
        goes_on: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<Simulated, SimulationError> {
        self.run_by(program, None, &mut |player| play_while(player, goes_on))
    }

    /// Plays it with samples for its stream layers, if there are any, while `play` lets the time pass.
    pub(crate) fn run_by(
        &self,
        program: &Program,
        feed: Option<Feed>,
        play: &mut Play<'_>,
    ) -> Result<Simulated, SimulationError> {
        simulate_by(program, &self.simulation, (self.own_finger, self.through_finger), feed, play)
    }
}

fn world(
    options: &PlayOptions,
    ideal: WorldConfig,
    person: Option<&Person>,
    touch: Option<TouchConfig>,
) -> WorldConfig {
    if options.ideal {
        return WorldConfig { touch: touch.map_or(ideal.touch, TouchConfig::without_losses), ..ideal };
    }
    let realistic = ideal.realistic();
    let fingertip = person.map_or(realistic.fingertip, |person| person.fingertip);
    let fingertip = if options.no_leakage { fingertip.without_leakage() } else { fingertip };
    WorldConfig { fingertip, touch: touch.unwrap_or(realistic.touch), ..realistic }
}
