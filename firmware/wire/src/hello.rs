//! The hello: a fixed little-endian layout that never changes, so that a host can always identify a board of another
//! protocol version and name the side to update.

mod codec;
mod compatibility;

use core::fmt;

use crate::fault::{Fault, State};
use crate::frame::FRAME_MAX_LEN;
use crate::payload::PAYLOAD_MAX_LEN;

pub use codec::HelloError;
pub use compatibility::Mismatch;

/// First four bytes of a hello.
pub const MAGIC: [u8; 4] = *b"FRXL";
/// Major protocol version of this crate, incremented by incompatible changes.
pub const PROTOCOL_MAJOR: u8 = 1;
/// Minor protocol version of this crate, incremented by additions that a peer may ignore.
pub const PROTOCOL_MINOR: u8 = 0;
/// Maximum length of a hello of any protocol, in bytes.
pub const HELLO_MAX_LEN: usize = 128;
/// Length of the hello that this crate writes, in bytes.
pub const HELLO_LEN: usize = codec::FIXED_LEN + codec::VALUES_LEN;

const _: () = assert!(HELLO_LEN <= HELLO_MAX_LEN && HELLO_MAX_LEN < PAYLOAD_MAX_LEN);

/// A board's description of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hello {
    /// Protocol version of the board: major, minor.
    pub protocol: (u8, u8),
    /// Version of the firmware: major, minor, patch.
    pub firmware: (u8, u8, u8),
    /// Kind of board.
    pub board: BoardKind,
    /// Unique identifier of the board.
    pub id: [u8; 12],
    /// Tick rate, Hz.
    pub tick_hz: u32,
    /// Largest frame that the board accepts, in bytes.
    pub frame_max_len: u16,
    /// Feature bits of the firmware build ([`feature`]).
    pub features: u32,
    /// CRC-32 of the committed scene; zero without one.
    pub scene_crc32: u32,
    /// Why the processor last started.
    pub reset_cause: ResetCause,
    /// The last hard fault since power-on, if any.
    pub last_fault: Option<Fault>,
    /// Additional information on the last fault; its interpretation depends on the fault.
    pub fault_detail: u32,
    /// State of the supervisor. A state that this crate does not know is read as [`State::Faulted`].
    pub state: State,
    /// Limits of the board, encoded as tag-length-value.
    pub limits: BoardLimits,
    /// Notices to show before playing ([`notice`]), encoded after the limits.
    pub notices: u8,
}

/// Bits of [`Hello::notices`]: warnings about a board to show before playing.
pub mod notice {
    /// The processor's option bytes, such as the brown-out level and the watchdog start, are wrong for this board. The
    /// board refuses to arm ([`Refusal::OptionBytes`](crate::message::Refusal::OptionBytes)).
    pub const OPTION_BYTES: u8 = 1;
    /// The built-in limits are in effect instead of the stored ones. A stored limit exceeds a ceiling of the firmware,
    /// or the limits were stored for another series resistance or by a build with other ceilings.
    pub const STORED_LIMITS_REFUSED: u8 = 1 << 1;
    /// The firmware was built to accept stored limits above its ceilings for voltage and current.
    pub const LIMITS_ABOVE_CEILINGS: u8 = 1 << 2;

    /// Meaning and remedy of each notice, as a sentence without a full stop.
    pub const SENTENCES: [(u8, &str); 3] = [
        (
            OPTION_BYTES,
            "the processor's option bytes are wrong for this board, so it refuses to arm: switch the amplifier off, \
             set them with `STM32_Programmer_CLI -c port=SWD -ob BOR_LEV=4 IWDG_SW=0`, reset the board, and \
             compare all of them if it refuses again (docs/board/hardware.md, Option bytes)",
        ),
        (
            STORED_LIMITS_REFUSED,
            "the board does not use its stored limits, but those built into its firmware: one exceeds a \
             ceiling, or they are damaged or were stored for another series resistance or by another build; flash a \
             build for the soldered resistance, or store them again with bring-up",
        ),
        (
            LIMITS_ABOVE_CEILINGS,
            "the board's firmware accepts voltages and currents above the ceilings for people: flash a build without \
             the feature limits-above-ceilings before anyone touches it",
        ),
    ];
}

