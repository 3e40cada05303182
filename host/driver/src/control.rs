//! Control lines, which change a scene while it plays. The command, the page and the Python module share them.
//!
//! A line is one of
//!
//! - `layer NAME on`, `layer NAME off`, `layer NAME gain X`, or a combination: changes a layer;
//! - `trigger NAME [MS]`: switches on a layer that is off, and switches it off again after MS milliseconds; without
//!   them, after its pattern or its burst, or else after 100;
//! - `replace FILE`: plays another scene, or restarts the same one;
//! - `wait S`: carries out the following lines S seconds later;
//! - `quit`: ends the play.
//!
//! NAME is the name of a layer in the scene, or its number as in messages: `3`, or `3.2` for a copy. Names and paths
//! with spaces need quotation marks. Empty lines, and everything after `#`, are ignored.

use frixel_wire::message::GAIN_MAX;
use thiserror::Error;

/// Longest duration of a trigger, or of a wait in a control line: one hour, s.
pub const DURATION_MAX_S: f64 = 3_600.0;

/// A line, parsed.
#[derive(Clone, Debug, PartialEq)]
pub enum ControlLine {
    /// Changes a layer.
    Layer {
        /// Name or number of the layer: `3`, or `3.2` for a copy.
        layer: String,
        /// Whether to switch it on or off; `None` leaves it unchanged.
        on: Option<bool>,
        /// The gain; `None` leaves it unchanged.
        gain: Option<f32>,
    },
    /// Switches a layer on temporarily.
    Trigger {
        /// Name or number of the layer: `3`, or `3.2` for a copy.
        layer: String,
        /// Duration, s; `None` for the duration of its pattern or burst.
        duration_s: Option<f64>,
    },
    /// Plays another scene.
    Replace {
        /// Path of the scene file.
        file: String,
    },
    /// Delays the following lines.
    Wait {
        /// Delay, s.
        duration_s: f64,
    },
    /// Ends the play.
    Quit,
}

/// Why a control line is invalid.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ControlError {
    /// The first word is unknown.
    #[error("`{0}` is not a control word: write layer, trigger, replace, wait or quit")]
    UnknownWord(String),
    /// The line is incomplete.
    #[error("`{line}` ends too early: {expected}")]
    Incomplete {
        /// The line.
        line: String,
        /// The expected word.
        expected: &'static str,
    },
    /// A word is unexpected.
    #[error("`{found}` is unexpected here: {expected}")]
    Unexpected {
        /// The word.
        found: String,
        /// The expected word.
        expected: &'static str,
    },
    /// A quotation mark is not closed.
    #[error("the quotation mark of `{0}` is not closed: add one after the name")]
    OpenQuote(String),
}

const LAYER: &str = "give the name of a layer, or its number: 3, or 3.2 for a copy";
const CHANGE: &str = "write on, off, or gain and a number from -100 to 100";
const FILE: &str = "give the path of a scene file";
const MILLISECONDS: &str = "give a number of milliseconds above 0, at most an hour";
const SECONDS: &str = "give a number of seconds above 0, at most an hour";
const NOTHING: &str = "end the line before it";

impl ControlLine {
    /// Parses a line; `None` for an empty one.
    ///
    /// ```
    /// use frixel_driver::ControlLine;
    ///
    /// let line = ControlLine::parse("layer \"OK button\" gain 0.5  # softer")?;
    /// let softer = ControlLine::Layer { layer: "OK button".into(), on: None, gain: Some(0.5) };
    /// assert_eq!(line, Some(softer));
    /// # Ok::<(), frixel_driver::ControlError>(())
    /// ```
    pub fn parse(line: &str) -> Result<Option<Self>, ControlError> {
        let mut words = Words { line: line.trim(), words: words(line)?.into_iter() };
        let Some(first) = words.words.next() else { return Ok(None) };
        let parsed = match first.as_str() {
            "layer" => Self::layer(&mut words)?,
            "trigger" => {
                let layer = words.next(LAYER)?;
                let number = words.words.next();
                let duration_s = number.map(|found| duration_s(&found, 1e-3, MILLISECONDS)).transpose()?;
                Self::Trigger { layer, duration_s }
            }
            "replace" => Self::Replace { file: words.next(FILE)? },
            "wait" => Self::Wait { duration_s: duration_s(&words.next(SECONDS)?, 1.0, SECONDS)? },
            "quit" => Self::Quit,
            _ => return Err(ControlError::UnknownWord(first)),
        };
        match words.words.next() {
            Some(found) => Err(ControlError::Unexpected { found, expected: NOTHING }),
            None => Ok(Some(parsed)),
        }
    }

