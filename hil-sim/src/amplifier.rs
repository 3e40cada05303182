//! The amplifier: converts DAC codes to voltages at its output and at the electrode, with gain error, offset,
//! saturation, lags, a current limit, and a turn-off delay.

mod config;
mod lag;

use frixel_control::Drive;

pub use config::AmplifierConfig;

use crate::error::{OutOfRange, above_zero};
use lag::{Cascade, Lag, Voltages};

/// The electrode voltage during a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Output {
    /// Mean voltage over the tick, V.
    pub(crate) mean_v: f64,
    /// Variance of the voltage over the tick, V^2.
    pub(crate) variance_v2: f64,
    /// Mean of the squared voltage over the tick, V^2: the square of its mean plus its variance.
    pub(crate) mean_square_v2: f64,
    /// Voltage at the end of the tick, V.
    pub(crate) end_v: f64,
}

impl Output {
    fn new(mean_v: f64, variance_v2: f64, end_v: f64) -> Self {
        Self { mean_v, variance_v2, mean_square_v2: mean_v * mean_v + variance_v2, end_v }
    }
}

/// State of the output stage.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    /// Follows the DAC.
    On,
    /// Holds its output, for this many ticks.
    Holding(u32),
    /// Discharges its output at once, within the current limit.
    Off,
}

/// The amplifier and its voltages.
#[derive(Clone, Debug)]
pub(crate) struct Amplifier {
    config: AmplifierConfig,
    volts_per_code: f64,
    /// Distance of the electrode from the target above which the current limit acts, V.
    slewing_above_v: f64,
    following: Cascade,
    tick_period_s: f64,
    turn_off_delay_ticks: u32,
    stage: Stage,
    voltages: Voltages,
    /// Monitor voltage at the end of the tick before the last one.
    monitor_v: f64,
}

impl Amplifier {
    /// An amplifier at rest at 0 V, with a DAC whose code 32,767 corresponds to `full_scale_v_peak`.
    pub(crate) fn new(config: &AmplifierConfig, full_scale_v_peak: f64, tick_hz: u32) -> Result<Self, OutOfRange> {
        config.check()?;
        let full_scale_v_peak = above_zero("full_scale_v_peak", full_scale_v_peak)?;
        let tick_period_s = 1.0 / f64::from(tick_hz);
        let electrode_tau_s = config.electrode_time_constant_s;
        // Avoid rounding up a time that exceeds a whole number of ticks only by rounding.
        let turn_off_delay_ticks = libm::ceil(config.turn_off_delay_s * f64::from(tick_hz) - 1e-6).max(0.0) as u32;
        let slew_v_per_s = config.slew_v_per_s;
        Ok(Self {
            config: *config,
            volts_per_code: config.gain * full_scale_v_peak / f64::from(i16::MAX),
            // Infinity times zero: without a limit, nothing exceeds it.
            slewing_above_v: if slew_v_per_s.is_finite() { slew_v_per_s * electrode_tau_s } else { f64::INFINITY },
            following: Cascade::new(config.output_time_constant_s, electrode_tau_s, tick_period_s),
            tick_period_s,
            turn_off_delay_ticks,
            stage: Stage::Off,
            voltages: Voltages::default(),
            monitor_v: 0.0,
        })
    }

    /// Returns this amplifier with another configuration and the same voltages.
    pub(crate) fn reconfigured(
        &self,
        config: &AmplifierConfig,
        full_scale_v_peak: f64,
        tick_hz: u32,
    ) -> Result<Self, OutOfRange> {
        let Self { stage, voltages, monitor_v, .. } = *self;
        Ok(Self { stage, voltages, monitor_v, ..Self::new(config, full_scale_v_peak, tick_hz)? })
    }

    /// Holds `drive` for one tick.
    pub(crate) fn tick(&mut self, drive: Drive) -> Output {
        self.monitor_v = self.voltages.output_v;
        if self.stage != Stage::On || !drive.amplifier_enable {
            self.switch(drive.amplifier_enable);
        }
        match self.stage {
            Stage::On => {
                let AmplifierConfig { offset_v, saturation_v_peak, .. } = self.config;
                let commanded_v = f64::from(drive.dac_code.bits()) * self.volts_per_code + offset_v;
                self.follow(commanded_v.clamp(-saturation_v_peak, saturation_v_peak))
            }
            Stage::Holding(_) => self.follow(self.voltages.output_v),
            Stage::Off => self.follow(0.0),
        }
    }

