//! The options of a play, which a recording has so that it can be played again.

use frixel_hil_sim::{HUMAN_STROKE_MAX_S, Point, Stroke, StrokeError};
use frixel_scene::Shown;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::REPEAT_PAUSE_S;
use crate::GeneratedStroke;

/// Largest number of repetitions of a straight stroke.
pub const TIMES_MAX: u32 = 100_000;
/// Longest stroke: one day, in s.
pub const STROKE_MAX_S: f64 = 86_400.0;
/// Default duration of a generated stroke, s.
const GENERATED_S: f64 = 10.0;
/// Speed of a straight stroke unless another is given, m/s.
const STRAIGHT_M_PER_S: f64 = 0.1;
/// Largest speed of a straight stroke, m/s.
pub const STRAIGHT_MAX_M_PER_S: f64 = 10.0;
/// Time between two places of a minimum-jerk stroke that goes back and forth, s.
const SAMPLE_PERIOD_S: f64 = 1e-3;

/// The options of a play, without the paths of files: `frixel play --record` and the Python module write them, `frixel
/// replay` reads them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(clippy::struct_excessive_bools, reason = "each is an option of its own")]
pub struct PlayOptions {
    /// Duration, s; `None` for as long as the stroke.
    pub seconds: Option<f64>,
    /// Seed of the simulator's random numbers.
    pub seed: u64,
    /// A world without load changes, noise, pre-sliding, leakage, offsets and lost touch reports.
    pub ideal: bool,
    /// Skin through which no charge leaks.
    pub no_leakage: bool,
    /// Friction that follows the mean squared voltage of the carrier, not that of each tick.
    pub mean_square: bool,
    /// Seed of a simulated person, whose finger the board does not know.
    pub finger_seed: Option<u64>,
    /// Rows a second.
    pub rows_hz: u32,
    /// The finger in place of the scene's own: the name of a bundled one, or [`Self::FILE`].
    pub finger: Option<String>,
    /// The screen in place of the scene's own, in the same way.
    pub screen: Option<String>,
    /// The touch source, in the same way.
    pub touch: Option<String>,
    /// Path of the finger.
    pub stroke: StrokeOptions,
    /// Whether the scene was changed while it played, by [`Self::lines`].
    pub control: bool,
    /// Whether samples were streamed: those of the file [`Self::STREAM`].
    pub stream: bool,
    /// The lines that changed it, in their order. A `replace` has the number of the scene among the later ones of the
    /// recording, from 1, and is left out if that scene could not be compiled. `None` on a board at a port, where a
    /// line takes effect on arrival.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lines: Option<Vec<String>>,
    /// Duration of the streamed file, s; `None` for samples from standard input. Without [`Self::seconds`], the play
    /// has this duration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stream_s: Option<f64>,
    /// Whether the play ended before its time.
    pub interrupted: bool,
}

impl PlayOptions {
    /// Stands for a name whose file is stored in the recording.
    pub const FILE: &'static str = "file";
    /// Name of the stroke among the files of a recording.
    pub const STROKE: &'static str = "stroke";
    /// Name of the finger among them.
    pub const FINGER: &'static str = "finger";
    /// Name of the screen among them.
    pub const SCREEN: &'static str = "screen";
    /// Name of the touch source among them.
    pub const TOUCH: &'static str = "touch";
    /// Name of the samples that were streamed among them: two bytes each, little-endian.
    pub const STREAM: &'static str = "stream";
    /// Prefix of the names of files that the scene names.
    pub const OF_SCENE: &'static str = "scene/";
}

/// The options of a stroke. Without any, the stroke is the default one of the scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StrokeOptions {
    /// The name of a [`GeneratedStroke`], or [`PlayOptions::FILE`].
    pub name: Option<String>,
    /// Start of a straight stroke from the top left corner of the screen, m.
    pub from_m: Option<[f64; 2]>,
    /// Its end, m.
    pub to_m: Option<[f64; 2]>,
    /// Its mean speed, m/s.
    pub speed_m_per_s: Option<f64>,
    /// Number of passes of the finger along it, back and forth.
    pub times: Option<u32>,
    /// Whether it starts and ends at rest.
    pub minimum_jerk: bool,
    /// Seed of a person's stroke; `None` for that of the play.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub human_seed: Option<u64>,
    /// Duration of a person's stroke, s; `None` for that of the play.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub human_seconds: Option<f64>,
}

