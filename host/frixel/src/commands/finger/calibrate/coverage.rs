//! Error of `frixel finger calibrate` and `frixel finger fit` against the truth, and coverage of the stated intervals.
//!
//! The truth is what a board that drives 150 V rms steadily adds to the friction of the same simulated person: measured
//! in steady sliding, under the median load of the recording, without noise. The recordings are those of the command,
//! to the byte ([`the_command_writes_what_is_measured_here`]), and `frixel finger fit` prints what is fitted here
//! (`tests/fit_command.rs`).
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use clap::Parser;
use frixel_driver::{Device, PollingLink, ignore_progress};
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::{
    Board, BoardMemory, BoardView, FingertipConfig, OwnFinger, Person, Point, Rig, RigConfig, RigTick, Stroke,
    TouchConfig, WorldOptions,
};
use frixel_lab::calibration::{align, write_csv};
use frixel_lab::fit::{self, Estimate, Fit, FitError, Settings};
use frixel_model::{Contact, Finger, Waveform};
use frixel_play::{Player, RigStream};
use frixel_scene::{Scene, Screen, compile};

use super::recorded::Simulated;
use super::{CalibrateArgs, run};
use crate::commands::interrupt::Interrupt;

/// Numbers of people and of seeds, in every test run and in the soak.
const FEW: (u64, u64) = (8, 1);
const MANY: (u64, u64) = (200, 20);
/// Lengths in strokes at which the error is measured over the length of a recording, and the number of people for each.
const STROKES: [u64; 6] = [9, 12, 18, 36, 72, 144];
const PEOPLE_PER_LENGTH: u64 = 24;
/// Steady sliding: its length, and the part at the end that is measured, in seconds.
const STEADY_S: f64 = 0.4;
const MEASURED_S: f64 = 0.2;

#[derive(Debug, Parser)]
struct Line {
    #[command(flatten)]
    args: CalibrateArgs,
}

fn arguments(line: &str) -> CalibrateArgs {
    Line::parse_from(format!("calibrate {line}").split(' ')).args
}

/// The recording that `frixel finger calibrate` writes with these arguments.
fn calibrated(line: &str) -> Vec<u8> {
    let (board, forces) = Simulated::new(&arguments(line)).unwrap().record(&Interrupt::default()).unwrap();
    let mut csv = Vec::new();
    write_csv(&mut csv, &align(&board, &forces, true).unwrap()).unwrap();
    csv
}

/// The fit that `frixel finger fit` makes of a recording.
fn fitted(csv: &[u8]) -> Result<Fit, FitError> {
    let settings = Settings {
        voltage_v_rms: 150.0,
        normal_load_n: None,
        coating_gap_m: Screen::example().coating_gap_m(),
        ripple: fit::measured_ripple(Waveform::Square, 1e3),
        without: Vec::new(),
        seed: 1,
    };
    fit::fit(fit::rows(csv)?.value, &settings)
}

