//! Measurements, as sent by the board and read by the host.

use core::fmt;

use frixel_wire::message::TICK_TIME_CLASSES;

/// Prefixes of the lines: the first one, a measurement, a histogram, the last one, and the reason for an early end.
const BEGIN: &str = "frixel self-test, version ";
const MEASURED: &str = "measured";
const HISTOGRAM: &str = "histogram";
const END: &str = "end";
const STOPPED: &str = "STOP. ";
/// Placeholder for a measurement without a range.
const ANY: &str = "any";

/// A measured number. Its name ends with its unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measurement<'n> {
    /// Its name, without spaces.
    pub name: &'n str,
    /// The measured value.
    pub found: u32,
    /// The smallest and the largest passing value; `None` for information only.
    pub range: Option<(u32, u32)>,
}

impl Measurement<'_> {
    /// Whether it is within its range.
    pub fn passes(&self) -> bool {
        self.range.is_none_or(|(least, most)| (least..=most).contains(&self.found))
    }
}

/// Machine-readable content of a line of the script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScriptLine<'n> {
    /// The script begins: its version, and the kind of board.
    Begin(u32, &'n str),
    /// A measurement.
    Measured(Measurement<'n>),
    /// Ticks by eighths of the deadline, those beyond it last: name and counts.
    Histogram(&'n str, [u32; TICK_TIME_CLASSES + 1]),
    /// The script has ended.
    End {
        /// Number of measurements.
        measured: u32,
        /// Number of measurements out of range.
        failed: u32,
    },
    /// The script has ended early, for this reason.
    Stopped(&'n str),
}

impl fmt::Display for ScriptLine<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Begin(version, board) => write!(f, "{BEGIN}{version}, of {board}"),
            Self::Stopped(reason) => write!(f, "{STOPPED}{reason}"),
            Self::Measured(measurement) => {
                let Measurement { name, found, range } = measurement;
                let verdict = if measurement.passes() { "ok" } else { "FAILED" };
                match range {
                    None => write!(f, "{MEASURED} {name} {found} {ANY} {verdict}"),
                    Some((least, most)) => write!(f, "{MEASURED} {name} {found} {least}..{most} {verdict}"),
                }
            }
            Self::Histogram(name, counts) => {
                write!(f, "{HISTOGRAM} {name}")?;
                counts.iter().try_for_each(|count| write!(f, " {count}"))
            }
            Self::End { measured, failed } => write!(f, "{END} {measured} measured, {failed} failed"),
        }
    }
}

impl<'n> ScriptLine<'n> {
    /// Parses a line; `None` for text meant for the person.
    pub fn parse(line: &'n str) -> Option<Self> {
        if let Some((version, board)) = line.strip_prefix(BEGIN).and_then(|rest| rest.split_once(", of ")) {
            return Some(Self::Begin(version.parse().ok()?, board));
        }
        if let Some(reason) = line.strip_prefix(STOPPED) {
            return Some(Self::Stopped(reason));
        }
        let mut words = line.split_ascii_whitespace();
        match words.next()? {
            MEASURED => {
                let (name, found) = (words.next()?, words.next()?.parse().ok()?);
                let range = match words.next()? {
                    ANY => None,
                    range => {
                        let (least, most) = range.split_once("..")?;
                        Some((least.parse().ok()?, most.parse().ok()?))
                    }
                };
                Some(Self::Measured(Measurement { name, found, range }))
            }
            HISTOGRAM => {
                let name = words.next()?;
                let mut counts = [0; TICK_TIME_CLASSES + 1];
                for count in &mut counts {
                    *count = words.next()?.parse().ok()?;
                }
                Some(Self::Histogram(name, counts))
            }
            END => {
                let measured = words.next()?.parse().ok()?;
                let failed = words.nth(1)?.parse().ok()?;
                Some(Self::End { measured, failed })
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn only_values_in_range_pass() {
        let measured = |found| Measurement { name: "clocks", found, range: Some((24, 25)) };
        assert_eq!([23, 24, 25, 26].map(|found| measured(found).passes()), [false, true, true, false]);
        assert!(Measurement { range: None, ..measured(0) }.passes());
        assert_eq!(ScriptLine::Measured(measured(23)).to_string(), "measured clocks 23 24..25 FAILED");
    }

    #[test]
    fn text_for_the_person_is_not_a_measurement() {
        for line in ["", "1. Connect the wires.", "measured", "measured it", "measured a b 0..1 ok", "histogram x 1 2"]
        {
            assert_eq!(ScriptLine::parse(line), None, "{line}");
        }
    }

    proptest! {
        #[test]
        fn every_line_is_parsed_back(
            name in "[a-z_0-9]{1,40}",
            found: u32,
            range: Option<(u32, u32)>,
            counts: [u32; TICK_TIME_CLASSES + 1],
        ) {
            for said in [
                ScriptLine::Begin(found, &name),
                ScriptLine::Stopped(&name),
                ScriptLine::Measured(Measurement { name: &name, found, range }),
                ScriptLine::Histogram(&name, counts),
                ScriptLine::End { measured: found, failed: counts[0] },
            ] {
                let line = said.to_string();
                prop_assert_eq!(ScriptLine::parse(&line), Some(said));
            }
        }

        #[test]
        fn no_line_fails_the_reader(line in "(measured |histogram |end )?\\PC{0,80}") {
            let _ = ScriptLine::parse(&line);
        }
    }
}
