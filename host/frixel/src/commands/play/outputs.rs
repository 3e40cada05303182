//! The output files of a play.

use std::path::PathBuf;

use frixel::output::{FeltCsv, Report, Subject, Trace, write_felt_svg, write_scene_png};
use frixel_scene::recorder::FeltRow;
use frixel_scene::{Program, TouchedLayers};

use super::rigs::Target;
use super::with_log::joined;
use super::{CommandError, PlayArgs};

/// Writes `felt.csv` while the scene plays, and the pictures at the end.
pub(super) struct Outputs {
    folder: PathBuf,
    title: String,
    csv: FeltCsv,
    csv_path: PathBuf,
    trace: Trace,
    target: Target,
    /// Whether finger or board is simulated.
    is_simulated: bool,
    touched: TouchedLayers,
    /// When the scene that plays replaced the one before, s.
    replaced_at_s: Option<f64>,
    /// The layers of the scene that are off, by index, from a time on, s.
    off: Vec<(f64, Vec<usize>)>,
    log: Option<PathBuf>,
    /// The rows so far, if they will be joined with a log.
    rows: Vec<FeltRow>,
}

impl Outputs {
    /// Creates `felt.csv`, and its folder if necessary.
    pub(super) fn create(
        args: &PlayArgs,
        target: Target,
        is_simulated: bool,
        program: &Program,
    ) -> Result<Self, CommandError> {
        let folder = args.out.clone();
        std::fs::create_dir_all(&folder).map_err(CommandError::writing(&folder))?;
        let csv_path = folder.join("felt.csv");
        let csv = FeltCsv::create(&csv_path)?;
        let log = args.with_log.clone();
        let (title, touched) = (args.scene.display().to_string(), TouchedLayers::new(program));
        Ok(Self {
            folder,
            title,
            csv,
            csv_path,
            trace: Trace::new(),
            target,
            is_simulated,
            touched,
            replaced_at_s: None,
            off: Vec::new(),
            log,
            rows: Vec::new(),
        })
    }

    /// Writes rows and flushes them to the file.
    pub(super) fn write(&mut self, rows: &[FeltRow]) -> Result<(), CommandError> {
        for row in rows {
            self.csv.write(row)?;
            if self.log.is_some() {
                self.rows.push(*row);
            }
            let place_mm = row.x_mm.zip(row.y_mm);
            let layer = place_mm.and_then(|(x_mm, y_mm)| self.touched.add(1e-3 * x_mm, 1e-3 * y_mm));
            let name = layer.map(|layer| self.name_at(layer, row.t_s));
            self.trace.push(row, name.as_deref());
        }
        Ok(self.csv.flush()?)
    }

    /// The title of a layer for the picture, which says when the layer is off.
    fn name_at(&self, layer: usize, t_s: f64) -> String {
        let last = self.off.iter().rfind(|(from_s, _)| *from_s < t_s);
        let suffix = if last.is_some_and(|(_, off)| off.contains(&layer)) { " off" } else { "" };
        format!("{}{suffix}", self.touched.title(layer))
    }

    /// Says which layers of the scene are off from a time on, by index.
    pub(super) fn switch(&mut self, t_s: f64, off: Vec<usize>) {
        if self.off.last().is_none_or(|(_, last)| *last != off) {
            self.off.push((t_s, off));
        }
    }

    /// Continues with another program from a time on, whose layers nobody has touched yet, and all of which are on.
    pub(super) fn replace(&mut self, t_s: f64, program: &Program) {
        self.touched = TouchedLayers::new(program);
        self.replaced_at_s = Some(t_s);
        self.off.clear();
    }

    /// When the scene of [`Self::untouched_layers`] replaced the one before, s.
    pub(super) fn replaced_at_s(&self) -> Option<f64> {
        self.replaced_at_s
    }

    /// Names of the layers of the last scene that the finger never touched.
    pub(super) fn untouched_layers(&self) -> Vec<String> {
        self.touched.untouched().map(|layer| self.touched.title(layer).to_owned()).collect()
    }

    /// Writes `felt.csv` and the trace anew with rows that are joined with a log.
    fn write_joined(&mut self, rows: &[FeltRow]) -> Result<(), CommandError> {
        self.csv = FeltCsv::create(&self.csv_path)?;
        self.trace = Trace::new();
        self.write(rows)
    }

    /// Closes `felt.csv`, writes `summary.json`, and draws `felt.svg`, or `commanded.svg` for a board at a port, and
    /// `scene.png`. Returns the paths of the files.
    ///
    /// `start_s` is the time from the power-on of the board to time zero of the rows.
    pub(super) fn finish(
        mut self,
        program: &Program,
        report: &Report,
        start_s: f64,
    ) -> Result<Vec<PathBuf>, CommandError> {
        let is_felt = self.target.is_virtual_time() || self.log.is_some();
        if let Some(log) = self.log.take() {
            self.write_joined(&joined(&log, &self.rows, start_s)?)?;
        }
        self.csv.finish()?;
        let summary = self.folder.join("summary.json");
        // The speed of the simulation is another one each time, and equal plays give equal files.
        let reproducible = Report { realtime_factor: None, ..report.clone() };
        std::fs::write(&summary, reproducible.to_json() + "\n").map_err(CommandError::writing(&summary))?;
        let mut files = vec![self.csv_path, summary];
        // Without a finger that is simulated beside the board, what was felt is unknown.
        let name = if is_felt { "felt.svg" } else { "commanded.svg" };
        let (svg, png) = (self.folder.join(name), self.folder.join("scene.png"));
        let subject = Subject { name: self.title, simulated: self.is_simulated, draft: report.draft };
        write_felt_svg(&svg, &subject, &self.trace, &program.reach)?;
        write_scene_png(&png, &subject, program, &self.trace)?;
        files.extend([svg, png]);
        Ok(files)
    }
}
