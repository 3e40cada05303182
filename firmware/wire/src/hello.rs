//! The hello: frozen for ever, hand-laid little-endian, so that a newer host can always tell an older board what to do.

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
/// Protocol of this crate, major: raised when an older peer can no longer be talked to.
pub const PROTOCOL_MAJOR: u8 = 1;
/// Protocol of this crate, minor: raised when something was added that an older peer may ignore.
pub const PROTOCOL_MINOR: u8 = 3;
/// Most bytes that a hello of any protocol may have.
pub const HELLO_MAX_LEN: usize = 128;
/// Bytes of a hello that this crate writes.
pub const HELLO_LEN: usize = codec::FIXED_LEN + codec::LIMITS_LEN;

const _: () = assert!(HELLO_LEN <= HELLO_MAX_LEN && HELLO_MAX_LEN < PAYLOAD_MAX_LEN);

/// What a board says of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hello {
    /// Protocol that the board speaks: major, minor.
    pub protocol: (u8, u8),
    /// Version of the firmware: major, minor, patch.
    pub firmware: (u8, u8, u8),
    /// Kind of board.
    pub board: BoardKind,
    /// Unique number of the board.
    pub id: [u8; 12],
    /// Ticks a second.
    pub tick_hz: u32,
    /// Largest frame in bytes that the board takes.
    pub frame_max_len: u16,
    /// Bits of what the firmware can do ([`feature`]).
    pub features: u32,
    /// CRC-32 of the committed scene, zero without one.
    pub scene_crc32: u32,
    /// Why the processor last started.
    pub reset_cause: ResetCause,
    /// The last hard fault, if there was one since power-on.
    pub last_fault: Option<Fault>,
    /// A number that belongs to the last fault.
    pub fault_detail: u32,
    /// State of the supervisor; read as [`State::Faulted`] when the board tells one that this crate does not know.
    pub state: State,
    /// Limits of the board, sent as tag-length-value.
    pub limits: BoardLimits,
}

/// Bits of [`Hello::features`]: what the firmware was built with beyond constant layers and the square carrier.
pub mod feature {
    /// Grating layers.
    pub const GRATING: u32 = 1;
    /// Bitmap layers.
    pub const BITMAP: u32 = 1 << 1;
    /// The sine carrier.
    pub const SINE_CARRIER: u32 = 1 << 2;
    /// Telemetry.
    pub const TELEMETRY: u32 = 1 << 3;
    /// The host says where the finger is.
    pub const HOST_TOUCH: u32 = 1 << 4;
    /// Noise layers.
    pub const NOISE: u32 = 1 << 5;
    /// Edge and button layers.
    pub const EDGE: u32 = 1 << 6;
    /// Vibration layers.
    pub const VIBRATION: u32 = 1 << 7;
    /// Speed layers.
    pub const SPEED: u32 = 1 << 8;
    /// Stream layers, and the samples that the host streams for them while a scene plays.
    pub const STREAM: u32 = 1 << 9;
    /// Polygons as regions.
    pub const POLYGON: u32 = 1 << 10;

    /// Rings layers. Since protocol 1.3.
    pub const RINGS: u32 = 1 << 11;

    /// The name of each, as the board's Cargo features have it where there is one.
    pub const NAMES: [(u32, &str); 12] = [
        (GRATING, "grating"),
        (BITMAP, "bitmap"),
        (SINE_CARRIER, "sine-carrier"),
        (TELEMETRY, "telemetry"),
        (HOST_TOUCH, "touch from the host"),
        (NOISE, "noise"),
        (EDGE, "edge"),
        (VIBRATION, "vibration"),
        (SPEED, "speed"),
        (STREAM, "stream"),
        (POLYGON, "polygon"),
        (RINGS, "rings"),
    ];
}

/// Kind of board. Numbers never change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoardKind {
    /// Simulated in a process on a desktop.
    Simulator,
    /// NUCLEO-G474RE with amplifier and electrode.
    NucleoG474re,
    /// Emulated Cortex-M4F.
    Mps2An386,
    /// A kind that this crate does not know, by number.
    Other(u8),
}

impl BoardKind {
    /// Whether no electrode hangs on the board, so that nobody can be hurt.
    pub const fn is_simulated(self) -> bool {
        matches!(self, Self::Simulator | Self::Mps2An386)
    }

    /// The kind's number on the wire.
    pub const fn number(self) -> u8 {
        match self {
            Self::Simulator => 1,
            Self::NucleoG474re => 2,
            Self::Mps2An386 => 3,
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
            Self::Other(number) => write!(f, "board of kind {number}, which this program does not know"),
        }
    }
}

/// Why the processor last started. Numbers never change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetCause {
    /// Power came on.
    PowerOn,
    /// The reset pin.
    Pin,
    /// Asked for by software, after a panic or a fault among others.
    Software,
    /// The independent watchdog.
    Watchdog,
    /// Supply voltage fell too low.
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
            Self::Software => f.write_str("software asked for it"),
            Self::Watchdog => f.write_str("the watchdog was not fed"),
            Self::BrownOut => f.write_str("the supply voltage fell too low"),
            Self::Other(number) => write!(f, "cause {number}, which this program does not know"),
        }
    }
}

/// Limits of a board that a scene has to keep; refused, never silently clamped, when exceeded by command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardLimits {
    /// Bytes for bitmaps, those being uploaded included.
    pub bitmap_pool_bytes: u32,
    /// Most records that a scene may have.
    pub records_max: u8,
    /// Bytes that the host may have sent and the board not yet acknowledged.
    pub receive_window_bytes: u16,
    /// Largest peak voltage on the electrode, in volts.
    pub voltage_max_v_peak: f32,
    /// Voltage on the electrode at the largest DAC code, in volts, peak.
    pub full_scale_v_peak: f32,
    /// Time constant of the carrier's edges (amplifier and series resistor), in seconds.
    pub edge_time_constant_s: f32,
    /// Worst-case electrode capacitance: bare coating, gap lost, largest contact; in farads.
    pub electrode_capacitance_max_f: f32,
    /// Largest rms current through the electrode, in amperes.
    pub current_max_a_rms: f32,
    /// Largest peak current through the electrode, in amperes.
    pub current_max_a_peak: f32,
    /// Time between two reports of the touch source, in seconds.
    pub touch_report_period_s: f32,
    /// Most processor cycles that a scene's longest tick may be estimated at. A scene that may take more at some place is
    /// refused.
    pub tick_cycles_max: u32,
}

impl BoardLimits {
    /// [`Self::tick_cycles_max`] of the smallest board: 60 % of the 4,250 cycles that an STM32G474 at 170 MHz has between two
    /// ticks at 40 kHz. The rest is for interrupts that delay the tick, and for what the estimate does not know.
    pub const SMALLEST_TICK_CYCLES_MAX: u32 = 2_550;

    /// What holds for limits that a hello leaves out: nothing can be played, and one frame at a time may be sent. Boards of
    /// protocols before 1.3 do not state [`Self::tick_cycles_max`]: the smallest board's is taken for theirs.
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
        tick_cycles_max: Self::SMALLEST_TICK_CYCLES_MAX,
    };
}
