//! The firmware without the hardware: a [`Session`] turns bytes from a host into scenes and touch reports into
//! [`Track`]s, and a [`Ticker`] turns the track into voltage, one tick at a time.
//!
//! The two run at different priorities on a board and never share mutable state. What goes between them are values:
//! [`Order`]s from the session to the ticker, one before each tick, a [`Status`] back, and the two [`Active`] buffers, which
//! change hands by reference so that a scene is swapped whole at a tick boundary. The
//! [`BitmapPool`](frixel_layers::BitmapPool) is shared memory of single bytes: the session writes only where the ticker
//! does not read.
//!
//! A board, a simulator and a test all drive them in the same way:
//!
//! ```
//! use frixel_layers::BitmapPool;
//! use frixel_render::{Active, Board, Sense, Session, Ticker, Touch};
//!
//! let board = Board::SIMULATOR;
//! let pool = BitmapPool::new();
//! let (mut first, mut second) = (Active::new(), Active::new());
//! let mut ticker = Ticker::new(&board, &pool, &mut first);
//! let mut session = Session::new(board, &pool, &mut second);
//!
//! session.receive(&[0, 0, 0], &ticker.status()); // bytes from the serial line
//! session.touch(Touch::Down { x_m: 0.02, y_m: 0.03, age_ticks: 0 }, 1); // from the touch source
//! if let Some(order) = session.next_order() {
//!     if let Some(spare) = ticker.apply(order) {
//!         session.take_back(spare);
//!     }
//! }
//! let drive = ticker.tick(&Sense::default()); // 40,000 times a second
//! session.poll(&ticker.status());
//! assert_eq!(drive.dac_code.bits(), 0);
//! assert_eq!(session.transmit(&mut [0; 64]), 0); // bytes for the serial line
//! ```
//!
//! # Leaving out
//!
//! Every Cargo feature is something that a scene or a host may ask for, and all are on by default: layers of `grating`,
//! `bitmap`, `noise`, `edge` (with buttons), `vibration`, `speed` and `stream`, `polygon` regions, the `sine-carrier`,
//! `telemetry`; and the `store` of what a board keeps over power-off. An image without one of them is smaller, says so
//! in the feature bits of its hello, and refuses what needs it. Constant layers, rectangles, ellipses, all blends and
//! the square carrier are always there.
//!
//! # Fast and small
//!
//! A board builds this crate for speed and itself for size. What a session or a commit does is `#[inline]`: a board takes
//! it in, and so builds it for size, too.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod active;
mod bitmap_directory;
mod board;
mod carrier;
mod deadline;
mod envelope;
mod estimator;
mod finger;
mod io;
mod order;
mod session;
mod standstill;
#[cfg(feature = "store")]
pub mod store;
#[cfg(feature = "stream")]
mod stream;
mod supervisor;
mod ticker;
mod track;
mod tracker;

pub use active::{Active, TableRows};
pub use board::Board;
pub use io::{Drive, Sense, Touch};
pub use order::{Counters, Order, Status};
#[cfg(feature = "store")]
pub use session::KeptScene;
pub use session::Session;
#[cfg(feature = "stream")]
pub use stream::{STREAM_LEN, StreamBuffer, StreamStart};
pub use ticker::Ticker;
pub use track::{StandstillRamp, Track};
