//! The serial ports of this machine.

use std::fmt;
use std::io::ErrorKind;
use std::path::Path;

use serialport::SerialPortType;

use super::error::PortError;

/// A serial port and what is known about what hangs on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PortInfo {
    /// What [`super::SerialLink::open`] takes.
    pub path: String,
    /// The USB device behind the port, if there is one.
    pub usb: Option<UsbDevice>,
}

/// What a USB device says of itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UsbDevice {
    /// Number of the vendor.
    pub vendor_id: u16,
    /// The vendor's number of the product.
    pub product_id: u16,
    /// Name of the vendor.
    pub manufacturer: Option<String>,
    /// Name of the product.
    pub product: Option<String>,
    /// Serial number.
    pub serial_number: Option<String>,
}

impl fmt::Display for PortInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.path)?;
        let Some(usb) = &self.usb else { return Ok(()) };
        write!(f, " (USB {:04x}:{:04x}", usb.vendor_id, usb.product_id)?;
        for name in [&usb.manufacturer, &usb.product].into_iter().flatten() {
            write!(f, ", {name}")?;
        }
        if let Some(number) = &usb.serial_number {
            write!(f, ", serial number {number}")?;
        }
        f.write_str(")")
    }
}

/// The serial ports of this machine, by path. Pseudo-terminals are not among them.
///
/// ```
/// for port in frixel_driver::ports()? {
///     println!("{port}");
/// }
/// # Ok::<(), frixel_driver::PortError>(())
/// ```
pub fn ports() -> Result<Vec<PortInfo>, PortError> {
    // The serialport crate panics on a Linux without sysfs, a bare container for one.
    if cfg!(target_os = "linux") && !Path::new("/sys/class/tty").is_dir() {
        return Ok(Vec::new());
    }
    let found = serialport::available_ports().map_err(|error| PortError::NoList { reason: error.description })?;
    let mut ports: Vec<PortInfo> = found.into_iter().map(port_info).collect();
    ports.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(ports)
}

fn port_info(port: serialport::SerialPortInfo) -> PortInfo {
    let usb = match port.port_type {
        SerialPortType::UsbPort(usb) => Some(UsbDevice {
            vendor_id: usb.vid,
            product_id: usb.pid,
            manufacturer: usb.manufacturer,
            product: usb.product,
            serial_number: usb.serial_number,
        }),
        _ => None,
    };
    PortInfo { path: port.port_name, usb }
}

/// Says what is behind an error of the serialport crate when `port` was opened.
pub(super) fn why_not_opened(port: &str, error: serialport::Error) -> PortError {
    use serialport::ErrorKind as Kind;

    let port_there = || Path::new(port).exists() || port_paths().iter().any(|path| path == port);
    match error.kind {
        // On Windows the same kind says that the port is not there.
        Kind::NoDevice if port_there() => PortError::Busy { port: port.into() },
        Kind::NoDevice | Kind::Io(ErrorKind::NotFound) => not_there(port),
        Kind::Io(ErrorKind::PermissionDenied) => PortError::NoPermission { port: port.into() },
        _ => PortError::NotOpened { port: port.into(), reason: error.description },
    }
}

fn not_there(port: &str) -> PortError {
    PortError::NotThere { port: port.into(), ports: port_paths() }
}

fn port_paths() -> Vec<String> {
    let ports = ports().unwrap_or_default();
    ports.into_iter().map(|port| port.path).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_says_what_is_known_of_it() {
        let mut port = PortInfo { path: "/dev/ttyS0".into(), usb: None };
        assert_eq!(port.to_string(), "/dev/ttyS0");
        port.usb = Some(UsbDevice {
            vendor_id: 0x0483,
            product_id: 0x374e,
            manufacturer: Some("STMicroelectronics".into()),
            product: None,
            serial_number: Some("0042".into()),
        });
        assert_eq!(port.to_string(), "/dev/ttyS0 (USB 0483:374e, STMicroelectronics, serial number 0042)");
    }

    #[test]
    fn what_the_operating_system_says_becomes_advice() {
        let error = |kind| serialport::Error::new(kind, "reason");
        let why = |port, kind| why_not_opened(port, error(kind));
        let io = serialport::ErrorKind::Io;
        let path = env!("CARGO_MANIFEST_DIR");
        assert_eq!(why(path, serialport::ErrorKind::NoDevice), PortError::Busy { port: path.into() });
        assert!(matches!(why("nowhere", serialport::ErrorKind::NoDevice), PortError::NotThere { .. }));
        assert!(matches!(why("nowhere", io(ErrorKind::NotFound)), PortError::NotThere { .. }));
        assert!(matches!(why(path, io(ErrorKind::PermissionDenied)), PortError::NoPermission { .. }));
        assert!(matches!(why(path, serialport::ErrorKind::Unknown), PortError::NotOpened { .. }));
        assert!(why(path, io(ErrorKind::PermissionDenied)).to_string().contains("dialout"));
    }
}
