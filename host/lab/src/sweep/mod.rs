//! Studies of many simulated fingers: every combination of scenes, screens, touch sources, values of a scene's fields
//! and people, each a [`Cell`].
//!
//! A [`Plan`] says which cells there are. A cell holds all that its plays need, so that it is played by any process on
//! any machine ([`Cell::play`]), and its key is a hash of that content. [`Study`] puts results together, in whatever
//! order and by however many processes they were made: intervals are computed from the results of single fingers.

mod cell;
mod parameter;
mod plan;
mod study;

pub use cell::{Cell, CellError, CellResult, Hand, LayerResult, Profile};
pub use parameter::{ParameterError, Value};
pub use plan::{Plan, PlanError, Range, Source, Values};
pub use study::{Group, LayerShare, Study};
