//! `frixel calibrate`: records the data that `frixel fit` needs.

mod forces;

use std::io::Write;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use frixel::output_file::{FileWriter, Inputs, Recording};
use frixel::player::player;
use frixel::rigs::{RecordedLink, SimStream};
use frixel_driver::{Device, PollingLink};
use frixel_felt::recorder::{FeltRow, Recorder};
use frixel_hil_sim::{BoardMemory, FingertipConfig, Person, Rig, RigConfig};
use frixel_lab::calibration::{
    BoardRow, CalibrationError, ForceRow, ForceSensor, Protocol, align, read_board, read_forces, write_board, write_csv,
};
use frixel_model::{Contact, Finger, LoadedContact};
use frixel_play::{Feed, Player};
use frixel_scene::{Elasticity, FingerProfile, Program, Scene, compile};
use frixel_wire::hello::BoardLimits;
use indicatif::{ProgressBar, ProgressStyle};

use super::error::CommandError;
use super::experiment;
use super::fit::screen;
use super::interrupt::Interrupt;
use super::terminal::{note, say};
use super::waiting;

/// Rows a second of the recording.
const ROW_HZ: u32 = 1_000;
/// Time after the run in which forces on standard input may still come, behind the sensor's own buffers.
const FORCES_LATE: Duration = Duration::from_millis(500);
/// How to keep what a board reported until the recording was cut off.
const CUT_OFF: &str = "add --finish, and the --forces of that run unless they came on standard input, to keep it";

#[derive(Debug, Args)]
pub(super) struct CalibrateArgs {
    /// `sim` for the simulator in this process, or the path of a board's serial port.
    #[arg(long, default_value = "sim")]
    port: String,
    /// The recording, for `frixel fit`. Until the end, what a board reports is in a file of the same name and
    /// `.partial`.
    #[arg(short, long, value_name = "DATA.csv")]
    output: PathBuf,
    /// Replace an earlier recording.
    #[arg(long)]
    overwrite: bool,
    /// Play nothing, and join the strokes of a recording that was cut off with their forces.
    #[arg(long)]
    finish: bool,
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
    let inputs = Inputs::new(&args.forces);
    let recording = Recording::new(&args.output, "-o", &inputs, args.overwrite, CUT_OFF)?;
    if args.finish {
        return finish(args, &recording).map_err(|error| experiment::cut_off(&recording, error));
    }
    let interrupt = Interrupt::watch()?;
    // A pipe is opened once.
    let partial = recording.output().is_file().then(|| recording.start()).transpose()?;
    // A file of forces that is missing, or of something else, is found before the run, not after it.
    if let Some(path) = args.forces.as_deref().filter(|path| *path != Path::new("-")) {
        forces::read(path)?;
    }
    let recorded = if args.port == "sim" {
        on_simulator(args, &recording, &interrupt)
    } else {
        on_port(args, &recording, &interrupt, partial)
    };
    let written = recorded.and_then(|(board, forces)| write(args, &recording, &board, &forces));
    written.map_err(|error| experiment::cut_off(&recording, error))
}

/// Makes the recording of what one that was cut off has left.
fn finish(args: &CalibrateArgs, recording: &Recording) -> Result<(), CommandError> {
    let (_partial, text) = recording.resume()?;
    let board = read_board(text.as_bytes())?;
    let copied = forces::copy(args)?.partial();
    let forces = forces::read(args.forces.as_deref().unwrap_or(&copied))?;
    write(args, recording, &board, &forces)
}

/// Joins what board and sensor saw, and writes it.
fn write(
    args: &CalibrateArgs,
    recording: &Recording,
    board: &[BoardRow],
    forces: &[ForceRow],
) -> Result<(), CommandError> {
    let rows = align(board, forces)?;
    let (output, mut bytes) = (recording.output(), Vec::new());
    write_csv(&mut bytes, &rows)?;
    output.write(&bytes)?;
    recording.discard_partial();
    forces::copy(args)?.discard_partial();
    let path = output.path().display();
    say(output, format_args!("  {:<16} {path}", "wrote"))?;
    let highest = rows.iter().map(|row| row.voltage_v_rms).fold(0.0, f64::max);
    let voltage = if highest < 145.0 { format!(" --voltage {highest:.0}") } else { String::new() };
    say(output, format_args!("  {:<16} frixel fit {path}{voltage} -o finger.toml", "next"))
}

type Recorded = (Vec<BoardRow>, Vec<ForceRow>);

