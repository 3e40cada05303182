//! The output files of a play.

use std::path::PathBuf;

use crate::output::{FeltCsv, Report, Subject, Trace, TracedLayer, draw_felt_svg, draw_scene_png};
use crate::scene_file::SceneFiles;
use anyhow::{Result, bail};
use frixel_felt::recorder::{FeltRow, Marker};
use frixel_files::{FileWriter, Inputs, OutputFile, OutputFolder, commit_all, is_of_person};
use frixel_lab::recording::{Metadata, PlaySource};
use frixel_scene::{LayerTitle, Program, TouchedLayers};

use super::super::error::cut_off;
use super::PlayArgs;
use super::Target;
use super::record_file::{self, RecordFile};
use super::with_log::{LayeredRow, LogJoin};

/// The option that names the folder.
const OPTION: &str = "--out";
/// Advice on how to keep the rows of an interrupted play on a board.
const CUT_OFF: &str = "rename it to keep it";

/// The files of a play.
#[derive(Clone)]
pub(super) struct PlayFiles {
    felt: OutputFile,
    summary: OutputFile,
    /// `felt.svg`, or `commanded.svg` where felt friction is unknown.
    svg: OutputFile,
    /// The other of the two, which an earlier play may have left.
    other_svg: OutputFile,
    png: OutputFile,
    /// The file of `--record`, and what its play is made from.
    record: Option<(OutputFile, PlaySource)>,
}

impl PlayFiles {
    /// Rejects a play whose files would overwrite an input, or an earlier play on a real board.
    pub(super) fn new(args: &PlayArgs, target: Target, scene: &SceneFiles) -> Result<Self> {
        // A real board does not report felt friction.
        let is_felt = target.is_virtual_time() || args.with_log.is_some();
        let (svg, other_svg) = if is_felt { ("felt.svg", "commanded.svg") } else { ("commanded.svg", "felt.svg") };
        let others = [args.stroke.file(), args.stream.file(), args.with_log.as_deref(), args.touch.file()];
        let inputs = Inputs::new(scene.paths().chain(others.into_iter().flatten()));
        Self::check_earlier(args)?;
        let file = |name: &str| OutputFile::replacing(&args.out.join(name), OPTION, &inputs, args.overwrite);
        let files = Self {
            felt: file("felt.csv")?,
            summary: file("summary.json")?,
            svg: file(svg)?,
            other_svg: file(other_svg)?,
            png: file("scene.png")?,
            record: None,
        };
        let record = record_file::output(args, &inputs)?;
        if let Some(record) = &record {
            for other in [&files.felt, &files.summary, &files.svg, &files.other_svg, &files.png] {
                record.check_apart_from(other)?;
            }
        }
        let record = record.map(|record| anyhow::Ok((record, record_file::source(args, scene)?))).transpose()?;
        Ok(Self { record, ..files })
    }

    /// Rejects a play that would replace an earlier play on a real board.
    fn check_earlier(args: &PlayArgs) -> Result<()> {
        let is_kept = |name| is_of_person(&args.out.join(name));
        if !args.overwrite && (is_kept("felt.csv") || is_kept("summary.json")) {
            bail!(
                "{} holds a play on a real board, which is not overwritten: give another folder to {OPTION}, or add \
                 --overwrite",
                args.out.display()
            );
        }
        Ok(())
    }

    /// Rejects output files that would overwrite a file of another scene.
    pub(super) fn check(&self, scene: &SceneFiles) -> Result<()> {
        let inputs = Inputs::new(scene.paths());
        for file in [&self.felt, &self.summary, &self.svg, &self.other_svg, &self.png] {
            file.check_inputs(&inputs)?;
        }
        Ok(self.record.iter().try_for_each(|(record, _)| record.check_inputs(&inputs))?)
    }

    /// Inputs of the play, for `--record`.
    pub(super) fn source(&self) -> Option<&PlaySource> {
        self.record.as_ref().map(|(_, source)| source)
    }

