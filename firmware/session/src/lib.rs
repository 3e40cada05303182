//! The part of the firmware without hard deadlines: a [`Session`] turns a host's bytes into scenes, and touch reports
//! into [`Track`](frixel_control::Track)s. A [`Ticker`](frixel_control::Ticker) turns the track into voltage, one tick
//! at a time.
//!
//! The two run at different priorities on a board and share no mutable state. They exchange values:
//! [`Order`](frixel_control::Order)s from the session to the ticker, one before each tick; a
//! [`Status`](frixel_control::Status) back; and the two [`Active`](frixel_control::Active) buffers, which are passed by
//! reference, so that a whole scene is swapped at a tick boundary. The [`BitmapPool`](frixel_layers::BitmapPool) is
//! shared memory of single bytes: the session writes only bytes that the ticker does not read.
//!
//! A board, a simulator and a test call them in the same way:
//!
//! ```
//! use frixel_control::{Active, Board, Sense, Ticker};
//! use frixel_layers::BitmapPool;
//! use frixel_session::{NextScene, Session, Touch};
//!
//! let board = Board::SIMULATOR;
//! let pool = BitmapPool::new();
//! let (mut playing, mut next) = (Active::new(), NextScene::new());
//! let mut ticker = Ticker::new(&board, &pool, &mut playing);
//! let mut session = Session::new(board, &pool, &mut next);
//!
//! session.receive(&[0, 0, 0], &ticker.status()); // bytes from the serial line
//! session.touch(Touch::Down { x_m: 0.02, y_m: 0.03, age_ticks: 0 }, 1); // from the touch source
//! session.hand_order_to(&mut ticker); // at most one before a tick
//! let drive = ticker.tick(&Sense::default()); // 40,000 times a second
//! session.poll(&ticker.status());
//! assert_eq!(drive.dac_code.bits(), 0);
//! assert_eq!(session.transmit(&mut [0; 64]), 0); // bytes for the serial line
//! ```
//!
//! # Modules
//!
//! `session` turns bytes into frames and back. `commands` dispatches the frames to four independent parts, and passes
//! values between them:
//!
//! | part | takes | gives |
//! |---|---|---|
//! | `link` | received bytes to count, requests that wait, answers and reports | credit, the next waiting request, bytes to send |
//! | `scene` | bytes of scenes, bitmaps and streams, commits, changes of layers | coefficients and changes, as orders |
//! | `motion` | touch reports of the board and of the host | tracks and lifts, as orders |
//! | `states` | orders, commands that arm and play, the ticker's status | refusals, changes of state, the next order |
//!
//! `scene` puts its orders into the queue of `states`. `hello` describes the board. `queues` connects a session in a
//! main loop with a ticker in an interrupt. `store` keeps measured limits across power-off.
//!
//! # Cargo features
//!
//! Every Cargo feature enables a part of scenes or of the protocol, and all are enabled by default: the kinds of layers
//! (`edge` includes buttons), `polygon` regions, the `sine-carrier` and `telemetry`. An image without a feature is
//! smaller, clears its feature bit in the hello, and refuses what needs it. Constant layers, rectangles, ellipses, all
//! blends and the square carrier are always included.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod commands;
mod hello;
mod link;
mod motion;
mod queues;
mod scene;
mod session;
mod states;
pub mod store;

pub use frixel_wire::touch::Touch;
pub use motion::Tracker;
pub use queues::{Queues, SessionEnds, TickEnds};
pub use scene::{NextScene, TableRows, active_bytes_filled, table_rows, voltage_max_v_rms};
pub use session::Session;