/// Why the options of a stroke are invalid.
#[derive(Debug, Error)]
pub enum StrokeOptionsError {
    /// Start and end are the same.
    #[error("the stroke starts and ends at the same place: give two places that differ")]
    InPlace,
    /// It takes too long.
    #[error("the stroke lasts {} s, longer than a day ({STROKE_MAX_S} s): give a shorter one", Shown(*.seconds))]
    TooLong {
        /// Its duration, s.
        seconds: f64,
    },
    /// The finger slides too slowly or too fast.
    #[error("the finger slides at {} mm/s: give a speed above 0, at most {} mm/s", Shown(1e3 * .m_per_s), 1e3 * STRAIGHT_MAX_M_PER_S)]
    Speed {
        /// Its speed, m/s.
        m_per_s: f64,
    },
    /// It is repeated too often.
    #[error("the stroke is repeated {times} times, more than {TIMES_MAX}: repeat it less often")]
    TooOften {
        /// Number of repetitions.
        times: u32,
    },
    /// A straight stroke cannot be made.
    #[error(transparent)]
    Straight(StrokeError),
    /// A stroke cannot be generated on this screen.
    #[error(transparent)]
    Generated(StrokeError),
}

impl StrokeOptions {
    /// Whether the stroke is that of a file.
    pub(crate) fn is_from_file(&self) -> bool {
        self.name.as_deref() == Some(PlayOptions::FILE)
    }

    /// The stroke that the options describe; `None` without options, and for that of a file. A generated stroke covers
    /// a screen of this width and height, in m, for the `seconds` and with the `seed` of the play, unless it has its
    /// own. In a play longer than
    /// [`HUMAN_STROKE_MAX_S`], a person's stroke repeats.
    pub fn generated(
        &self,
        screen_m: [f64; 2],
        seconds: Option<f64>,
        seed: u64,
    ) -> Result<Option<Stroke>, StrokeOptionsError> {
        if let Some(generated) = self.name.as_deref().and_then(GeneratedStroke::named) {
            let max_s = if generated.is_of_people() { HUMAN_STROKE_MAX_S } else { STROKE_MAX_S };
            let play_s = seconds.unwrap_or(GENERATED_S);
            let stroke_s = self.human_seconds.unwrap_or(play_s.min(max_s));
            let is_repeated = self.human_seconds.is_none() && play_s > max_s;
            let stroke = generated.stroke(screen_m, stroke_s, None, self.human_seed.unwrap_or(seed));
            let stroke = if is_repeated { stroke.and_then(|once| once.looped(REPEAT_PAUSE_S)) } else { stroke };
            return stroke.map(Some).map_err(StrokeOptionsError::Generated);
        }
        let point = |[x_m, y_m]: [f64; 2]| Point { x_m, y_m };
        match self.from_m.zip(self.to_m) {
            Some((from_m, to_m)) => self.straight(point(from_m), point(to_m)).map(Some),
            None => Ok(None),
        }
    }

    fn straight(&self, from: Point, to: Point) -> Result<Stroke, StrokeOptionsError> {
        if from == to {
            return Err(StrokeOptionsError::InPlace);
        }
        let failed = StrokeOptionsError::Straight;
        let (speed_m_per_s, times) = (self.speed_m_per_s.unwrap_or(STRAIGHT_M_PER_S), self.times.unwrap_or(1));
        if !(speed_m_per_s > 0.0 && speed_m_per_s <= STRAIGHT_MAX_M_PER_S) {
            return Err(StrokeOptionsError::Speed { m_per_s: speed_m_per_s });
        }
        if times > TIMES_MAX {
            return Err(StrokeOptionsError::TooOften { times });
        }
        let once = Stroke::constant_speed(from, to, speed_m_per_s).map_err(failed)?;
        let once_s = once.duration_s();
        let seconds = f64::from(times) * once_s;
        if seconds > STROKE_MAX_S {
            return Err(StrokeOptionsError::TooLong { seconds });
        }
        let once = if self.minimum_jerk { Stroke::minimum_jerk(from, to, once_s).map_err(failed)? } else { once };
        if times == 1 { Ok(once) } else { back_and_forth(&once, times, self.minimum_jerk).map_err(failed) }
    }
}

