//! Random scenes in the emulator: no tick may take more cycles than the loader estimates.
//!
//! The emulator counts instructions, not cycles. Therefore every scene is played and its instructions are counted. For
//! the scenes that come nearest to their estimate, a debugger then follows the longest tick to compute its cycles.

use std::cmp::Reverse;

use super::follow::Seen;
use super::image::Image;
use super::{EMULATOR, M4F_CORE};

/// Number of scenes per pace that are played for every change, which takes about ten seconds.
pub(crate) const FEW: u64 = 500;
/// Number of these scenes whose longest tick a debugger follows.
const FOLLOWED: usize = 12;

/// How often the touch source of a random scene reports: at the usual rate of touch chips and screens, and at the
/// highest that a host may send at. The image uses the same names.
pub(crate) const PACES: [&str; 2] = ["usual", "fast"];

/// The counts of one scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Played {
    seed: u64,
    /// Instructions of the scene's longest tick.
    instructions: u64,
    /// Cycles that the loader estimates for the scene, without flash wait states.
    estimated_cycles: u64,
    /// Number of the longest tick, from 1.
    tick: u32,
}

/// Plays the scenes of `count` seeds, starting at `first`. Fails if a scene has a tick that takes more than its
/// estimate.
pub(crate) fn check(pace: &str, first: u64, count: u64) -> Result<(), String> {
    let image = Image::build(&M4F_CORE)?;
    let mut played = play(&image, pace, first, count)?;
    played.sort_by_key(|played| Reverse(played.share()));
    let followed: Vec<(Played, Seen)> = played
        .iter()
        .take(FOLLOWED)
        .map(|played| play_and_follow(&image, pace, played.seed))
        .collect::<Result<_, _>>()?;
    eprintln!("random scenes, touch source {pace}: {count} played; {}", judge(&followed)?);
    Ok(())
}

/// Plays the scenes of `count` seeds, starting at `first`.
fn play(image: &Image, pace: &str, first: u64, count: u64) -> Result<Vec<Played>, String> {
    let played: Vec<Played> = image.run(&words(pace, first, count))?.lines().map(parse).collect::<Result<_, _>>()?;
    if played.iter().map(|played| played.seed).eq(first..first + count) {
        Ok(played)
    } else {
        Err(format!("{EMULATOR} played {} scenes of {count} from seed {first} on", played.len()))
    }
}

/// Plays one scene on a freshly started board, and follows its longest tick.
fn play_and_follow(image: &Image, pace: &str, seed: u64) -> Result<(Played, Seen), String> {
    let played = play(image, pace, seed, 1)?;
    let [played] = played.as_slice() else { return Err(format!("seed {seed} was not played")) };
    let seen = image.follow(&words(pace, seed, 1), &[played.tick])?;
    let [seen] = seen.as_slice() else { return Err(format!("seed {seed} was not followed")) };
    Ok((*played, *seen))
}

/// Command-line arguments that make the image play random scenes.
fn words(pace: &str, first: u64, count: u64) -> [String; 4] {
    ["programs".to_owned(), pace.to_owned(), first.to_string(), count.to_string()]
}

/// Describes the scene that came nearest to its estimate; fails if a scene exceeded it.
fn judge(followed: &[(Played, Seen)]) -> Result<String, String> {
    let describe = |(played, seen): &(Played, Seen)| {
        let Played { seed, estimated_cycles, tick, .. } = played;
        let Seen { cycles, instructions } = seen;
        format!("seed {seed}, {cycles} of {estimated_cycles} cycles ({instructions} instructions) at tick {tick}")
    };
    if let Some((played, seen)) = followed.iter().find(|(played, seen)| played.instructions != seen.instructions) {
        let Played { seed, instructions, .. } = played;
        return Err(format!(
            "seed {seed}: the timer counts {instructions} instructions, the debugger {}",
            seen.instructions
        ));
    }
    let longer: Vec<String> =
        followed.iter().filter(|(played, seen)| seen.cycles > played.estimated_cycles).map(describe).collect();
    if !longer.is_empty() {
        return Err(format!("scenes that take longer than estimated:\n  {}", longer.join("\n  ")));
    }
    let nearest = followed.iter().max_by_key(|(played, seen)| 1_000_000 * seen.cycles / played.estimated_cycles.max(1));
    nearest
        .map(describe)
        .map(|nearest| format!("the nearest to its estimate: {nearest}"))
        .ok_or("no scene was played".to_owned())
}

impl Played {
    /// Ratio of the executed instructions to the estimated cycles, in millionths.
    fn share(&self) -> u64 {
        1_000_000 * self.instructions / self.estimated_cycles.max(1)
    }
}

fn parse(line: &str) -> Result<Played, String> {
    let numbers: Vec<u64> = line.split(' ').map_while(|word| word.parse().ok()).collect();
    match numbers.as_slice() {
        &[seed, instructions, estimated_cycles, tick] => {
            Ok(Played { seed, instructions, estimated_cycles, tick: tick as u32 })
        }
        _ => Err(format!("the benchmark wrote `{line}`: expected seed, instructions, estimated cycles, and tick")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_that_takes_longer_than_estimated_is_noticed() {
        let followed = |line: &str, instructions, cycles| (parse(line).unwrap(), Seen { instructions, cycles });
        let sentence = judge(&[followed("7 300 400 12", 300, 380), followed("8 299 400 1", 299, 400)]).unwrap();
        assert!(sentence.contains("seed 8, 400 of 400 cycles (299 instructions) at tick 1"), "{sentence}");
        let error = judge(&[followed("7 300 400 12", 300, 380), followed("8 299 400 1", 299, 401)]).unwrap_err();
        assert!(error.contains("seed 8, 401 of 400") && !error.contains("seed 7"), "{error}");
        assert!(judge(&[followed("7 300 400 12", 301, 380)]).unwrap_err().contains("the debugger 301"));
        assert!(judge(&[]).is_err() && parse("the scene is refused").is_err());
    }
}
