//! `frixel play`: a scene on the simulator or on a board.

mod board;
mod simulator;

use std::io::{IsTerminal, stderr};
use std::path::{Path, PathBuf};
use std::time::Duration;

use frixel::device::{Bitmap, Device, DeviceError, Link, Upload};
use frixel::output::{FeltRow, FeltWriter};
use frixel::scene::Program;
use indicatif::{ProgressBar, ProgressStyle};

use super::PlayArgs;
use super::error::CommandError;
use super::summary::Summary;

pub(super) fn run(args: &PlayArgs) -> Result<(), CommandError> {
    let summary = if args.port == "sim" { simulator::play(args)? } else { board::play(args)? };
    if args.json {
        println!("{}", summary.to_json());
    } else {
        print!("{}", summary.to_text());
    }
    Ok(())
}

/// Says what the compiler has to say of a scene: conversions, roundings.
fn tell_notes(program: &Program) {
    for note in &program.notes {
        eprintln!("{note}");
    }
}

/// From hello to a scene that plays.
fn start<L: Link>(device: &mut Device<L>, program: &Program) -> Result<(), DeviceError> {
    let scene = program.scene_bytes();
    let bitmaps = program
        .bitmaps
        .iter()
        .map(|bitmap| Bitmap {
            crc32: bitmap.crc32,
            width: bitmap.width,
            height: bitmap.height,
            samples: &bitmap.samples,
        })
        .collect();
    let upload = Upload { scene: &scene, bitmaps };
    // A board that another client left armed or playing starts from the beginning.
    device.disarm()?;
    let bar = progress_bar("upload", upload.total_bytes() as u64);
    device.upload(&upload, &mut |progress| bar.set_position(progress.done_bytes as u64))?;
    bar.finish_and_clear();
    device.commit(upload.scene_crc32())?;
    device.arm()?;
    device.play()
}

/// A bar on standard error, where a person looks at it.
fn progress_bar(name: &'static str, length: u64) -> ProgressBar {
    if !stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(length).with_message(name);
    if let Ok(style) = ProgressStyle::with_template("{msg:8} {bar:40} {percent:>3} %") {
        bar.set_style(style);
    }
    bar
}

/// Lets time pass in steps that show on a bar, until it is over or `ended`.
fn pass<L: Link>(
    device: &mut Device<L>,
    seconds: Option<f64>,
    ended: &mut dyn FnMut(&mut Device<L>, Duration) -> Result<bool, CommandError>,
) -> Result<(), CommandError> {
    const STEP_S: f64 = 0.05;
    let bar = progress_bar("play", seconds.map_or(0, |seconds| (1e3 * seconds) as u64));
    let mut passed_s = 0.0;
    while seconds.is_none_or(|seconds| passed_s < seconds) {
        let step_s = seconds.map_or(STEP_S, |seconds| STEP_S.min(seconds - passed_s));
        if ended(device, Duration::from_secs_f64(step_s))? {
            break;
        }
        passed_s += step_s;
        bar.set_position((1e3 * passed_s) as u64);
    }
    bar.finish_and_clear();
    Ok(())
}

/// Writes `felt.csv` into a folder that is made when it is not there.
fn write_felt_csv(folder: &Path, rows: &[FeltRow]) -> Result<PathBuf, CommandError> {
    let path = folder.join("felt.csv");
    let write = || {
        std::fs::create_dir_all(folder)?;
        let mut writer = FeltWriter::new(std::io::BufWriter::new(std::fs::File::create(&path)?))?;
        rows.iter().try_for_each(|row| writer.write(row))?;
        writer.flush()
    };
    write().map_err(CommandError::file(&path))?;
    Ok(path)
}
