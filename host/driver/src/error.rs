//! Errors between a caller and a board. Each message states what was found and what to do.

use std::time::Duration;

use frixel_wire::fault::State;
use frixel_wire::hello::Mismatch;
use frixel_wire::message::Refusal;
use frixel_wire::payload::WriteError;
use thiserror::Error;

/// The link closed while in use.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{port} vanished ({reason})")]
pub struct LinkClosed {
    /// Name of the link: the path of a port, or a description.
    pub port: String,
    /// The reason, in the operating system's words.
    pub reason: String,
}

/// A call to a board failed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum DeviceError {
    /// No board answered the hello.
    #[error(
        "no frixel board answered on {port} within {} ms{}; check that it is the right port and that frixel firmware runs on \
         the board, then reset the board and try again",
        .waited.as_millis(),
        if *.heard_bytes > 0 {
            ", but something else was received: another program that opened the port first (a serial monitor, a second \
             frixel) takes part of the answers, so close it"
        } else {
            ""
        }
    )]
    NoHello {
        /// Name of the link.
        port: String,
        /// How long the host waited, on the link's clock.
        waited: Duration,
        /// Bytes received while waiting.
        heard_bytes: usize,
    },
    /// The board speaks another protocol.
    #[error("{port}: {mismatch}")]
    Version {
        /// Name of the link.
        port: String,
        /// The versions, and the side to update.
        mismatch: Mismatch,
    },
    /// The board did not answer.
    #[error(
        "{command} was not answered by the board on {port} for {} ms; its output goes to zero by itself; \
         check cable and power, then start again",
        .waited.as_millis()
    )]
    Silent {
        /// Name of the link.
        port: String,
        /// The command that was not answered.
        command: &'static str,
        /// How long the host waited, on the link's clock.
        waited: Duration,
    },
    /// The board answers, but the answer to one request took too long.
    #[error(
        "{command} was not answered by the board on {port} for {} s, although it answers other frames: it is too slow; \
         disconnect its other clients, or reset it, then start again",
        .waited.as_secs()
    )]
    TooSlow {
        /// Name of the link.
        port: String,
        /// The command that was not answered.
        command: &'static str,
        /// How long the host waited, on the link's clock.
        waited: Duration,
    },
    /// The caller ended the wait for an answer; see [`Device::while_waiting`](crate::Device::while_waiting).
    #[error("the wait for the board on {port} was interrupted during: {command}; its output goes to zero by itself")]
    BrokenOff {
        /// Name of the link.
        port: String,
        /// The command that was not answered.
        command: &'static str,
    },
    /// The firmware lacks a feature that the scene needs. Nothing was uploaded.
    #[error(
        "the scene needs {missing}, which the firmware of the board on {port} does not have (firmware {}.{}.{}, protocol {}.{}): \
         flash newer firmware, or firmware that is built with it",
        .firmware.0, .firmware.1, .firmware.2, .protocol.0, .protocol.1
    )]
    MissingFeatures {
        /// Name of the link.
        port: String,
        /// Names of the features.
        missing: String,
        /// Version of the board's firmware.
        firmware: (u8, u8, u8),
        /// Protocol that the board speaks.
        protocol: (u8, u8),
    },
    /// The board refused a command.
    #[error("{command} was refused by the board on {port}: {refusal}")]
    Refused {
        /// Name of the link.
        port: String,
        /// The command that was refused.
        command: &'static str,
        /// The board's reason.
        refusal: Refusal,
    },
    /// The board accepted a command, but is not in the resulting state.
    #[error(
        "the board on {port} accepted {command} and then reported that it is {found:?}, not {expected:?}: its \
         firmware is faulty; {}flash its firmware again",
        if *found == State::Active { "its output may be driven: switch off its supply, then " } else { "" }
    )]
    WrongState {
        /// Name of the link.
        port: String,
        /// The command.
        command: &'static str,
        /// The state in the board's answer.
        found: State,
        /// The state that the command results in.
        expected: State,
    },
    /// The cable was pulled, or the other end closed the line.
    #[error("{closed} during: {command}; the board's output goes to zero by itself; plug the cable in and start again")]
    Vanished {
        /// The command that was under way.
        command: &'static str,
        /// The error that the link reported.
        closed: LinkClosed,
    },
    /// The board's count of received bytes restarted: the board was reset, or another host connected to it.
    #[error(
        "the board on {port} restarted, or another program connected to it, during: {command}; connect again and \
         upload the scene again"
    )]
    Restarted {
        /// Name of the link.
        port: String,
        /// The current command.
        command: &'static str,
    },
    /// The board answers, but an upload makes no progress although its chunks were resent.
    #[error(
        "the upload to {port} is stuck at {arrived_bytes} of {total_bytes} bytes because the line damages data: \
         try another cable or a lower line rate"
    )]
    UploadStalled {
        /// Name of the link.
        port: String,
        /// Bytes of the scene or bitmap received by the board.
        arrived_bytes: usize,
        /// Bytes of the whole scene or bitmap.
        total_bytes: usize,
    },
    /// The board answers, but stops acknowledging an upload.
    #[error(
        "the board on {port} has acknowledged no byte of an upload for {} s, and has {arrived_bytes} of {total_bytes} \
         bytes: reset it, then start again",
        .waited.as_secs()
    )]
    UploadTooSlow {
        /// Name of the link.
        port: String,
        /// Bytes of the scene or bitmap received by the board.
        arrived_bytes: usize,
        /// Bytes of the whole scene or bitmap.
        total_bytes: usize,
        /// How long the host waited, on the link's clock.
        waited: Duration,
    },
    /// The board requests a complete upload repeatedly.
    #[error(
        "the board on {port} requests all {total_bytes} bytes of an upload again, although they were sent {times} \
         times: reset the board; if that does not help, flash its firmware again"
    )]
    UploadForgotten {
        /// Name of the link.
        port: String,
        /// Bytes of the scene or bitmap.
        total_bytes: usize,
        /// Number of times they were sent.
        times: u32,
    },
    /// The caller ended the upload. The board keeps its previous scene.
    #[error("the upload to {port} was interrupted: the board has no new scene")]
    Interrupted {
        /// Name of the link.
        port: String,
    },
    /// The hello states an invalid limit.
    #[error(
        "the board on {port} states {limit} = {found} in its hello, which is not a valid limit: flash its \
         firmware again; nothing was sent to it"
    )]
    Limit {
        /// Name of the link.
        port: String,
        /// Name of the limit.
        limit: &'static str,
        /// The value found.
        found: f64,
    },
    /// The ticks of telemetry went backwards: two boards share a line, or the firmware is faulty.
    #[error(
        "the telemetry of the board on {port} went back from tick {last_tick} to {tick}: its firmware is faulty, or another \
         board answers on the same line; disconnect it, and start again"
    )]
    TelemetryBackwards {
        /// Name of the link.
        port: String,
        /// The latest tick so far.
        last_tick: u32,
        /// The earlier tick received after it.
        tick: u32,
    },
    /// A bitmap does not have width times height samples.
    #[error("bitmap {crc32:#010x} is {width} by {height}, but has {found} samples; it needs width times height")]
    BitmapSize {
        /// CRC-32 of the samples.
        crc32: u32,
        /// Samples in a row.
        width: u16,
        /// Rows.
        height: u16,
        /// Samples that the bitmap has.
        found: usize,
    },
    /// A frame cannot be encoded: the upload is longer than the protocol allows.
    #[error(transparent)]
    Frame(#[from] WriteError),
}