    /// Starts to write `felt.csv`: as a recording on a real board, since a person's movements cannot be repeated.
    fn start(&self, is_simulated: bool, args: &PlayArgs) -> Result<FeltCsv> {
        if is_simulated {
            return FeltCsv::new(self.felt.create()?);
        }
        FeltCsv::of_person(self.felt.begin_recording(CUT_OFF)?, args.participant.as_deref())
    }

    fn paths(&self) -> Vec<PathBuf> {
        let record = self.record.as_ref().map(|(record, _)| record);
        let files = [&self.felt, &self.summary, &self.svg, &self.png].into_iter().chain(record);
        files.map(|file| file.path().to_owned()).collect()
    }
}

/// Writes `felt.csv` while the scene plays, and the pictures at the end.
pub(super) struct Outputs {
    /// Locked until the files have their names.
    folder: Option<OutputFolder>,
    files: PlayFiles,
    title: String,
    csv: FeltCsv,
    record: Option<RecordFile>,
    trace: Trace,
    /// Whether finger or board is simulated.
    is_simulated: bool,
    touched: TouchedLayers,
    /// Time at which the current scene replaced the previous one, s.
    replaced_at_s: Option<f64>,
    /// Indices of the scene's layers that are off, each list from a time on, s.
    off: Vec<(f64, Vec<usize>)>,
    /// The log that the rows are joined with.
    log: Option<LogJoin>,
}

impl Outputs {
    /// Starts to write `felt.csv`, and with `metadata` the file of `--record`. Creates the folder if necessary.
    pub(super) fn create(
        args: &PlayArgs,
        files: PlayFiles,
        is_simulated: bool,
        program: &Program,
        metadata: Option<Metadata>,
    ) -> Result<Self> {
        let folder = OutputFolder::open(&args.out)?;
        // The play that held the lock until now may have been on a real board.
        PlayFiles::check_earlier(args)?;
        let csv = files.start(is_simulated, args)?;
        let create =
            |((output, _), metadata): (&(OutputFile, PlaySource), Metadata)| RecordFile::start(output, metadata);
        let record = files.record.as_ref().zip(metadata).map(create).transpose()?;
        let log = args.with_log.as_deref().map(LogJoin::new);
        let (title, touched) = (args.scene.display().to_string(), TouchedLayers::new(program));
        Ok(Self {
            folder: Some(folder),
            files,
            title,
            csv,
            record,
            trace: Trace::new(),
            is_simulated,
            touched,
            replaced_at_s: None,
            off: Vec::new(),
            log,
        })
    }

    /// Writes rows and flushes them to the file; with a log, the rows that it has reached. `markers` are all markers so
    /// far, and `start_s` is the time from the power-on of the board to time zero of the rows.
    pub(super) fn write(&mut self, rows: &[FeltRow], markers: &[Marker], start_s: f64) -> Result<()> {
        let rows = rows.iter().map(|row| (*row, self.touch(row))).collect();
        let rows = match &mut self.log {
            Some(log) => log.add(rows, start_s),
            None => rows,
        };
        self.put(&rows, markers)
    }

    fn put(&mut self, rows: &[LayeredRow], markers: &[Marker]) -> Result<()> {
        if let Some(record) = &mut self.record {
            let rows: Vec<FeltRow> = rows.iter().map(|(row, _)| *row).collect();
            record.write(&rows, markers)?;
        }
        for (row, layer) in rows {
            self.csv.write(row)?;
            self.trace.push(row, *layer);
        }
        self.csv.flush()
    }

    /// Notes the layers under the finger, and returns the topmost.
    fn touch(&mut self, row: &FeltRow) -> Option<TracedLayer> {
        let (x_mm, y_mm) = row.x_mm.zip(row.y_mm)?;
        let off = self.off.iter().rfind(|(from_s, _)| *from_s < row.t_s).map(|(_, off)| &off[..]);
        if let Some(off) = off {
            self.touched.switch(off);
        }
        let layer = self.touched.add(1e-3 * x_mm, 1e-3 * y_mm)?;
        let is_off = off.is_some_and(|off| off.contains(&layer));
        Some(self.trace.layer(self.touched.title(layer)?, is_off))
    }

