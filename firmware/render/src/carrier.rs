//! The carrier: alternates the envelope's sign, so that no charge leaks through the skin and no direct current flows.
//!
//! The running integral of the DAC code, exact in integers, never leaves plus or minus one half period at full
//! voltage, however the amplitude moves: a code that would take it out is put out with the other sign, as an early
//! edge.

use frixel_wire::scene::Carrier as Shape;

#[cfg(feature = "sine-carrier")]
use crate::turns;

/// What a carrier is made of; part of `Active`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CarrierTiming {
    pub(crate) shape: Shape,
    pub(crate) half_period_ticks: u32,
    /// DAC codes for a volt rms of envelope: crest factor and loss in the edges included.
    pub(crate) codes_per_v_rms: f32,
    /// Largest DAC code.
    pub(crate) code_max: i32,
    /// Largest magnitude of the running integral, in code ticks.
    integral_max: i32,
    turns_per_tick: f32,
}

impl CarrierTiming {
    /// Output zero.
    pub(crate) const SILENT: Self = Self::new(Shape::Square, 20, 0.0, 0);

    /// A carrier whose integral stays within one half period at full voltage.
    pub(crate) const fn new(shape: Shape, half_period_ticks: u32, codes_per_v_rms: f32, code_max: i32) -> Self {
        let mean = match shape {
            Shape::Square => 1.0,
            Shape::Sine => core::f32::consts::FRAC_2_PI,
        };
        let integral_max = (code_max as f32 * (half_period_ticks as f32 * mean)) as i32;
        let turns_per_tick = 0.5 / half_period_ticks as f32;
        Self { shape, half_period_ticks, codes_per_v_rms, code_max, integral_max, turns_per_tick }
    }
}

/// The carrier's state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carrier {
    /// Ticks into the current period, in which the first half is positive.
    phase_ticks: u32,
    integral: i32,
}

impl Carrier {
    /// Starts a quarter period in, so that the integral swings evenly about zero.
    pub(crate) fn new(timing: &CarrierTiming) -> Self {
        Self { phase_ticks: timing.half_period_ticks / 2, integral: 0 }
    }

    /// Goes on with the timing of another scene. The integral is the electrode's, and stays.
    pub(crate) fn retime(&mut self, timing: &CarrierTiming) {
        self.phase_ticks = self.phase_ticks.checked_rem(2 * timing.half_period_ticks).unwrap_or_default();
    }

    /// Waits at zero output. It will start again a quarter period before an edge, on the side that takes the integral
    /// back.
    pub(crate) fn rest(&mut self, timing: &CarrierTiming) {
        let quarter = timing.half_period_ticks / 2;
        self.phase_ticks = if self.integral > 0 { timing.half_period_ticks + quarter } else { quarter };
    }

    /// The code for this tick, and whether its edge came early to keep direct current away.
    #[inline]
    pub(crate) fn next(&mut self, envelope_v_rms: f32, timing: &CarrierTiming) -> (i16, bool) {
        let code = self.code(envelope_v_rms, timing);
        let too_far = (self.integral + code).abs() > timing.integral_max;
        let early = too_far && self.takes_out(code);
        let code = if early { -code } else { code };
        if early {
            let half = timing.half_period_ticks;
            self.phase_ticks = if self.phase_ticks < half { self.phase_ticks + half } else { self.phase_ticks - half };
        }
        self.integral += code;
        self.phase_ticks += 1;
        if self.phase_ticks >= 2 * timing.half_period_ticks {
            self.phase_ticks = 0;
        }
        (code as i16, early)
    }

    /// Whether a code takes the integral away from zero.
    #[cold]
    fn takes_out(&self, code: i32) -> bool {
        (self.integral + code).abs() > self.integral.abs()
    }

    fn code(&self, envelope_v_rms: f32, timing: &CarrierTiming) -> i32 {
        let amplitude = envelope_v_rms * timing.codes_per_v_rms;
        match timing.shape {
            Shape::Square => {
                let code = ((amplitude + 0.5) as i32).min(timing.code_max);
                if self.phase_ticks < timing.half_period_ticks { code } else { -code }
            }
            #[cfg(feature = "sine-carrier")]
            Shape::Sine => {
                // A quarter of a turn before its crest.
                let turns = self.phase_ticks as f32 * timing.turns_per_tick - 0.25;
                let code = amplitude * turns::cosine(turns);
                let rounded = (code + 0.5_f32.copysign(code)) as i32;
                // Not `clamp`, which has a panic for limits that are the wrong way round.
                rounded.min(timing.code_max).max(-timing.code_max)
            }
            #[cfg(not(feature = "sine-carrier"))]
            Shape::Sine => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn timing(shape: Shape, half_period_ticks: u32) -> CarrierTiming {
        CarrierTiming::new(shape, half_period_ticks, 100.0, 20_000)
    }

    #[test]
    fn a_steady_square_alternates_without_early_edges() {
        let timing = timing(Shape::Square, 20);
        let mut carrier = Carrier::new(&timing);
        let codes: Vec<(i16, bool)> = (0..400).map(|_| carrier.next(200.0, &timing)).collect();
        assert!(codes.iter().all(|(_, early)| !early));
        for (i, (code, _)) in codes.iter().enumerate() {
            let positive = (i + 10) % 40 < 20;
            assert_eq!(*code, if positive { 20_000 } else { -20_000 }, "{i}");
        }
    }

    #[cfg(feature = "sine-carrier")]
    #[test]
    fn a_sine_has_the_rms_of_its_envelope() {
        let timing = timing(Shape::Sine, 20);
        let mut carrier = Carrier::new(&timing);
        let sum: f64 = (0..4000).map(|_| f64::from(carrier.next(100.0, &timing).0).powi(2)).sum();
        let rms = (sum / 4000.0).sqrt();
        assert!((rms * 2.0_f64.sqrt() - 10_000.0).abs() < 1.0, "{rms}");
    }

    proptest! {
        /// Amplitudes that move with the carrier are the worst: every half wave of one sign large, of the other small.
        #[test]
        fn the_integral_stays_within_a_half_period_at_full_voltage(
            sine in any::<bool>(),
            half_period_ticks in 4_u32..80,
            seed_amplitudes in proptest::collection::vec(0.0_f32..200.0, 1..200),
            resonant in any::<bool>(),
        ) {
            let timing = timing(if sine { Shape::Sine } else { Shape::Square }, half_period_ticks);
            let mut carrier = Carrier::new(&timing);
            let mut integral = 0_i64;
            let full = i64::from(timing.integral_max);
            for i in 0..4000_usize {
                let half = i as u32 / half_period_ticks;
                let amplitude = if resonant { if half.is_multiple_of(2) { 200.0 } else { 3.0 } }
                    else { seed_amplitudes[i % seed_amplitudes.len()] };
                if i % 1013 == 0 { carrier.rest(&timing); }
                integral += i64::from(carrier.next(amplitude, &timing).0);
                prop_assert!(integral.abs() <= full, "{integral} after {i} ticks, {full} allowed");
            }
        }
    }
}
