//! Ceilings of a board's output for any coefficients.

use frixel_layers::{CARRIER_MIN_HZ, HALF_PERIOD_MIN_TICKS, HOST_TIMEOUTS_S};
use frixel_model::TouchBound;
use frixel_wire::dac_code::DacCode;

use crate::Board;

/// The ceilings of a board. The ticker lowers every coefficient to them when it takes a scene; the session refuses a
/// scene above them.
#[derive(Clone, Copy, Debug)]
pub struct Ceilings {
    voltage_max_v_peak: f32,
    touch: TouchBound,
    codes_per_v: f32,
    tick_period_s: f32,
    half_period_max_ticks: u32,
    pub(crate) host_timeout_max_ticks: u32,
}

impl Ceilings {
    pub(crate) fn new(board: &Board) -> Self {
        let [_, host_timeout_max_s] = HOST_TIMEOUTS_S;
        Self {
            voltage_max_v_peak: board.limits.voltage_max_v_peak,
            touch: TouchBound::behind(board.limits.series_resistance_ohm),
            codes_per_v: f32::from(i16::MAX) / board.limits.full_scale_v_peak,
            tick_period_s: board.tick_period_s(),
            half_period_max_ticks: board.ticks(0.5 / CARRIER_MIN_HZ).max(HALF_PERIOD_MIN_TICKS),
            host_timeout_max_ticks: board.ticks(host_timeout_max_s),
        }
    }

    /// The largest peak voltage on a carrier with half periods of `half_period_ticks`, in V: the board's, or less if
    /// the current through a person who touches the electrode is the limit.
    pub fn voltage_max_v_peak(&self, half_period_ticks: u32) -> f32 {
        let carrier_hz = 0.5 / (half_period_ticks as f32 * self.tick_period_s);
        self.voltage_max_v_peak.min(self.touch.voltage_max_v_peak(carrier_hz))
    }

    /// The largest code up to a peak voltage in V.
    pub fn code(&self, voltage_v_peak: f32) -> DacCode {
        let code = (voltage_v_peak * self.codes_per_v) as i32;
        DacCode::from_bits(code.clamp(0, i32::from(i16::MAX)) as i16)
    }

    /// The nearest allowed length of a half period, in ticks.
    #[allow(clippy::manual_clamp, reason = "`clamp` panics if its ends are reversed")]
    pub(crate) fn half_period_ticks(&self, ticks: u32) -> u32 {
        ticks.min(self.half_period_max_ticks).max(HALF_PERIOD_MIN_TICKS)
    }
}
