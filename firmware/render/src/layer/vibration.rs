//! Friction that changes with time.

use core::num::NonZeroU32;

use frixel_wire::scene::{Beat, Burst as Record};

use super::Around;
use crate::Board;
use crate::turns;

/// 2^-32: a phase in whole steps to turns.
const TURNS_PER_STEP: f32 = 1.0 / (1u64 << 32) as f32;

/// `low + span e w(f t)`. The phase is a tick number times a step, modulo a turn, so that it never drifts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vibration {
    beat: Beat,
    step: u32,
    low_n: f32,
    half_span_n: f32,
    burst: Option<Burst>,
}

/// The envelope: the smaller of `offset + rise` times the ticks since it began and until it ends, and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Burst {
    period_ticks: NonZeroU32,
    on_ticks: u32,
    per_tick: f32,
    offset: f32,
}

impl Vibration {
    pub(super) fn new(beat: Beat, frequency_hz: f32, [low_n, high_n]: [f32; 2], burst: Record, board: &Board) -> Self {
        let turns_per_tick = f64::from(frequency_hz) / f64::from(board.tick_hz);
        Self {
            beat,
            step: (turns_per_tick * (1u64 << 32) as f64 + 0.5) as u32,
            low_n,
            half_span_n: 0.5 * (high_n - low_n),
            burst: Burst::new(burst, board),
        }
    }

    #[inline(never)]
    pub(super) fn electric_friction_n(&self, around: &Around) -> f32 {
        let tick = around.moment.tick;
        let phase = tick.wrapping_mul(self.step);
        // As a signed number, the phase is between -1/2 and 1/2 turn.
        let height = match self.beat {
            Beat::Sine => turns::cosine(phase.wrapping_sub(1 << 30) as i32 as f32 * TURNS_PER_STEP),
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
}

impl Burst {
    fn new(record: Record, board: &Board) -> Option<Self> {
        let ramp_ticks = board.ticks(record.ramp_s);
        let (per_tick, offset) = if ramp_ticks > 0 { (1.0 / ramp_ticks as f32, 0.0) } else { (0.0, 1.0) };
        let period_ticks = NonZeroU32::new(board.ticks(record.period_s))?;
        Some(Self { period_ticks, on_ticks: board.ticks(record.on_s), per_tick, offset })
    }

    #[inline]
    fn envelope(&self, tick: u32) -> f32 {
        let begun = tick % self.period_ticks;
        if begun >= self.on_ticks {
            return 0.0;
        }
        let left = self.on_ticks - begun;
        let envelope = self.offset + self.per_tick * begun.min(left) as f32;
        if envelope < 1.0 { envelope } else { 1.0 }
    }
}
