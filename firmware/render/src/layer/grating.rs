//! Stripes.

use frixel_wire::scene::Wave;

use super::Around;
use crate::turns;

/// `middle + swing w(kx x + ky y + phase)`, with `w` between -1 and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grating {
    stripes: Stripes,
    cycles_per_m_x: f32,
    cycles_per_m_y: f32,
    phase_turns: f32,
    middle_n: f32,
    swing_n: f32,
}

/// A wave whose middle, of its high part or of its rise, lies at no phase.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stripes {
    Cosine,
    /// 1 up to half the duty on both sides.
    Square {
        half_duty_turns: f32,
    },
    Triangle,
    Saw,
}

impl Grating {
    pub(super) fn new(
        wave: Wave,
        [cycles_per_m_x, cycles_per_m_y]: [f32; 2],
        phase_turns: f32,
        [trough_n, crest_n]: [f32; 2],
    ) -> Self {
        // How much later the wire's wave is than the one here.
        let (stripes, later_turns) = match wave {
            Wave::Sine => (Stripes::Cosine, 0.25),
            Wave::Square { duty } => (Stripes::Square { half_duty_turns: 0.5 * duty }, 0.5 * duty),
            Wave::Triangle => (Stripes::Triangle, 0.5),
            Wave::Saw => (Stripes::Saw, 0.5),
        };
        Self {
            stripes,
            cycles_per_m_x,
            cycles_per_m_y,
            phase_turns: phase_turns - later_turns,
            middle_n: 0.5 * (crest_n + trough_n),
            swing_n: 0.5 * (crest_n - trough_n),
        }
    }

    /// As [`Self::at`], as a call.
    #[inline(never)]
    pub(super) fn electric_friction_n(&self, around: &Around) -> f32 {
        self.at(around.moment.place_m)
    }

    /// Electric friction at a place, in N.
    #[inline]
    pub(crate) fn at(&self, [x_m, y_m]: [f32; 2]) -> f32 {
        let turns = x_m * self.cycles_per_m_x + y_m * self.cycles_per_m_y + self.phase_turns;
        let height = match self.stripes {
            Stripes::Cosine => turns::cosine(turns),
            Stripes::Square { half_duty_turns } => {
                let turns = turns::centred(turns);
                if turns >= -half_duty_turns && turns < half_duty_turns { 1.0 } else { -1.0 }
            }
            Stripes::Triangle => 1.0 - 4.0 * turns::centred(turns).abs(),
            Stripes::Saw => 2.0 * turns::centred(turns),
        };
        self.middle_n + self.swing_n * height
    }
}