    /// Sets the indices of the layers that are off from a time on.
    pub(super) fn switch(&mut self, t_s: f64, off: Vec<usize>) {
        if self.off.last().is_none_or(|(_, last)| *last != off) {
            self.off.push((t_s, off));
        }
    }

    /// Continues with another program from a time on. None of its layers counts as touched.
    pub(super) fn replace(&mut self, t_s: f64, program: &Program) {
        self.touched = TouchedLayers::new(program);
        self.replaced_at_s = Some(t_s);
        self.off.clear();
    }

    /// Adds a scene that was put on the board at a time, and perhaps refused, to the file of `--record`.
    pub(super) fn keep_scene(&mut self, t_s: f64, scene: &SceneFiles, is_refused: bool) {
        if let Some(record) = &mut self.record {
            record.add_scene(t_s, scene, is_refused);
        }
    }

    /// Adds the lines of `--control` to the file of `--record`.
    pub(super) fn keep_lines(&mut self, lines: &[String]) {
        if let Some(record) = &mut self.record {
            record.set_lines(lines);
        }
    }

    /// Adds streamed samples to the file of `--record`.
    pub(super) fn keep_samples(&mut self, samples: &[u16]) {
        if let Some(record) = &mut self.record {
            record.add_samples(samples);
        }
    }

    /// Whether finger or board is simulated.
    pub(super) fn is_simulated(&self) -> bool {
        self.is_simulated
    }

    /// Time at which the current scene replaced the previous one, s; `None` for the first scene.
    pub(super) fn replaced_at_s(&self) -> Option<f64> {
        self.replaced_at_s
    }

    /// The layers of the last scene that the finger never touched.
    pub(super) fn untouched_layers(&self) -> Vec<LayerTitle> {
        self.touched.untouched().filter_map(|layer| self.touched.title(layer)).cloned().collect()
    }

    /// Completes `felt.csv` and the file of `--record`, draws `scene.png` and `felt.svg` (`commanded.svg` for a board
    /// at a port), and writes `summary.json`, which has their hashes. Returns the paths of the files. If a file cannot
    /// be written, the files of an earlier play stay unchanged, and the rows of a real board are in `felt.csv.partial`.
    pub(super) fn finish(
        mut self,
        program: &Program,
        report: &Report,
        (markers, interrupted): (&[Marker], bool),
    ) -> Result<Vec<PathBuf>> {
        let (rows, joined) = self.log.take().map_or((Vec::new(), Ok(())), LogJoin::finish);
        let joined = self.put(&rows, markers).and(joined);
        let (files, is_simulated, _locked) = (self.files.clone(), self.is_simulated, self.folder.take());
        let written = self.write_all(program, report, (markers, interrupted));
        let committed = written.and_then(|written| Ok(commit_all(written, std::slice::from_ref(&files.other_svg))?));
        match committed.and(joined) {
            Ok(()) => Ok(files.paths()),
            Err(error) if is_simulated => Err(error),
            Err(error) => Err(cut_off(&files.felt, CUT_OFF, error)),
        }
    }

