//! Errors of opening and listing serial ports. Each message states what was found and what to do.

use thiserror::Error;

/// A port could not be opened.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum PortError {
    /// There is no such port.
    #[error("there is no port {port}; {}", port_list(.ports))]
    NotThere {
        /// The path that was given.
        port: String,
        /// Paths of the ports of this machine.
        ports: Vec<String>,
    },
    /// Another program has the port open.
    #[error("{port} is in use by another program; close that one (a serial monitor, or a second frixel) and try again")]
    Busy {
        /// Path of the port.
        port: String,
    },
    /// This user lacks the permission to open the port.
    #[error(
        "no permission to open {port}; on Linux, members of its group (usually `dialout` or `uucp`) may open it: \
         join it with `sudo usermod -aG dialout $USER` and log in again"
    )]
    NoPermission {
        /// Path of the port.
        port: String,
    },
    /// The path is that of a file or a folder.
    #[error("{port} is not a serial port; `frixel board ports` lists the ports of this machine")]
    NotASerialPort {
        /// The path that was given.
        port: String,
    },
    /// Any other refusal by the operating system.
    #[error("{port} cannot be opened as a serial port: {reason}; check the path, and plug the board in again")]
    NotOpened {
        /// Path of the port.
        port: String,
        /// The operating system's reason.
        reason: String,
    },
    /// The ports of this machine could not be listed.
    #[error("the serial ports of this machine cannot be listed: {reason}; name the port by its path")]
    NoList {
        /// The operating system's reason.
        reason: String,
    },
}

fn port_list(ports: &[String]) -> String {
    match ports {
        [] => "this machine has none: plug the board in".into(),
        [only] => format!("the only one is {only}"),
        [..] => format!("the ports of this machine are {}", ports.join(", ")),
    }
}
