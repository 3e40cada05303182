//! The path of the simulated finger.

use std::io;
use std::path::{Path, PathBuf};

use super::error::{at, of_generated_stroke, reading, unreadable};
use crate::input;
use anyhow::{Result, anyhow};
use clap::Args;
use frixel_hil_sim::{Point, Stroke};
use frixel_lab::GeneratedStroke;
use frixel_lab::simulate::{
    PlayOptions, PlayOptionsError, STRAIGHT_MAX_M_PER_S, StrokeOptions, StrokeOptionsError, TIMES_MAX, off_screen_note,
};
use frixel_lab::stroke_file::StrokeFile;
use frixel_scene::Nearest;

use super::argument::{RARE, above_zero_to, number, whole};
use super::terminal::{note, note_interrupted, note_understood};

/// Options of the simulated finger's path.
#[derive(Clone, Debug, Args)]
pub(super) struct StrokeArgs {
    /// Finger's path: `human`, `human-rough`, `sweep` or a CSV file. Default: over every layer.
    #[arg(long, value_name = "NAME|FILE", conflicts_with = "from")]
    stroke: Option<PathBuf>,
    /// Start of a straight stroke, in mm from the screen's top left corner.
    #[arg(
        long,
        value_name = "X,Y",
        value_parser = place_mm,
        requires = "to",
        allow_hyphen_values = true,
        help_heading = RARE
    )]
    from: Option<Point>,
    /// End of a straight stroke, in mm.
    #[arg(
        long,
        value_name = "X,Y",
        value_parser = place_mm,
        requires = "from",
        allow_hyphen_values = true,
        help_heading = RARE
    )]
    to: Option<Point>,
    /// Mean speed of a straight stroke, in mm/s. Default: 100.
    #[arg(long, value_name = "MM_PER_S", value_parser = speed_m_per_s, requires = "from", help_heading = RARE)]
    #[arg(allow_negative_numbers = true)]
    speed: Option<f64>,
    /// Passes along a straight stroke, back and forth. Default: 1.
    #[arg(
        long,
        value_name = "N",
        value_parser = whole(1..=TIMES_MAX),
        allow_negative_numbers = true,
        requires = "from",
        help_heading = RARE
    )]
    times: Option<u32>,
    /// Start and end a straight stroke at rest, as a hand does.
    #[arg(long, requires = "from", help_heading = RARE)]
    minimum_jerk: bool,
}

impl StrokeArgs {
    /// The options as a recording stores them, without the path of a file.
    pub(super) fn options(&self) -> StrokeOptions {
        let place = |point: Point| [point.x_m, point.y_m];
        let name = |path: &PathBuf| generated(path).map_or(PlayOptions::FILE, GeneratedStroke::name).to_owned();
        StrokeOptions {
            name: self.stroke.as_ref().map(name),
            from_m: self.from.map(place),
            to_m: self.to.map(place),
            speed_m_per_s: self.speed,
            times: self.times,
            minimum_jerk: self.minimum_jerk,
            ..StrokeOptions::default()
        }
    }

    /// Whether any option is given.
    pub(super) fn is_given(&self) -> bool {
        self.stroke.is_some() || self.from.is_some()
    }

    /// The file of the stroke.
    pub(super) fn file(&self) -> Option<&Path> {
        self.stroke.as_deref().filter(|path| generated(path).is_none())
    }

    /// The stroke that the options describe; `None` without options. A person's stroke covers a screen of this width
    /// and height, in m, for `seconds` seconds.
    pub(super) fn stroke(&self, screen_m: [f64; 2], seconds: Option<f64>, seed: u64) -> Result<Option<Stroke>> {
        if let Some(path) = self.file() {
            return from_file(path).map(Some);
        }
        self.options().generated(screen_m, seconds, seed).map_err(of_stroke_options)
    }

    /// Name of the stroke in messages.
    pub(super) fn name(&self) -> String {
        self.stroke.as_ref().map_or_else(|| "the stroke".to_owned(), |path| path.display().to_string())
    }
}

/// The generated stroke that an option names; `None` for a file.
fn generated(option: &Path) -> Option<GeneratedStroke> {
    option.to_str().and_then(GeneratedStroke::named)
}

/// Converts an error of the options into a sentence that names them.
pub(super) fn of_stroke_options(error: StrokeOptionsError) -> anyhow::Error {
    match error {
        StrokeOptionsError::InPlace => anyhow!("--from and --to are the same place: give two places that differ"),
        StrokeOptionsError::TooLong { .. } => anyhow!("{error}"),
        StrokeOptionsError::Speed { .. } => anyhow!("--speed: {error}"),
        StrokeOptionsError::TooOften { .. } => anyhow!("--times: {error}"),
        StrokeOptionsError::Straight(source) => anyhow!("--from and --to: {source}; give two places that differ"),
        StrokeOptionsError::Generated(source) => of_generated_stroke(source),
    }
}

/// The error of a stroke that cannot be read. Without a file extension, it may be a mistyped name.
fn of_unreadable(path: &Path, error: io::Error) -> anyhow::Error {
    let name = path.to_str().filter(|_| path.extension().is_none() && error.kind() == io::ErrorKind::NotFound);
    match name.and_then(|name| Nearest::new(name, GeneratedStroke::names()).suggestion) {
        Some(name) => unreadable(path, format_args!("did you mean `{name}`?"))(error),
        None => reading(path)(error),
    }
}

pub(super) fn from_file(path: &Path) -> Result<Stroke> {
    let bytes = input::read(path, input::CSV_MAX_BYTES).map_err(|error| of_unreadable(path, error))?;
    note_interrupted(path, &bytes);
    let file = StrokeFile::read(bytes.as_slice()).map_err(at(path.display()))?;
    let StrokeFile { stroke, ignored_columns, understood } = file;
    note_understood(path, understood.as_deref());
    if !ignored_columns.is_empty() {
        let names = ignored_columns.join(", ");
        note(format_args!(
            "warning: {}: ignored column {names}: a stroke has t_s, x_mm, y_mm and force_n",
            path.display()
        ));
    }
    Ok(stroke)
}

/// Parses a place in mm, such as `12,34.5`.
fn place_mm(text: &str) -> Result<Point, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|mm| mm.abs() <= 10_000.0);
    match text.split_once(',').and_then(|(x, y)| number(x).zip(number(y))) {
        Some((x_mm, y_mm)) => Ok(Point { x_m: 1e-3 * x_mm, y_m: 1e-3 * y_mm }),
        None => Err("expected a place in mm from the top left corner of the screen, for example 12,34.5".into()),
    }
}

/// Parses a speed in mm/s.
fn speed_m_per_s(text: &str) -> Result<f64, String> {
    let speed_mm_per_s =
        number(text, above_zero_to(1e3 * STRAIGHT_MAX_M_PER_S), "a speed above 0, at most 10000 mm/s")?;
    Ok(1e-3 * speed_mm_per_s)
}

/// Prints a note if a stroke is partly off a screen of this width and height, in m, in its first `seconds`. Fails if
/// the stroke is never on the screen.
pub(super) fn note_off_screen(
    name: &str,
    stroke: &Stroke,
    screen_m: [f64; 2],
    seconds: f64,
) -> Result<(), PlayOptionsError> {
    if let Some(sentence) = off_screen_note(stroke, screen_m, seconds)? {
        note(format_args!("{name}: {sentence}"));
    }
    Ok(())
}
