//! Scenarios: what a host does with a board, what goes wrong meanwhile, and what has to be seen of it.

mod read;
pub(crate) mod tables;
#[cfg(test)]
mod tests;

use frixel_hil_sim::{NoiseConfig, RigFault};
use frixel_wire::fault::{Fault, State};

use crate::compile_error::CompileError;
use crate::fields::read_text;

/// A scenario, as its file says it (`docs/scenarios.md`). A host connects and plays the scene; times count from there.
///
/// A fraction is of what the board reaches with the scene, so that a scenario fits every board.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// The name of the file, as it was given.
    pub file: String,
    /// What the scenario shows; empty if the file does not say it.
    pub about: String,
    /// The scene's file, relative to the folder of the scenario.
    pub scene: String,
    /// How long it runs after the play began, s.
    pub seconds: f64,
    /// Seed of all that is random.
    pub seed: u64,
    /// Whether the world has every effect of amplifier, finger and touch source.
    pub is_realistic: bool,
    /// Where the finger goes; `None` for a sweep over the screen.
    pub stroke: Option<StraightStroke>,
    /// What the host does, in the order of time.
    pub commands: Vec<ScenarioCommand>,
    /// What goes wrong, in the order of time.
    pub faults: Vec<ScenarioFault>,
    /// What has to be seen.
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
    pub fn parse(text: &str, name: &str) -> Result<Self, CompileError> {
        read_text(text, name, "this scenario", |fields, log| read::scenario(fields, name, log))
    }

    /// The files of all scenes that the scenario plays.
    pub fn scenes(&self) -> impl Iterator<Item = &str> {
        let replacing = self.commands.iter().filter_map(|command| match &command.action {
            Action::Replace { scene } => Some(scene.as_str()),
            _ => None,
        });
        std::iter::once(self.scene.as_str()).chain(replacing)
    }

    /// How often the board is reset.
    pub fn resets(&self) -> usize {
        let is_reset = |cause| matches!(cause, Cause::Rig(RigFault::Reset | RigFault::OptionBytes));
        self.faults.iter().filter(|fault| is_reset(fault.cause)).count()
    }
}

/// A stroke along a line at constant speed, again and again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraightStroke {
    /// Where it begins, mm.
    pub from_mm: [f64; 2],
    /// Where it ends, mm.
    pub to_mm: [f64; 2],
    /// Its speed, mm/s.
    pub speed_mm_per_s: f64,
}

/// Something that the host does.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioCommand {
    /// When it begins, ms. A command that takes longer than until the next one delays it.
    pub at_ms: f64,
    /// Its name, for expectations.
    pub name: Option<String>,
    /// Line of the file, from one.
    pub line: usize,
    /// What the host does.
    pub action: Action,
}

/// What a host does.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Connects again, after the connection was given up.
    Connect,
    /// Uploads the scenario's scene again, arms the board and plays.
    Play,
    /// Uploads the scenario's scene and commits it.
    Upload,
    /// Stops and disarms the board.
    Stop,
    /// Clears a latched fault.
    ClearFault,
    /// Plays another scene in place of the one that plays.
    Replace {
        /// Its file.
        scene: String,
    },
    /// Switches a layer on for a time.
    Trigger {
        /// Its name or its number.
        layer: String,
        /// How long, in s; `None` for as long as its pattern lasts.
        duration_s: Option<f64>,
    },
    /// Sets the gain of a layer.
    SetLayer {
        /// Its name or its number.
        layer: String,
        /// The gain.
        gain: Option<f64>,
    },
    /// Does nothing, not even ping, for a time in ms.
    Hang {
        /// How long, in ms.
        ms: f64,
    },
    /// Is gone without a word, as a process that was killed.
    Die,
    /// Another program says hello on the same line.
    OtherClient,
}

/// A fault with its time.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioFault {
    /// When it begins, ms.
    pub at_ms: f64,
    /// How long it lasts, in ms; `None` until the end.
    pub for_ms: Option<f64>,
    /// Its name, for expectations.
    pub name: Option<String>,
    /// Line of the file, from one.
    pub line: usize,
    /// What goes wrong.
    pub cause: Cause,
}

/// What goes wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// On the serial line.
    Line {
        /// To the board, and to the host.
        directions: [bool; 2],
        /// What happens to the bytes.
        damage: LineDamage,
    },
    /// At the board, or around it.
    Rig(RigFault),
    /// The DAC holds a voltage, as a fraction of the largest one that the scene may drive.
    DacStuck {
        /// At most full scale is held.
        fraction: f64,
    },
    /// The board's tick count wraps around after a time.
    TickCountWraps {
        /// In ms.
        in_ms: f64,
    },
}

/// What happens to bytes on the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LineDamage {
    /// All are lost: the cable is cut.
    Cut,
    /// Some are damaged.
    Noise(NoiseConfig),
    /// All arrive later, by a time in ms.
    Late {
        /// How late, in ms.
        ms: f64,
    },
}

/// What has to be seen in a span of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    /// Line of the file, from one.
    pub line: usize,
    /// The command or fault from which times count; `None` for the play with which the scenario begins.
    pub after: Option<String>,
    /// First time, in ms.
    pub from_ms: f64,
    /// Last time, in ms; `None` for the end of the scenario.
    pub to_ms: Option<f64>,
    /// What has to be seen.
    pub seen: Seen,
}

/// What has to be seen.
#[derive(Clone, Debug, PartialEq)]
pub enum Seen {
    /// DAC code zero in every tick.
    OutputZero,
    /// DAC code zero and amplifier disabled in every tick.
    OutputOff,
    /// A code other than zero at least once, and at least once in every 10 ms.
    OutputDriven,
    /// The electrode's voltage is below this fraction of the largest one that the scene may drive, in every tick.
    ElectrodeBelow(f64),
    /// The mean of the electric friction felt while the finger is down lies between these fractions of the largest.
    Friction([f64; 2]),
    /// The board has said of its state, by the end of the span.
    State(State),
    /// The board has said of its fault, by the end of the span.
    Fault(Fault),
    /// A command or the connection fails with a sentence that has these words.
    Error(String),
}
