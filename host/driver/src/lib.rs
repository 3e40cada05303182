//! Driver library for frixel boards: connect, upload a scene, play it, stream samples, receive telemetry.
//!
//! The input is the bytes of a compiled scene and of its bitmaps ([`Upload`]), the samples of a stream, and a [`Link`]
//! that carries bytes to one board. The output is the board's answers as `Result`s, and its telemetry as [`Event`]s.
//!
//! - [`Device`] runs the protocol. Each call has a deadline on the link's clock and returns the board's answer or an
//!   error. An absent, silent or unplugged board is reported within a second, a board that answers too slowly within
//!   10 s of a request or of the last byte of an upload that it has acknowledged; see [`Device::while_waiting`].
//! - [`Link`] carries the bytes, keeps the board alive, and has the clock. [`PollingLink`] makes a link of any
//!   [`ByteStream`]: a TCP connection, a browser's serial port, a simulated line in virtual time.
//! - With the feature `native` (on by default) `SerialLink` is a serial port of the operating system, with a thread
//!   that keeps the board alive, and `ports` lists the ports of this machine.
//!
//! Without that feature the crate reads no clock, opens no file and starts no thread, and it compiles for
//! `wasm32-unknown-unknown`.
//!
//! ```no_run
//! # #[cfg(feature = "native")]
//! # fn play(scene: &[u8]) -> Result<(), Box<dyn std::error::Error>> {
//! use std::ops::ControlFlow;
//! use std::time::Duration;
//! use frixel_driver::{DEFAULT_BAUD, Device, Event, SerialLink, Upload};
//!
//! let mut board = Device::connect(SerialLink::open("/dev/ttyACM0", DEFAULT_BAUD)?)?;
//! let upload = Upload { scene, bitmaps: Vec::new() };
//! board.upload(&upload, &mut |progress| {
//!     println!("{} of {} bytes", progress.done_bytes, progress.total_bytes);
//!     ControlFlow::Continue(())
//! })?;
//! board.commit(upload.scene_crc32())?;
//! board.arm()?;
//! board.play()?;
//! board.subscribe(400)?;
//! board.wait(Duration::from_secs(10), &mut |event| {
//!     if let Event::Telemetry(telemetry) = event {
//!         println!("{} V", telemetry.voltage_v_rms);
//!     }
//! })?;
//! board.stop()?;
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]

mod command;
mod control;
mod credit;
mod device;
mod error;
mod exchange;
mod handshake;
mod keep_alive;
mod link;
#[cfg(feature = "native")]
mod native;
mod polling;
mod upload;

pub use control::{ControlError, ControlLine, DURATION_MAX_S};
pub use device::{Counters, Device, Event, StreamSettings, StreamStatus};
pub use error::{DeviceError, LinkClosed};
pub use exchange::Waiting;
pub use keep_alive::KEEP_ALIVE_TIMEOUT;
pub use keep_alive::KeepAlive;
pub use link::{Link, Written};
#[cfg(feature = "native")]
pub use native::{DEFAULT_BAUD, PortError, PortInfo, SerialLink, UsbDevice, ports};
pub use polling::{ByteStream, PollingLink};
pub use upload::{Bitmap, Progress, Upload, ignore_progress};
