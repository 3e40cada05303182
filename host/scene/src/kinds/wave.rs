//! The fields of a periodic wave, and its reference.

use super::*;

const WAVE: FieldSpec = word(
    "wave",
    Means("`\"sine\"`"),
    "`\"sine\"`; `\"square\"`; `\"triangle\"`, which rises and falls; `\"saw\"`, which rises and drops",
);
const DUTY: FieldSpec = number(
    "duty",
    Range::new(range::DUTY.min, range::DUTY.max, ""),
    Number(0.5),
    "fraction of a square's wavelength that is high",
);

/// Reads `wave`, and `duty` if it is a square wave.
pub(super) fn read(fields: &mut Fields, log: &mut Log) -> Wave {
    let square = Wave::Square { duty: 0.5 };
    let waves = [("sine", Wave::Sine), ("square", square), ("triangle", Wave::Triangle), ("saw", Wave::Saw)];
    match fields.choice(log, &WAVE, &waves).unwrap_or_default() {
        Wave::Square { .. } => Wave::Square { duty: fields.number_or_default(log, &DUTY) as f32 },
        other => other,
    }
}

/// A wave between two frictions.
#[derive(Debug)]
pub(super) struct WaveField {
    pub(super) wave: Wave,
    /// Friction where the wave is 0, N.
    pub(super) trough_n: f64,
    /// Friction where the wave is 1, N.
    pub(super) crest_n: f64,
}

impl WaveField {
    pub(super) fn new(wave: Wave, trough_n: f32, crest_n: f32) -> Self {
        Self { wave, trough_n: trough_n.into(), crest_n: crest_n.into() }
    }

    /// Electric friction at a phase, in newtons.
    pub(super) fn at_turns(&self, turns: f64) -> f64 {
        // Truncate first: a cast is faster than a floor, and no screen has 2^53 stripes.
        let part = turns - (turns as i64) as f64;
        let turn = if part < 0.0 { part + 1.0 } else { part };
        let wave = match self.wave {
            Wave::Sine => 0.5 + 0.5 * libm::sin(TAU * turn),
            Wave::Square { duty } => f64::from(u8::from(turn < f64::from(duty))),
            Wave::Triangle => (2.0 * turn).min(2.0 - 2.0 * turn),
            Wave::Saw => turn,
        };
        self.trough_n + (self.crest_n - self.trough_n) * wave
    }

    /// The range of the friction while the phase covers an interval, in turns.
    pub(super) fn interval(&self, turns: Interval<f64>) -> Interval<f64> {
        let passes = |turn: f64| libm::floor(turns.high - turn) > libm::floor(turns.low - turn);
        let (trough_n, crest_n) = (self.trough_n, self.crest_n);
        let ends = [turns.low, turns.high].into_iter().map(|turns| self.at_turns(turns));
        let extremes = match self.wave {
            Wave::Sine => [(passes(0.25), crest_n), (passes(0.75), trough_n)],
            Wave::Square { duty } => [(passes(0.0), crest_n), (passes(f64::from(duty)), trough_n)],
            Wave::Triangle => [(passes(0.5), crest_n), (passes(0.0), trough_n)],
            Wave::Saw => [(passes(0.0), crest_n), (passes(0.0), trough_n)],
        };
        let passed = extremes.into_iter().filter(|(passed, _)| *passed).map(|(_, friction_n)| friction_n);
        Interval::of(ends.chain(passed))
    }
}
