//! Stripes.

use frixel_wire::scene::Wave;

use super::Moment;
use crate::turns;

/// `middle + swing w(kx x + ky y + phase)`, with `w` a cosine, or 1 in the first half turn and -1 in the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grating {
    wave: Wave,
    cycles_per_m_x: f32,
    cycles_per_m_y: f32,
    phase_turns: f32,
    middle_n: f32,
    swing_n: f32,
}

impl Grating {
    pub(super) fn new(
        wave: Wave,
        [cycles_per_m_x, cycles_per_m_y]: [f32; 2],
        phase_turns: f32,
        [trough_n, crest_n]: [f32; 2],
    ) -> Self {
        // A sine is a cosine a quarter of a turn later.
        let later_turns = if wave == Wave::Sine { 0.25 } else { 0.0 };
        Self {
            wave,
            cycles_per_m_x,
            cycles_per_m_y,
            phase_turns: phase_turns - later_turns,
            middle_n: 0.5 * (crest_n + trough_n),
            swing_n: 0.5 * (crest_n - trough_n),
        }
    }

    #[inline]
    pub(super) fn electric_friction_n(&self, moment: &Moment) -> f32 {
        let turns = moment.x_m * self.cycles_per_m_x + moment.y_m * self.cycles_per_m_y + self.phase_turns;
        let height = match self.wave {
            Wave::Sine => turns::cosine(turns),
            Wave::Square => 1.0_f32.copysign(turns::centred(turns)),
        };
        self.middle_n + self.swing_n * height
    }
}
