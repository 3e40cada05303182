//! `frixel threshold`: a detection threshold for those who have no force sensor.

mod answers;

use std::io::{Cursor, stdin};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use clap::Args;
use frixel::input;
use frixel::output_file::{Inputs, OutputFile, Recording};
use frixel::player::player;
use frixel::rigs::{RecordedLink, SimStream};
use frixel_driver::{Device, PollingLink};
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::{BoardMemory, Rig, RigConfig};
use frixel_lab::calibration::Protocol;
use frixel_lab::threshold::{Staircase, Threshold};
use frixel_play::{Feed, Player};
use frixel_scene::{Evidence, Experiment, FingerProfile, Scene, compile};
use frixel_wire::hello::BoardLimits;
use hound::{SampleFormat, WavSpec, WavWriter};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use time::OffsetDateTime;

use super::error::CommandError;
use super::experiment;
use super::fit::screen;
use super::interrupt::Interrupt;
use super::terminal::{print, print_line, say};
use super::waiting;
use answers::{Answer, Answers};

/// Duration of each of the two strokes of a trial, in seconds.
const STROKE_S: f64 = 1.6;
/// Arrows that show the pace of a stroke.
const ARROWS: u32 = 8;
/// The stimulus: friction that swings at this frequency, in Hz, near which fingers feel best (Vardar 2016; Wijekoon
/// 2012: 160 Hz of force).
const STIMULUS_HZ: f64 = 160.0;
/// Fade of the stimulus at either end of a stroke, in seconds, so that no click gives it away.
const FADE_S: f64 = 0.2;
/// Duration of the masking noise, in seconds.
const NOISE_S: u32 = 60;
const NOISE_HZ: u32 = 44_100;
/// Longest time without a word to the board while an answer is awaited.
const ANSWER_POLL: Duration = Duration::from_millis(50);
/// Lines that are read ahead of the trials that they answer.
const LINES_AHEAD: usize = 64;
/// Answers in a row that are neither 1 nor 2, after which the trials end.
const WRONG_ANSWERS_MAX: u32 = 10;
/// How to keep the answers of a session that was cut off.
const CUT_OFF: &str = "add --finish to go on with it";