impl Hello {
    /// Sentences of the notices that this crate knows, without a full stop.
    pub fn notice_sentences(&self) -> impl Iterator<Item = &'static str> {
        let notices = self.notices;
        notice::SENTENCES.iter().filter(move |(bit, _)| notices & bit != 0).map(|(_, sentence)| *sentence)
    }
}

/// Bits of [`Hello::features`]: features of the firmware build besides constant layers and the square carrier, which
/// every build has. `frixel-layers` has the bits of the other kinds of layers.
pub mod feature {
    /// The sine carrier.
    pub const SINE_CARRIER: u32 = 1 << 2;
    /// Telemetry.
    pub const TELEMETRY: u32 = 1 << 3;
    /// Touch reported by the host.
    pub const HOST_TOUCH: u32 = 1 << 4;
    /// Stream layers, and receiving their samples while a scene plays.
    pub const STREAM: u32 = 1 << 9;
    /// Polygons as regions.
    pub const POLYGON: u32 = 1 << 10;
    /// Empirical laws of fingers.
    pub const EMPIRICAL: u32 = 1 << 13;

    /// The name of each feature that is not a kind of layer: the board's Cargo feature, if it has one.
    pub const NAMES: [(u32, &str); 5] = [
        (SINE_CARRIER, "sine-carrier"),
        (TELEMETRY, "telemetry"),
        (HOST_TOUCH, "touch from the host"),
        (POLYGON, "polygon"),
        (EMPIRICAL, "empirical"),
    ];
}

/// Kind of board. The numbers on the wire never change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoardKind {
    /// Simulated in a process on a desktop.
    Simulator,
    /// NUCLEO-G474RE with amplifier and electrode.
    NucleoG474re,
    /// Emulated Cortex-M4F.
    Mps2An386,
    /// Raspberry Pi Pico (RP2040) with amplifier and electrode, or its emulation.
    Pico,
    /// Raspberry Pi Pico 2 (RP2350) with amplifier and electrode.
    Pico2,
    /// A kind that this crate does not know, by number.
    Other(u8),
}

impl BoardKind {
    /// Whether the board is simulated or emulated. It then has no electrode, and cannot harm anyone.
    pub const fn is_simulated(self) -> bool {
        matches!(self, Self::Simulator | Self::Mps2An386)
    }

    /// The kind's number on the wire.
    pub const fn number(self) -> u8 {
        match self {
            Self::Simulator => 1,
            Self::NucleoG474re => 2,
            Self::Mps2An386 => 3,
            Self::Pico => 4,
            Self::Pico2 => 5,
            Self::Other(number) => number,
        }
    }
}

impl From<u8> for BoardKind {
    fn from(number: u8) -> Self {
        match number {
            1 => Self::Simulator,
            2 => Self::NucleoG474re,
            3 => Self::Mps2An386,
            4 => Self::Pico,
            5 => Self::Pico2,
            number => Self::Other(number),
        }
    }
}

impl fmt::Display for BoardKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Simulator => f.write_str("simulator"),
            Self::NucleoG474re => f.write_str("NUCLEO-G474RE"),
            Self::Mps2An386 => f.write_str("emulated MPS2-AN386"),
            Self::Pico => f.write_str("Raspberry Pi Pico"),
            Self::Pico2 => f.write_str("Raspberry Pi Pico 2"),
            Self::Other(number) => write!(f, "board of kind {number}, which this program does not know"),
        }
    }
}

/// Why the processor last started. The numbers on the wire never change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetCause {
    /// Power-on.
    PowerOn,
    /// The reset pin.
    Pin,
    /// A software reset, for example after a panic or a fault.
    Software,
    /// The independent watchdog.
    Watchdog,
    /// The supply voltage fell too low.
    BrownOut,
    /// A cause that this crate does not know, by number.
    Other(u8),
}

impl ResetCause {
    /// The cause's number on the wire.
    pub const fn number(self) -> u8 {
        match self {
            Self::PowerOn => 1,
            Self::Pin => 2,
            Self::Software => 3,
            Self::Watchdog => 4,
            Self::BrownOut => 5,
            Self::Other(number) => number,
        }
    }
}

