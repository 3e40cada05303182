//! `frixel threshold`: a detection threshold for those who have no force sensor.

mod answers;
mod noise;
mod session;

use std::fmt::Write;
use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use frixel_lab::calibration::Protocol;
use frixel_lab::threshold::{Guessed, Observer, STIMULUS_HZ, Threshold, level_v_rms};
use frixel_scene::{Evidence, Experiment, FingerProfile};
use thiserror::Error;
use time::OffsetDateTime;

use super::error::of_finger;
use super::experiment;
use super::fit::screen;
use super::interrupt::Interrupt;
use super::terminal::{print_line, say};
use crate::output_file::{Inputs, OutputFile, Recording};
use answers::Answers;

/// How to keep the answers of a session that was cut off.
const CUT_OFF: &str = "add --finish to go on with it";

#[derive(Debug, Args)]
pub(super) struct ThresholdArgs {
    /// `sim` for the simulator in this process, or the path of a board's serial port.
    #[arg(long, required_unless_present_any = ["noise", "observer"])]
    port: Option<String>,
    /// Let a simulated observer answer, whose threshold is known: it differs from seed to seed. Needs no person and no
    /// board.
    #[arg(long, value_name = "SEED")]
    observer: Option<u64>,
    /// The finger profile to write: how far a level is above threshold, and no newtons. Until the end, the answers are
    /// in a file of the same name and `.partial`.
    #[arg(short, long, value_name = "FINGER.toml")]
    output: Option<PathBuf>,
    /// Replace an earlier profile.
    #[arg(long, requires = "output")]
    overwrite: bool,
    /// Go on with a session that was cut off, after its last answer. It takes the options of that session.
    #[arg(long, requires = "output")]
    finish: bool,
    /// Number of trials, 12 to 40: 12 find the threshold to a factor of 1.7 in amplitude, 40 to a factor of 1.25 (root
    /// mean square over simulated observers). After them follow checks at the highest voltage, 0 to 30: as many as tell
    /// feeling from guessing.
    #[arg(long, value_name = "N", default_value_t = 24, value_parser = clap::value_parser!(u8).range(12..=40))]
    trials: u8,
    /// Write a minute of masking noise to this WAV file and end. Play it over and over on closed headphones during the
    /// trials, so that the electrode is not heard; frixel itself plays no sound.
    #[arg(long, value_name = "FILE.wav")]
    noise: Option<PathBuf>,
    /// Highest voltage, in volts rms, at most 150. Without it, 150 or what the board allows.
    #[arg(long, value_name = "V_RMS", value_parser = experiment::voltage)]
    voltage: Option<f64>,
    /// The screen under the finger: a bundled name or a screen file.
    #[arg(long, value_name = "SCREEN")]
    screen: Option<String>,
    /// Seed of the order of the strokes.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Let a board that is not a simulator drive its electrode.
    #[arg(long)]
    arm: bool,
}

pub(super) fn run(args: &ThresholdArgs) -> Result<()> {
    if let Some(path) = &args.noise {
        let output = OutputFile::new(path, "--noise", &Inputs::default())?;
        output.write(&noise::wav(args.seed)?)?;
        return say(&output, format_args!("  {:<16} {}", "wrote", path.display()));
    }
    let interrupt = Interrupt::watch()?;
    let (screen_name, _) = screen(args.screen.as_deref())?;
    let inputs = Inputs::new(args.screen.as_ref());
    let recording = args.output.as_deref();
    let recording = recording.map(|path| Recording::new(path, "-o", &inputs, args.overwrite, CUT_OFF)).transpose()?;
    let answers = Answers::open(recording.as_ref(), args.finish)?;
    let measured = session::measure(args, &interrupt, answers);
    let reported = measured.and_then(|(threshold, protocol)| {
        let profile = report(args, &threshold, &protocol, screen_name)?;
        let Some(recording) = &recording else { return Ok(()) };
        recording.output().write(profile.to_toml().as_bytes())?;
        recording.discard_partial();
        say(recording.output(), format_args!("  {:<16} {}", "wrote", recording.output().path().display()))
    });
    reported.map_err(|error| match &recording {
        // The session is over, and has no answers to go on with.
        Some(recording) if error.is::<NoThreshold>() => {
            recording.discard_partial();
            error
        }
        Some(recording) if !error.is::<OtherSession>() => experiment::cut_off(recording, error),
        _ => error,
    })
}

/// The answers show no threshold.
#[derive(Debug, Error)]
#[error(
    "{} of {} answers are right, which is no better than guessing, so that there is no threshold: check that the \
     electrode is driven, and press less hard", .0.right, .0.trials
)]
struct NoThreshold(Guessed);

/// The answers that were kept are of another session.
#[derive(Debug, Error)]
#[error(
    "{}: {reason}: give the options of the session that was cut off, or begin a new one with --overwrite", partial.display()
)]
struct OtherSession {
    partial: PathBuf,
    reason: String,
}

/// Prints the threshold, and returns the profile of the finger.
fn report(
    args: &ThresholdArgs,
    threshold: &Threshold,
    protocol: &Protocol,
    screen_name: String,
) -> Result<FingerProfile> {
    let volts = |level_db| level_v_rms(level_db, protocol).map_err(of_finger);
    let Threshold { level_db, interval_db: (low_db, high_db) } = *threshold;
    let (threshold_v_rms, interval_v_rms) = (volts(level_db)?, [volts(low_db)?, volts(high_db)?]);
    let highest = protocol.voltage_max_v_rms();
    print_line(format_args!(
        "  {:<16} {threshold_v_rms:.1} V rms ({:.1} to {:.1})",
        "threshold", interval_v_rms[0], interval_v_rms[1]
    ))?;
    print_line(format_args!("  {:<16} {highest:.0} V rms is {:.0} dB above it", "highest", -level_db))?;
    if threshold.is_near_largest() {
        print_line(format_args!(
            "  {:<16} so near the highest voltage, luck makes thresholds too low: 7 of 10 such intervals contain them",
            "note"
        ))?;
    }
    let mut method = format!("two-alternative staircase, {} trials, {STIMULUS_HZ} Hz", args.trials);
    if let Some(seed) = args.observer {
        // Writing to a string cannot fail.
        let _ = write!(method, ", simulated observer {seed}");
        if let Some(truth_db) = Observer::drawn(seed).threshold_db() {
            let line = format_args!("  {:<16} has a threshold of {:.1} V rms", "the observer", volts(truth_db)?);
            print_line(line)?;
        }
    }
    print_line(format_args!(
        "  {:<16} this gives no newtons: write scenes in fractions of what can be reached",
        "note"
    ))?;
    let experiment = Experiment { date: OffsetDateTime::now_utc().date().to_string(), method, screen: screen_name };
    let evidence = Evidence::Perceptual { experiment, threshold_v_rms, threshold_interval_v_rms: interval_v_rms };
    Ok(FingerProfile { evidence, ..FingerProfile::example() })
}
