//! Reasons for refusing a command, with sentences that state the value found, the limit and the remedy.

use core::fmt;

use postcard::experimental::max_size::MaxSize;
use serde::{Deserialize, Serialize};

use crate::fault::{Fault, State};
use crate::scene::SceneError;

/// Why the board refused a command. The fields hold the value found and the limit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, MaxSize)]
pub enum Refusal {
    /// The command cannot be deserialized; most likely it belongs to a newer protocol.
    UnknownCommand,
    /// The command is not allowed in this state.
    WrongState(State),
    /// A fault is latched and must be cleared first.
    Faulted(Fault),
    /// No scene was committed.
    NoScene,
    /// No upload has been started, or chunks are missing.
    UploadIncomplete {
        /// Number of the chunk that the board expects next.
        next_chunk: u16,
    },
    /// The CRC-32 of the received bytes differs from the announced one.
    CrcMismatch {
        /// The announced CRC-32.
        expected: u32,
        /// The CRC-32 of the received bytes.
        found: u32,
    },
    /// The scene is larger than the board's buffer.
    SceneTooLarge {
        /// Requested size in bytes.
        len: u32,
        /// Size of the buffer in bytes.
        max: u32,
    },
    /// The bitmap pool has no room.
    BitmapPoolFull {
        /// Requested size in bytes.
        len: u32,
        /// Free bytes once every bitmap that the playing scene does not use is evicted.
        free: u32,
    },
    /// The scene refers to a bitmap that is not in the pool.
    BitmapMissing {
        /// CRC-32 of the bitmap.
        crc32: u32,
    },
    /// The bytes are not a valid scene of this layout version.
    Scene(SceneError),
    /// A number in the scene is outside the board's limits.
    Config(ConfigRefusal),
    /// The board has not finished earlier commands or not yet released the previous scene; the host may retry.
    Busy,
    /// The requested telemetry period is too short.
    TelemetryTooFast {
        /// Shortest period in ticks.
        period_min_ticks: u32,
    },
    /// The arm switch on the board is not held, or has not been pressed since the last reset or disarm.
    ArmSwitch,
    /// The scene needs a feature that is disabled in this firmware build ([`crate::hello::feature`]).
    FeatureDisabled {
        /// The layer that needs it, counted from zero; [`ConfigRefusal::WHOLE_SCENE`] for the carrier.
        layer: u8,
    },
    /// The board has its own touch source and does not accept touch from the host.
    TouchSource,
    /// The playing scene has no layer of this number.
    NoSuchLayer {
        /// The layer in the command, counted from zero.
        layer: u8,
        /// Number of layers in the scene.
        layers: u8,
    },
    /// The playing scene has no stream layer.
    NoStreamLayer,
    /// The estimated cost of the scene's longest tick is above the limit (`frixel_layers::cost`).
    TooCostly {
        /// Estimated cost of the longest tick, in cycles.
        cycles: u32,
        /// Largest estimate that the board accepts.
        cycles_max: u32,
        /// A position with this cost: distance from the left edge of the screen, m.
        x_m: f32,
        /// Distance of that position from the top edge, m.
        y_m: f32,
    },
    /// The playing scene declares its layers fixed (`frixel_layers::Header::layers_fixed`).
    LayersFixed,
    /// The processor's option bytes are wrong for this board ([`crate::hello::notice::OPTION_BYTES`]).
    OptionBytes,
}

/// A number, in a scene or in a command, that is outside the board's limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, MaxSize)]
pub struct ConfigRefusal {
    /// The quantity.
    pub field: ConfigField,
    /// The value found, in SI units.
    pub found: f32,
    /// Smallest value that the board accepts.
    pub min: f32,
    /// Largest value that the board accepts.
    pub max: f32,
    /// The layer that contains it, counted from zero; [`ConfigRefusal::WHOLE_SCENE`] for the scene as a whole.
    pub layer: u8,
}

impl ConfigRefusal {
    /// Layer number that denotes the scene as a whole.
    pub const WHOLE_SCENE: u8 = u8::MAX;
}