/// Electric friction of a person at a steady drive of 150 V rms, in steady sliding under a load, in newtons.
fn steady_electric_friction_n(person: &Person, load_n: f64) -> f64 {
    // Almost the whole reach, so that rounding stays within it.
    let scene = "version = 1\ndrive = { voltage_max_v_rms = 150 }\n[[layer]]\nname = \"steady\"\nkind = \"constant\"\n\
                 friction_fraction = 0.9999\n";
    let scene = Scene::parse(scene, "steady", &BTreeMap::new()).unwrap();
    let program = compile(&scene, &Board::SIMULATOR.limits, Board::SIMULATOR.tick_hz).unwrap();
    // The person's friction coefficient under this load, since the contact below has this load as its own.
    let gain = (load_n / person.normal_load_n).powf(person.fingertip.load_exponent);
    let finger = Finger { friction_coefficient: gain * person.finger.friction_coefficient, ..person.finger };
    let gap_m = person.skin_gap_m + Screen::example().coating_gap_m();
    let contact = Contact::new(&finger, gap_m).unwrap().under_load(load_n).unwrap();

    let fingertip = FingertipConfig { load_sd_n: 0.0, noise_rms_n: 0.0, ..person.fingertip };
    let finger = Some(OwnFinger { law: contact.into(), fingertip });
    let world = WorldOptions { touch: Some(TouchConfig::IDEAL), finger, ..WorldOptions::default() };
    let config = RigConfig::default().with(&world);
    let at = |x_m| Point { x_m, y_m: 0.04 };
    let stroke = Stroke::constant_speed(at(0.03), at(0.09), 0.06).unwrap();
    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &config, stroke, 1).unwrap();
    let hz = f64::from(config.board.tick_hz);
    let (ticks, measured) = ((STEADY_S * hz) as u64, (MEASURED_S * hz) as u64);
    let (mut tick, mut sum_n, mut volts) = (0, 0.0, 0.0);
    let observe = |record: &RigTick| {
        tick += 1;
        if (ticks - measured..ticks).contains(&tick) {
            sum_n += record.felt.electric_friction_n / measured as f64;
            if let BoardView::Status(status) = &record.status {
                volts += f64::from(status.telemetry.voltage_v_rms) / measured as f64;
            }
        }
    };
    let recorder = Recorder::new(&program, &config.board.limits, config.board.tick_hz, ticks, 40).unwrap();
    let line = RigStream::new(rig).observed(observe);
    let mut player = Player::recording(Device::connect(PollingLink::new(line)).unwrap(), recorder);
    player.start(program, 0, &mut ignore_progress).unwrap();
    while player.recorder_mut().ticks_left() > 0 {
        player.step(Duration::MAX).unwrap();
    }
    drop(player);
    assert!((volts / 150.0 - 1.0).abs() < 1e-3, "the board drove {volts} V rms");
    sum_n
}

/// One recording of a person that was fitted.
#[derive(Clone, Copy, Debug)]
struct Outcome {
    person: u64,
    /// Error of electric friction, as a part of the truth.
    error: f64,
    /// Half-width of its interval, as a part of the truth.
    half_width: f64,
    /// Whether the interval contains the truth.
    covers: bool,
}

/// Outcomes of the recordings of many people.
#[derive(Debug, Default)]
struct Tally {
    outcomes: Vec<Outcome>,
    refusals: Vec<String>,
}

impl Tally {
    /// Calibrates and fits these people, each with these seeds, on two threads.
    fn of(people: Range<u64>, seeds: Range<u64>, options: &str) -> Self {
        let tally = Mutex::new(Self::default());
        let runs = (people.end - people.start) * (seeds.end - seeds.start);
        let next = AtomicU64::new(0);
        let work = || {
            loop {
                let run = next.fetch_add(1, Ordering::Relaxed);
                if run >= runs {
                    break;
                }
                let (person, seed) =
                    (people.start + run % (people.end - people.start), run / (people.end - people.start));
                let seed = seeds.start + seed;
                let fit = fitted(&calibrated(&format!("-o x.csv --finger-seed {person} --seed {seed}{options}")));
                let outcome = fit.map(|fit| outcome(person, &fit));
                let mut tally = tally.lock().unwrap();
                match outcome {
                    Ok(outcome) => tally.outcomes.push(outcome),
                    Err(error) => tally.refusals.push(format!("person {person}, seed {seed}: {error}")),
                }
                let done = tally.outcomes.len() + tally.refusals.len();
                if done.is_multiple_of(200) {
                    tally.print();
                }
            }
        };
        std::thread::scope(|scope| {
            scope.spawn(work);
            scope.spawn(work);
        });
        tally.into_inner().unwrap()
    }

    fn mean(&self, of: impl Fn(&Outcome) -> f64) -> f64 {
        self.outcomes.iter().map(of).sum::<f64>() / self.outcomes.len() as f64
    }

    fn bias(&self) -> f64 {
        self.mean(|outcome| outcome.error)
    }

