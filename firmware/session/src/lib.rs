//! All of the firmware that may take its time: a [`Session`] turns bytes from a host into scenes, and touch reports into
//! [`Track`](frixel_control::Track)s. A [`Ticker`](frixel_control::Ticker) turns the track into voltage, one tick at a time.
//!
//! The two run at different priorities on a board and never share mutable state. What goes between them are values:
//! [`Order`](frixel_control::Order)s from the session to the ticker, one before each tick, a
//! [`Status`](frixel_control::Status) back, and the two
//! [`Active`](frixel_control::Active) buffers, which
//! change hands by reference so that a scene is swapped whole at a tick boundary. The
//! [`BitmapPool`](frixel_layers::BitmapPool) is shared memory of single bytes: the session writes only where the ticker
//! does not read.
//!
//! A board, a simulator and a test all drive them in the same way:
//!
//! ```
//! use frixel_control::{Active, Board, Sense, Ticker};
//! use frixel_layers::BitmapPool;
//! use frixel_session::{Session, Touch};
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
//! # Inside
//!
//! `session` turns bytes into frames and back; `commands` says what the frames mean, and the others do what they ask for:
//! `greeting` the hello, `states` arming and playing, `storing` uploads, whose bytes `upload` gathers, `commit` the change of
//! scene, which `loading` computes step by step, `live` what changes while one plays, `fingers` touches of the host.
//! `tracker` turns touch reports into tracks, with `estimator` and `standstill`.
//!
//! # Leaving out
//!
//! Every Cargo feature is something that a scene or a host may ask for, and all are on by default: layers of `grating`,
//! `bitmap`, `noise`, `edge` (with buttons), `vibration`, `speed` and `stream`, `polygon` regions, the `sine-carrier`,
//! `telemetry`; and the `store` of what a board keeps over power-off. An image without one of them is smaller, says so
//! in the feature bits of its hello, and refuses what needs it. Constant layers, rectangles, ellipses, all blends and
//! the square carrier are always there.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod bitmap_directory;
mod commands;
mod commit;
mod credit;
mod estimator;
mod fingers;
mod greeting;
mod live;
mod loading;
mod session;
mod standstill;
mod states;
#[cfg(feature = "store")]
pub mod store;
#[cfg(feature = "store")]
mod stored;
mod storing;
mod tracker;
mod transmit_queue;
mod upload;

pub use loading::{TableRows, active_bytes_filled, table_rows};
pub use session::Session;
#[cfg(feature = "store")]
pub use stored::StoredScene;
pub use tracker::Touch;