/// The quantities for which the board can refuse a scene or a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, MaxSize)]
pub enum ConfigField {
    /// Screen width, m.
    ScreenWidth,
    /// Screen height, m.
    ScreenHeight,
    /// Finger radius, m.
    FingerRadius,
    /// Winkler-Fuss stiffness, Pa/m.
    Stiffness,
    /// Friction coefficient.
    FrictionCoefficient,
    /// Normal load, N.
    NormalLoad,
    /// Effective gap, m.
    EffectiveGap,
    /// Largest rms voltage, V.
    VoltageRms,
    /// Largest peak voltage, V.
    VoltagePeak,
    /// Slew of the envelope, V/s.
    Slew,
    /// Carrier frequency, Hz.
    CarrierFrequency,
    /// Host timeout, s.
    HostTimeout,
    /// Rms current into the worst-case electrode, A.
    CurrentRms,
    /// Peak current into the worst-case electrode, A.
    CurrentPeak,
    /// A layer's region, m.
    Region,
    /// A layer's gain.
    Gain,
    /// A layer's friction, N.
    Friction,
    /// A grating's wave vector, cycles per metre.
    WaveVector,
    /// A grating's phase, turns.
    Phase,
    /// A bitmap's position or pitch, m.
    BitmapPlacement,
    /// The largest rms voltage, V: the friction range from 1 V up to it does not fit into the inverse table.
    TableRange,
    /// Finger position reported by the host, m.
    TouchPlace,
    /// Sample rate of a stream, Hz.
    SampleRate,
    /// Start level of a stream, in samples.
    StartLevel,
    /// Duty cycle of a square grating: the fraction of a period in which it is high.
    Duty,
    /// An angle, turns.
    Angle,
    /// A wavelength of noise, m.
    Wavelength,
    /// Position or width of an edge or a rim, m.
    Shape,
    /// A vibration's frequency, Hz.
    VibrationFrequency,
    /// Duration of a click or of a part of a burst, s.
    Duration,
    /// A vertex of a polygon, m.
    Vertex,
    /// A speed of a curve, m/s; the speeds of a curve must increase.
    CurveSpeed,
    /// Number of noise layers up to and including this layer.
    NoiseLayers,
    /// Number of edge and button layers up to and including this layer.
    ClickLayers,
    /// The largest electric friction that the scene declares as its target, N.
    ElectricFrictionMax,
    /// The exponent of the voltage in an empirical law, below its first point or between two points.
    LawExponent,
    /// The voltage of a point of an empirical law, V rms: finite, above zero and above the previous point's.
    LawPoint,
    /// The electric friction of a point of an empirical law, or of the law at the largest voltage, N.
    LawFriction,
}

impl ConfigField {
    /// The quantity's name, and its unit with a leading space; the unit is empty for dimensionless quantities.
    const fn name_and_unit(self) -> (&'static str, &'static str) {
        match self {
            Self::ScreenWidth => ("screen width", " m"),
            Self::ScreenHeight => ("screen height", " m"),
            Self::FingerRadius => ("finger radius", " m"),
            Self::Stiffness => ("Winkler-Fuss stiffness", " Pa/m"),
            Self::FrictionCoefficient => ("friction coefficient", ""),
            Self::NormalLoad => ("normal load", " N"),
            Self::EffectiveGap => ("effective gap", " m"),
            Self::VoltageRms => ("largest rms voltage", " V"),
            Self::VoltagePeak => ("largest peak voltage", " V"),
            Self::Slew => ("envelope slew", " V/s"),
            Self::CarrierFrequency => ("carrier frequency", " Hz"),
            Self::HostTimeout => ("host timeout", " s"),
            Self::CurrentRms => ("rms current into the worst-case electrode", " A"),
            Self::CurrentPeak => ("peak current into the worst-case electrode", " A"),
            Self::Region => ("region", " m"),
            Self::Gain => ("gain", ""),
            Self::Friction => ("electric friction", " N"),
            Self::WaveVector => ("wave vector", " cycles/m"),
            Self::Phase => ("phase", " turns"),
            Self::BitmapPlacement => ("bitmap place or pitch", " m"),
            Self::TableRange => ("span of friction", " V"),
            Self::TouchPlace => ("place of the finger", " m"),
            Self::SampleRate => ("sample rate of the stream", " Hz"),
            Self::StartLevel => ("start level of the stream", " samples"),
            Self::Duty => ("duty", ""),
            Self::Angle => ("angle", " turns"),
            Self::Wavelength => ("wavelength", " m"),
            Self::Shape => ("place or width", " m"),
            Self::VibrationFrequency => ("vibration frequency", " Hz"),
            Self::Duration => ("click or burst", " s"),
            Self::Vertex => ("vertex", " m"),
            Self::CurveSpeed => ("speed", " m/s"),
            Self::NoiseLayers => ("number of noise layers", ""),
            Self::ClickLayers => ("number of edges and buttons", ""),
            Self::ElectricFrictionMax => ("largest electric friction", " N"),
            Self::LawExponent => ("exponent of the finger's law", ""),
            Self::LawPoint => ("point of the finger's law", " V"),
            Self::LawFriction => ("friction of the finger's law", " N"),
        }
    }
}

/// Writes the quantity's name.
impl fmt::Display for ConfigField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name_and_unit().0)
    }
}

