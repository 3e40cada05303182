//! Parsers of numbers on the command line.

use std::fmt::Display;
use std::ops::{Bound, RangeBounds, RangeInclusive};
use std::str::FromStr;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use frixel_hil_sim::Board;
use frixel_lab::simulate::STROKE_MAX_S;
use frixel_scene::has_unit;

/// Help heading of rarely needed options.
pub(super) const RARE: &str = "Rare options";
/// Longest code of a participant, in characters.
const PARTICIPANT_MAX: usize = 32;

/// Parses a number in a range; the error states `expected`.
pub(super) fn number(text: &str, range: impl RangeBounds<f64>, expected: &str) -> Result<f64, String> {
    let without_unit = || if has_unit(text) { ", without a unit" } else { "" };
    let number = text.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| format!("expected {expected}{}", without_unit()))
}

/// Parses a quantity above zero.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    number(text, (Bound::Excluded(0.0), Bound::Excluded(f64::INFINITY)), "a number above 0")
}

/// Parses the duration of a play.
pub(super) fn seconds(text: &str) -> Result<f64, String> {
    number(text, above_zero_to(STROKE_MAX_S), "a number of seconds above 0, at most a day")
}

/// Parses the seed of random numbers.
pub(super) fn seed(text: &str) -> Result<u64, String> {
    whole(0..=u64::MAX)(text)
}

/// Returns a parser of whole numbers in a range.
pub(super) fn whole<N>(range: RangeInclusive<N>) -> impl Fn(&str) -> Result<N, String> + Clone
where
    N: FromStr + PartialOrd + Display + Clone,
{
    move |text| {
        let expected = || format!("expected a whole number from {} to {}", range.start(), range.end());
        text.parse().ok().filter(|number| range.contains(number)).ok_or_else(expected)
    }
}

/// Returns a parser of the names of real boards.
pub(super) fn board() -> impl TypedValueParser<Value = Board> {
    let of_name = |name: String| {
        let named = Board::NAMED.into_iter().find(|(other, _)| *other == name);
        named.map(|(_, board)| board).ok_or("unknown board")
    };
    PossibleValuesParser::new(Board::NAMED.map(|(name, _)| name)).try_map(of_name)
}

/// Parses a part of a whole, such as `2/8`.
pub(super) fn shard(text: &str) -> Result<(usize, usize), String> {
    let numbers = text.split_once('/').and_then(|(part, parts)| part.parse().ok().zip(parts.parse().ok()));
    numbers
        .filter(|(part, parts): &(usize, usize)| (1..=*parts).contains(part))
        .ok_or_else(|| "expected a part and the number of parts, for example 2/8".to_owned())
}

/// The numbers above zero, up to and including `max`.
pub(super) fn above_zero_to(max: f64) -> impl RangeBounds<f64> {
    (Bound::Excluded(0.0), Bound::Included(max))
}

/// Parses the code of a participant.
pub(super) fn participant(text: &str) -> Result<String, String> {
    let is_allowed = |character: char| character.is_ascii_alphanumeric() || "-_.".contains(character);
    if (1..=PARTICIPANT_MAX).contains(&text.len()) && text.chars().all(is_allowed) {
        return Ok(text.to_owned());
    }
    Err(format!("expected a code of 1 to {PARTICIPANT_MAX} letters, digits, `-`, `_` and `.`, for example P07"))
}