fn on_simulator(args: &CalibrateArgs, recording: &Recording, interrupt: &Interrupt) -> Result<Recorded, CommandError> {
    let (contact, fingertip) = simulated_finger(args.finger_seed)?;
    let rig = RigConfig::default();
    let mut config = RigConfig { world: rig.world.realistic(), ..rig };
    config.world.fingertip = fingertip;
    let plan = Plan::new(args, recording, &config.board.limits, config.board.tick_hz)?;
    let stroke = plan.protocol.stroke().map_err(CommandError::GeneratedStroke)?;
    let mut memory = BoardMemory::new();
    let mut rig = Rig::new(&mut memory, &config, stroke, args.seed)?;
    rig.world_mut().set_own_finger(contact);
    let mut sensor = ForceSensor::new(ROW_HZ, config.board.tick_hz);
    let line = SimStream::new(rig, Recorder::idle()).observed(|record| sensor.measure(record));
    let mut player = plan.start(Device::connect(PollingLink::new(line))?, 0)?;
    // What is simulated needs no file until it is whole.
    let board = plan.play(&mut player, interrupt, Duration::MAX, &mut std::io::sink())?;
    drop(player);
    let forces = match &args.forces {
        Some(path) => forces::read(path)?,
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
        Elasticity::Soft { .. } => frixel_lab::fit::CONVENTIONAL_STIFFNESS_PA_PER_M,
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

fn on_port(
    args: &CalibrateArgs,
    recording: &Recording,
    interrupt: &Interrupt,
    mut partial: Option<FileWriter>,
) -> Result<Recorded, CommandError> {
    let Some(forces) = &args.forces else { return Err(CommandError::NoForces { port: args.port.clone() }) };
    if args.finger_seed.is_some() {
        return Err(CommandError::FingerOnBoard { port: args.port.clone() });
    }
    let device = experiment::connect(&args.port, args.arm)?;
    let hello = *device.hello();
    let plan = Plan::new(args, recording, &hello.limits, hello.tick_hz)?;
    let from_stdin = if forces == Path::new("-") {
        // What goes to a stream has no copies.
        let copy = partial.is_some().then(|| forces::copy(args)?.start()).transpose()?;
        Some(forces::StandardInput::read(copy))
    } else {
        None
    };
    let mut player = plan.start(waiting::watch(device, interrupt), hello.tick_hz / ROW_HZ)?;
    let duration = Duration::from_secs_f64(plan.protocol.duration_s());
    let board = match &mut partial {
        Some(partial) => plan.play(&mut player, interrupt, duration, partial)?,
        None => plan.play(&mut player, interrupt, duration, &mut std::io::sink())?,
    };
    drop(partial);
    let forces = match from_stdin {
        Some(input) => read_forces(input.after(FORCES_LATE).as_slice())?,
        None => forces::read(forces)?,
    };
    Ok((board, forces))
}

/// A protocol that is ready to play on a board.
struct Plan {
    protocol: Protocol,
    program: Program,
    limits: BoardLimits,
    tick_hz: u32,
}

impl Plan {
    fn new(
        args: &CalibrateArgs,
        recording: &Recording,
        limits: &BoardLimits,
        tick_hz: u32,
    ) -> Result<Self, CommandError> {
        let voltage_max_v_rms = experiment::highest_voltage(args.voltage, limits)?;
        let protocol = Protocol { strokes: args.strokes.into(), ..Protocol::new(voltage_max_v_rms, args.seed) };
        for line in protocol.words().lines() {
            say(recording.output(), format_args!("  {:<16} {line}", "plan"))?;
        }
        let scene = protocol.scene().map_err(CommandError::Finger)?;
        let scene = Scene::parse(&scene, "calibration", &std::collections::BTreeMap::new())?;
        Ok(Self { program: compile(&scene, limits, tick_hz)?, protocol, limits: *limits, tick_hz })
    }

    /// Starts to play the protocol.
    fn start<L: RecordedLink>(&self, device: Device<L>, telemetry_ticks: u32) -> Result<Player<L>, CommandError> {
        let ticks = (self.protocol.duration_s() * f64::from(self.tick_hz)) as u64;
        let recorder = Recorder::new(&self.program, &self.limits, self.tick_hz, ticks, self.tick_hz / ROW_HZ);
        let mut player = player(device, recorder.map_err(CommandError::Finger)?);
        player
            .start(self.program.clone(), telemetry_ticks, &mut |_| ControlFlow::Continue(()))
            .map_err(CommandError::Play)?;
        let samples = self.protocol.samples().map_err(CommandError::Finger)?;
        player.stream(Feed::of(samples, self.protocol.sample_hz())).map_err(CommandError::Play)?;
        Ok(player)
    }

    /// Plays to the end, and returns what the board reported, which is written to `partial` in the meantime.
    fn play<L: RecordedLink>(
        &self,
        player: &mut Player<L>,
        interrupt: &Interrupt,
        time_max: Duration,
        partial: &mut dyn Write,
    ) -> Result<Vec<BoardRow>, CommandError> {
        let mut rows = Vec::new();
        write_board(&mut *partial, None)?;
        let bar = ProgressBar::new(self.protocol.strokes as u64);
        let style = ProgressStyle::with_template("  stroke {pos} of {len}: {msg}  {bar:30}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        let mut left = time_max;
        while !left.is_zero() && player.recorder_mut().ticks_left() > 0 {
            if interrupt.is_requested() {
                player.stop()?;
                return Err(CommandError::ExperimentInterrupted);
            }
            let stepped = player.step(left);
            let seen = rows.len();
            rows.extend(board_rows(player));
            write_board(&mut *partial, rows.get(seen..))?;
            left = left.saturating_sub(stepped.map_err(CommandError::Play)?);
            let stroke = (player.recorder_mut().t_s() / (self.protocol.stroke_s + self.protocol.pause_s)) as u64;
            bar.set_position((stroke + 1).min(self.protocol.strokes as u64));
            bar.set_message(if stroke.is_multiple_of(2) { "to the right" } else { "to the left" });
        }
        player.stop()?;
        bar.finish_and_clear();
        let stream = player.device().stream_status();
        if let Some(status) = stream.filter(|status| status.underruns > 0) {
            note(format_args!(
                "the board ran out of samples {} times; its output was zero meanwhile",
                status.underruns
            ));
        }
        rows.extend(board_rows(player));
        Ok(rows)
    }
}

/// What the board has reported since the last call.
fn board_rows<L: RecordedLink>(player: &mut Player<L>) -> impl Iterator<Item = BoardRow> {
    let row = |row: FeltRow| {
        let (time_s, speed_mm_s) = (row.t_s, row.speed_mm_s.unwrap_or(0.0));
        Some(BoardRow { time_s, voltage_v_rms: row.voltage_v_rms?, speed_mm_s })
    };
    player.recorder_mut().take_rows().into_iter().filter_map(row)
}

impl From<CalibrationError> for CommandError {
    fn from(error: CalibrationError) -> Self {
        Self::Calibration(error)
    }
}
