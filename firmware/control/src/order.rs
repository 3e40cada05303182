//! What goes between the session and the ticker: values only, so that a board may hand them over through a queue.

use frixel_wire::fault::Fault;
use frixel_wire::message::Telemetry;

#[cfg(feature = "stream")]
use crate::stream::StreamStart;
use crate::{Active, Track};

/// What the session asks of the ticker, which takes one before each tick. `'a` is the life of the two [`Active`] buffers.
// A tag of a whole word: an order is then copied word by word.
#[repr(u32)]
pub enum Order<'a> {
    /// The host has said something.
    HostHeard,
    /// The finger follows this track from now on.
    Track(Track),
    /// The finger has been lifted.
    Lift,
    /// Play by these coefficients from now on, and hand back the others.
    Load(&'a mut Active),
    /// Forget the scene: its bitmaps are about to be overwritten.
    Unload,
    /// Change a layer of the scene that plays; a layer that it does not have is none.
    SetLayer {
        /// Its number among the scene's records.
        layer: u8,
        /// Whether it takes part at all.
        on: bool,
        /// Factor on its friction, in place of its record's.
        gain: f32,
    },
    /// Disarmed to Armed.
    Arm,
    /// Any state but Faulted to Disarmed.
    Disarm,
    /// Armed to Active.
    Play,
    /// Active to Armed.
    Stop,
    /// Faulted to Disarmed.
    ClearFault,
    /// Begin a stream.
    #[cfg(feature = "stream")]
    StartStream(StreamStart),
    /// Let the stream end.
    #[cfg(feature = "stream")]
    EndStream {
        /// Position behind its last sample.
        last: u32,
    },
}

impl Order<'_> {
    /// Whether the order carries out a command of the host, and so says that there is one.
    pub fn is_sign_of_life(&self) -> bool {
        !matches!(self, Self::Track(_) | Self::Lift | Self::Load(_) | Self::Unload)
    }

    /// Whether [`Status::orders_applied`] counts it.
    pub(crate) fn is_counted(&self) -> bool {
        !matches!(self, Self::HostHeard | Self::Track(_) | Self::Lift)
    }
}

/// What the ticker reports to the session. Made when needed, not at every tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Status {
    /// State, flags, place, friction and voltage at the last tick.
    pub telemetry: Telemetry,
    /// The last hard fault with a number that belongs to it; it is latched while the state is Faulted.
    pub fault: Option<(Fault, u32)>,
    /// Orders that were applied since power-on, modulo 2^32. Signs of life, tracks and lifts are not counted.
    pub orders_applied: u32,
    /// The arm switch was held at the last tick, and has been pressed since the reset or the last disarming.
    pub arm_switch: bool,
    /// What was counted since power-on.
    pub counters: Counters,
}

/// What a ticker counts since power-on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Ticks at which the friction asked for was out of reach.
    pub saturated_ticks: u32,
    /// Ticks at which the envelope was at its slew limit.
    pub slewed_ticks: u32,
    /// Early edges of the carrier, to keep direct current off the electrode.
    pub balanced_edges: u32,
    /// Ticks whose deadline was missed.
    pub missed_deadlines: u32,
    /// Times that a stream ran dry; none without the feature `stream`.
    pub stream_underruns: u32,
    /// Runs of samples of a stream that never came, though later ones did; none without the feature `stream`.
    pub stream_gaps: u32,
}
