//! Deviations of a simulated amplifier from an ideal one.

use frixel_control::Board;
use frixel_wire::hello::BoardLimits;

use crate::error::{OutOfRange, above_zero, within, zero_to_ten};

/// Deviations of the amplifier from an ideal one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmplifierConfig {
    /// True gain over the gain that the board assumes: 1 for an ideal amplifier. Above 0.
    pub gain: f64,
    /// Largest voltage that the output reaches in either direction, in volts, peak. Above 0.
    pub saturation_v_peak: f64,
    /// Time constant of the amplifier's output, before the series resistor, in seconds: 0 (no lag) to 10.
    pub output_time_constant_s: f64,
    /// Time constant of the electrode behind the series resistor, in seconds: 0 (no lag) to 10.
    pub electrode_time_constant_s: f64,
    /// Offset voltage of the output while the amplifier is enabled, in volts: -10 to 10.
    pub offset_v: f64,
    /// Slew limit of the electrode, in V/s, above 0: the amplifier's current limit over the load capacitance.
    pub slew_v_per_s: f64,
    /// Time from the fall of the enable until the output falls, in seconds: 0 to 10, rounded up to whole ticks. The
    /// output is constant meanwhile.
    pub turn_off_delay_s: f64,
    /// Whether the output stays constant as long as the amplifier is disabled, as with a broken output stage.
    pub is_stuck_on: bool,
    /// Monitor voltage over output voltage: 1 for an ideal monitor, 0 for a dead one. Finite.
    pub monitor_gain: f64,
}

impl AmplifierConfig {
    /// Exact gain, no offset, no current limit, an electrode time constant of 20 us that includes the amplifier's own,
    /// and 250 V: the simulated board's full scale, above any voltage that it allows. It switches on and off at once,
    /// as that board assumes.
    pub const IDEAL: Self = Self {
        gain: 1.0,
        saturation_v_peak: 250.0,
        output_time_constant_s: 0.0,
        electrode_time_constant_s: 20e-6,
        offset_v: 0.0,
        slew_v_per_s: f64::INFINITY,
        turn_off_delay_s: 0.0,
        is_stuck_on: false,
        monitor_gain: 1.0,
    };

    /// An amplifier as required by `docs/board/hardware.md`: an offset of 0.5 V (assumed: 25 mV at the input of a gain
    /// of 20), and a current limit of 5 mA into the simulated board's worst-case electrode, 0.53 nF. It switches at
    /// once, like [`Self::IDEAL`].
    pub const REALISTIC: Self = Self { offset_v: 0.5, slew_v_per_s: 5e-3 / 0.53e-9, ..Self::IDEAL };

    /// [`Self::IDEAL`] with the lags that a board states for its amplifier and its electrode, the latter from its
    /// series resistance. A board without series resistance states both as one lag of the electrode. The simulator's
    /// own board has [`Self::IDEAL`].
    pub fn of(board: &Board) -> Self {
        let BoardLimits { series_resistance_ohm, electrode_capacitance_max_f, edge_time_constant_s, .. } = board.limits;
        let electrode_s = f64::from(series_resistance_ohm * electrode_capacitance_max_f);
        // To a nanosecond, the limit is the number that the board states.
        let edge_s = libm::round(1e9 * f64::from(edge_time_constant_s)) / 1e9;
        Self {
            output_time_constant_s: board.amplifier.time_constant_s.into(),
            electrode_time_constant_s: if electrode_s.is_finite() { electrode_s } else { edge_s },
            ..Self::IDEAL
        }
    }

    /// Checks the range of every number.
    pub(crate) fn check(&self) -> Result<(), OutOfRange> {
        above_zero("amplifier gain", self.gain)?;
        above_zero("amplifier saturation_v_peak", self.saturation_v_peak)?;
        zero_to_ten("amplifier output_time_constant_s", self.output_time_constant_s)?;
        zero_to_ten("amplifier electrode_time_constant_s", self.electrode_time_constant_s)?;
        zero_to_ten("amplifier turn_off_delay_s", self.turn_off_delay_s)?;
        if self.slew_v_per_s != f64::INFINITY {
            above_zero("amplifier slew_v_per_s", self.slew_v_per_s)?;
        }
        within("amplifier offset_v", -10.0..=10.0, "from -10 to 10", self.offset_v)?;
        within("amplifier monitor_gain", f64::MIN..=f64::MAX, "finite", self.monitor_gain)?;
        Ok(())
    }
}

impl Default for AmplifierConfig {
    /// [`Self::IDEAL`].
    fn default() -> Self {
        Self::IDEAL
    }
}