#[derive(Debug, Args)]
pub(super) struct ThresholdArgs {
    /// `sim` for the simulator in this process, or the path of a board's serial port.
    #[arg(long, required_unless_present = "noise")]
    port: Option<String>,
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
    /// mean square over simulated observers).
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

pub(super) fn run(args: &ThresholdArgs) -> Result<(), CommandError> {
    if let Some(path) = &args.noise {
        let output = OutputFile::new(path, "--noise", &Inputs::default())?;
        output.write(&noise(args.seed)?)?;
        return say(&output, format_args!("  {:<16} {}", "wrote", path.display()));
    }
    let interrupt = Interrupt::watch()?;
    let (screen_name, _) = screen(args.screen.as_deref())?;
    let inputs = Inputs::new(args.screen.as_ref());
    let recording = args.output.as_deref();
    let recording = recording.map(|path| Recording::new(path, "-o", &inputs, args.overwrite, CUT_OFF)).transpose()?;
    let answers = Answers::open(recording.as_ref(), args.finish)?;
    let measured = measure(args, &interrupt, answers);
    let reported = measured.and_then(|(threshold, protocol)| {
        let profile = report(args, &threshold, &protocol, screen_name)?;
        let Some(recording) = &recording else { return Ok(()) };
        recording.output().write(profile.to_toml().as_bytes())?;
        recording.discard_partial();
        say(recording.output(), format_args!("  {:<16} {}", "wrote", recording.output().path().display()))
    });
    reported.map_err(|error| match &recording {
        Some(recording) => experiment::cut_off(recording, error),
        None => error,
    })
}

/// Plays the trials on the board of the options.
fn measure(
    args: &ThresholdArgs,
    interrupt: &Interrupt,
    answers: Answers,
) -> Result<(Threshold, Protocol), CommandError> {
    // Without a port, there is a file of noise, which ends the command before.
    let port = args.port.as_deref().unwrap_or("sim");
    if port == "sim" {
        let config = RigConfig::default();
        let protocol = protocol(args, &config.board.limits)?;
        let stroke = protocol.stroke().and_then(|stroke| stroke.looped(0.0));
        let mut memory = BoardMemory::new();
        let rig = Rig::new(&mut memory, &config, stroke.map_err(CommandError::GeneratedStroke)?, args.seed)?;
        session(
            args,
            interrupt,
            Device::connect(PollingLink::new(SimStream::new(rig, Recorder::idle())))?,
            protocol,
            answers,
        )
    } else {
        let device = experiment::connect(port, args.arm)?;
        let protocol = protocol(args, &device.hello().limits)?;
        session(args, interrupt, device, protocol, answers)
    }
}

fn protocol(args: &ThresholdArgs, limits: &BoardLimits) -> Result<Protocol, CommandError> {
    Ok(Protocol::new(experiment::highest_voltage(args.voltage, limits)?, args.seed))
}

/// Plays all trials, and returns the threshold.
fn session<L: RecordedLink>(
    args: &ThresholdArgs,
    interrupt: &Interrupt,
    device: Device<L>,
    protocol: Protocol,
    mut recorded: Answers,
) -> Result<(Threshold, Protocol), CommandError> {
    let Some(mut staircase) = Staircase::new(usize::from(args.trials)) else {
        return Err(CommandError::NoAnswer { trial: 0 });
    };
    let mut random = Pcg64::seed_from_u64(args.seed);
    let highest_v_rms = protocol.voltage_max_v_rms();
    for _ in 0..recorded.repeat(highest_v_rms, &mut staircase)? {
        // As in the session that was cut off.
        let _ = random.next_u64();
    }
    let hello = *device.hello();
    let scene = protocol.scene().map_err(CommandError::Finger)?;
    let scene = Scene::parse(&scene, "threshold", &std::collections::BTreeMap::new())?;
    let program = compile(&scene, &hello.limits, hello.tick_hz)?;
    let mut player = player(waiting::watch(device, interrupt), Recorder::idle());
    player.start(program, 0, &mut |_| ControlFlow::Continue(())).map_err(CommandError::Play)?;
    print_line("  Slide 7 cm to the right while arrows to the right appear, then back with those to the left.")?;
    print_line("  Type 1 or 2 and Enter: which of the two strokes was rougher? Guess if you are not sure.")?;
    let answers = answers();
    while let Some(level_db) = staircase.next_level_db() {
        let (trial, trials) = staircase.progress();
        let is_second = random.next_u64() >> 63 == 1;
        let feed = Feed::of(samples(&protocol, level_db, is_second), protocol.sample_hz());
        player.stream(feed).map_err(CommandError::Play)?;
        print(format_args!("  trial {trial} of {trials}: "))?;
        guide(&mut player, interrupt)?;
        let mut wrong = 0;
        let said_second = loop {
            match answers.recv_timeout(ANSWER_POLL) {
                Ok(line) if line.trim() == "1" => break false,
                Ok(line) if line.trim() == "2" => break true,
                Ok(_) if wrong + 1 == WRONG_ANSWERS_MAX => {
                    player.stop()?;
                    return Err(CommandError::WrongAnswers { trial, count: WRONG_ANSWERS_MAX });
                }
                Ok(_) => {
                    wrong += 1;
                    print(format_args!("  trial {trial} of {trials}, 1 or 2? "))?;
                    wait(&mut player, interrupt, 0.0)?;
                }
                // A board whose host is silent disarms itself: serve it while the person thinks.
                Err(RecvTimeoutError::Timeout) => wait(&mut player, interrupt, 0.0)?,
                Err(RecvTimeoutError::Disconnected) => return Err(CommandError::NoAnswer { trial }),
            }
        };
        let is_right = said_second == is_second;
        staircase.answer(level_db, is_right);
        recorded.add(Answer { trial, highest_v_rms, level_db, is_right })?;
    }
    player.stop()?;
    Ok((staircase.threshold(), protocol))
}

/// Plays the two strokes of a trial, and shows their pace: an arrow for each part of the way.
fn guide<L: RecordedLink>(player: &mut Player<L>, interrupt: &Interrupt) -> Result<(), CommandError> {
    for (stroke, arrow) in [("1 ", ">"), (" 2 ", "<")] {
        print(stroke)?;
        for _ in 0..ARROWS {
            print(arrow)?;
            wait(player, interrupt, STROKE_S / f64::from(ARROWS))?;
        }
    }
    wait(player, interrupt, FADE_S)?;
    print("  1 or 2? ")
}

/// The lines of standard input, read by a thread of their own.
fn answers() -> Receiver<String> {
    let (sender, receiver) = sync_channel(LINES_AHEAD);
    thread::spawn(move || {
        let mut input = stdin().lock();
        while let Some(line) = input::next_line(&mut input) {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    receiver
}

/// Lets time pass on the board. Stops it if the person wants to end.
fn wait<L: RecordedLink>(player: &mut Player<L>, interrupt: &Interrupt, seconds: f64) -> Result<(), CommandError> {
    let mut left = Duration::from_secs_f64(seconds);
    loop {
        if interrupt.is_requested() {
            player.stop()?;
            return Err(CommandError::ExperimentInterrupted);
        }
        left = left.saturating_sub(player.step(left).map_err(CommandError::Play)?);
        if left.is_zero() {
            return Ok(());
        }
    }
}

/// The samples of two strokes, of which one has the stimulus.
fn samples(protocol: &Protocol, level_db: f64, is_second: bool) -> Vec<u16> {
    let sample_hz = f64::from(protocol.sample_hz());
    let amplitude = libm::pow(10.0, level_db / 20.0);
    (0..(2.0 * STROKE_S * sample_hz) as u32)
        .map(|sample| {
            let time_s = f64::from(sample) / sample_hz;
            let in_stroke_s = time_s % STROKE_S;
            if (time_s >= STROKE_S) != is_second {
                return 0;
            }
            let fade = (in_stroke_s.min(STROKE_S - in_stroke_s) / FADE_S).min(1.0);
            let wave = 0.5 - 0.5 * libm::cos(core::f64::consts::TAU * STIMULUS_HZ * in_stroke_s);
            (fade * amplitude * wave * f64::from(u16::MAX)).round() as u16
        })
        .collect()
}

/// Prints the threshold, and returns the profile of the finger.
fn report(
    args: &ThresholdArgs,
    threshold: &Threshold,
    protocol: &Protocol,
    screen_name: String,
) -> Result<FingerProfile, CommandError> {
    let volts =
        |level_db: f64| protocol.voltage_of_share_v_rms(libm::pow(10.0, level_db / 20.0)).map_err(CommandError::Finger);
    let Threshold { level_db, interval_db: (low_db, high_db) } = *threshold;
    let (threshold_v_rms, interval_v_rms) = (volts(level_db)?, [volts(low_db)?, volts(high_db)?]);
    let highest = protocol.voltage_max_v_rms();
    print_line(format_args!(
        "  {:<16} {threshold_v_rms:.1} V rms ({:.1} to {:.1})",
        "threshold", interval_v_rms[0], interval_v_rms[1]
    ))?;
    print_line(format_args!("  {:<16} {highest:.0} V rms is {:.0} dB above it", "highest", -level_db))?;
    print_line(format_args!(
        "  {:<16} this gives no newtons: write scenes in fractions of what can be reached",
        "note"
    ))?;
    let experiment = Experiment {
        date: OffsetDateTime::now_utc().date().to_string(),
        method: format!("two-alternative staircase, {} trials, {STIMULUS_HZ} Hz", args.trials),
        screen: screen_name,
    };
    let evidence = Evidence::Perceptual { experiment, threshold_v_rms, threshold_interval_v_rms: interval_v_rms };
    Ok(FingerProfile { evidence, ..FingerProfile::example() })
}

/// White noise, which masks what the electrode sounds like, as a WAV file.
fn noise(seed: u64) -> Result<Vec<u8>, CommandError> {
    let spec = WavSpec { channels: 1, sample_rate: NOISE_HZ, bits_per_sample: 16, sample_format: SampleFormat::Int };
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = WavWriter::new(&mut bytes, spec).map_err(CommandError::Noise)?;
    let mut random = Pcg64::seed_from_u64(seed);
    for _ in 0..NOISE_S * NOISE_HZ {
        // A quarter of full scale, which leaves room for any player's volume.
        writer.write_sample((random.next_u64() >> 48) as u16 as i16 / 4).map_err(CommandError::Noise)?;
    }
    writer.finalize().map_err(CommandError::Noise)?;
    Ok(bytes.into_inner())
}