    fn median_half_width(&self) -> f64 {
        let mut widths: Vec<f64> = self.outcomes.iter().map(|outcome| outcome.half_width).collect();
        widths.sort_by(f64::total_cmp);
        widths.get(widths.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// Share of the intervals that contain the truth, and the standard error of that share over people.
    fn coverage(&self) -> (f64, f64) {
        let share = self.mean(|outcome| f64::from(outcome.covers));
        let mut clusters: BTreeMap<u64, f64> = BTreeMap::new();
        for outcome in &self.outcomes {
            *clusters.entry(outcome.person).or_default() += f64::from(outcome.covers) - share;
        }
        let count = clusters.len() as f64;
        let square: f64 = clusters.values().map(|sum| sum * sum).sum();
        (share, (square * count / (count - 1.0)).sqrt() / self.outcomes.len() as f64)
    }

    fn refused(&self) -> f64 {
        self.refusals.len() as f64 / (self.refusals.len() + self.outcomes.len()) as f64
    }

    fn print(&self) {
        let (share, error) = self.coverage();
        let rms = self.mean(|outcome| outcome.error * outcome.error).sqrt();
        println!(
            "{} fitted, {:.2} % refused; electric friction is off by {:+.2} % on average, {:.2} % rms; median \
             half-width {:.2} %; the interval contains the truth for {:.1} % ({:.1} to {:.1}, clustered by person)",
            self.outcomes.len(),
            100.0 * self.refused(),
            100.0 * self.bias(),
            100.0 * rms,
            100.0 * self.median_half_width(),
            100.0 * share,
            100.0 * (share - 1.96 * error).max(0.0),
            100.0 * (share + 1.96 * error).min(1.0),
        );
    }
}

fn outcome(person: u64, fit: &Fit) -> Outcome {
    let truth_n = steady_electric_friction_n(&Person::drawn(person), fit.data.normal_load_n);
    let Estimate { value, low, high } = fit.electric_friction_n;
    let (error, half_width) = (value / truth_n - 1.0, (high - low) / (2.0 * truth_n));
    Outcome { person, error, half_width, covers: (low..=high).contains(&truth_n) }
}

#[test]
#[ignore = "an hour or more: cargo xtask soak fit"]
fn intervals_of_200_people_and_20_seeds_contain_the_truth() {
    let tally = Tally::of(0..MANY.0, 1..1 + MANY.1, "");
    tally.print();
    for refusal in &tally.refusals {
        println!("  {refusal}");
    }
    assert!(tally.bias().abs() <= 0.005, "bias {}", tally.bias());
    assert!(tally.median_half_width() <= 0.015, "half-width {}", tally.median_half_width());
    let (share, _) = tally.coverage();
    assert!((0.93..=0.97).contains(&share), "coverage {share}");
    assert!(tally.refused() <= 0.02, "{:#?}", tally.refusals);
}

/// The table of `docs/inside/evidence.md`: error of a fit over the number of strokes.
#[test]
#[ignore = "minutes: cargo xtask soak fit"]
fn errors_fall_with_the_root_of_the_number_of_strokes() {
    let tallies = STROKES.map(|strokes| {
        let tally = Tally::of(0..PEOPLE_PER_LENGTH, 1..2, &format!(" --strokes {strokes}"));
        println!("{strokes} strokes, {:.0} s:", 1.8 * strokes as f64);
        tally.print();
        tally
    });
    let [short, .., long] = &tallies;
    assert!(long.median_half_width() < 0.4 * short.median_half_width());
}

/// Friction that is 3 % low, as with the rows in which the drive is off, would be caught: none of eight intervals of
/// 1 % would contain the truth.
#[test]
fn a_few_people_are_fitted_as_they_are() {
    let tally = Tally::of(0..FEW.0, 1..1 + FEW.1, "");
    tally.print();
    assert!(tally.refusals.is_empty(), "{:#?}", tally.refusals);
    // The mean of eight errors of 0.6 % rms has a standard error of 0.2 %.
    assert!(tally.bias().abs() <= 0.01, "bias {}", tally.bias());
    assert!(tally.median_half_width() <= 0.02, "half-width {}", tally.median_half_width());
    // Three or more of eight intervals of 95 % miss the truth once in 170 sets of seeds.
    let covered = tally.outcomes.iter().filter(|outcome| outcome.covers).count();
    assert!(covered >= 6, "{covered} of {}: {:#?}", tally.outcomes.len(), tally.outcomes);
}

#[test]
fn the_command_writes_what_is_measured_here() {
    let folder = tempfile::TempDir::new().unwrap();
    let line = |output: &str| format!("-o {output} --finger-seed 3 --seed 2 --strokes 9");
    let output = folder.path().join("data.csv");
    run(&arguments(&line(output.to_str().unwrap()))).unwrap();
    assert_eq!(frixel_lab::input::read(&output, frixel_lab::input::CSV_MAX_BYTES).unwrap(), calibrated(&line("x.csv")));
}
