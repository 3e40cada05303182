//! Strokes that cannot be used: all of them are found before any is named.

use core::fmt;

use super::error::FitError;

/// Faults that are described; of the others only the strokes are named.
const DESCRIBED: usize = 6;

/// Why a stroke cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// It is too short.
    Short {
        /// How short it is.
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
        /// How it shows.
        found: String,
    },
}

/// A stroke that cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub struct FaultyStroke {
    /// Name of the stroke.
    pub stroke: String,
    /// What is wrong with it.
    pub fault: Fault,
}

impl fmt::Display for FaultyStroke {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let stroke = &self.stroke;
        match &self.fault {
            Fault::Short { found } => {
                write!(formatter, "stroke {stroke} is too short, {found}, where 0.4 s and 5 rows are the least")
            }
            Fault::Load { load_n, percent, median_n } => write!(
                formatter,
                "stroke {stroke}: its load of {load_n:.3} N is {percent:.0} % off the median load of {median_n:.3} N, \
                 more than 15 %"
            ),
            Fault::Speed { speed_mm_s } => write!(
                formatter,
                "stroke {stroke}: its speed of {speed_mm_s:.3} mm/s is outside 20 to 100 mm/s, where the lag of \
                 friction was measured"
            ),
            Fault::NoSlip { found } => write!(formatter, "stroke {stroke} did not slip: {found}"),
        }
    }
}

/// The strokes with faults, as far as they have been found.
#[derive(Debug, Default)]
pub(super) struct Faults(Vec<FaultyStroke>);

impl Faults {
    pub(super) fn push(&mut self, stroke: &str, fault: Fault) {
        self.0.push(FaultyStroke { stroke: stroke.to_owned(), fault });
    }

    /// Fails if there are faults.
    pub(super) fn check(&self) -> Result<(), FitError> {
        if self.0.is_empty() { Ok(()) } else { Err(FitError::FaultyStrokes(self.0.clone())) }
    }
}

/// The faults in a sentence: the first of them in words, and all strokes for `--without`.
pub(super) fn sentence(faulty: &[FaultyStroke]) -> String {
    let described: Vec<String> = faulty.iter().take(DESCRIBED).map(ToString::to_string).collect();
    let names: Vec<&str> = faulty.iter().map(|faulty| faulty.stroke.as_str()).collect();
    let (it, more) = match faulty.len() {
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
