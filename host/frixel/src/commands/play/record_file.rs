//! The file of `--record`.

use std::io::Write;
use std::path::Path;

use anyhow::{Result, bail};
use frixel_felt::recorder::{FeltRow, Marker};
use frixel_lab::recording::{
    GrowingFile, Metadata, ParquetWriter, PlaySource, ROWS_PER_GROUP, play_fields, play_values,
};
use frixel_lab::simulate::PlayOptions;
use frixel_scene::{FingerProfile, Screen};

use crate::commands::error::{at, reading};
use crate::input;
use crate::scene_file::{SceneFiles, named};
use frixel_files::{FileWriter, Inputs, OutputFile};

use super::super::parquet;
use super::PlayArgs;

/// The option that names the file.
const OPTION: &str = "--record";
/// Advice on how to keep the rows of an interrupted play on a board.
const CUT_OFF: &str = "rename it to keep it";
/// Longest part of a person's play that is lost when the process is killed, s.
const PERSON_GROUP_S: u32 = 10;

/// The file that `--record` names; `None` without that option.
pub(super) fn output(args: &PlayArgs, inputs: &Inputs) -> Result<Option<OutputFile>> {
    let Some(path) = &args.record else { return Ok(None) };
    if !parquet::is_parquet(path) && path != Path::new("-") && !path.starts_with("/dev") {
        let path = path.display();
        bail!("{path} is not the name of a Parquet file: give --record a name that ends in .parquet");
    }
    Ok(Some(OutputFile::replacing(path, OPTION, inputs, args.overwrite)?))
}

/// Returns the inputs of a play. Reads the files of profiles and stroke; those of the scene have been read already.
pub(super) fn source(args: &PlayArgs, scene: &SceneFiles) -> Result<PlaySource> {
    let names = args.profiles.names();
    let read = |path| input::read(path, input::CSV_MAX_BYTES).map_err(reading(path));
    Ok(PlaySource {
        scene: scene.scene_text(),
        files: scene.named_bytes().clone(),
        finger: names.finger.as_deref().map(named::<FingerProfile>).transpose()?,
        screen: names.screen.as_deref().map(named::<Screen>).transpose()?,
        touch: args.touch.named()?,
        stroke: args.stroke.file().map(read).transpose()?,
    })
}

/// Writes rows as Parquet while a scene plays.
pub(super) struct RecordFile {
    file: FileWriter,
    parquet: ParquetWriter<Vec<u8>>,
    metadata: Metadata,
    /// The samples that were streamed so far; `None` without a stream.
    samples: Option<GrowingFile>,
    /// Rows of the next row group.
    rows: Vec<FeltRow>,
    rows_per_group: usize,
}

impl RecordFile {
    /// Begins the file. A play on a real board goes to `FILE.partial`, which is a whole Parquet file after each row
    /// group; a simulated play can be repeated.
    pub(super) fn start(output: &OutputFile, metadata: Metadata) -> Result<Self> {
        let (file, rows_per_group) = if metadata.is_simulated {
            (output.create()?, ROWS_PER_GROUP)
        } else {
            output.check_new()?;
            let rows_hz = metadata.tick_hz / metadata.ticks_per_row.max(1);
            (output.begin_recording(CUT_OFF)?, (PERSON_GROUP_S * rows_hz).max(1) as usize)
        };
        let path = output.path();
        let parquet = ParquetWriter::new(Vec::new(), play_fields()).map_err(at(path.display()))?;
        let samples = (metadata.play["stream"] == true).then(GrowingFile::default);
        Ok(Self { file, parquet, metadata, samples, rows: Vec::new(), rows_per_group })
    }

    /// Adds rows. `markers` are all markers so far.
    pub(super) fn write(&mut self, rows: &[FeltRow], markers: &[Marker]) -> Result<()> {
        for row in rows {
            self.rows.push(*row);
            if self.rows.len() >= self.rows_per_group {
                self.end_group(markers)?;
            }
        }
        Ok(())
    }

    /// Adds a scene that was put on the board at a time.
    pub(super) fn add_scene(&mut self, t_s: f64, scene: &SceneFiles, is_refused: bool) {
        let files = scene.named_bytes().iter().map(|(name, bytes)| (name.clone(), bytes.as_slice()));
        self.metadata.add_scene((t_s, scene.scene_text(), is_refused), files);
    }

