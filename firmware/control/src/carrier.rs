//! The carrier: alternates the envelope's sign, so that no charge leaks through the skin and no direct current flows.
//!
//! The running integral of the DAC code, exact in fixed point, stays within plus or minus one half period at full
//! voltage for any change of amplitude: a half period ends early before a code that would leave this range.
//!
//! A whole half period follows an early edge, so a constant envelope has at most one early edge: the half period after
//! the edge reverses at most half of the range, and the next one returns to the position of the edge. From the second
//! period after a change on, all half periods have their nominal length, and the codes of a period add up to zero. The
//! mean of the integral remains where the changes have left it, which is not a direct current. An integral beyond the
//! smaller limit of a new scene first falls, with a sixteenth of the envelope. Otherwise a coating charged by a slower
//! carrier would add its voltage to the full envelope, and the touch current would exceed its limit once
//! (`frixel_model::TouchBound`).

use fixed::types::{I1F15, I17F15};
use frixel_layers::{Waveform, cosine};
use frixel_wire::dac_code::DacCode;

use crate::Ceilings;

/// An integral beyond its limit falls with the envelope divided by two to this power. A positive envelope below sixteen
/// codes, 0.1 V at 200 V full scale, then becomes zero, and the output waits for a larger one.
const FALL_SHIFT: u32 = 4;

/// Parameters of a carrier; part of [`Active`](crate::Active).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarrierTiming {
    pub(crate) waveform: Waveform,
    pub(crate) half_period_ticks: u32,
    /// DAC codes per volt rms of the envelope, including the crest factor and the loss in the edges.
    pub(crate) codes_per_v_rms: f32,
    /// Largest DAC code; not negative.
    pub(crate) code_max: DacCode,
    /// Largest magnitude of the running integral, in ticks at full scale.
    integral_max: I17F15,
    turns_per_tick: f32,
}

impl CarrierTiming {
    /// A carrier whose output is zero.
    pub const ZERO_OUTPUT: Self = Self {
        waveform: Waveform::Square,
        half_period_ticks: 0,
        codes_per_v_rms: 0.0,
        code_max: DacCode::ZERO,
        integral_max: I17F15::ZERO,
        turns_per_tick: 0.0,
    };

    /// A carrier whose integral stays within one half period at full voltage. A negative `code_max` counts as zero.
    pub const fn new(waveform: Waveform, half_period_ticks: u32, codes_per_v_rms: f32, code_max: DacCode) -> Self {
        let code_max = if code_max.bits() < 0 { DacCode::ZERO } else { code_max };
        let mean = match waveform {
            Waveform::Square => 1.0,
            Waveform::Sine => core::f32::consts::FRAC_2_PI,
        };
        let integral_max = I17F15::from_bits((code_max.bits() as f32 * (half_period_ticks as f32 * mean)) as i32);
        let turns_per_tick = 0.5 / half_period_ticks as f32;
        Self { waveform, half_period_ticks, codes_per_v_rms, code_max, integral_max, turns_per_tick }
    }

    /// This carrier, lowered to a board's ceilings.
    pub(crate) fn within(&self, ceilings: &Ceilings) -> Self {
        let half_period_ticks = ceilings.half_period_ticks(self.half_period_ticks);
        let ceiling = ceilings.code(ceilings.voltage_max_v_peak(half_period_ticks));
        Self::new(self.waveform, half_period_ticks, self.codes_per_v_rms, self.code_max.min(ceiling))
    }

    /// Ticks from the middle of a half period to its edge.
    fn ticks_from_crest(&self) -> u32 {
        self.half_period_ticks - self.half_period_ticks / 2
    }
}

/// The carrier's state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carrier {
    /// 1 in the first half of a period, -1 in the second.
    sign: i32,
    /// Ticks until the next edge, including the current one.
    left_ticks: u32,
    /// Volt-seconds so far, in ticks at full scale.
    integral: I17F15,
    /// Early edges since power-on, modulo 2^32.
    early_edges: u32,
    last_early_tick: u32,
}

