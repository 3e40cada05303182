//! The path of the simulated finger.

use std::path::{Path, PathBuf};

use super::error::{at, of_generated_stroke, reading};
use crate::input;
use anyhow::{Result, anyhow, bail};
use clap::Args;
use frixel_hil_sim::{Point, Stroke};
use frixel_lab::simulate::{PlayOptions, STROKE_MAX_S, StrokeOptions, StrokeOptionsError};
use frixel_lab::stroke_file::StrokeFile;
use frixel_scene::Shown;

use super::argument::{RARE, above_zero_to, number};
use super::terminal::{note, note_interrupted, note_understood};

/// Time between two positions of a stroke that are checked, s.
const CHECK_PERIOD_S: f64 = 1e-3;
/// Largest number of positions of a stroke that are checked.
const CHECKS_MAX: f64 = 1e6;

/// Options that say where the simulated finger goes.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct StrokeArgs {
    /// Path of the finger: `human`, `human-rough` or a CSV file (docs/outputs.md). Default: a sweep.
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
    speed: Option<f64>,
    /// Passes along a straight stroke, back and forth. Default: 1.
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..=10_000),
        requires = "from",
        help_heading = RARE
    )]
    times: Option<u32>,
    /// Start and end a straight stroke at rest, as a hand does.
    #[arg(long, requires = "from", help_heading = RARE)]
    minimum_jerk: bool,
}

impl StrokeArgs {
    /// The options as a recording has them, without the path of a file.
    pub(super) fn options(&self) -> StrokeOptions {
        let place = |point: Point| [point.x_m, point.y_m];
        let name = |path: &PathBuf| {
            path.to_str().filter(|name| StrokeOptions::is_generated(name)).unwrap_or(PlayOptions::FILE).to_owned()
        };
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
        self.stroke.as_deref().filter(|path| !path.to_str().is_some_and(StrokeOptions::is_generated))
    }

    /// The stroke that the options describe; `None` without options. A person's stroke covers a screen of this width
    /// and height, in m, for `seconds` seconds.
    pub(super) fn stroke(&self, screen_m: [f64; 2], seconds: Option<f64>, seed: u64) -> Result<Option<Stroke>> {
        if let Some(path) = self.file() {
            return from_file(path).map(Some);
        }
        self.options().generated(screen_m, seconds, seed).map_err(|error| self.error(error))
    }

    /// The error in the words of the options.
    pub(super) fn error(&self, error: StrokeOptionsError) -> anyhow::Error {
        match error {
            StrokeOptionsError::InPlace => anyhow!("--from and --to are the same place: give two places that differ"),
            StrokeOptionsError::TooLong { seconds } => too_long(&self.name(), seconds),
            StrokeOptionsError::TooOften { .. } => anyhow!("--times: {error}"),
            StrokeOptionsError::Straight(source) => anyhow!("--from and --to: {source}; give two places that differ"),
            StrokeOptionsError::Human(source) => of_generated_stroke(source),
        }
    }

    /// What the stroke is called in messages.
    pub(super) fn name(&self) -> String {
        self.stroke.as_ref().map_or_else(|| "the stroke".to_owned(), |path| path.display().to_string())
    }
}

fn too_long(name: &str, seconds: f64) -> anyhow::Error {
    let seconds = Shown(seconds);
    anyhow!("{name} lasts {seconds} s, longer than a day (86400 s): give a shorter stroke; its times are in seconds")
}

pub(super) fn from_file(path: &Path) -> Result<Stroke> {
    let bytes = input::read(path, input::CSV_MAX_BYTES).map_err(reading(path))?;
    note_interrupted(path, &bytes);
    let file = StrokeFile::read(bytes.as_slice()).map_err(at(path.display()))?;
    let StrokeFile { stroke, ignored_columns, understood } = file;
    note_understood(path, understood.as_deref());
    let seconds = stroke.duration_s();
    if seconds > STROKE_MAX_S {
        return Err(too_long(&path.display().to_string(), seconds));
    }
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
    let speed_mm_per_s = number(text, above_zero_to(10_000.0), "a speed above 0, at most 10000 mm/s")?;
    Ok(1e-3 * speed_mm_per_s)
}

/// Fails if the stroke is never on the screen in its first `seconds`. Prints a note if it is partly off the screen.
pub(super) fn check_on_screen(
    name: &str,
    stroke: &Stroke,
    screen_width_m: f64,
    screen_height_m: f64,
    seconds: f64,
) -> Result<()> {
    let end_s = seconds.min(stroke.duration_s());
    let checks = (end_s / CHECK_PERIOD_S).ceil().clamp(1.0, CHECKS_MAX);
    let (mut on, mut off) = (0_u32, 0_u32);
    for finger in (0..=checks as u32).filter_map(|check| stroke.at(end_s * f64::from(check) / checks)) {
        if (0.0..=screen_width_m).contains(&finger.x_m) && (0.0..=screen_height_m).contains(&finger.y_m) {
            on += 1;
        } else {
            off += 1;
        }
    }
    // The sides are stored as f32; rounding to a micrometre restores the values of the scene file.
    let in_mm = |side_m: f64| (1e6 * side_m).round() / 1e3;
    let (width_mm, height_mm) = (in_mm(screen_width_m), in_mm(screen_height_m));
    if on == 0 && off > 0 {
        bail!(
            "{name} is nowhere on the screen, which is {width_mm} by {height_mm} mm: give places in mm from its top \
             left corner"
        );
    }
    if off > 0 {
        let percent = (100.0 * f64::from(off) / f64::from(on + off)).max(0.1);
        note(format_args!(
            "{name}: the finger is off the screen ({width_mm} by {height_mm} mm) for {percent:.1} % of the stroke"
        ));
    }
    Ok(())
}
