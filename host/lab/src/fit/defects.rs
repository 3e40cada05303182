//! Strokes that cannot be used: all of them are found before any is named. A few odd ones are left out.

use core::fmt;

use frixel_scene::brief;

use super::error::FitError;

/// Largest number of defects that are described; further strokes are only named.
const DESCRIBED: usize = 6;
/// Largest fraction of the strokes that may be odd; they are left out.
const LEFT_OUT_PART: f64 = 0.25;

/// Why a stroke cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub enum StrokeDefect {
    /// It is too short.
    Short {
        /// Its length, in words.
        found: String,
    },
    /// Its load is not that of the others.
    Load {
        /// Its median load, in newtons.
        load_n: f64,
        /// How far it is off, in percent.
        percent: f64,
        /// Median load of the recording, in newtons.
        median_n: f64,
    },
    /// It is too slow or too fast.
    Speed {
        /// Its median speed, in mm/s.
        speed_mm_s: f64,
    },
    /// It did not slip.
    NoSlip {
        /// The evidence.
        found: String,
    },
}

/// A stroke that cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub struct DefectiveStroke {
    /// Name of the stroke.
    pub stroke: String,
    /// The defect.
    pub defect: StrokeDefect,
}

impl fmt::Display for StrokeDefect {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Short { found } => write!(formatter, "too short ({found}): at least 0.4 s and 5 rows are needed"),
            Self::Load { load_n, percent, median_n } => write!(
                formatter,
                "its load of {load_n:.3} N is {percent:.0} % off the median load of {median_n:.3} N, more than 15 %"
            ),
            Self::Speed { speed_mm_s } => write!(
                formatter,
                "its speed of {speed_mm_s:.3} mm/s is outside 20 to 100 mm/s, where the lag of friction was measured"
            ),
            Self::NoSlip { found } => write!(formatter, "did not slip: {found}"),
        }
    }
}

impl fmt::Display for DefectiveStroke {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { stroke, defect } = self;
        let verb = match defect {
            StrokeDefect::Short { .. } => " is",
            StrokeDefect::Load { .. } | StrokeDefect::Speed { .. } => ":",
            StrokeDefect::NoSlip { .. } => "",
        };
        write!(formatter, "stroke {}{verb} {defect}", brief(stroke))
    }
}

/// The strokes with defects, as far as they have been found.
#[derive(Debug, Default)]
pub(super) struct Defects {
    pub(super) defective: Vec<DefectiveStroke>,
    /// Number of all strokes.
    pub(super) strokes: usize,
}

impl Defects {
    pub(super) fn push(&mut self, stroke: &str, defect: StrokeDefect) {
        self.defective.push(DefectiveStroke { stroke: stroke.to_owned(), defect });
    }

    /// Fails if a person has to look at the recording: if more than a few strokes are odd, or if friction itself shows
    /// that a finger stuck. Leaving those out would select among results.
    pub(super) fn check(&self) -> Result<(), FitError> {
        let has_stuck = self.defective.iter().any(|defective| matches!(defective.defect, StrokeDefect::NoSlip { .. }));
        if has_stuck || self.defective.len() as f64 > LEFT_OUT_PART * self.strokes as f64 {
            self.refuse()
        } else {
            Ok(())
        }
    }

    /// Fails if there are defects.
    pub(super) fn refuse(&self) -> Result<(), FitError> {
        if self.defective.is_empty() { Ok(()) } else { Err(FitError::DefectiveStrokes(self.defective.clone())) }
    }
}

/// The defects in a sentence: the first of them in words, and all strokes for `--without`.
pub(super) fn sentence(defective: &[DefectiveStroke]) -> String {
    let described: Vec<String> = defective.iter().take(DESCRIBED).map(ToString::to_string).collect();
    let mut names: Vec<_> = defective.iter().map(|defective| brief(&defective.stroke)).collect();
    // Pieces of one stroke.
    names.dedup();
    let (it, more) = match defective.len() {
        0 | 1 => ("it", String::new()),
        count if count > DESCRIBED => ("them", format!("; and {} more", count - DESCRIBED)),
        _ => ("them", String::new()),
    };
    format!(
        "{}{more}; record {it} again with a finger that slides all the way, or leave {it} out with --without {}",
        described.join("; "),
        names.join(",")
    )
}
