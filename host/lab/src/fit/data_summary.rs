//! The data of a fit in numbers.

use super::{Division, Preparation};

/// The data that were fitted, and the load at which friction is stated.
#[derive(Clone, Debug, PartialEq)]
pub struct DataSummary {
    /// Normal load at which friction is stated, in newtons.
    pub normal_load_n: f64,
    /// Lowest and highest voltage of the data with the drive on, in volts rms.
    pub voltage_range_v_rms: (f64, f64),
    /// Smallest and largest load of the strokes, in newtons.
    pub load_range_n: (f64, f64),
    /// Number of rows that were used.
    pub rows: usize,
    /// How rows were divided into strokes.
    pub division: Division,
    /// Whether the data have times, so that starts and turns were dropped.
    pub has_time: bool,
    /// Whether the data have speeds.
    pub has_speed: bool,
    /// Bandwidth with which friction follows a switch of the drive, in Hz.
    ///
    /// It is that of force sensor and finger together; `None` if the data are inconclusive.
    pub bandwidth_hz: Option<f64>,
    /// Omissions and corrections before the fit.
    pub preparation: Preparation,
}