    fn layer(words: &mut Words) -> Result<Self, ControlError> {
        let layer = words.next(LAYER)?;
        let (mut on, mut gain) = (None, None);
        let mut word = words.next(CHANGE)?;
        loop {
            match word.as_str() {
                "on" => on = Some(true),
                "off" => on = Some(false),
                "gain" => {
                    let found = words.next(CHANGE)?;
                    let number = found.parse().ok().filter(|gain: &f32| f64::from(gain.abs()) <= GAIN_MAX);
                    gain = Some(number.ok_or(ControlError::Unexpected { found, expected: CHANGE })?);
                }
                _ => return Err(ControlError::Unexpected { found: word, expected: CHANGE }),
            }
            match words.words.next() {
                Some(next) => word = next,
                None => return Ok(Self::Layer { layer, on, gain }),
            }
        }
    }
}

/// The remaining words of a line.
struct Words<'l> {
    line: &'l str,
    words: std::vec::IntoIter<String>,
}

impl Words<'_> {
    fn next(&mut self, expected: &'static str) -> Result<String, ControlError> {
        self.words.next().ok_or_else(|| ControlError::Incomplete { line: self.line.to_owned(), expected })
    }
}

/// Splits a line at spaces outside quotation marks, up to a `#`.
fn words(line: &str) -> Result<Vec<String>, ControlError> {
    let mut words = Vec::new();
    let mut rest = line.trim_start();
    while !rest.is_empty() && !rest.starts_with('#') {
        let (word, behind) = match rest.strip_prefix('"') {
            Some(quoted) => quoted.split_once('"').ok_or_else(|| ControlError::OpenQuote(rest.to_owned()))?,
            None => rest.split_at(rest.find(char::is_whitespace).unwrap_or(rest.len())),
        };
        words.push(word.to_owned());
        rest = behind.trim_start();
    }
    Ok(words)
}

fn duration_s(found: &str, unit_s: f64, expected: &'static str) -> Result<f64, ControlError> {
    let seconds = found.parse::<f64>().ok().map(|number| unit_s * number);
    let seconds = seconds.filter(|seconds| *seconds > 0.0 && *seconds <= DURATION_MAX_S);
    seconds.ok_or_else(|| ControlError::Unexpected { found: found.to_owned(), expected })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_is_understood() {
        let layer = |on, gain| Some(ControlLine::Layer { layer: "OK".into(), on, gain });
        let trigger = |duration_s| Some(ControlLine::Trigger { layer: "OK".into(), duration_s });
        for (line, expected) in [
            ("layer OK off", layer(Some(false), None)),
            ("  layer \"OK\" on gain -0.5", layer(Some(true), Some(-0.5))),
            ("layer OK gain 2 # louder", layer(None, Some(2.0))),
            ("trigger OK", trigger(None)),
            ("trigger OK 250", trigger(Some(0.25))),
            ("replace \"my scene.toml\"", Some(ControlLine::Replace { file: "my scene.toml".into() })),
            ("wait 1.5", Some(ControlLine::Wait { duration_s: 1.5 })),
            ("quit", Some(ControlLine::Quit)),
            ("", None),
            ("# a comment", None),
        ] {
            assert_eq!(ControlLine::parse(line), Ok(expected), "{line}");
        }
    }
}
