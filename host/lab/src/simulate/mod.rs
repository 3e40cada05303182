//! From the options of a play to its board, world, stroke and finger: the one way for `play`, `replay` and Python.
//!
//! A world without a play of its own, as in a score or a scenario, is made of [`WorldOptions`] alone.

mod default_stroke;
mod options;

use frixel_hil_sim::{Person, RigConfig, Stroke, StrokeError, TouchConfig, WorldOptions};
use frixel_model::ParameterError;
use frixel_play::Simulation;
use frixel_scene::{CompileError, Program, Scene};
use thiserror::Error;

pub use default_stroke::{REPEAT_PAUSE_S, default_stroke};
pub use options::{PlayOptions, STROKE_MAX_S, StrokeOptions, StrokeOptionsError};

/// Why options describe no play.
#[derive(Debug, Error)]
pub enum PlayOptionsError {
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

impl PlayOptions {
    /// The play of `program`, which was compiled from `scene`, on the simulated board of `rig`: its world is that of
    /// `rig` with the effects of the options. `stroke` is that of a file, and `touch` the touch source, where the
    /// options name one.
    pub fn simulation(
        &self,
        scene: &Scene,
        program: &Program,
        (stroke, touch): (Option<Stroke>, Option<TouchConfig>),
        rig: &RigConfig,
    ) -> Result<Simulation, PlayOptionsError> {
        let tick_hz = rig.board.tick_hz;
        if self.rows_hz == 0 || !tick_hz.is_multiple_of(self.rows_hz) {
            return Err(PlayOptionsError::RowRate { found: self.rows_hz, tick_hz });
        }
        let seconds = self.seconds.or(self.stream_s);
        let stroke = match stroke {
            Some(stroke) => Some(stroke),
            None => self.stroke.generated(screen_m(program), seconds, self.seed)?,
        };
        let stroke = stroke.map_or_else(|| default_stroke(program, seconds), Ok)?;
        let seconds = seconds.unwrap_or(stroke.duration_s());
        let is_repeated = self.seconds.is_none() && stroke.duration_s() < seconds;
        let stroke = if is_repeated { stroke.looped(REPEAT_PAUSE_S)? } else { stroke };
        let own_finger = |seed| Person::drawn(seed).own_finger(1e-6 * scene.screen().coating_gap_um());
        let world = WorldOptions {
            ideal: self.ideal,
            no_leakage: self.no_leakage,
            touch,
            finger: self.finger_seed.map(own_finger).transpose()?,
        };
        Ok(Simulation {
            rig: rig.for_drafts().with(&world),
            seconds,
            seed: self.seed,
            ticks_per_row: tick_hz / self.rows_hz,
            // In steady sliding, the simulated finger is then more than the scene's under its load.
            through_finger: !self.ideal || world.finger.is_some() || stroke.has_loads(),
            stroke,
        })
    }
}

fn screen_m(program: &Program) -> [f64; 2] {
    [program.header.screen_width_m.into(), program.header.screen_height_m.into()]
}
