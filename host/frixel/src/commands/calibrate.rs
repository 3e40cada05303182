//! `frixel calibrate`: records the data that `frixel fit` needs.

use std::fs::File;
use std::io::{BufReader, Read, stdin};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use clap::Args;
use frixel::calibration::{BoardRow, CalibrationError, ForceRow, Protocol, align, read_forces, write_csv};
use frixel::input::{self, Bounded};
use frixel::player::Player;
use frixel::rigs::{ForceSensor, RecordedLink, SimLink};
use frixel::stream::Feed;
use frixel_driver::Device;
use frixel_hil_sim::{BoardMemory, FingertipConfig, Person, Rig, RigConfig, Stroke};
use frixel_model::{Contact, Finger, LoadedContact};
use frixel_scene::recorder::Recorder;
use frixel_scene::{Elasticity, FingerProfile, Program, Scene, compile};
use frixel_wire::hello::BoardLimits;
use indicatif::{ProgressBar, ProgressStyle};

use super::error::CommandError;
use super::experiment;
use super::fit::screen;
use super::interrupt::Interrupt;
use super::terminal::{note, print_line};
use super::waiting;

/// Rows a second of the recording.
const ROW_HZ: u32 = 1_000;
/// Time after the run in which forces on standard input may still come, behind the sensor's own buffers.
const FORCES_LATE: Duration = Duration::from_millis(500);

#[derive(Debug, Args)]
pub(super) struct CalibrateArgs {
    /// `sim` for the simulator in this process, or the path of a board's serial port.
    #[arg(long, default_value = "sim")]
    port: String,
    /// The recording, for `frixel fit`.
    #[arg(short, long, value_name = "DATA.csv")]
    output: PathBuf,
    /// Forces of a sensor during the run: CSV with the columns `time_s,normal_force_n,friction_n`, on any clock; `-`
    /// for standard input. A file is there when the run begins, and is read when it is over. The simulator has a sensor
    /// of its own, and `frixel sim` writes what one under its screen measures, forces.csv.
    #[arg(long, value_name = "FILE.csv")]
    forces: Option<PathBuf>,
    /// Highest voltage, in volts rms, at most 150. Without it, 150 or what the board allows.
    #[arg(long, value_name = "V_RMS", value_parser = experiment::voltage)]
    voltage: Option<f64>,
    /// Number of strokes, 8 to 360. Each takes 1.8 s; the interval narrows with the root of their number.
    #[arg(long, value_name = "N", default_value_t = 36, value_parser = clap::value_parser!(u16).range(8..=360))]
    strokes: u16,
    /// Simulated person: another one for each seed. Without it, the example finger.
    #[arg(long, value_name = "N")]
    finger_seed: Option<u64>,
    /// Seed of the half-periods, and of all that is random in the simulator.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Let a board that is not a simulator drive its electrode.
    #[arg(long)]
    arm: bool,
}

pub(super) fn run(args: &CalibrateArgs) -> Result<(), CommandError> {
    let interrupt = Interrupt::watch()?;
    experiment::check_writable(&args.output)?;
    // A file of forces that is missing, or of something else, is found before the run, not after it.
    if let Some(path) = args.forces.as_deref().filter(|path| *path != Path::new("-")) {
        read(path)?;
    }
    let (board, forces) = if args.port == "sim" { on_simulator(args, &interrupt)? } else { on_port(args, &interrupt)? };
    let rows = align(&board, &forces)?;
    let file = File::create(&args.output).map_err(CommandError::writing(&args.output))?;
    write_csv(file, &rows)?;
    let path = args.output.display();
    print_line(format_args!("  {:<16} {path}", "wrote"))?;
    let highest = rows.iter().map(|row| row.voltage_v_rms).fold(0.0, f64::max);
    let voltage = if highest < 145.0 { format!(" --voltage {highest:.0}") } else { String::new() };
    print_line(format_args!("  {:<16} frixel fit {path}{voltage} -o finger.toml", "next"))
}

type Recorded = (Vec<BoardRow>, Vec<ForceRow>);

