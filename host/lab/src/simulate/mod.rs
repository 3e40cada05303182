//! Board, world, stroke and finger from the options of a play, for `play`, `replay` and Python.
//!
//! A world without a play of its own, as in a score or a scenario, is made of [`WorldOptions`] alone.

mod checks;
mod default_stroke;
mod options;

use frixel_hil_sim::{Person, RigConfig, Stroke, StrokeError, TouchConfig, WorldOptions};
use frixel_model::ParameterError;
use frixel_play::Simulation;
use frixel_scene::{CompileError, Program, Scene, Shown};
use thiserror::Error;

use checks::fraction_off_screen;
pub use checks::{check_duration, off_screen_note, ticks_per_row};
pub use default_stroke::{BUNDLED_SCREEN_M, REPEAT_PAUSE_S, default_stroke, endless_sweep};
pub use options::{PlayOptions, STRAIGHT_MAX_M_PER_S, STROKE_MAX_S, StrokeOptions, StrokeOptionsError, TIMES_MAX};

/// Why the options of a play are invalid.
#[derive(Debug, Error)]
pub enum PlayOptionsError {
    /// Rows are not a whole number of ticks apart.
    #[error("{found} rows a second do not divide the board's {tick_hz} ticks a second; give {nearest}")]
    RowRate {
        /// Rows a second.
        found: u32,
        /// Ticks a second.
        tick_hz: u32,
        /// The nearest rates that do.
        nearest: String,
    },
    /// The play is shorter than a tick, or longer than a day.
    #[error(
        "a play lasts from one tick of the board ({tick_s} s) to a day ({STROKE_MAX_S} s); found {} s",
        Shown(*.seconds)
    )]
    Duration {
        /// Its duration, s.
        seconds: f64,
        /// Duration of a tick, s.
        tick_s: f64,
    },
    /// The finger never touches the screen.
    #[error(
        "the stroke is nowhere on the screen, which is {width_mm} by {height_mm} mm: give places in mm from its top \
         left corner"
    )]
    OffScreen {
        /// Width of the screen, mm.
        width_mm: f64,
        /// Its height, mm.
        height_mm: f64,
    },
    /// The options of the stroke are invalid.
    #[error(transparent)]
    Stroke(#[from] StrokeOptionsError),
    /// The scene's screen has no default stroke, or it cannot be repeated.
    #[error("no stroke can be generated for this scene's screen: {0}")]
    DefaultStroke(#[from] StrokeError),
    /// The scene's screen is not known without its own finger.
    #[error(transparent)]
    Screen(#[from] CompileError),
    /// The contact model refuses the person on this screen.
    #[error("the contact model refuses the finger of this person: {0}")]
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
        let ticks_per_row = ticks_per_row(self.rows_hz, tick_hz)?;
        let seconds = self.seconds.or(self.stream_s);
        seconds.map_or(Ok(()), |seconds| check_duration(seconds, tick_hz))?;
        let stroke = match stroke {
            Some(stroke) => Some(stroke),
            None => self.stroke.generated(screen_m(program), seconds, self.seed)?,
        };
        let stroke = stroke.map_or_else(|| default_stroke(program, seconds), Ok)?;
        let seconds = seconds.unwrap_or(stroke.duration_s());
        check_duration(seconds, tick_hz)?;
        fraction_off_screen(&stroke, screen_m(program), seconds)?;
        let is_repeated = self.seconds.is_none() && stroke.duration_s() < seconds;
        let stroke = if is_repeated { stroke.looped(REPEAT_PAUSE_S)? } else { stroke };
        let own_finger = |seed| Person::drawn(seed).own_finger(scene.screen().coating_gap_m());
        let world = WorldOptions {
            ideal: self.ideal,
            no_leakage: self.no_leakage,
            mean_square: self.mean_square,
            touch,
            finger: self.finger_seed.map(own_finger).transpose()?,
        };
        Ok(Simulation { rig: rig.for_drafts().with(&world), seconds, seed: self.seed, ticks_per_row, stroke })
    }
}

/// Width and height of a program's screen, m.
pub fn screen_m(program: &Program) -> [f64; 2] {
    [program.header.screen_width_m.into(), program.header.screen_height_m.into()]
}