    /// Monitor voltage at the start of the next tick. A board latches the code of a tick at the end of the tick, which
    /// is the start of a tick of this world. The monitor is therefore one tick behind.
    pub(crate) fn monitor_v(&self) -> f64 {
        self.config.monitor_gain * self.monitor_v
    }

    /// Monitor voltage at the end of the last tick.
    #[cfg(unix)]
    pub(crate) fn monitor_now_v(&self) -> f64 {
        self.config.monitor_gain * self.voltages.output_v
    }

    /// Moves the output stage on by a tick.
    fn switch(&mut self, enable: bool) {
        self.stage = match self.stage {
            _ if enable => Stage::On,
            Stage::On => Stage::Holding(self.turn_off_delay_ticks),
            Stage::Holding(ticks) => Stage::Holding(ticks.saturating_sub(1)),
            Stage::Off => Stage::Off,
        };
        if self.stage == Stage::Holding(0) && !self.config.is_stuck_on {
            self.stage = Stage::Off;
        }
    }

    fn follow(&mut self, target_v: f64) -> Output {
        let distance_v = self.voltages.electrode_v - target_v;
        if distance_v.abs() > self.slewing_above_v {
            return self.slew(target_v, distance_v);
        }
        self.following.tick(&mut self.voltages, target_v)
    }

    /// A tick that starts too far from the target for the amplifier's current: the electrode follows a ramp, and its
    /// lag after the end of the ramp. The lag of the output is negligible in comparison.
    fn slew(&mut self, target_v: f64, distance_v: f64) -> Output {
        let slew_v_per_s = self.config.slew_v_per_s;
        let start_v = self.voltages.electrode_v;
        let slope_v_per_s = slew_v_per_s.copysign(-distance_v);
        let ramp_s = (distance_v.abs() - self.slewing_above_v) / slew_v_per_s;
        let ramp = |time_s: f64| {
            let rise_v = slope_v_per_s * time_s;
            (start_v + 0.5 * rise_v, rise_v * rise_v / 12.0)
        };
        if ramp_s >= self.tick_period_s {
            let (mean_v, variance_v2) = ramp(self.tick_period_s);
            let end_v = start_v + slope_v_per_s * self.tick_period_s;
            self.settle_at(end_v, target_v);
            return Output::new(mean_v, variance_v2, end_v);
        }
        let (ramp_mean_v, ramp_variance_v2) = ramp(ramp_s);
        // An electrode without lag holds its target instead.
        let lag = Lag::new(self.config.electrode_time_constant_s, self.tick_period_s - ramp_s);
        let remaining_v = self.slewing_above_v.copysign(distance_v);
        let lag_mean_v = target_v + remaining_v * lag.mean;
        let lag_variance_v2 = remaining_v * remaining_v * lag.variance;
        let ramp_part = ramp_s / self.tick_period_s;
        let lag_part = 1.0 - ramp_part;
        let between_v = ramp_mean_v - lag_mean_v;
        let end_v = target_v + remaining_v * lag.remainder;
        self.settle_at(end_v, target_v);
        Output::new(
            ramp_part * ramp_mean_v + lag_part * lag_mean_v,
            ramp_part * ramp_variance_v2 + lag_part * lag_variance_v2 + ramp_part * lag_part * between_v * between_v,
            end_v,
        )
    }

    /// Ends a tick with the electrode at `electrode_v`. The voltage across the series resistor stays within the current
    /// limit.
    fn settle_at(&mut self, electrode_v: f64, target_v: f64) {
        let drop_v = (target_v - electrode_v).clamp(-self.slewing_above_v, self.slewing_above_v);
        self.voltages = Voltages { output_v: electrode_v + drop_v, electrode_v };
    }
}

#[cfg(test)]
mod tests;