fn on_simulator(args: &CalibrateArgs, interrupt: &Interrupt) -> Result<Recorded, CommandError> {
    let (contact, fingertip) = simulated_finger(args.finger_seed)?;
    let rig = RigConfig::default();
    let mut config = RigConfig { world: rig.world.realistic(), ..rig };
    config.world.fingertip = fingertip;
    let plan = Plan::new(args, &config.board.limits, config.board.tick_hz)?;
    let stroke = Stroke::from_csv(&plan.protocol.stroke_csv()).map_err(CommandError::GeneratedStroke)?;
    let mut memory = BoardMemory::new();
    let mut rig = Rig::new(&mut memory, &config, stroke, args.seed)?;
    rig.world_mut().set_own_finger(contact);
    let mut sensor = ForceSensor::new(ROW_HZ, config.board.tick_hz);
    let link = SimLink::new(rig, Recorder::idle()).observed(|record| sensor.measure(record));
    let mut player = plan.start(Device::connect(link)?, 0)?;
    let board = plan.play(&mut player, interrupt, Duration::MAX)?;
    drop(player);
    let forces = match &args.forces {
        Some(path) => read(path)?,
        None => sensor.rows().to_vec(),
    };
    Ok((board, forces))
}

/// The finger under the simulated board: its contact on the example screen, and what it does beside the model.
fn simulated_finger(seed: Option<u64>) -> Result<(LoadedContact<f64>, FingertipConfig), CommandError> {
    let coating_gap_m = 1e-6 * screen(None)?.1.coating_gap_um();
    if let Some(seed) = seed {
        let person = Person::drawn(seed);
        let contact = person.contact(coating_gap_m).map_err(CommandError::Finger)?;
        return Ok((contact, person.fingertip));
    }
    let example = FingerProfile::example();
    let stiffness_pa_per_m = match example.elasticity {
        Elasticity::WinklerFuss { stiffness_pa_per_m } => stiffness_pa_per_m,
        Elasticity::Soft { .. } => frixel::fit::CONVENTIONAL_STIFFNESS_PA_PER_M,
    };
    let finger = Finger {
        radius_m: 1e-3 * example.radius_mm,
        stiffness_pa_per_m,
        friction_coefficient: example.friction_coefficient,
    };
    let contact = Contact::new(&finger, coating_gap_m + 1e-6 * example.skin_gap_um);
    let contact = contact.and_then(|contact| contact.under_load(example.normal_load_n));
    Ok((contact.map_err(CommandError::Finger)?, FingertipConfig::REALISTIC))
}

fn on_port(args: &CalibrateArgs, interrupt: &Interrupt) -> Result<Recorded, CommandError> {
    let Some(forces) = &args.forces else { return Err(CommandError::NoForces { port: args.port.clone() }) };
    if args.finger_seed.is_some() {
        return Err(CommandError::FingerOnBoard { port: args.port.clone() });
    }
    let device = experiment::connect(&args.port, args.arm)?;
    let hello = *device.hello();
    let plan = Plan::new(args, &hello.limits, hello.tick_hz)?;
    let from_stdin = (forces == Path::new("-")).then(StandardInput::read);
    let mut player = plan.start(waiting::watch(device, interrupt), hello.tick_hz / ROW_HZ)?;
    let board = plan.play(&mut player, interrupt, Duration::from_secs_f64(plan.protocol.duration_s()))?;
    let forces = match from_stdin {
        Some(input) => read_forces(input.after(FORCES_LATE).as_slice())?,
        None => read(forces)?,
    };
    Ok((board, forces))
}

/// Standard input, which is read while the board plays, so that its writer does not block.
struct StandardInput {
    reader: JoinHandle<()>,
    bytes: Arc<Mutex<Vec<u8>>>,
}

impl StandardInput {
    fn read() -> Self {
        let bytes = Arc::new(Mutex::new(Vec::new()));
        let shared = Arc::clone(&bytes);
        let reader = thread::spawn(move || {
            let mut input = Bounded::new(stdin(), input::CSV_MAX_BYTES);
            let mut chunk = [0; 4096];
            // A pipe that breaks has ended, and so has one that goes on beyond the limit.
            while let Ok(count @ 1..) = input.read(&mut chunk) {
                let mut bytes = shared.lock().unwrap_or_else(PoisonError::into_inner);
                bytes.extend_from_slice(chunk.get(..count).unwrap_or_default());
            }
        });
        Self { reader, bytes }
    }

