//! Messages, serialized with postcard. Enums are append-only: a variant never changes its position.

mod refusal;

use postcard::experimental::max_size::MaxSize;
use serde::{Deserialize, Serialize};

use crate::fault::{Fault, Flags, State};

pub use refusal::{ConfigField, ConfigRefusal, Refusal};

/// A command from the host, with a sequence number that the board repeats in its answer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, MaxSize)]
pub struct Request {
    /// Chosen by the host; repeated in the answer.
    pub sequence: u16,
    /// The command to carry out.
    pub command: Command,
}

/// A command from the host to the board. The board answers every command with one [`Answer`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, MaxSize)]
pub enum Command {
    /// Keep-alive: shows that the host is still connected.
    Ping,
    /// Starts the upload of a scene ([`crate::scene`]) and discards an unfinished upload.
    UploadScene {
        /// Bytes of the whole scene.
        len: u32,
        /// CRC-32 of the whole scene.
        crc32: u32,
    },
    /// Starts the upload of a bitmap: one byte per sample, row by row from the top left. The board answers
    /// [`Accepted::AlreadyHeld`] if its pool already contains the bitmap.
    UploadBitmap {
        /// Samples in a row.
        width: u16,
        /// Rows.
        height: u16,
        /// The bitmap's name in scene records: [`crate::scene::bitmap_crc32`].
        crc32: u32,
    },
    /// Ends an upload; the board then checks its CRC-32.
    UploadEnd,
    /// Replaces the playing scene with the uploaded one, atomically, at a tick boundary.
    Commit {
        /// CRC-32 of the scene to commit.
        crc32: u32,
    },
    /// Changes the state from Disarmed to Armed.
    Arm,
    /// Changes any state but Faulted to Disarmed; sets the output to zero in every state.
    Disarm,
    /// Changes the state from Armed to Active.
    Play,
    /// Changes the state from Active to Armed.
    Stop,
    /// Changes the state from Faulted to Disarmed, if the cause of the fault is gone.
    ClearFault,
    /// Starts periodic telemetry, or stops it if the period is zero.
    Subscribe {
        /// Ticks between two telemetry messages: at least that of [`TELEMETRY_MAX_HZ`], or zero.
        period_ticks: u32,
    },
    /// Reports the position of the finger, for a board that takes touch from the host.
    Touch {
        /// Distance from the left edge of the screen, m.
        x_m: f32,
        /// Distance from the top edge of the screen, m.
        y_m: f32,
        /// Age of the position, in ticks.
        age_ticks: u16,
    },
    /// Reports that the finger has left the screen, for a board that takes touch from the host.
    Lift,
    /// Reads the text that the firmware stored about the fault that led to the last reset. The board answers
    /// [`Accepted::FaultText`].
    FaultText {
        /// Offset in the text, in bytes: how much of it the host already has.
        offset: u8,
    },
    /// Enables or disables a layer of the playing scene and sets its gain, at a tick boundary. A commit restores the
    /// values of the scene.
    SetLayer {
        /// The layer: index of its record in the scene, from zero.
        layer: u8,
        /// Whether the layer is enabled.
        on: bool,
        /// Factor on the layer's friction; replaces the gain in the layer's record.
        gain: f32,
    },
    /// Starts a stream of samples for the `stream` layers of the playing scene and discards any current stream. Sample
    /// indices start at zero.
    StartStream {
        /// Samples per second; at most the board's tick rate.
        sample_hz: u32,
        /// Samples that must be buffered before the stream starts to play, and before it resumes after an underrun;
        /// 1 to [`STREAM_START_LEVEL_MAX`].
        start_level: u16,
    },
    /// Marks the end of the stream: the board plays the samples it has, and does not count an underrun after the last.
    EndStream,
    /// As [`Self::Touch`], for one of several fingers. A rule in the scene selects the finger that is rendered.
    TouchFinger {
        /// Number of the finger; constant from touch to lift.
        finger: u8,
        /// Distance from the left edge of the screen, m.
        x_m: f32,
        /// Distance from the top edge of the screen, m.
        y_m: f32,
        /// Age of the position, in ticks.
        age_ticks: u16,
    },
    /// As [`Self::Lift`], for one of several fingers.
    LiftFinger {
        /// The finger's number.
        finger: u8,
    },
    /// Reads the durations of the ticks. The board answers [`Accepted::TickTimes`]; without telemetry, it refuses.
    TickTimes,
}

/// Largest start level of a stream, in samples: it leaves room for two more frames in the smallest buffer.
pub const STREAM_START_LEVEL_MAX: u16 = 800;

/// Bytes of the fault text in one answer.
pub const FAULT_TEXT_PIECE_LEN: usize = 32;
/// Maximum length of the fault text, in bytes.
pub const FAULT_TEXT_MAX_LEN: usize = 192;

