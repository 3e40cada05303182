//! The serial ports of this machine.

use std::fmt;
use std::io::ErrorKind;
use std::path::Path;

use serialport::SerialPortType;

use super::port_error::PortError;

/// A serial port and the USB device behind it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PortInfo {
    /// The path, for [`SerialLink::open`](super::SerialLink::open).
    pub path: String,
    /// The USB device behind the port, if there is one.
    pub usb: Option<UsbDevice>,
}

/// The descriptor of a USB device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UsbDevice {
    /// USB vendor ID.
    pub vendor_id: u16,
    /// USB product ID.
    pub product_id: u16,
    /// The vendor's name.
    pub manufacturer: Option<String>,
    /// The product's name.
    pub product: Option<String>,
    /// The device's serial number.
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

/// The serial ports of this machine, sorted by path. Pseudo-terminals are not listed.
///
/// ```
/// for port in frixel_driver::ports()? {
///     println!("{port}");
/// }
/// # Ok::<(), frixel_driver::PortError>(())
/// ```
pub fn ports() -> Result<Vec<PortInfo>, PortError> {
    // The serialport crate panics on a Linux without sysfs, as in a bare container.
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

/// Converts the error that the serialport crate returned when opening `port`.
pub(super) fn why_not_opened(port: &str, error: serialport::Error) -> PortError {
    use serialport::ErrorKind as Kind;

    let is_other = || std::fs::metadata(port).is_ok_and(|found| found.is_file() || found.is_dir());
    let port_exists = || Path::new(port).exists() || port_paths().iter().any(|path| path == port);
    match error.kind {
        // On Windows the same kind means that the port does not exist.
        Kind::NoDevice if port_exists() => PortError::Busy { port: port.into() },
        Kind::NoDevice | Kind::Io(ErrorKind::NotFound) => not_there(port),
        Kind::Io(ErrorKind::PermissionDenied) => PortError::NoPermission { port: port.into() },
        _ if is_other() => PortError::NotASerialPort { port: port.into() },
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
    fn an_error_of_the_operating_system_becomes_advice() {
        let error = |kind| serialport::Error::new(kind, "reason");
        let why = |port, kind| why_not_opened(port, error(kind));
        let io = serialport::ErrorKind::Io;
        let path = env!("CARGO_MANIFEST_DIR");
        assert_eq!(why(path, serialport::ErrorKind::NoDevice), PortError::Busy { port: path.into() });
        assert!(matches!(why("nowhere", serialport::ErrorKind::NoDevice), PortError::NotThere { .. }));
        assert!(matches!(why("nowhere", io(ErrorKind::NotFound)), PortError::NotThere { .. }));
        assert!(matches!(why(path, io(ErrorKind::PermissionDenied)), PortError::NoPermission { .. }));
        assert_eq!(why(path, serialport::ErrorKind::Unknown), PortError::NotASerialPort { port: path.into() });
        assert!(matches!(why("nowhere", serialport::ErrorKind::Unknown), PortError::NotOpened { .. }));
        assert!(why(path, io(ErrorKind::PermissionDenied)).to_string().contains("dialout"));
    }
}
