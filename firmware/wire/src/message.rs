//! Messages in postcard. Enums are append-only: a variant keeps its place for ever.

mod refusal;

use postcard::experimental::max_size::MaxSize;
use serde::{Deserialize, Serialize};

use crate::fault::{Fault, Flags, State};

pub use refusal::{ConfigField, ConfigRefusal, Refusal};

/// What the host sends: a command with a sequence number that comes back in its answer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, MaxSize)]
pub struct Request {
    /// Chosen by the host; repeated in the answer.
    pub sequence: u16,
    /// What the board is to do.
    pub command: Command,
}

/// What the host asks of the board. Every command is answered by one [`Answer`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, MaxSize)]
pub enum Command {
    /// Says that the host is there.
    Ping,
    /// Starts the upload of a scene ([`crate::scene`]), and drops any upload that was under way.
    UploadScene {
        /// Bytes of the whole scene.
        len: u32,
        /// CRC-32 of the whole scene.
        crc32: u32,
    },
    /// Starts the upload of a bitmap, one byte a sample, row after row from the top left; answered
    /// [`Accepted::AlreadyHeld`] when the pool has it.
    UploadBitmap {
        /// Samples in a row.
        width: u16,
        /// Rows.
        height: u16,
        /// The bitmap's name in scene records: [`crate::scene::bitmap_crc32`].
        crc32: u32,
    },
    /// Ends an upload: the board checks its CRC.
    UploadEnd,
    /// Makes the uploaded scene the one that plays, whole, at a tick boundary.
    Commit {
        /// CRC-32 of the scene that is meant.
        crc32: u32,
    },
    /// Disarmed to Armed.
    Arm,
    /// Any state but Faulted to Disarmed; always puts the output to zero.
    Disarm,
    /// Armed to Active.
    Play,
    /// Active to Armed.
    Stop,
    /// Faulted to Disarmed, when the cause is gone.
    ClearFault,
    /// Asks for telemetry, one message every so many ticks; zero ends it.
    Subscribe {
        /// Ticks between two telemetry messages; at least [`TELEMETRY_PERIOD_MIN_TICKS`], or zero.
        period_ticks: u32,
    },
    /// Tells where the host's pointer has the finger; for a board that takes touch from the host.
    Touch {
        /// From the left edge of the screen, m.
        x_m: f32,
        /// From the top edge of the screen, m.
        y_m: f32,
        /// Ticks since the finger was there.
        age_ticks: u16,
    },
    /// Tells that the finger has left the screen; for a board that takes touch from the host.
    Lift,
    /// Asks what the firmware said of the fault that led to the last reset; answered [`Accepted::FaultText`].
    FaultText {
        /// Bytes of the text that the host has already.
        offset: u8,
    },
    /// Switches a layer of the playing scene on or off and sets its gain, at a tick boundary. A commit brings back
    /// what the scene says.
    SetLayer {
        /// The layer: its record's place in the scene, from zero.
        layer: u8,
        /// Whether the layer acts.
        on: bool,
        /// Factor on the layer's friction from now on, in place of its record's.
        gain: f32,
    },
    /// Starts a stream of samples for the `stream` layers of the playing scene; one under way is forgotten. Its samples
    /// count from zero.
    StartStream {
        /// Samples a second; at most the board's ticks a second.
        sample_hz: u32,
        /// Samples that have to be there before the stream begins to play, and again after it ran dry;
        /// 1 to [`STREAM_START_LEVEL_MAX`].
        start_level: u16,
    },
    /// Says that no more samples come: the stream ends after the last one, which is no underrun.
    EndStream,
    /// As [`Self::Touch`], for one of several fingers. The scene's rule says which of them leads.
    TouchFinger {
        /// The finger's number; the same from touch to lift.
        finger: u8,
        /// From the left edge of the screen, m.
        x_m: f32,
        /// From the top edge of the screen, m.
        y_m: f32,
        /// Ticks since the finger was there.
        age_ticks: u16,
    },
    /// As [`Self::Lift`], for one of several fingers.
    LiftFinger {
        /// The finger's number.
        finger: u8,
    },
}

/// Largest start level of a stream, in samples: what leaves room in the smallest buffer for two frames more.
pub const STREAM_START_LEVEL_MAX: u16 = 800;

/// Bytes of a fault's text that one answer carries.
pub const FAULT_TEXT_PIECE_LEN: usize = 32;
/// Most bytes that a fault's text has.
pub const FAULT_TEXT_MAX_LEN: usize = 192;

/// Shortest period of telemetry, in ticks: 1 kHz at 40 kHz ticks.
pub const TELEMETRY_PERIOD_MIN_TICKS: u32 = 40;

/// What the board sends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, MaxSize)]
pub enum FromBoard {
    /// Answers one request.
    Answer(Answer),
    /// How far an upload has come; gives credit back while chunks flow.
    Progress {
        /// Number of the chunk that the board wants next; the host goes back to it when it is lower than expected.
        next_chunk: u16,
        /// Bytes received since the hello, garbage included, modulo 2^32.
        received_bytes: u32,
    },
    /// What the board does now.
    Telemetry(Telemetry),
    /// The state changed without a command: a fault, or the host was silent.
    StateChanged {
        /// The state now.
        state: State,
        /// The fault, if one is latched.
        fault: Option<Fault>,
        /// Why, where it is not a fault ([`Flags::HOST_SILENT`]).
        flags: Flags,
    },
    /// How a stream is doing; gives credit back while samples flow, in bytes and in samples.
    StreamProgress {
        /// Index of the sample behind the last one that the board has.
        next_index: u32,
        /// Samples from `next_index` on that the board has room for. What goes beyond is dropped.
        room: u16,
        /// Times that the stream ran dry since power-on, modulo 2^32.
        underruns: u32,
        /// Runs of samples that never came, though later ones did, since power-on, modulo 2^32.
        gaps: u32,
        /// Bytes received since the hello, garbage included, modulo 2^32.
        received_bytes: u32,
    },
}

/// The answer to a request.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, MaxSize)]
pub struct Answer {
    /// The request's sequence number.
    pub sequence: u16,
    /// Bytes received since the hello, garbage included, modulo 2^32: the credit.
    pub received_bytes: u32,
    /// State of the supervisor once the command is carried out.
    pub state: State,
    /// Whether it was done.
    pub outcome: Result<Accepted, Refusal>,
}

/// How a command was accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, MaxSize)]
pub enum Accepted {
    /// Done.
    Done,
    /// The bitmap is in the pool already: do not send it.
    AlreadyHeld,
    /// A piece of the fault's text, UTF-8; the last one has fewer than [`FAULT_TEXT_PIECE_LEN`] bytes, or none.
    FaultText {
        /// Bytes of the text in this piece.
        len: u8,
        /// The text, and zeros behind it.
        bytes: [u8; FAULT_TEXT_PIECE_LEN],
    },
}

/// What the board does at one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, MaxSize)]
pub struct Telemetry {
    /// Ticks since power-on, modulo 2^32.
    pub tick: u32,
    /// State of the supervisor.
    pub state: State,
    /// Limits that act.
    pub flags: Flags,
    /// Where the board takes the finger to be, m from the left edge of the screen.
    pub finger_x_m: f32,
    /// Where the board takes the finger to be, m from the top edge of the screen.
    pub finger_y_m: f32,
    /// Sliding speed, m/s.
    pub speed_m_per_s: f32,
    /// Friction that the inverse was asked for, above natural, N.
    pub asked_electric_friction_n: f32,
    /// Rms voltage of the envelope, V.
    pub voltage_v_rms: f32,
    /// Code that went to the DAC.
    pub dac_code: i16,
}
