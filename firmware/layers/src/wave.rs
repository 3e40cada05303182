//! Periodic waves over an angle in turns, for kinds that repeat over the screen.
#![allow(dead_code, reason = "which of these is used depends on the features that are on")]

use frixel_wire::message::ConfigRefusal;

use crate::cosine::{centred, cosine};
use crate::cost::Cost;
use crate::kind::measured_cost;
use crate::layout::RecordBytes;
use crate::parameters::{Parameter, UnknownForm, form, put_form, range};
use crate::prepare::steps_per_tick;

/// Converts a phase in integer steps of 2^-32 turns to turns.
pub(crate) const TURNS_PER_STEP: f32 = 1.0 / (1u64 << 32) as f32;

const SINE: u8 = 0;
const SQUARE: u8 = 1;
const TRIANGLE: u8 = 2;
const SAW: u8 = 3;

/// Shape of stripes over a turn, from 0 to 1.
///
/// A record stores it as the form byte, with the duty at the parameter's offset, which is zero for other shapes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Wave {
    /// `(1 + sin(2 pi turns)) / 2`.
    #[default]
    Sine,
    /// 1 in the first part of each turn, 0 in the rest.
    Square {
        /// Duration of the first part as a fraction of a turn, from 0.01 to 0.99.
        duty: f32,
    },
    /// Rises from 0 to 1 in the first half of each turn, and falls in the second.
    Triangle,
    /// Rises from 0 to 1 in each turn.
    Saw,
}

impl Wave {
    /// Largest number of core cycles of a grating of this shape.
    pub(crate) fn cost(&self) -> Cost {
        match self {
            Self::Sine => const { measured_cost("sine") },
            Self::Square { .. } => const { measured_cost("square") },
            Self::Triangle => const { measured_cost("triangle") },
            Self::Saw => const { measured_cost("saw") },
        }
    }
}

impl Parameter for Wave {
    const LEN: usize = f32::LEN;

    fn read(record: &RecordBytes, offset: usize) -> Result<Self, UnknownForm> {
        match form(record) {
            SINE => Ok(Self::Sine),
            SQUARE => Ok(Self::Square { duty: f32::read(record, offset)? }),
            TRIANGLE => Ok(Self::Triangle),
            SAW => Ok(Self::Saw),
            other => Err(UnknownForm(other)),
        }
    }

    fn write(&self, record: &mut RecordBytes, offset: usize) {
        match self {
            Self::Sine => put_form(record, SINE),
            Self::Square { duty } => {
                put_form(record, SQUARE);
                duty.write(record, offset);
            }
            Self::Triangle => put_form(record, TRIANGLE),
            Self::Saw => put_form(record, SAW),
        }
    }

    fn check(&self, layer: u8) -> Result<(), ConfigRefusal> {
        match self {
            Self::Square { duty } => range::DUTY.check(*duty, layer),
            Self::Sine | Self::Triangle | Self::Saw => Ok(()),
        }
    }
}

/// Phase of a moving wave: as exact after 2^32 ticks as after one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Phase {
    /// Phase at tick 0, in turns.
    turns: f32,
    /// Decrement of the phase per tick, in steps of 2^-32 turns, modulo a turn; 0 at rest.
    steps_per_tick: u32,
}

impl Phase {
    /// Phase of a wave that passes a place `drift_hz` times a second.
    pub(crate) fn new(turns: f32, drift_hz: f32, tick_hz: u32) -> Self {
        // Waves at rest need no division.
        let steps_per_tick = if drift_hz == 0.0 { 0 } else { steps_per_tick(drift_hz, tick_hz) };
        Self { turns, steps_per_tick }
    }

    #[inline]
    pub(crate) fn at(&self, tick: u32) -> f32 {
        if self.steps_per_tick == 0 { self.turns } else { self.moved(tick) }
    }

    /// Phase of a moving wave. A separate function, since a wave at rest would otherwise execute its instructions too.
    #[cold]
    #[inline(never)]
    fn moved(&self, tick: u32) -> f32 {
        // As a signed number, the phase is between -1/2 and 1/2 turn.
        let steps = tick.wrapping_mul(self.steps_per_tick) as i32;
        self.turns - steps as f32 * TURNS_PER_STEP
    }
}

/// A wave from -1 to 1, with the middle of its high part or of its rise at phase 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum CentredWave {
    Cosine,
    /// 1 up to half the duty on both sides.
    Square {
        half_duty_turns: f32,
    },
    Triangle,
    Saw,
}

impl CentredWave {
    /// The wave, and its phase in turns where `wave` has phase 0.
    pub(crate) fn new(wave: Wave) -> (Self, f32) {
        match wave {
            Wave::Sine => (Self::Cosine, -0.25),
            Wave::Square { duty } => (Self::Square { half_duty_turns: 0.5 * duty }, -0.5 * duty),
            Wave::Triangle => (Self::Triangle, -0.5),
            Wave::Saw => (Self::Saw, -0.5),
        }
    }

    /// The wave at a phase, from -1 to 1, within a millionth.
    #[inline]
    pub(crate) fn at(&self, turns: f32) -> f32 {
        match *self {
            Self::Cosine => cosine(turns),
            Self::Square { half_duty_turns } => {
                let turns = centred(turns);
                if turns >= -half_duty_turns && turns < half_duty_turns { 1.0 } else { -1.0 }
            }
            Self::Triangle => 1.0 - 4.0 * centred(turns).abs(),
            Self::Saw => 2.0 * centred(turns),
        }
    }
}
