//! Friction that changes with time: `low + (high - low) e w(f t)`, with the burst's envelope `e`.

use core::num::NonZeroU32;

use frixel_wire::message::{ConfigField, ConfigRefusal, Refusal};

use crate::context::Context;
use crate::cosine::cosine;
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind, measured_cost};
use crate::layout::RecordBytes;
use crate::parameters::{Parameter, UnknownForm, form, parameters, put_form, range, within};
use crate::point::Point;
use crate::prepare::{Preparation, steps_per_tick, ticks};
use crate::region::ActiveRegion;
use crate::wave::TURNS_PER_STEP;

parameters! {
    /// Friction that changes with time: `low + (high - low) e w(f t)`, with the burst's envelope `e`.
    pub struct Vibration {
        /// Shape over a period.
        beat: Beat = 3,
        /// Frequency, Hz.
        frequency_hz: f32 = 24 in range::FREQUENCY_HZ,
        /// Smallest electric friction, and that between bursts, N.
        low_n: f32 = 28 in range::FRICTION_N,
        /// Largest electric friction, N.
        high_n: f32 = 32 in range::FRICTION_N,
        /// Bursts of the vibration.
        burst: Burst = 36,
    }
}

/// Shape of a vibration over its period.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Beat {
    /// `(1 + sin(2 pi turns)) / 2`.
    #[default]
    Sine,
    /// 1 in the first half of each turn, 0 in the second.
    Square,
}

impl Parameter for Beat {
    const LEN: usize = 1;

    fn read(record: &RecordBytes, _offset: usize) -> Result<Self, UnknownForm> {
        match form(record) {
            0 => Ok(Self::Sine),
            1 => Ok(Self::Square),
            other => Err(UnknownForm(other)),
        }
    }

    fn write(&self, record: &mut RecordBytes, _offset: usize) {
        put_form(record, *self as u8);
    }
}

/// Bursts of a vibration: in each period, its envelope rises over the ramp, stays at 1, and falls over the ramp. The
/// first period begins when the host switches the layer on, or at power-on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Burst {
    /// Period of the bursts, s; 0 for a continuous vibration.
    pub period_s: f32,
    /// Duration of a burst including both ramps, s; at most the period.
    pub on_s: f32,
    /// Duration of each ramp, s; at most half the duration of the burst.
    pub ramp_s: f32,
}

impl Parameter for Burst {
    const LEN: usize = 3 * f32::LEN;

    fn read(record: &RecordBytes, offset: usize) -> Result<Self, UnknownForm> {
        let number = |number| f32::read(record, offset + number * f32::LEN);
        Ok(Self { period_s: number(0)?, on_s: number(1)?, ramp_s: number(2)? })
    }

    fn write(&self, record: &mut RecordBytes, offset: usize) {
        for (number, time_s) in [self.period_s, self.on_s, self.ramp_s].into_iter().enumerate() {
            time_s.write(record, offset + number * f32::LEN);
        }
    }

    fn check(&self, layer: u8) -> Result<(), ConfigRefusal> {
        range::BURST_S.check(self.period_s, layer)?;
        within(ConfigField::Duration, self.on_s, 0.0, self.period_s, layer)?;
        within(ConfigField::Duration, self.ramp_s, 0.0, 0.5 * self.on_s, layer)
    }
}

impl Kind for Vibration {
    type Coefficients = VibrationCoefficients;

    fn cost(&self) -> Cost {
        match self.beat {
            Beat::Sine => const { measured_cost("vibration_sine") },
            Beat::Square => const { measured_cost("vibration_square") },
        }
    }

    fn bounds(&self, _points: &[Point]) -> Interval<f32> {
        Interval::of([self.low_n, self.high_n])
    }

    fn prepare(&self, _layer: u8, preparation: &mut Preparation) -> Result<VibrationCoefficients, Refusal> {
        Ok(VibrationCoefficients {
            beat: self.beat,
            step: steps_per_tick(self.frequency_hz, preparation.tick_hz),
            low_n: self.low_n,
            half_span_n: 0.5 * (self.high_n - self.low_n),
            burst: BurstCoefficients::new(&self.burst, preparation.tick_hz),
        })
    }
}

/// `low + half_span e (1 + w)`. The phase is a tick number times a step, modulo a turn, so it does not drift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VibrationCoefficients {
    beat: Beat,
    step: u32,
    low_n: f32,
    half_span_n: f32,
    burst: Option<BurstCoefficients>,
}

/// The envelope: `offset + per_tick n`, at most 1, with the smaller number `n` of ticks since the burst's start and
/// until its end.
#[derive(Clone, Copy, Debug, PartialEq)]
struct BurstCoefficients {
    period_ticks: NonZeroU32,
    on_ticks: u32,
    per_tick: f32,
    offset: f32,
    /// The tick at which the first burst begins.
    begin_tick: u32,
}

impl Evaluate for VibrationCoefficients {
    #[inline]
    fn electric_friction_n(&self, _region: &ActiveRegion, context: &mut Context) -> f32 {
        let tick = context.inputs.tick;
        let phase = tick.wrapping_mul(self.step);
        // As a signed number, the phase is between -1/2 and 1/2 turn.
        let height = match self.beat {
            Beat::Sine => cosine(phase.wrapping_sub(1 << 30) as i32 as f32 * TURNS_PER_STEP),
            Beat::Square => {
                if phase < 1 << 31 {
                    1.0
                } else {
                    -1.0
                }
            }
        };
        let span_n = match &self.burst {
            Some(burst) => self.half_span_n * burst.envelope(tick),
            None => self.half_span_n,
        };
        self.low_n + span_n * (1.0 + height)
    }

    #[inline]
    fn begin(&mut self, tick: u32) {
        if let Some(burst) = &mut self.burst {
            burst.begin_tick = tick;
        }
    }
}

impl BurstCoefficients {
    fn new(burst: &Burst, tick_hz: u32) -> Option<Self> {
        let ramp_ticks = ticks(burst.ramp_s, tick_hz);
        let (per_tick, offset) = if ramp_ticks > 0 { (1.0 / ramp_ticks as f32, 0.0) } else { (0.0, 1.0) };
        let period_ticks = NonZeroU32::new(ticks(burst.period_s, tick_hz))?;
        Some(Self { period_ticks, on_ticks: ticks(burst.on_s, tick_hz), per_tick, offset, begin_tick: 0 })
    }

    #[inline]
    fn envelope(&self, tick: u32) -> f32 {
        let since_ticks = tick.wrapping_sub(self.begin_tick) % self.period_ticks;
        if since_ticks >= self.on_ticks {
            return 0.0;
        }
        let until_ticks = self.on_ticks - since_ticks;
        let envelope = self.offset + self.per_tick * since_ticks.min(until_ticks) as f32;
        if envelope < 1.0 { envelope } else { 1.0 }
    }
}