/// Largest magnitude of a layer's gain.
pub const GAIN_MAX: f64 = 100.0;

/// Highest rate of telemetry, messages per second.
pub const TELEMETRY_MAX_HZ: u32 = 1000;

/// Telemetry period in ticks of a board with this tick rate, for at most `messages_hz` messages per second (above 0).
pub const fn telemetry_period_ticks(tick_hz: u32, messages_hz: u32) -> u32 {
    tick_hz.div_ceil(messages_hz)
}

/// A message from the board.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, MaxSize)]
pub enum FromBoard {
    /// Answers one request.
    Answer(Answer),
    /// Progress of an upload; returns credit while the host sends chunks.
    Progress {
        /// Number of the chunk that the board expects next. If it is lower than the host's next chunk, the host resends
        /// from there.
        next_chunk: u16,
        /// Bytes received since the hello, including invalid ones, modulo 2^32.
        received_bytes: u32,
    },
    /// The current tick's values, as subscribed to by [`Command::Subscribe`].
    Telemetry(Telemetry),
    /// The state changed without a command, because of a fault or of the keep-alive timeout.
    StateChanged {
        /// The new state.
        state: State,
        /// The fault, if one is latched.
        fault: Option<Fault>,
        /// The reason, if it is not a fault ([`Flags::HOST_SILENT`]).
        flags: Flags,
    },
    /// Progress of a stream; returns credit, in bytes and in samples, while the host sends samples.
    StreamProgress {
        /// Index after that of the last sample the board received.
        next_index: u32,
        /// Free space in samples, counted from `next_index`. The board drops samples beyond it.
        room: u16,
        /// Underruns since power-on, modulo 2^32.
        underruns: u32,
        /// Runs of lost samples that were followed by later ones, since power-on, modulo 2^32.
        gaps: u32,
        /// Bytes received since the hello, including invalid ones, modulo 2^32.
        received_bytes: u32,
    },
}

/// The answer to a request.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, MaxSize)]
pub struct Answer {
    /// The request's sequence number.
    pub sequence: u16,
    /// Bytes received since the hello, including invalid ones, modulo 2^32; the host computes its credit from it.
    pub received_bytes: u32,
    /// State of the supervisor after the command.
    pub state: State,
    /// Whether the command was accepted or refused.
    pub outcome: Result<Accepted, Refusal>,
}

/// The result of an accepted command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, MaxSize)]
pub enum Accepted {
    /// The command was carried out.
    Done,
    /// The bitmap is already in the pool; the host does not send it.
    AlreadyHeld,
    /// A piece of the fault text, in UTF-8. The last piece is shorter than [`FAULT_TEXT_PIECE_LEN`] bytes, possibly
    /// empty.
    FaultText {
        /// Bytes of the text in this piece.
        len: u8,
        /// The text, padded with zeros.
        bytes: [u8; FAULT_TEXT_PIECE_LEN],
    },
    /// Durations of the ticks.
    TickTimes(TickTimes),
}

/// Number of classes of [`TickTimes::histogram`] up to the deadline.
pub const TICK_TIME_CLASSES: usize = 8;

/// Durations of the ticks since power-on, from the start of a tick's period until its drive was handed to the DAC. A
/// board that does not measure them, such as a simulated one, reports zeros except for missed deadlines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, MaxSize)]
pub struct TickTimes {
    /// Deadline of a drive in processor cycles; zero if the board does not measure its ticks.
    pub deadline_cycles: u32,
    /// Cycles of the longest tick.
    pub worst_cycles: u32,
    /// Missed deadlines, modulo 2^32: late drives, and ticks that had not ended when the next one began.
    pub missed_deadlines: u32,
    /// Number of ticks that took up to one eighth of the deadline, up to two eighths, and so on; the last counts those
    /// beyond the deadline. A count stays at 2^32 - 1.
    pub histogram: [u32; TICK_TIME_CLASSES + 1],
}

/// The state of the output at one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, MaxSize)]
pub struct Telemetry {
    /// Ticks since power-on, modulo 2^32.
    pub tick: u32,
    /// State of the supervisor.
    pub state: State,
    /// Limits in effect, and the state of the finger.
    pub flags: Flags,
    /// Estimated position of the finger, m from the left edge of the screen.
    pub finger_x_m: f32,
    /// Estimated position of the finger, m from the top edge of the screen.
    pub finger_y_m: f32,
    /// Estimated sliding speed, m/s.
    pub speed_m_per_s: f32,
    /// Target electric friction, the friction above natural friction: the input of the inverse model, N.
    pub commanded_electric_friction_n: f32,
    /// Rms voltage of the envelope, V.
    pub voltage_v_rms: f32,
    /// Code written to the DAC.
    pub dac_code: i16,
}
