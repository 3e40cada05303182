//! The output files of a play.

use std::path::{Path, PathBuf};

use frixel::output::{FeltCsv, Report, Subject, Trace, TracedLayer, write_felt_svg, write_scene_png};
use frixel::scene_file::SceneFiles;
use frixel_scene::recorder::FeltRow;
use frixel_scene::{Program, TouchedLayers};

use super::rigs::Target;
use super::with_log::joined;
use super::{CommandError, PlayArgs, overwrite};

/// The paths of the files of a play: `felt.csv`, `summary.json`, `felt.svg`, or `commanded.svg` where nobody knows what
/// is felt, and `scene.png`.
pub(super) fn output_paths(args: &PlayArgs, target: Target) -> [PathBuf; 4] {
    // Without a finger that is simulated beside the board, what was felt is unknown.
    let is_felt = target.is_virtual_time() || args.with_log.is_some();
    let svg = if is_felt { "felt.svg" } else { "commanded.svg" };
    ["felt.csv", "summary.json", svg, "scene.png"].map(|name| args.out.join(name))
}

/// Rejects a play whose files would overwrite a file of its scene.
pub(super) fn check_play_outputs(files: &SceneFiles, outputs: &[PathBuf]) -> Result<(), CommandError> {
    overwrite::check_outputs(files, outputs, "give another folder to --out")
}

/// Writes `felt.csv` while the scene plays, and the pictures at the end.
pub(super) struct Outputs {
    paths: [PathBuf; 4],
    title: String,
    csv: FeltCsv,
    trace: Trace,
    /// Whether finger or board is simulated.
    is_simulated: bool,
    touched: TouchedLayers,
    /// When the scene that plays replaced the one before, s.
    replaced_at_s: Option<f64>,
    /// The layers of the scene that are off, by index, from a time on, s.
    off: Vec<(f64, Vec<usize>)>,
    log: Option<PathBuf>,
    /// The rows so far, if they will be joined with a log, with the layer under the finger at each. They are not in the
    /// trace.
    rows: Vec<(FeltRow, Option<TracedLayer>)>,
}

impl Outputs {
    /// Creates `felt.csv`, and its folder if necessary.
    pub(super) fn create(
        args: &PlayArgs,
        target: Target,
        is_simulated: bool,
        program: &Program,
    ) -> Result<Self, CommandError> {
        std::fs::create_dir_all(&args.out).map_err(CommandError::writing(&args.out))?;
        let paths = output_paths(args, target);
        let csv = FeltCsv::create(&paths[0])?;
        let log = args.with_log.clone();
        let (title, touched) = (args.scene.display().to_string(), TouchedLayers::new(program));
        Ok(Self {
            paths,
            title,
            csv,
            trace: Trace::new(),
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
            let layer = self.touch(row);
            if self.log.is_some() {
                self.rows.push((*row, layer));
            } else {
                self.trace.push(row, layer);
            }
        }
        Ok(self.csv.flush()?)
    }

    /// Notes which layers the finger touches. Returns the topmost one.
    fn touch(&mut self, row: &FeltRow) -> Option<TracedLayer> {
        let (x_mm, y_mm) = row.x_mm.zip(row.y_mm)?;
        let layer = self.touched.add(1e-3 * x_mm, 1e-3 * y_mm)?;
        let last = self.off.iter().rfind(|(from_s, _)| *from_s < row.t_s);
        let is_off = last.is_some_and(|(_, off)| off.contains(&layer));
        Some(self.trace.layer(self.touched.title(layer), is_off))
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

    /// Joins the rows with a log, writes `felt.csv` anew with them, and draws them.
    fn write_joined(&mut self, log: &Path, start_s: f64) -> Result<(), CommandError> {
        let (rows, layers): (Vec<FeltRow>, Vec<Option<TracedLayer>>) =
            std::mem::take(&mut self.rows).into_iter().unzip();
        let joined = joined(log, &rows, start_s)?;
        self.csv = FeltCsv::create(&self.paths[0])?;
        for (row, layer) in joined.iter().zip(layers) {
            self.csv.write(row)?;
            self.trace.push(row, layer);
        }
        Ok(())
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
        if let Some(log) = self.log.take() {
            self.write_joined(&log, start_s)?;
        }
        self.csv.finish()?;
        let [_, summary, svg, png] = &self.paths;
        // The speed of the simulation is another one each time, and equal plays give equal files.
        let reproducible = Report { realtime_factor: None, ..report.clone() };
        std::fs::write(summary, reproducible.to_json() + "\n").map_err(CommandError::writing(summary))?;
        let subject = Subject { name: self.title, simulated: self.is_simulated, draft: report.draft };
        write_felt_svg(svg, &subject, &self.trace, &program.reach)?;
        write_scene_png(png, &subject, program, &self.trace)?;
        Ok(self.paths.into())
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::fmt::Write;
    use std::fs;

    use frixel_driver::Counters;
    use frixel_hil_sim::RigConfig;
    use frixel_scene::recorder::Recorder;
    use frixel_scene::{Scene, compile};

    use super::*;

    fn program(layer: &str) -> Program {
        let text =
            format!("version = 2\n[[layer]]\nname = \"{layer}\"\nkind = \"constant\"\nfriction_fraction = 0.5\n");
        let scene = Scene::parse(&text, "test.toml", &BTreeMap::new()).unwrap();
        let board = RigConfig::default().board;
        compile(&scene, &board.limits, board.tick_hz).unwrap()
    }

    #[test]
    fn each_row_that_is_joined_with_a_log_has_the_layer_that_played() {
        let folder = tempfile::tempdir().unwrap();
        let log = folder.path().join("log.csv");
        let row =
            |row: u32| FeltRow { t_s: 1e-3 * f64::from(row), x_mm: Some(60.0), y_mm: Some(40.0), ..FeltRow::default() };
        let rows: Vec<FeltRow> = (0..2_000).map(row).collect();
        let mut text = String::from("t_s,x_mm,y_mm,speed_mm_s,felt_n\n");
        for FeltRow { t_s, .. } in &rows {
            writeln!(text, "{t_s},60,40,50,0.25").unwrap();
        }
        fs::write(&log, text + "2,60,40,50,0.25\n").unwrap();
        let args =
            PlayArgs { out: folder.path().join("out"), with_log: Some(log), ..PlayArgs::ideal("a.toml".as_ref()) };

        let (first, second) = (program("first"), program("second"));
        let mut outputs = Outputs::create(&args, Target::Port, true, &first).unwrap();
        outputs.switch(0.0, Vec::new());
        outputs.write(&rows[..1_000]).unwrap();
        outputs.switch(1.0, vec![0]);
        outputs.write(&rows[1_000..1_500]).unwrap();
        outputs.replace(1.5, &second);
        outputs.write(&rows[1_500..]).unwrap();
        let link = Counters { frames_sent: 0, frames_rejected: 0, payload_bytes: 0, wire_bytes: 0 };
        let report = Report::new("board", &Recorder::idle().summary(), &second.reach, &link, None);
        let files = outputs.finish(&second, &report, 0.0).unwrap();
        let svg = fs::read_to_string(&files[2]).unwrap();
        let shown: Vec<&str> = svg.lines().filter(|line| ["first", "first off", "second"].contains(line)).collect();
        assert_eq!(shown, ["first", "first off", "second"]);
        let joined = fs::read_to_string(&files[0]).unwrap();
        assert!(joined.lines().count() == 2_001 && joined.contains(",0.25"), "the rows have what was felt");
    }
}