impl From<u8> for ResetCause {
    fn from(number: u8) -> Self {
        match number {
            1 => Self::PowerOn,
            2 => Self::Pin,
            3 => Self::Software,
            4 => Self::Watchdog,
            5 => Self::BrownOut,
            number => Self::Other(number),
        }
    }
}

impl fmt::Display for ResetCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PowerOn => f.write_str("power came on"),
            Self::Pin => f.write_str("the reset pin"),
            Self::Software => f.write_str("software request"),
            Self::Watchdog => f.write_str("the watchdog was not fed"),
            Self::BrownOut => f.write_str("the supply voltage fell too low"),
            Self::Other(number) => write!(f, "cause {number}, which this program does not know"),
        }
    }
}

/// The processor core whose costs are used to estimate the ticks of a scene. The numbers on the wire never change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Core {
    /// Cortex-M4F, or a core with a floating-point unit that takes no more cycles.
    CortexM4f,
    /// Cortex-M0+, which emulates floating-point arithmetic in software.
    CortexM0Plus,
}

impl Core {
    /// The core's number on the wire.
    pub const fn number(self) -> u8 {
        match self {
            Self::CortexM4f => 0,
            Self::CortexM0Plus => 1,
        }
    }
}

impl From<u8> for Core {
    /// Reads an unknown number as Cortex-M4F. The board itself refuses scenes that its core cannot play in time.
    fn from(number: u8) -> Self {
        match number {
            1 => Self::CortexM0Plus,
            _ => Self::CortexM4f,
        }
    }
}

/// Limits of a board. The board refuses a command that exceeds a limit; it never clamps the value silently.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardLimits {
    /// Size of the bitmap pool in bytes, including bitmaps being uploaded.
    pub bitmap_pool_bytes: u32,
    /// Maximum number of records in a scene.
    pub records_max: u8,
    /// Maximum number of sent bytes that the board has not yet acknowledged.
    pub receive_window_bytes: u16,
    /// Largest peak voltage on the electrode, in volts.
    pub voltage_max_v_peak: f32,
    /// Electrode voltage at the largest DAC code, in volts peak.
    pub full_scale_v_peak: f32,
    /// Time constant of the carrier's edges (amplifier and series resistor), in seconds.
    pub edge_time_constant_s: f32,
    /// Worst-case electrode capacitance, in farads: the coating alone, without an air gap, at the largest contact.
    pub electrode_capacitance_max_f: f32,
    /// Largest rms current through the electrode, in amperes.
    pub current_max_a_rms: f32,
    /// Largest peak current through the electrode, in amperes.
    pub current_max_a_peak: f32,
    /// Time between two reports of the touch source, in seconds.
    pub touch_report_period_s: f32,
    /// Limit on the estimated processor cycles of a scene's longest tick. The board refuses a scene whose estimate
    /// exceeds it at any position.
    pub tick_cycles_max: u32,
    /// Resistance between the amplifier and the electrode, Ohm. It bounds the current through a person who is not
    /// protected by a coating, and thus the peak voltage at each carrier frequency (`frixel_model::TouchBound`).
    /// Infinite if the board cannot be touched, such as a simulated one.
    pub series_resistance_ohm: f32,
    /// The core for which [`Self::tick_cycles_max`] counts cycles.
    pub core: Core,
}

impl BoardLimits {
    /// [`Self::tick_cycles_max`] of the slowest board: 60 % of the 4,250 cycles between two ticks of an STM32G474 at
    /// 170 MHz and 40 kHz. The rest is reserved for interrupts that delay the tick and for the error of the estimate.
    pub const SMALLEST_TICK_CYCLES_MAX: u32 = 2_550;

    /// Defaults for limits that a hello omits: no scene can be played, and the host may send one frame at a time.
    pub const UNSTATED: Self = Self {
        bitmap_pool_bytes: 0,
        records_max: 0,
        receive_window_bytes: FRAME_MAX_LEN as u16,
        voltage_max_v_peak: 0.0,
        full_scale_v_peak: 0.0,
        edge_time_constant_s: 0.0,
        electrode_capacitance_max_f: f32::INFINITY,
        current_max_a_rms: 0.0,
        current_max_a_peak: 0.0,
        touch_report_period_s: 0.0,
        tick_cycles_max: 0,
        series_resistance_ohm: f32::INFINITY,
        core: Core::CortexM4f,
    };
}
