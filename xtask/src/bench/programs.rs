//! Random scenes in the emulator: no tick may take more instructions than the loader reckoned.

use std::fmt;

use super::image::Image;
use super::{EMULATOR, M4F_CORE};
use crate::command::add_target;

/// Scenes of a pace that are played for every change: some ten seconds.
pub(crate) const FEW: u64 = 500;
/// Scenes of a pace that are played in `cargo xtask soak`: some two minutes.
pub(crate) const MANY: u64 = 6_000;

/// How often the touch source of a random scene reports, as the image calls it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pace {
    /// As chips and screens do.
    Usual,
    /// As fast as a host may.
    Fast,
}

impl Pace {
    /// Every pace.
    pub(crate) const ALL: [Self; 2] = [Self::Usual, Self::Fast];

    /// The pace of this name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|pace| pace.to_string() == name)
    }
}

impl fmt::Display for Pace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Usual => "usual",
            Self::Fast => "fast",
        })
    }
}

/// What was counted of one scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Played {
    seed: u64,
    /// Instructions of its longest tick, and those that the loader reckoned.
    counted: u64,
    reckoned: u64,
    /// Number of that tick, from 1.
    tick: u64,
}

/// Plays the scenes of `count` seeds from `first` on. Says which of them have a tick that is longer than reckoned.
pub(crate) fn check(pace: Pace, first: u64, count: u64) -> Result<(), String> {
    super::emulator()?;
    add_target(M4F_CORE.target)?;
    let image = Image::build(&M4F_CORE, false)?;
    let words = ["programs".to_owned(), pace.to_string(), first.to_string(), count.to_string()];
    let text = image.run(&words)?;
    let played: Vec<Played> = text.lines().map(parse).collect::<Result<_, _>>()?;
    let told = judge(&played, first, count)?;
    eprintln!("random scenes, touch source {pace}: {told}");
    Ok(())
}

/// A sentence on all scenes, or on those that took too long.
fn judge(played: &[Played], first: u64, count: u64) -> Result<String, String> {
    if !played.iter().map(|played| played.seed).eq(first..first + count) {
        return Err(format!(
            "{EMULATOR} played {} scenes, and was asked for {count} from seed {first} on",
            played.len()
        ));
    }
    let dearer: Vec<String> =
        played.iter().filter(|played| played.counted > played.reckoned).map(Played::told).collect();
    if !dearer.is_empty() {
        return Err(format!(
            "{} of {count} scenes take longer than reckoned:\n  {}",
            dearer.len(),
            dearer.join("\n  ")
        ));
    }
    let longest = played.iter().max_by_key(|played| played.counted).map(Played::told).unwrap_or_default();
    let nearest =
        played.iter().min_by_key(|played| played.reckoned - played.counted).map(Played::told).unwrap_or_default();
    Ok(format!("{count} played. The longest: {longest}. The nearest to what was reckoned: {nearest}"))
}

impl Played {
    fn told(&self) -> String {
        let Self { seed, counted, reckoned, tick } = self;
        format!("seed {seed}, {counted} of {reckoned} instructions at tick {tick}")
    }
}

fn parse(line: &str) -> Result<Played, String> {
    let numbers: Vec<u64> = line.split(' ').map_while(|word| word.parse().ok()).collect();
    match numbers.as_slice() {
        &[seed, counted, reckoned, tick] => Ok(Played { seed, counted, reckoned, tick }),
        _ => Err(format!("the benchmark wrote `{line}`: expected seed, instructions, those reckoned, and tick")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_that_takes_longer_or_was_not_played_is_noticed() {
        let played = |lines: &str| lines.lines().map(parse).collect::<Result<Vec<_>, _>>().unwrap();
        let told = judge(&played("7 300 400 12\n8 399 400 1"), 7, 2).unwrap();
        assert!(told.contains("seed 8, 399 of 400 instructions at tick 1"), "{told}");
        let error = judge(&played("7 300 400 12\n8 401 400 3"), 7, 2).unwrap_err();
        assert!(
            error.contains("1 of 2") && error.contains("seed 8, 401 of 400") && !error.contains("seed 7"),
            "{error}"
        );
        assert!(judge(&played("7 300 400 12"), 7, 2).is_err() && judge(&[], 7, 2).is_err());
        assert!(judge(&played("7 300 400 12\n9 300 400 1"), 7, 2).is_err());
        assert!(parse("the scene is refused").is_err());
    }
}
