//! Supervisor states, hard faults and limit flags: their stable numbers, each with a human-readable sentence.

use core::fmt;

use postcard::experimental::max_size::MaxSize;
use serde::{Deserialize, Serialize};

/// State of the supervisor that controls the output. Numbers never change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, MaxSize)]
#[repr(u8)]
pub enum State {
    /// Output zero, amplifier off. The state after every reset.
    #[default]
    Disarmed = 0,
    /// Output zero, ready to play.
    Armed = 1,
    /// The scene is playing.
    Active = 2,
    /// A hard fault is latched: output zero and amplifier off until the fault is cleared.
    Faulted = 3,
}

impl State {
    /// The state's number on the wire.
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// The state in one word.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Disarmed => "disarmed",
            Self::Armed => "armed",
            Self::Active => "active",
            Self::Faulted => "faulted",
        }
    }
}

impl TryFrom<u8> for State {
    type Error = UnknownNumber;

    fn try_from(number: u8) -> Result<Self, UnknownNumber> {
        match number {
            0 => Ok(Self::Disarmed),
            1 => Ok(Self::Armed),
            2 => Ok(Self::Active),
            3 => Ok(Self::Faulted),
            number => Err(UnknownNumber(number)),
        }
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Disarmed => "disarmed: output zero, amplifier off",
            Self::Armed => "armed: output zero, ready to play",
            Self::Active => "active: the scene is playing",
            Self::Faulted => "faulted: output zero, amplifier off, until the fault is cleared",
        })
    }
}

/// A hard fault. It is latched, sets the output to zero and switches the amplifier off. On the wire a fault is its
/// number, which never changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub enum Fault {
    /// The amplifier reports a fault.
    Amplifier,
    /// The amplifier's monitor shows a voltage other than the driven one, or one that rises or stays while the
    /// amplifier is disabled.
    Monitor,
    /// A tick missed its deadline.
    Deadline,
    /// The firmware panicked.
    Panic,
    /// The processor took a hard fault.
    HardFault,
    /// The stack overflowed.
    StackOverflow,
    /// The independent watchdog was not fed.
    Watchdog,
    /// The arm switch was released while armed or playing.
    ArmSwitch,
    /// The configuration read back from the DAC before arming or playing was wrong. The fault's detail is the control
    /// register as read.
    Dac,
    /// A fault of newer firmware that this crate does not know, by number.
    Other(u8),
}

impl Fault {
    /// The fault's stable number, from 1.
    pub const fn number(self) -> u8 {
        match self {
            Self::Amplifier => 1,
            Self::Monitor => 2,
            Self::Deadline => 3,
            Self::Panic => 4,
            Self::HardFault => 5,
            Self::StackOverflow => 6,
            Self::Watchdog => 7,
            Self::ArmSwitch => 8,
            Self::Dac => 9,
            Self::Other(number) => number,
        }
    }
}

impl TryFrom<u8> for Fault {
    type Error = UnknownNumber;

    /// Accepts every number except zero, which means no fault.
    fn try_from(number: u8) -> Result<Self, UnknownNumber> {
        match number {
            0 => Err(UnknownNumber(number)),
            1 => Ok(Self::Amplifier),
            2 => Ok(Self::Monitor),
            3 => Ok(Self::Deadline),
            4 => Ok(Self::Panic),
            5 => Ok(Self::HardFault),
            6 => Ok(Self::StackOverflow),
            7 => Ok(Self::Watchdog),
            8 => Ok(Self::ArmSwitch),
            9 => Ok(Self::Dac),
            number => Ok(Self::Other(number)),
        }
    }
}

impl From<Fault> for u8 {
    fn from(fault: Fault) -> Self {
        fault.number()
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "fault {}: ", self.number())?;
        f.write_str(match self {
            Self::Amplifier => {
                "the amplifier signals a fault; check its supply, wiring and temperature, then clear the fault"
            }
            Self::Monitor => {
                "the amplifier's output is not what was driven, or was not at zero in time; check amplifier, series \
                 resistor and the monitor's wire, then clear the fault"
            }
            Self::Deadline => "a tick missed its deadline; clear the fault and play a scene with fewer layers",
            Self::Panic => {
                "the firmware panicked; report it with the output of `frixel board info`, then clear the fault"
            }
            Self::HardFault => {
                "the processor took a hard fault; report it with the output of `frixel board info`, then clear the \
                 fault"
            }
            Self::StackOverflow => {
                "the firmware's stack overflowed; report it with the output of `frixel board info`, then clear the \
                 fault"
            }
            Self::Watchdog => {
                "the firmware hung until the watchdog restarted it; report it with the output of `frixel board info`, \
                 then clear the fault"
            }
            Self::ArmSwitch => {
                "the arm switch was released while the board was armed or playing; release it, clear the fault, press \
                 and hold it, and arm again"
            }
            Self::Dac => {
                "the DAC did not answer with its configuration before arming or playing; check its supplies and wires, \
                 clear the fault and arm again"
            }
            Self::Other(_) => "unknown to this version; update the frixel command",
        })
    }
}

