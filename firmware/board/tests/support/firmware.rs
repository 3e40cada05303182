//! The board whose firmware runs in virtual time.

use frixel_control::{Active, Board, Ticker};
use frixel_layers::BitmapPool;
use frixel_session::{NextScene, Session};
use frixel_testkit::IdealMonitor;
use frixel_wire::hello::{BoardKind, BoardLimits};

/// A board with the limits of the NUCLEO-G474RE.
pub(crate) const BOARD: Board = Board {
    kind: BoardKind::NucleoG474re,
    limits: BoardLimits {
        voltage_max_v_peak: 50.0,
        full_scale_v_peak: 200.0,
        edge_time_constant_s: 37.5e-6,
        current_max_a_rms: 0.5e-3,
        current_max_a_peak: 1.8e-3,
        ..Board::SIMULATOR.limits
    },
    touch_from_host: true,
    ..Board::SIMULATOR
};

/// The limits with which bring-up begins, for 68 kOhm. [`BOARD`] drives a capacitor that cannot be touched.
pub(crate) const BUILT_IN: BoardLimits = BoardLimits { series_resistance_ohm: 68e3, ..BOARD.limits };

/// Session and ticker, whose memory lives as long as the program.
pub(crate) fn firmware() -> (Session<'static>, Ticker<'static>) {
    let pool: &BitmapPool = Box::leak(Box::new(BitmapPool::new()));
    let (playing, next) = (Box::leak(Box::new(Active::new())), Box::leak(Box::new(NextScene::new())));
    (Session::new(BOARD, pool, next), Ticker::new(&BOARD, pool, playing))
}

/// Its monitor.
pub(crate) fn monitor() -> IdealMonitor {
    IdealMonitor::new(BOARD.limits.full_scale_v_peak, BOARD.amplifier.time_constant_s / BOARD.tick_period_s())
}
