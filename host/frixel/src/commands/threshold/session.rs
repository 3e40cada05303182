//! The trials: what is played to a person, asked, and answered.

use std::io::stdin;
use std::ops::ControlFlow;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use anyhow::{Result, anyhow, bail};
use frixel_driver::{Device, PollingLink};
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::{BoardMemory, Rig, RigConfig};
use frixel_lab::calibration::Protocol;
use frixel_lab::simulation::SimStream;
use frixel_lab::threshold::{FADE_S, Observer, STROKE_S, Staircase, Threshold, samples};
use frixel_play::{Feed, Player};
use frixel_scene::{Scene, compile};
use frixel_wire::hello::BoardLimits;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

use super::answers::{Answer, Answers};
use super::{NoThreshold, ThresholdArgs, experiment};
use crate::commands::error::{of_finger, of_generated_stroke};
use crate::commands::interrupt::Interrupt;
use crate::commands::terminal::{print, print_line};
use crate::commands::waiting;
use crate::input;
use crate::rigs::RecordedLink;

/// Arrows that show the pace of a stroke.
const ARROWS: u32 = 8;
/// Longest time without a word to the board while an answer is awaited.
const ANSWER_POLL: Duration = Duration::from_millis(50);
/// Lines that are read ahead of the trials that they answer.
const LINES_AHEAD: usize = 64;
/// Answers in a row that are neither 1 nor 2, after which the trials end.
const WRONG_ANSWERS_MAX: u32 = 10;

/// Plays the trials on the board of the options.
pub(super) fn measure(args: &ThresholdArgs, interrupt: &Interrupt, answers: Answers) -> Result<(Threshold, Protocol)> {
    // Without a port, a simulated observer answers; a file of noise ends the command before.
    let port = args.port.as_deref().unwrap_or("sim");
    if port == "sim" {
        let config = RigConfig::default();
        let protocol = protocol(args, &config.board.limits)?;
        let stroke = protocol.stroke().and_then(|stroke| stroke.looped(0.0));
        let mut memory = BoardMemory::new();
        let rig = Rig::new(&mut memory, &config, stroke.map_err(of_generated_stroke)?, args.seed)?;
        let line = SimStream::new(rig, Recorder::default());
        session(args, interrupt, Device::connect(PollingLink::new(line))?, protocol, answers)
    } else if args.observer.is_some() {
        bail!("--observer answers in place of a person, and feels no board on {port}: leave --port out")
    } else {
        let device = experiment::connect(port, &["sim"], args.arm)?;
        let protocol = protocol(args, &device.hello().limits)?;
        session(args, interrupt, device, protocol, answers)
    }
}

fn protocol(args: &ThresholdArgs, limits: &BoardLimits) -> Result<Protocol> {
    Ok(Protocol::new(experiment::highest_voltage(args.voltage, limits)?, args.seed))
}