impl Carrier {
    /// A carrier that starts a quarter period in, so that the integral is symmetric about zero.
    pub(crate) fn new(timing: &CarrierTiming) -> Self {
        Self {
            sign: 1,
            left_ticks: timing.ticks_from_crest(),
            integral: I17F15::ZERO,
            early_edges: 0,
            last_early_tick: 0,
        }
    }

    /// Continues with the timing of another scene. The integral belongs to the electrode and is kept.
    pub(crate) fn retime(&mut self, timing: &CarrierTiming) {
        self.left_ticks = match self.left_ticks {
            // There was no carrier.
            0 => timing.ticks_from_crest(),
            left_ticks => left_ticks.min(timing.half_period_ticks),
        };
    }

    /// Prepares the restart from zero output: a quarter period before an edge, with the sign that moves the integral
    /// towards zero.
    pub(crate) fn reset_to_zero(&mut self, timing: &CarrierTiming) {
        self.sign = if self.integral.is_positive() { -1 } else { 1 };
        self.left_ticks = timing.ticks_from_crest();
    }

    /// Early edges since power-on, modulo 2^32.
    pub(crate) fn early_edges(&self) -> u32 {
        self.early_edges
    }

    /// Tick of the last early edge.
    pub(crate) fn last_early_tick(&self) -> u32 {
        self.last_early_tick
    }

    /// The code for this tick.
    #[inline]
    pub(crate) fn next(&mut self, envelope_v_rms: f32, timing: &CarrierTiming, tick: u32) -> DacCode {
        let mut code = self.magnitude(envelope_v_rms, timing) * self.sign;
        // One unsigned comparison checks both limits. Neither sum can overflow.
        let above_least = (self.integral + code + timing.integral_max).to_bits().cast_unsigned();
        if above_least > 2 * timing.integral_max.to_bits().cast_unsigned() {
            code = self.within_balance(code, timing, tick);
        }
        self.integral += code;
        if self.left_ticks > 1 {
            self.left_ticks -= 1;
        } else {
            self.turn(timing);
        }
        // This does not wrap: the magnitude is at most `code_max`, which is not negative.
        DacCode(I1F15::wrapping_from_num(code))
    }

    /// Handles a code that would move the integral beyond its limit. If it moves the integral away from zero, ends the
    /// half period before this tick, and takes the first code of the next. An integral already beyond its limit falls
    /// slowly.
    #[cold]
    fn within_balance(&mut self, mut code: I17F15, timing: &CarrierTiming, tick: u32) -> I17F15 {
        if self.integral.is_negative() == self.sign.is_negative() {
            self.early_edges = self.early_edges.wrapping_add(1);
            self.last_early_tick = tick;
            self.turn(timing);
            // A half wave of a sine begins at zero.
            code =
                if cfg!(feature = "sine-carrier") && timing.waveform == Waveform::Sine { I17F15::ZERO } else { -code };
        }
        let is_beyond = (self.integral + timing.integral_max).to_bits().cast_unsigned()
            > 2 * timing.integral_max.to_bits().cast_unsigned();
        if is_beyond { code >> FALL_SHIFT } else { code }
    }

    /// Ends a half period.
    #[inline]
    fn turn(&mut self, timing: &CarrierTiming) {
        self.sign = -self.sign;
        self.left_ticks = timing.half_period_ticks;
    }

    #[inline]
    fn magnitude(&self, envelope_v_rms: f32, timing: &CarrierTiming) -> I17F15 {
        let amplitude = envelope_v_rms * timing.codes_per_v_rms;
        let code = match timing.waveform {
            Waveform::Square => amplitude,
            Waveform::Sine if cfg!(feature = "sine-carrier") => {
                // The crest, at which the cosine's angle is 0, is a quarter of a turn before the edge.
                amplitude * cosine(self.left_ticks as f32 * timing.turns_per_tick - 0.25)
            }
            Waveform::Sine => 0.0,
        };
        // The last line of defence: for any envelope and coefficients, the code is from zero to `code_max`. The
        // conversion turns a negative number and NaN into zero.
        let code_max = i32::from(timing.code_max.bits()).cast_unsigned();
        I17F15::from_bits(((code + 0.5) as u32).min(code_max).cast_signed())
    }
}

#[cfg(test)]
mod tests;