    /// What has come when the input ends, or when this time has passed: a sensor may go on measuring.
    fn after(&self, time_max: Duration) -> Vec<u8> {
        let begun = Instant::now();
        while !self.reader.is_finished() && begun.elapsed() < time_max {
            thread::sleep(Duration::from_millis(5));
        }
        std::mem::take(&mut self.bytes.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

fn read(path: &Path) -> Result<Vec<ForceRow>, CommandError> {
    let rows = if path == Path::new("-") {
        read_forces(Bounded::new(stdin(), input::CSV_MAX_BYTES))
    } else {
        read_forces(BufReader::new(input::open(path, input::CSV_MAX_BYTES).map_err(CommandError::reading(path))?))
    };
    rows.map_err(|source| CommandError::Forces { path: path.to_owned(), source })
}

/// A protocol that is ready to play on a board.
struct Plan {
    protocol: Protocol,
    program: Program,
    limits: BoardLimits,
    tick_hz: u32,
}

impl Plan {
    fn new(args: &CalibrateArgs, limits: &BoardLimits, tick_hz: u32) -> Result<Self, CommandError> {
        let voltage_max_v_rms = experiment::highest_voltage(args.voltage, limits)?;
        let protocol = Protocol { strokes: args.strokes.into(), ..Protocol::new(voltage_max_v_rms, args.seed) };
        for line in protocol.words().lines() {
            print_line(format_args!("  {:<16} {line}", "plan"))?;
        }
        let scene = protocol.scene().map_err(CommandError::Finger)?;
        let scene = Scene::parse(&scene, "calibration", &std::collections::BTreeMap::new())?;
        Ok(Self { program: compile(&scene, limits, tick_hz)?, protocol, limits: *limits, tick_hz })
    }

    /// Starts to play the protocol.
    fn start<L: RecordedLink>(&self, device: Device<L>, telemetry_ticks: u32) -> Result<Player<L>, CommandError> {
        let ticks = (self.protocol.duration_s() * f64::from(self.tick_hz)) as u64;
        let recorder = Recorder::new(&self.program, &self.limits, self.tick_hz, ticks, self.tick_hz / ROW_HZ);
        let mut player = Player::new(device, recorder.map_err(CommandError::Finger)?);
        player.start(&self.program, telemetry_ticks, &mut |_| ControlFlow::Continue(())).map_err(CommandError::Play)?;
        let samples = self.protocol.samples().map_err(CommandError::Finger)?;
        player.stream(Feed::of(samples, self.protocol.sample_hz())).map_err(CommandError::Play)?;
        Ok(player)
    }

    /// Plays to the end, and returns what the board reported.
    fn play<L: RecordedLink>(
        &self,
        player: &mut Player<L>,
        interrupt: &Interrupt,
        time_max: Duration,
    ) -> Result<Vec<BoardRow>, CommandError> {
        let bar = ProgressBar::new(self.protocol.strokes as u64);
        let style = ProgressStyle::with_template("  stroke {pos} of {len}: {msg}  {bar:30}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        let mut left = time_max;
        while !left.is_zero() && player.recorder_mut().ticks_left() > 0 {
            if interrupt.is_requested() {
                player.stop().map_err(CommandError::Play)?;
                return Err(CommandError::ExperimentInterrupted);
            }
            left = left.saturating_sub(player.step(left).map_err(CommandError::Play)?);
            let stroke = (player.recorder_mut().t_s() / (self.protocol.stroke_s + self.protocol.pause_s)) as u64;
            bar.set_position((stroke + 1).min(self.protocol.strokes as u64));
            bar.set_message(if stroke.is_multiple_of(2) { "to the right" } else { "to the left" });
        }
        player.stop().map_err(CommandError::Play)?;
        bar.finish_and_clear();
        let stream = player.device().stream_status();
        if let Some(status) = stream.filter(|status| status.underruns > 0) {
            note(format_args!(
                "the board ran out of samples {} times; its output was zero meanwhile",
                status.underruns
            ));
        }
        let rows = player.recorder_mut().take_rows();
        Ok(rows
            .iter()
            .filter_map(|row| {
                Some(BoardRow {
                    time_s: row.t_s,
                    voltage_v_rms: row.voltage_v_rms?,
                    speed_mm_s: row.speed_mm_s.unwrap_or(0.0),
                })
            })
            .collect())
    }
}

impl From<CalibrationError> for CommandError {
    fn from(error: CalibrationError) -> Self {
        Self::Calibration(error)
    }
}