/// Plays all trials, and returns the threshold.
fn session<L: RecordedLink>(
    args: &ThresholdArgs,
    interrupt: &Interrupt,
    device: Device<L>,
    protocol: Protocol,
    mut recorded: Answers,
) -> Result<(Threshold, Protocol)> {
    let Some(mut staircase) = Staircase::new(usize::from(args.trials)) else {
        return Err(no_answer(0));
    };
    let mut random = Pcg64::seed_from_u64(args.seed);
    let mut answering = Answering::new(args.observer);
    let highest_v_rms = protocol.voltage_max_v_rms();
    for level_db in recorded.repeat(highest_v_rms, args.observer, &mut staircase)? {
        // As in the session that was cut off.
        let _ = random.next_u64();
        if let Answering::Observer(observer) = &mut answering {
            let _ = observer.answers_rightly(level_db);
        }
    }
    let hello = *device.hello();
    let scene = protocol.scene().map_err(of_finger)?;
    let scene = Scene::parse(&scene, "threshold", &std::collections::BTreeMap::new())?;
    let program = compile(&scene, &hello.limits, hello.tick_hz)?;
    let mut player = Player::recording(waiting::watch(device, interrupt), Recorder::default());
    player.start(program, 0, &mut |_| ControlFlow::Continue(()))?;
    if args.observer.is_none() {
        print_line("  Slide 7 cm to the right while arrows to the right appear, then back with those to the left.")?;
        print_line("  Type 1 or 2 and Enter: which of the two strokes was rougher? Guess if you are not sure.")?;
    }
    while let Some(level_db) = staircase.next_level_db() {
        let trial = staircase.progress().0;
        let is_second = random.next_u64() >> 63 == 1;
        let feed = Feed::of(samples(&protocol, level_db, is_second), protocol.sample_hz());
        player.stream(feed)?;
        print(format_args!("  {}: ", title(&staircase)))?;
        guide(&mut player, interrupt)?;
        let is_right = match &mut answering {
            Answering::Person(answers) => ask(&mut player, interrupt, answers, &staircase)? == is_second,
            Answering::Observer(observer) => {
                let is_right = observer.answers_rightly(level_db);
                print_line(if is_right == is_second { "2" } else { "1" })?;
                is_right
            }
        };
        staircase.answer(level_db, is_right);
        recorded.add(Answer { trial, highest_v_rms, level_db, is_right, observer: args.observer })?;
    }
    player.stop()?;
    Ok((staircase.threshold().map_err(NoThreshold)?, protocol))
}

fn no_answer(trial: usize) -> anyhow::Error {
    anyhow!("the answers ended at trial {trial}: answer each trial with 1 or 2 and Enter")
}

/// Who answers.
enum Answering {
    Person(Receiver<String>),
    Observer(Observer),
}

impl Answering {
    fn new(observer: Option<u64>) -> Self {
        observer.map_or_else(|| Self::Person(answers()), |seed| Self::Observer(Observer::drawn(seed)))
    }
}

/// The next trial, in words.
fn title(staircase: &Staircase) -> String {
    match staircase.progress() {
        (trial, trials) if trial > trials => format!("check {}", trial - trials),
        (trial, trials) => format!("trial {trial} of {trials}"),
    }
}

/// Waits for a person's answer to the next trial: whether it was the second stroke.
fn ask<L: RecordedLink>(
    player: &mut Player<L>,
    interrupt: &Interrupt,
    answers: &Receiver<String>,
    staircase: &Staircase,
) -> Result<bool> {
    let trial = staircase.progress().0;
    let mut wrong = 0;
    loop {
        match answers.recv_timeout(ANSWER_POLL) {
            Ok(line) if line.trim() == "1" => return Ok(false),
            Ok(line) if line.trim() == "2" => return Ok(true),
            Ok(_) if wrong + 1 == WRONG_ANSWERS_MAX => {
                player.stop()?;
                bail!(
                    "{WRONG_ANSWERS_MAX} answers to trial {trial} were neither 1 nor 2: answer each trial with 1 or 2 \
                     and Enter"
                );
            }
            Ok(_) => {
                wrong += 1;
                print(format_args!("  {}, 1 or 2? ", title(staircase)))?;
                wait(player, interrupt, 0.0)?;
            }
            // A board whose host is silent disarms itself: serve it while the person thinks.
            Err(RecvTimeoutError::Timeout) => wait(player, interrupt, 0.0)?,
            Err(RecvTimeoutError::Disconnected) => return Err(no_answer(trial)),
        }
    }
}

/// Plays the two strokes of a trial, and shows their pace: an arrow for each part of the way.
fn guide<L: RecordedLink>(player: &mut Player<L>, interrupt: &Interrupt) -> Result<()> {
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
fn wait<L: RecordedLink>(player: &mut Player<L>, interrupt: &Interrupt, seconds: f64) -> Result<()> {
    let mut left = Duration::from_secs_f64(seconds);
    loop {
        if interrupt.is_requested() {
            player.stop()?;
            bail!("the run was interrupted: start it again");
        }
        left = left.saturating_sub(player.step(left)?);
        if left.is_zero() {
            return Ok(());
        }
    }
}
