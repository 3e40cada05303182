//! The output files of a play.

use std::path::PathBuf;

use frixel::output::{FeltCsv, Subject, Trace, write_felt_svg, write_scene_png};
use frixel_scene::Program;
use frixel_scene::recorder::FeltRow;

use super::rigs::Target;
use super::{CommandError, PlayArgs};

/// Writes `felt.csv` while the scene plays and, if the finger is simulated, the pictures at the end.
pub(super) struct Outputs {
    folder: PathBuf,
    title: String,
    csv: FeltCsv,
    csv_path: PathBuf,
    trace: Option<Trace>,
}

impl Outputs {
    /// Creates `felt.csv`, and its folder if necessary.
    pub(super) fn create(args: &PlayArgs, target: Target) -> Result<Self, CommandError> {
        let folder = args.out.clone();
        std::fs::create_dir_all(&folder).map_err(CommandError::writing(&folder))?;
        let csv_path = folder.join("felt.csv");
        let csv = FeltCsv::create(&csv_path)?;
        let trace = target.is_virtual_time().then(Trace::new);
        Ok(Self { folder, title: args.scene.display().to_string(), csv, csv_path, trace })
    }

    /// Writes rows and flushes them to the file.
    pub(super) fn write(&mut self, rows: &[FeltRow]) -> Result<(), CommandError> {
        for row in rows {
            self.csv.write(row)?;
            if let Some(trace) = &mut self.trace {
                trace.push(row);
            }
        }
        Ok(self.csv.flush()?)
    }

    /// Closes `felt.csv`, and draws `felt.svg` and `scene.png`. Returns the paths of the files.
    pub(super) fn finish(self, program: &Program) -> Result<Vec<PathBuf>, CommandError> {
        self.csv.finish()?;
        let mut files = vec![self.csv_path];
        if let Some(trace) = &self.trace {
            let (svg, png) = (self.folder.join("felt.svg"), self.folder.join("scene.png"));
            let subject = Subject { name: self.title, simulated: true };
            write_felt_svg(&svg, &subject, trace, &program.reach)?;
            write_scene_png(&png, &subject, program, trace)?;
            files.extend([svg, png]);
        }
        Ok(files)
    }
}
