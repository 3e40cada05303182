//! Stable numbers of what goes wrong, and of what merely limits, each with a sentence for a person.

use serde::{Deserialize, Serialize};

/// State of the supervisor that owns the output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u8)]
pub enum State {
    /// Output zero, amplifier off. Every reset lands here.
    #[default]
    Disarmed = 0,
    /// Output zero, ready to play.
    Armed = 1,
    /// The scene is playing.
    Active = 2,
    /// A hard fault is latched: output zero, amplifier off, until it is cleared.
    Faulted = 3,
}

/// A hard fault. It latches, puts the output to zero and the amplifier off. Numbers never change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u8)]
pub enum Fault {
    /// The amplifier reports a fault.
    Amplifier = 1,
    /// The monitor voltage is not the voltage that was driven.
    Monitor = 2,
    /// A tick missed its deadline.
    Deadline = 3,
    /// The firmware panicked.
    Panic = 4,
    /// The processor took a hard fault.
    HardFault = 5,
    /// The stack overflowed.
    StackOverflow = 6,
    /// The independent watchdog was not fed.
    Watchdog = 7,
    /// The arm switch was let go while playing.
    ArmSwitch = 8,
}

/// Limits that act without stopping the scene, one bit each; and what the finger does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Flags(pub u16);

impl Flags {
    /// The friction asked for was out of reach, and was clamped to what can be reached.
    pub const SATURATED: Self = Self(1);
    /// The envelope moved slower than asked, at its slew limit.
    pub const SLEWED: Self = Self(1 << 1);
    /// The finger is still: the envelope is ramped down, or is ramping.
    pub const STILL: Self = Self(1 << 2);
    /// No finger touches the screen, or none was reported yet.
    pub const NO_FINGER: Self = Self(1 << 3);
    /// Touch data is too old to be used.
    pub const TOUCH_STALE: Self = Self(1 << 4);
    /// A carrier edge came early, to keep direct current off the electrode.
    pub const CARRIER_BALANCED: Self = Self(1 << 5);
    /// The host has gone silent, and the output was put to zero.
    pub const HOST_SILENT: Self = Self(1 << 6);

    /// These flags and those.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether every bit of `other` is set here.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}