    /// Sets the lines of `--control` that were carried out so far.
    pub(super) fn set_lines(&mut self, lines: &[String]) {
        self.metadata.play["lines"] = lines.into();
    }

    /// Adds the next streamed samples.
    pub(super) fn add_samples(&mut self, samples: &[u16]) {
        if let Some(streamed) = &mut self.samples {
            let bytes: Vec<u8> = samples.iter().flat_map(|sample| sample.to_le_bytes()).collect();
            streamed.extend(&bytes);
        }
    }

    /// Writes the remaining rows. The caller commits the file.
    pub(super) fn finish(mut self, markers: &[Marker], interrupted: bool) -> Result<FileWriter> {
        self.metadata.play["interrupted"] = interrupted.into();
        if let Some(samples) = self.samples.take() {
            self.metadata.add_grown(PlayOptions::STREAM, samples);
        }
        self.write_group(markers, true)?;
        Ok(self.file)
    }

    fn end_group(&mut self, markers: &[Marker]) -> Result<()> {
        self.write_group(markers, !self.metadata.is_simulated)
    }

    /// Writes a row group, and a footer if `is_whole`.
    fn write_group(&mut self, markers: &[Marker], is_whole: bool) -> Result<()> {
        let Self { file, parquet, metadata, rows, .. } = self;
        if !rows.is_empty() {
            parquet.write(&play_values(rows)).map_err(at(file.path().display()))?;
            rows.clear();
        }
        if is_whole {
            metadata.markers = markers.to_vec();
            parquet.end(metadata).map_err(at(file.path().display()))?;
        }
        let bytes = std::mem::take(parquet.get_mut());
        Ok(file.write_all(&bytes).and_then(|()| file.flush())?)
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use frixel_lab::recording;
    use frixel_play::TO_THE_END;

    use super::*;

    /// A recording on a real board, at 1,000 rows a second.
    fn start(folder: &Path) -> Result<RecordFile> {
        let output = OutputFile::new(&folder.join("me.parquet"), OPTION, &Inputs::default())?;
        let metadata = Metadata { tick_hz: 40_000, ticks_per_row: 40, ..Metadata::default() };
        RecordFile::start(&output, metadata)
    }

    fn rows(count: u32) -> Vec<FeltRow> {
        (0..count).map(|row| FeltRow { t_s: 1e-3 * f64::from(row), ..FeltRow::default() }).collect()
    }

    fn read(path: &Path) -> recording::Recording {
        recording::Recording::read_parquet(fs::read(path).unwrap(), TO_THE_END).unwrap()
    }

    #[test]
    fn a_persons_play_that_is_killed_loses_ten_seconds_at_most() {
        let folder = tempfile::tempdir().unwrap();
        let partial = folder.path().join("me.parquet.partial");
        let mut file = start(folder.path()).unwrap();
        file.write(&rows(9_999), &[]).unwrap();
        assert!(fs::read(&partial).unwrap().is_empty());
        file.write(&rows(12_000), &[]).unwrap();
        // As a process that is killed leaves it.
        let kept = read(&partial);
        assert_eq!((kept.rows(), kept.is_cut_off), (20_000, false));
        drop(file);
        assert_eq!(read(&partial), kept, "an error that ends the play leaves it as well");

        let error = start(folder.path()).err().unwrap().to_string();
        assert!(
            error.contains("me.parquet.partial has the rows of a recording that was cut off: rename it to"),
            "{error}"
        );
        assert_eq!(read(&partial), kept);
        fs::rename(&partial, folder.path().join("me.parquet")).unwrap();
        let error = start(folder.path()).err().unwrap().to_string();
        assert!(error.contains("me.parquet is a recording of a person, and results do not overwrite it"), "{error}");
    }

    #[test]
    fn a_persons_play_that_ends_has_every_row() {
        let folder = tempfile::tempdir().unwrap();
        let mut file = start(folder.path()).unwrap();
        file.write(&rows(10_001), &[]).unwrap();
        file.finish(&[], false).unwrap().commit().unwrap();
        let recorded = read(&folder.path().join("me.parquet"));
        assert_eq!((recorded.rows(), recorded.metadata.is_simulated), (10_001, false));
        assert!(!folder.path().join("me.parquet.partial").exists());
    }

    #[test]
    fn a_persons_play_that_has_no_row_group_yet_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let mut file = start(folder.path()).unwrap();
        file.write(&rows(100), &[]).unwrap();
        drop(file);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
