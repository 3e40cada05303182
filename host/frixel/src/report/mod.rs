//! `frixel report`: four questions on the first screen of a page, each with a small table and its plot. What is the
//! error against the run time? How stable is the model in stiff and extreme cases? Which of the board's resources does
//! a scene not use? Is mean friction right under each carrier?
//!
//! [`write()`] creates a folder with a self-contained `index.html` and the numbers behind each plot as CSV.

mod carrier;
mod counts;
mod error;
mod finger;
mod methods;
mod page;
mod run_time;
mod scene;
mod stability;
mod timing;

use std::path::{Path, PathBuf};

pub(crate) use error::ReportError;

use frixel_scene::{CompileError, Program, Scene};

use counts::Counts;
use finger::DrawnFinger;
use frixel_files::{Inputs, OutputFolder};
use page::Page;

/// The scene that a report is about.
#[derive(Debug)]
pub(crate) struct Subject<'s> {
    /// Name of the scene, for display.
    pub name: &'s str,
    /// The scene.
    pub scene: &'s Scene,
    /// The scene, compiled as a draft for the simulated board.
    pub program: Result<Program, CompileError>,
}

/// Writes the report into a folder, creating it if necessary, and returns the paths of the files.
///
/// `bench` is a file of counts written by `cargo xtask bench`, in place of this version's counts. `inputs` are the
/// files that were read. Run times are measured; everything else is equal in every run.
pub(crate) fn write(
    folder: &Path,
    subject: &Subject,
    bench: Option<&Path>,
    inputs: &Inputs,
) -> Result<Vec<PathBuf>, ReportError> {
    let counts = bench.map_or_else(Counts::committed, Counts::read)?;
    let _locked = OutputFolder::open(folder)?;
    let drawn = DrawnFinger::of(subject);
    let sections = [
        run_time::section(&drawn, &counts)?,
        stability::section()?,
        scene::section(subject, &counts),
        carrier::section()?,
    ];
    Page { finger: &drawn.words, counts: &counts.origin(), sections: &sections }.write(folder, inputs)
}
