//! Scenarios: actions of a host, faults, and the expected outcome.

mod read;
pub(crate) mod tables;
#[cfg(test)]
mod tests;

use frixel_hil_sim::{NoiseConfig, RigFault};
use frixel_wire::fault::{Fault, State};

use crate::compile_error::CompileError;
use crate::fields::read_text;
use crate::file_kind::FileKind;

/// A scenario file (`docs/inside/scenarios.md`). A host connects and plays the scene; times count from the start of the
/// play.
///
/// Amplitudes are fractions of the board's reach in the scene, so that a scenario fits every board.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// The name of the file, as it was given.
    pub file: String,
    /// Description; empty if the file has none.
    pub about: String,
    /// The scene's file, relative to the folder of the scenario.
    pub scene: String,
    /// Duration after the start of the play, s.
    pub seconds: f64,
    /// Seed of all random effects.
    pub seed: u64,
    /// Whether amplifier, finger and touch source are simulated with all their effects.
    pub is_realistic: bool,
    /// Path of the finger; `None` for a sweep over the screen.
    pub stroke: Option<StraightStroke>,
    /// Actions of the host, in chronological order.
    pub commands: Vec<ScenarioCommand>,
    /// Faults, in chronological order.
    pub faults: Vec<ScenarioFault>,
    /// Expected outcomes.
    pub expectations: Vec<Expectation>,
}

impl Scenario {
    /// Reads the text of a scenario's file. Messages call the file `name`.
    ///
    /// ```
    /// let text = "scenario = 1\nscene = \"brick.toml\"\nseconds = 1\n\
    ///             [[command]]\nat_ms = 600\ndo = \"stop\"\n\
    ///             [[expect]]\nfrom_ms = 100\nto_ms = 500\noutput = \"driven\"\n";
    /// let scenario = frixel_scene::Scenario::parse(text, "brick-plays.toml")?;
    /// assert_eq!((scenario.commands.len(), scenario.expectations.len()), (1, 1));
    /// # Ok::<(), frixel_scene::CompileError>(())
    /// ```
    pub fn parse(text: impl AsRef<[u8]>, name: &str) -> Result<Self, CompileError> {
        read_text(FileKind::Scenario, text.as_ref(), name, |fields, log| read::scenario(fields, name, log))
    }

    /// The files of all scenes that the scenario plays.
    pub fn scenes(&self) -> impl Iterator<Item = &str> {
        let replacing = self.commands.iter().filter_map(|command| match &command.action {
            Action::Replace { scene } => Some(scene.as_str()),
            _ => None,
        });
        std::iter::once(self.scene.as_str()).chain(replacing)
    }

    /// Number of board resets.
    pub fn resets(&self) -> usize {
        let is_reset = |cause| matches!(cause, Cause::Rig(RigFault::Reset | RigFault::OptionBytes));
        self.faults.iter().filter(|fault| is_reset(fault.cause)).count()
    }
}

/// A straight stroke at constant speed, repeated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraightStroke {
    /// Start, mm.
    pub from_mm: [f64; 2],
    /// End, mm.
    pub to_mm: [f64; 2],
    /// Speed, mm/s.
    pub speed_mm_per_s: f64,
}

/// A timed action of the host.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioCommand {
    /// Start time, ms. A command that is still running delays the next one.
    pub at_ms: f64,
    /// Name, for expectations.
    pub name: Option<String>,
    /// Line of the file, from one.
    pub line: usize,
    /// The action.
    pub action: Action,
}

/// Action of a host.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Reconnects after giving up the connection.
    Connect,
    /// Uploads the scenario's scene again, arms the board and plays it.
    Play,
    /// Uploads the scenario's scene and commits it.
    Upload,
    /// Stops and disarms the board.
    Stop,
    /// Clears a latched fault.
    ClearFault,
    /// Plays another scene in place of the current one.
    Replace {
        /// Its file.
        scene: String,
    },
    /// Switches a layer on temporarily.
    Trigger {
        /// Name or number of the layer.
        layer: String,
        /// Duration, s; `None` for the duration of the layer's pattern.
        duration_s: Option<f64>,
    },
    /// Sets the gain of a layer.
    SetLayer {
        /// Name or number of the layer.
        layer: String,
        /// The gain.
        gain: Option<f64>,
    },
    /// Suspends the host, including its pings.
    Hang {
        /// Duration, ms.
        ms: f64,
    },
    /// Ends the host without closing the connection, like a killed process.
    Die,
    /// Another program sends a hello on the same line.
    OtherClient,
}

/// A timed fault.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioFault {
    /// Start time, ms.
    pub at_ms: f64,
    /// Duration, ms; `None` until the end.
    pub for_ms: Option<f64>,
    /// Name, for expectations.
    pub name: Option<String>,
    /// Line of the file, from one.
    pub line: usize,
    /// Cause of the fault.
    pub cause: Cause,
}

/// Cause of a fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// A damaged serial line.
    Line {
        /// Whether the direction is affected: to the board, to the host.
        directions: [bool; 2],
        /// Kind of damage.
        damage: LineDamage,
    },
    /// A fault at or around the board.
    Rig(RigFault),
    /// The DAC is stuck at a voltage.
    DacStuck {
        /// Fraction of the scene's largest voltage, limited to full scale.
        fraction: f64,
    },
    /// The board's tick count wraps around after a time.
    TickCountWraps {
        /// Time, ms.
        in_ms: f64,
    },
}

/// Damage to the bytes on a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LineDamage {
    /// All bytes are lost, as with a cut cable.
    Cut,
    /// Some bytes are corrupted.
    Noise(NoiseConfig),
    /// All bytes are delayed.
    Late {
        /// Delay, ms.
        ms: f64,
    },
}

/// Expected outcome in an interval of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    /// Line of the file, from one.
    pub line: usize,
    /// The command or fault that times are relative to; `None` for the start of the first play.
    pub after: Option<String>,
    /// Start of the interval, ms.
    pub from_ms: f64,
    /// End of the interval, ms; `None` for the end of the scenario.
    pub to_ms: Option<f64>,
    /// The condition.
    pub condition: Condition,
}

/// Condition of an expectation.
#[derive(Clone, Debug, PartialEq)]
pub enum Condition {
    /// DAC code is zero in every tick.
    OutputZero,
    /// DAC code is zero and the amplifier is disabled in every tick.
    OutputOff,
    /// DAC code is nonzero at least once, and at least once in every 10 ms.
    OutputDriven,
    /// Electrode voltage is below this fraction of the scene's largest voltage in every tick.
    ElectrodeBelow(f64),
    /// Mean electric friction felt while the finger is down is between these fractions of the largest.
    Friction([f64; 2]),
    /// The board has reported this state by the end of the interval.
    State(State),
    /// The board has reported this fault by the end of the interval.
    Fault(Fault),
    /// A command or the connection fails with a message that contains this text.
    Error(String),
}
