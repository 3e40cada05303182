//! The board whose firmware runs in virtual time.

use frixel_control::Board;
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

/// Its monitor.
pub(crate) fn monitor() -> IdealMonitor {
    IdealMonitor::new(BOARD.limits.full_scale_v_peak, BOARD.amplifier.time_constant_s / BOARD.tick_period_s())
}