impl fmt::Display for ConfigRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { field, found, min, max, layer } = *self;
        let (name, unit) = field.name_and_unit();
        if field == ConfigField::TableRange {
            return write!(
                f,
                "the scene's friction from 1 V to its largest voltage, {found:?} V rms, spans more than the \
                 board's table holds: \
                 lower that voltage, or raise the normal load"
            );
        }
        write!(f, "the {name} of ")?;
        match layer {
            Self::WHOLE_SCENE => f.write_str("the scene")?,
            layer => write!(f, "layer {layer} (the first is 0)")?,
        }
        write!(f, " is {found:?}{unit}, which the board cannot play: expected ")?;
        match (min.is_finite(), max.is_finite()) {
            (true, true) => write!(f, "{min:?} to {max:?}{unit}"),
            (true, false) => write!(f, "{min:?}{unit} or more"),
            (false, true) => write!(f, "{max:?}{unit} or less"),
            (false, false) => f.write_str("any finite number"),
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::UnknownCommand => f.write_str("the board does not know this command: flash newer firmware"),
            Self::WrongState(state) => f.write_str(wrong_state(state)),
            Self::Faulted(fault) => write!(f, "a fault is latched on the board: {fault}"),
            Self::NoScene => f.write_str("the board holds no scene: upload and commit one first"),
            Self::UploadIncomplete { next_chunk } => write!(
                f,
                "no upload is complete: the board expects chunk {next_chunk}; continue there or start the upload again"
            ),
            Self::CrcMismatch { expected, found } => {
                write!(
                    f,
                    "CRC-32 {expected:#010x} was announced, but the received data has {found:#010x}: upload it again"
                )
            }
            Self::SceneTooLarge { len, max } => {
                write!(f, "the scene has {len} bytes, and the board accepts {max}: use fewer layers")
            }
            Self::BitmapPoolFull { len, free } => write!(
                f,
                "the bitmap has {len} bytes, and the board has {free} free: use a smaller picture or a coarser pitch"
            ),
            Self::BitmapMissing { crc32 } => {
                write!(f, "the scene uses bitmap {crc32:#010x}, which the board does not hold: upload it first")
            }
            Self::Scene(error) => error.fmt(f),
            Self::Config(refusal) => refusal.fmt(f),
            Self::Busy => {
                f.write_str("the board has not finished earlier commands, or still plays the previous scene: try again")
            }
            Self::TelemetryTooFast { period_min_ticks } => write!(
                f,
                "the shortest telemetry period is {period_min_ticks} ticks: request a longer one, or 0 to end it"
            ),
            Self::ArmSwitch => f.write_str(
                "the arm switch was not pressed since the board was last disarmed: release it, press and hold it, \
                 and arm again",
            ),
            Self::FeatureDisabled { layer } => fmt_feature_disabled(f, layer),
            Self::TouchSource => f.write_str("the board has a touch source of its own: send it no touch reports"),
            Self::NoSuchLayer { layer, layers } => write!(
                f,
                "the playing scene has no layer {layer} (counted from 0); it has {layers}: use one of those, or commit \
                 the intended scene"
            ),
            Self::NoStreamLayer => {
                f.write_str("no layer of the playing scene is a stream: add one to the scene, or send no samples")
            }
            Self::TooCostly { cycles, cycles_max, x_m, y_m } => fmt_too_costly(f, cycles, cycles_max, [x_m, y_m]),
            Self::LayersFixed => f.write_str(
                "the playing scene declares its layers fixed: set `live = true` in the layers to change, and commit it \
                 again",
            ),
            Self::OptionBytes => f.write_str(
                "the processor's option bytes do not allow the board to drive: switch the amplifier off, run \
                 `STM32_Programmer_CLI -c port=SWD -ob BOR_LEV=4 IWDG_SW=0`, reset the board, and compare all of them \
                 if it refuses again (docs/board/hardware.md, Option bytes)",
            ),
        }
    }
}

fn wrong_state(state: State) -> &'static str {
    match state {
        State::Disarmed => "the board is disarmed: arm it before play or stop",
        State::Armed => "the board is armed and is not playing: play the scene first, or disarm it",
        State::Active => "the board is playing: stop it first",
        State::Faulted => "a fault is latched on the board: clear it first",
    }
}

fn fmt_feature_disabled(f: &mut fmt::Formatter<'_>, layer: u8) -> fmt::Result {
    if layer == ConfigRefusal::WHOLE_SCENE {
        return f.write_str("the firmware was built without the carrier of the scene: flash one that has it");
    }
    write!(
        f,
        "the firmware was built without a feature that layer {layer} (counted from 0) needs: flash one that has it"
    )
}

fn fmt_too_costly(f: &mut fmt::Formatter<'_>, cycles: u32, cycles_max: u32, [x_m, y_m]: [f32; 2]) -> fmt::Result {
    write!(
        f,
        "a tick would take about {cycles} cycles at {:.1} mm, {:.1} mm, and may take {cycles_max}: let fewer layers \
         overlap there",
        1e3 * x_m,
        1e3 * y_m
    )
}

impl core::error::Error for ConfigRefusal {}
impl core::error::Error for Refusal {}
