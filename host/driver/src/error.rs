//! What can go wrong between a caller and a board. The message of each says what was found and what to do.

use std::time::Duration;

use frixel_wire::hello::Mismatch;
use frixel_wire::message::Refusal;
use frixel_wire::payload::WriteError;
use thiserror::Error;

/// A port could not be opened.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum PortError {
    /// There is no such port.
    #[error("there is no port {port}; {}", port_list(.ports))]
    NotThere {
        /// Path that was asked for.
        port: String,
        /// Paths of the ports that there are.
        ports: Vec<String>,
    },
    /// Another program has the port open.
    #[error("{port} is in use by another program; close that one (a serial monitor, or a second frixel) and try again")]
    Busy {
        /// Path of the port.
        port: String,
    },
    /// The operating system does not let this user open the port.
    #[error(
        "no permission to open {port}; on Linux its group may, usually `dialout` or `uucp`: add yourself with \
         `sudo usermod -aG dialout $USER` and log in again"
    )]
    NoPermission {
        /// Path of the port.
        port: String,
    },
    /// The operating system refuses for another reason; a file that is not a serial port is one.
    #[error("{port} does not open as a serial port: {reason}; check the path, and plug the board in again")]
    NotOpened {
        /// Path of the port.
        port: String,
        /// In the operating system's words.
        reason: String,
    },
    /// The ports of this machine could not be listed.
    #[error("the serial ports of this machine cannot be listed: {reason}; name the port by its path")]
    NoList {
        /// In the operating system's words.
        reason: String,
    },
}

/// A link that was open is no more.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("the port {port} vanished ({reason})")]
pub struct LinkClosed {
    /// Path of the port.
    pub port: String,
    /// In the operating system's words.
    pub reason: String,
}

/// A call to a board failed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum DeviceError {
    /// The port could not be opened.
    #[error(transparent)]
    Port(#[from] PortError),
    /// Nothing that answers a hello is on the line.
    #[error(
        "no frixel board answered on {port} within {} ms{}; check that it is the right port and that frixel firmware runs on the board, \
         then reset the board and try again",
        .waited.as_millis(),
        if *.heard_bytes > 0 { ", though something else talks there" } else { "" }
    )]
    NoHello {
        /// Name of the link.
        port: String,
        /// How long it was waited for, in the link's time.
        waited: Duration,
        /// Bytes that came meanwhile.
        heard_bytes: usize,
    },
    /// The board speaks another protocol.
    #[error("{port}: {mismatch}")]
    Version {
        /// Name of the link.
        port: String,
        /// Which versions, and which side to change.
        mismatch: Mismatch,
    },
    /// The board did not answer.
    #[error(
        "{command} was not answered by the board on {port} for {} ms; its output goes to zero by itself; check cable and power, then start again",
        .waited.as_millis()
    )]
    Silent {
        /// Name of the link.
        port: String,
        /// What was not answered.
        command: &'static str,
        /// How long it was waited for, in the link's time.
        waited: Duration,
    },
    /// The board answered that it will not.
    #[error("{command} was refused by the board on {port}: {refusal}")]
    Refused {
        /// Name of the link.
        port: String,
        /// What was refused.
        command: &'static str,
        /// Why.
        refusal: Refusal,
    },
    /// The cable was pulled, or the other end closed the line.
    #[error("{closed} during: {command}; the board's output goes to zero by itself; plug the cable in and start again")]
    Vanished {
        /// What was under way.
        command: &'static str,
        /// The link's own words.
        closed: LinkClosed,
    },
    /// The board's count of bytes began anew: it was reset, or another host said hello to it.
    #[error("the board on {port} restarted during: {command}; connect again and upload the scene again")]
    Restarted {
        /// Name of the link.
        port: String,
        /// What was under way.
        command: &'static str,
    },
    /// The board answers, but an upload does not get on however often it is sent again.
    #[error(
        "the upload to {port} does not get past {arrived_bytes} of {total_bytes} bytes; the line damages what is sent: try another cable \
         or a lower line rate"
    )]
    UploadStalled {
        /// Name of the link.
        port: String,
        /// Bytes of the scene or bitmap that the board has.
        arrived_bytes: usize,
        /// Bytes of the whole scene or bitmap.
        total_bytes: usize,
    },
    /// A bitmap to be uploaded has not one sample for each of its places.
    #[error("bitmap {crc32:#010x} is {width} by {height}, but has {found} samples; it needs one for each place")]
    BitmapSize {
        /// CRC-32 of the samples.
        crc32: u32,
        /// Samples in a row.
        width: u16,
        /// Rows.
        height: u16,
        /// Samples that there are.
        found: usize,
    },
    /// A frame cannot be written: an upload that is longer than any may be.
    #[error(transparent)]
    Frame(#[from] WriteError),
}

fn port_list(ports: &[String]) -> String {
    match ports {
        [] => "this machine has none: plug the board in".into(),
        [only] => format!("the only one is {only}"),
        [..] => format!("those that are there: {}", ports.join(", ")),
    }
}