impl MaxSize for Fault {
    const POSTCARD_MAX_SIZE: usize = u8::POSTCARD_MAX_SIZE;
}

/// Limits in effect that do not stop the scene, and the state of the finger and of the host; one bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, MaxSize)]
pub struct Flags(pub u16);

impl Flags {
    /// The target friction was out of reach and was clamped to the reachable range.
    pub const SATURATED: Self = Self(1);
    /// The envelope is at its slew limit and lags behind its target.
    pub const SLEWED: Self = Self(1 << 1);
    /// The finger is at a standstill: the envelope is ramping down or is at zero.
    pub const STILL: Self = Self(1 << 2);
    /// No finger touches the screen, or no touch has been reported yet.
    pub const NO_FINGER: Self = Self(1 << 3);
    /// Touch data is old and friction falls; it is zero if [`Self::NO_FINGER`] is also set.
    pub const TOUCH_STALE: Self = Self(1 << 4);
    /// A carrier edge came early, to keep the electrode free of direct current.
    pub const CARRIER_BALANCED: Self = Self(1 << 5);
    /// The host's keep-alive timed out, and the output was set to zero.
    pub const HOST_SILENT: Self = Self(1 << 6);
    /// The stream ran out of samples: its layers are fading out, or have faded out.
    pub const STREAM_DRY: Self = Self(1 << 7);
    /// The scene's coefficients were above the board's ceilings, and were lowered to them.
    pub const CLAMPED: Self = Self(1 << 8);

    /// The union of both sets of flags.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether every bit of `other` is set here.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// The names of the flags that are set, each one word, lowest bit first.
    ///
    /// ```
    /// use frixel_wire::fault::Flags;
    ///
    /// let flags = Flags::NO_FINGER.with(Flags::SATURATED);
    /// assert!(flags.names().eq(["saturated", "no-finger"]));
    /// ```
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        FLAGS.into_iter().filter(move |(flag, ..)| self.contains(*flag)).map(|(_, name, _)| name)
    }

    /// The flags that this crate does not know.
    #[must_use]
    pub fn unnamed(self) -> Self {
        Self(FLAGS.into_iter().fold(self.0, |left, (flag, ..)| left & !flag.0))
    }
}

/// Each flag with its name, for tables, and its sentence.
const FLAGS: [(Flags, &str, &str); 9] = [
    (Flags::SATURATED, "saturated", "friction out of reach was clamped"),
    (Flags::SLEWED, "slewed", "the envelope is at its slew limit"),
    (Flags::STILL, "still", "the finger is still"),
    (Flags::NO_FINGER, "no-finger", "no finger touches the screen"),
    (Flags::TOUCH_STALE, "touch-stale", "touch data is too old"),
    (Flags::CARRIER_BALANCED, "carrier-balanced", "a carrier edge came early to keep direct current off the electrode"),
    (Flags::HOST_SILENT, "host-silent", "the host timed out, and the output was set to zero"),
    (Flags::STREAM_DRY, "stream-dry", "the stream has no samples to play"),
    (Flags::CLAMPED, "clamped", "the scene was above the board's ceilings, and is played within them"),
];

/// Writes the sentences of the flags that are set, separated by semicolons.
impl fmt::Display for Flags {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut separator = "";
        for (_, _, sentence) in FLAGS.into_iter().filter(|(flag, ..)| self.contains(*flag)) {
            write!(f, "{separator}{sentence}")?;
            separator = "; ";
        }
        match (self.unnamed().0, self.0) {
            (_, 0) => f.write_str("nothing limits the output"),
            (0, _) => Ok(()),
            (left, _) => write!(f, "{separator}flags {left:#06x}, which this program does not know"),
        }
    }
}

/// A number without an assigned state or fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownNumber(pub u8);

impl fmt::Display for UnknownNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "number {} is unknown to this program: update it", self.0)
    }
}

impl core::error::Error for UnknownNumber {}
