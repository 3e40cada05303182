//! A finger that slides, rests, jumps and lifts, and touch sources of different report rates.

use frixel_layers::Header;
use frixel_wire::touch::Touch;

use crate::random::Random;

/// How far beyond the edges of the screen the finger moves, m.
const OFF_SCREEN_M: f32 = 5e-3;
/// Tick period of the boards that these scenes are for, s.
const TICK_S: f32 = 25e-6;

/// A finger and its touch source, tick by tick.
pub struct RandomFinger {
    random: Random,
    size_m: [f32; 2],
    place_m: [f32; 2],
    step_m: [f32; 2],
    /// Ticks until the next movement begins.
    left_ticks: u32,
    report_ticks: u32,
    until_report_ticks: u32,
    age_ticks: u32,
    lifted: bool,
}

/// How often a touch source reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// Like touch chips and screens: every 20 to 400 ticks, 0.5 to 10 ms.
    Usual,
    /// Every 1 to 6 ticks: faster than any chip, but possible for a host.
    Fast,
}

impl RandomFinger {
    /// A finger with random movements from `seed`, over the screen of `header`.
    pub fn new(seed: u64, header: &Header, pace: Pace) -> Self {
        let mut random = Random::new(!seed);
        let size_m = [header.screen_width_m, header.screen_height_m];
        let report_ticks = match pace {
            Pace::Usual => random.pick([400, 400, 80, 80, 20, 20]),
            Pace::Fast => random.pick([1, 2, 3, 4, 5, 6]),
        };
        let age_ticks = random.pick([0, 0, 40, 400]);
        Self {
            place_m: size_m.map(|size_m| random.between(0.0, size_m)),
            random,
            size_m,
            step_m: [0.0; 2],
            left_ticks: 0,
            report_ticks,
            until_report_ticks: 0,
            age_ticks,
            lifted: false,
        }
    }

    /// Advances one tick, and returns the touch source's report at that tick.
    pub fn tick(&mut self) -> Option<Touch> {
        if self.left_ticks == 0 {
            self.turn();
        }
        self.left_ticks -= 1;
        for ((place_m, step_m), size_m) in self.place_m.iter_mut().zip(&mut self.step_m).zip(self.size_m) {
            *place_m += *step_m;
            let beyond = *place_m < -OFF_SCREEN_M || *place_m > size_m + OFF_SCREEN_M;
            if beyond {
                *place_m = place_m.clamp(-OFF_SCREEN_M, size_m + OFF_SCREEN_M);
                *step_m = -*step_m;
            }
        }
        if self.until_report_ticks > 0 {
            self.until_report_ticks -= 1;
            return None;
        }
        self.until_report_ticks = self.report_ticks - 1;
        let [x_m, y_m] = self.place_m;
        Some(if self.lifted { Touch::Up } else { Touch::Down { x_m, y_m, age_ticks: self.age_ticks } })
    }

    /// Begins another movement.
    fn turn(&mut self) {
        let random = &mut self.random;
        let longest_ticks = random.pick([500, 500, 500, 2_800]);
        self.left_ticks = 100 + random.below(longest_ticks);
        let speed_m_per_s = match random.below(6) {
            0 => 0.0,
            1 => random.between(0.0, 2e-3),
            2 => random.between(2e-3, 2e-2),
            3 | 4 => random.between(0.02, 0.3),
            _ => random.between(0.3, 2.0),
        };
        self.step_m = [0.0; 2].map(|_: f32| random.between(-1.0, 1.0) * speed_m_per_s * TICK_S);
        if random.once_in(2) {
            self.place_m = self.size_m.map(|size_m| random.between(0.0, size_m));
        }
        self.lifted = random.once_in(8);
        if self.lifted {
            self.left_ticks = self.report_ticks + random.below(50);
        }
    }
}
