//! The values that the session and the ticker exchange. They hold no shared state, so a board can pass them through a
//! queue.

use frixel_wire::fault::Fault;
use frixel_wire::message::Telemetry;

#[cfg(feature = "stream")]
use crate::stream::StreamStart;
use crate::{Active, Track};

/// A command from the session to the ticker, which takes at most one before each tick. `'a` is the lifetime of the two
/// [`Active`] buffers.
// With a word-sized tag, the compiler copies an order word by word.
#[repr(u32)]
pub enum Order<'a> {
    /// The host has sent a valid frame: restarts the host timeout.
    SignOfLife,
    /// The finger follows this track from now on.
    Track(Track),
    /// The finger has been lifted.
    Lift,
    /// Use these coefficients from now on, and return the previous ones.
    Load(&'a mut Active),
    /// Remove the scene, because its bitmaps are about to be overwritten.
    Unload,
    /// Change a layer of the current scene. Unknown layer numbers are ignored.
    SetLayer {
        /// Number of the layer's record in the scene.
        layer: u8,
        /// Whether the layer is enabled.
        on: bool,
        /// Factor on the layer's friction; replaces the gain in its record.
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
    /// End the stream after its last sample.
    #[cfg(feature = "stream")]
    EndStream {
        /// End of the stream, exclusive.
        end: u32,
    },
}

impl Order<'_> {
    /// Whether the order restarts the host timeout because it follows directly from a frame. Other orders may have
    /// waited, such as a play that was sent during a commit.
    pub fn is_sign_of_life(&self) -> bool {
        matches!(self, Self::SignOfLife | Self::Arm | Self::Disarm | Self::Stop | Self::ClearFault)
    }

    /// Whether [`Status::orders_applied`] counts this order.
    pub(crate) fn is_counted(&self) -> bool {
        !matches!(self, Self::SignOfLife | Self::Track(_) | Self::Lift)
    }
}

/// The ticker's report to the session. It is built on request, not at every tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Status {
    /// State, flags, finger position, friction and voltage at the last tick.
    pub telemetry: Telemetry,
    /// The last hard fault and its detail number. The fault is latched while the state is Faulted.
    pub fault: Option<(Fault, u32)>,
    /// Orders applied since power-on, modulo 2^32. [`Order::SignOfLife`], tracks and lifts are not counted.
    pub orders_applied: u32,
    /// Whether the arm switch was held at the last tick, and pressed since the reset or the last disarming.
    pub arm_switch: bool,
    /// The ticker's counters.
    pub counters: Counters,
}

/// Events that a ticker has counted since power-on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Scenes whose coefficients were above the board's ceilings.
    pub clamped_loads: u32,
    /// Ticks at which the target friction was out of reach.
    pub saturated_ticks: u32,
    /// Ticks at which the envelope was at its slew limit.
    pub slewed_ticks: u32,
    /// Early edges of the carrier, which keep direct current off the electrode.
    pub balanced_edges: u32,
    /// Ticks whose deadline was missed.
    pub missed_deadlines: u32,
    /// Times that a stream ran dry; 0 without the feature `stream`.
    pub stream_underruns: u32,
    /// Runs of stream samples that never arrived although later samples did; 0 without the feature `stream`.
    pub stream_gaps: u32,
}