    /// Writes all files under temporary names, the summary last.
    fn write_all(self, program: &Program, report: &Report, marked: (&[Marker], bool)) -> Result<Vec<FileWriter>> {
        let subject = Subject { name: self.title, simulated: self.is_simulated, draft: report.draft };
        let svg = draw_felt_svg(&subject, &self.trace, &program.reach)?;
        let png = draw_scene_png(&subject, program, &self.trace)?;
        let PlayFiles { summary, svg: svg_file, png: png_file, .. } = &self.files;
        let record = self.record.map(|record| record.finish(marked.0, marked.1)).transpose()?;
        let others = [self.csv.into_writer(), svg_file.filled(svg.as_bytes())?, png_file.filled(&png)?];
        let mut written: Vec<FileWriter> = others.into_iter().chain(record).collect();
        let named = |file: &FileWriter| {
            let name = file.path().file_name().unwrap_or_default().to_string_lossy().into_owned();
            (name, file.sha256())
        };
        let files = written.iter().map(named).collect();
        // The speed of the simulation varies, and equal plays give equal files.
        let reproducible = Report { realtime_factor: None, files, ..report.clone() };
        written.push(summary.filled((reproducible.to_json() + "\n").as_bytes())?);
        Ok(written)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::fmt::Write;
    use std::fs;

    use frixel_driver::Counters;
    use frixel_felt::recorder::Recorder;
    use frixel_hil_sim::RigConfig;
    use frixel_scene::{Scene, compile};

    use super::*;

    fn program(layer: &str) -> Program {
        let text =
            format!("version = 1\n[[layer]]\nname = \"{layer}\"\nkind = \"constant\"\nfriction_fraction = 0.5\n");
        let scene = Scene::parse(&text, "test.toml", &BTreeMap::new()).unwrap();
        let board = RigConfig::default().board;
        compile(&scene, &board.limits, board.tick_hz).unwrap()
    }

    fn report(program: &Program) -> Report {
        let link = Counters { frames_sent: 0, frames_rejected: 0, payload_bytes: 0, wire_bytes: 0 };
        Report::new("board", &Recorder::default().summary(), &program.reach, &link, None)
    }

    fn files(args: &PlayArgs) -> PlayFiles {
        let (_, scene) = crate::scene_file::load_with_files("a.toml".as_ref());
        PlayFiles::new(args, Target::Port, &scene).unwrap()
    }

    /// The earlier play writes its summary at its end, after the later play has checked for one.
    #[test]
    fn a_play_of_a_person_that_ends_while_another_one_begins_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let args = PlayArgs::ideal("a.toml".as_ref(), folder.path()).unwrap();
        let files = files(&args);
        fs::write(folder.path().join("summary.json"), "{\"simulated\":false}").unwrap();
        let error = Outputs::create(&args, files, true, &program("plate"), None).err().unwrap().to_string();
        assert!(error.contains("which is not overwritten"), "{error}");
    }

    #[test]
    fn rows_of_a_real_board_stay_as_a_recording_where_the_other_files_fail() {
        let folder = tempfile::tempdir().unwrap();
        let args = PlayArgs::ideal("a.toml".as_ref(), folder.path()).unwrap();
        fs::create_dir(folder.path().join(".scene.png.frixel-tmp")).unwrap();
        let plate = program("plate");
        let mut outputs = Outputs::create(&args, files(&args), false, &plate, None).unwrap();
        outputs.write(&[FeltRow { x_mm: Some(60.0), y_mm: Some(40.0), ..FeltRow::default() }], &[], 0.0).unwrap();
        let error = outputs.finish(&plate, &report(&plate), (&[], false)).unwrap_err().to_string();
        assert!(error.contains("felt.csv.partial: rename it to keep it"), "{error}");
        assert!(!folder.path().join("felt.csv").exists(), "the next play would replace it");
        let kept = fs::read_to_string(folder.path().join("felt.csv.partial")).unwrap();
        assert_eq!(kept.lines().count(), 2);
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
            PlayArgs { with_log: Some(log), ..PlayArgs::ideal("a.toml".as_ref(), &folder.path().join("out")).unwrap() };

        let (first, second) = (program("first"), program("second"));
        let mut outputs = Outputs::create(&args, files(&args), true, &first, None).unwrap();
        outputs.switch(0.0, Vec::new());
        outputs.write(&rows[..1_000], &[], 0.0).unwrap();
        outputs.switch(1.0, vec![0]);
        outputs.write(&rows[1_000..1_500], &[], 0.0).unwrap();
        outputs.replace(1.5, &second);
        outputs.write(&rows[1_500..], &[], 0.0).unwrap();
        let files = outputs.finish(&second, &report(&second), (&[], false)).unwrap();
        let svg = fs::read_to_string(&files[2]).unwrap();
        let shown: Vec<&str> = svg.lines().filter(|line| ["first", "first off", "second"].contains(line)).collect();
        assert_eq!(shown, ["first", "first off", "second"]);
        let joined = fs::read_to_string(&files[0]).unwrap();
        assert!(joined.lines().count() == 2_001 && joined.contains(",0.25"), "the rows have what was felt");
    }
}