/// Goes along a stroke `times` times, back and forth.
fn back_and_forth(once: &Stroke, times: u32, is_curved_in_time: bool) -> Result<Stroke, StrokeError> {
    let once_s = once.duration_s();
    let steps = if is_curved_in_time { (once_s / SAMPLE_PERIOD_S).ceil().max(1.0) as u32 } else { 1 };
    let place = |number: u32| {
        let (round, step) = (number / steps, number % steps);
        let part = f64::from(step) / f64::from(steps);
        let finger = once.at(once_s * if round.is_multiple_of(2) { part } else { 1.0 - part });
        let t_s = once_s * (f64::from(round) + part);
        (t_s, finger.map(|finger| Point { x_m: finger.x_m, y_m: finger.y_m }))
    };
    Stroke::through(&(0..=times * steps).map(place).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCREEN_M: [f64; 2] = [0.12, 0.08];

    fn human(seed: Option<u64>, seconds: Option<f64>) -> StrokeOptions {
        let name = Some(GeneratedStroke::Human.name().to_owned());
        StrokeOptions { name, human_seed: seed, human_seconds: seconds, ..StrokeOptions::default() }
    }

    /// Places of the finger, by their bits.
    fn places(options: &StrokeOptions, seconds: Option<f64>, seed: u64) -> (u64, Vec<Option<u64>>) {
        let stroke = options.generated(SCREEN_M, seconds, seed).unwrap().unwrap();
        let place = |step: u32| stroke.at(0.01 * f64::from(step)).map(|finger| finger.x_m.to_bits());
        (stroke.duration_s().to_bits(), (0..100).map(place).collect())
    }

    #[test]
    fn a_person_has_the_seed_and_the_duration_of_the_play_unless_they_have_their_own() {
        let of_play = places(&human(None, None), Some(2.0), 5);
        assert_eq!(of_play, places(&human(Some(5), Some(2.0)), Some(9.0), 1));
        assert_ne!(of_play, places(&human(Some(6), None), Some(2.0), 5));
        assert_ne!(of_play, places(&human(None, Some(3.0)), Some(2.0), 5));
    }

    #[test]
    fn a_person_repeats_the_longest_stroke() {
        let stroke = human(None, None).generated(SCREEN_M, Some(900.0), 5).unwrap().unwrap();
        let once = human(None, None).generated(SCREEN_M, Some(HUMAN_STROKE_MAX_S), 5).unwrap().unwrap();
        let again_s = once.duration_s() + REPEAT_PAUSE_S;
        let x_m = |t_s: f64| stroke.at(t_s).map(|finger| finger.x_m);
        let times = (0..1000).map(|step| 0.01 * f64::from(step));
        let both: Vec<_> = times.filter_map(|t_s| x_m(t_s).zip(x_m(again_s + t_s))).collect();
        assert!(both.len() > 500, "{}", both.len());
        assert!(both.iter().all(|(first, again)| (first - again).abs() < 1e-6));
        let of_its_own = human(None, Some(900.0)).generated(SCREEN_M, None, 5);
        assert!(matches!(of_its_own, Err(StrokeOptionsError::Generated(_))), "its duration would be infinite");
    }

    #[test]
    fn a_stroke_in_place_too_fast_or_longer_than_a_day_is_refused() {
        let straight = |to_m, speed_m_per_s| StrokeOptions {
            from_m: Some([0.01, 0.02]),
            to_m: Some(to_m),
            speed_m_per_s: Some(speed_m_per_s),
            ..StrokeOptions::default()
        };
        let refused = |options: &StrokeOptions| options.generated(SCREEN_M, None, 1).unwrap_err();
        assert!(matches!(refused(&straight([0.01, 0.02], 0.1)), StrokeOptionsError::InPlace));
        assert!(matches!(refused(&straight([0.1, 0.02], 1e-7)), StrokeOptionsError::TooLong { .. }));
        for speed_m_per_s in [0.0, 10.1, f64::NAN] {
            assert!(matches!(refused(&straight([0.1, 0.02], speed_m_per_s)), StrokeOptionsError::Speed { .. }));
        }
        assert!(StrokeOptions::default().generated(SCREEN_M, None, 1).unwrap().is_none());
    }
}
