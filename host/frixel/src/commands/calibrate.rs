//! `frixel calibrate`: records the data that `frixel fit` needs.

use std::fs::File;
use std::io::{BufReader, stdin};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

use clap::Args;
use frixel::calibration::{BoardRow, CalibrationError, ForceRow, Protocol, align, read_forces, write_csv};
use frixel::player::Player;
use frixel::rigs::{ForceSensor, PortLink, RecordedLink, SimLink};
use frixel::stream::Feed;
use frixel_driver::{DEFAULT_BAUD, Device, SerialLink};
use frixel_hil_sim::{BoardMemory, FingertipConfig, Person, Rig, RigConfig, Stroke};
use frixel_model::{Contact, Finger, LoadedContact};
use frixel_scene::recorder::Recorder;
use frixel_scene::{Elasticity, FingerProfile, Program, Scene, compile};
use frixel_wire::hello::BoardLimits;
use indicatif::{ProgressBar, ProgressStyle};

use super::error::CommandError;
use super::fit::screen;
use super::interrupt::Interrupt;
use super::terminal::{note, print_line};

/// Rows a second of the recording.
const ROW_HZ: u32 = 1_000;

#[derive(Debug, Args)]
pub(super) struct CalibrateArgs {
    /// `sim` for the simulator in this process, or the path of a board's serial port.
    #[arg(long, default_value = "sim")]
    port: String,
    /// The recording, for `frixel fit`.
    #[arg(short, long, value_name = "DATA.csv")]
    output: PathBuf,
    /// Forces of a sensor during the run: CSV with the columns `time_s,normal_force_n,friction_n`, on any clock; `-`
    /// for
    /// standard input. A file is read when the run is over. The simulator has a sensor of its own.
    #[arg(long, value_name = "FILE.csv")]
    forces: Option<PathBuf>,
    /// Highest voltage, in volts rms; at most 150, and at most what the board allows.
    #[arg(long, value_name = "V_RMS", default_value_t = 150.0, value_parser = super::argument::positive)]
    voltage: f64,
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
    let natural = RigConfig::default();
    let mut config = RigConfig { world: natural.world.natural(), ..natural };
    config.world.fingertip = fingertip;
    let plan = Plan::new(args, &config.board.limits, config.board.tick_hz)?;
    let stroke = Stroke::from_csv(&plan.protocol.stroke_csv()).map_err(CommandError::NaturalStroke)?;
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
    Ok((contact.map_err(CommandError::Finger)?, FingertipConfig::NATURAL))
}

fn on_port(args: &CalibrateArgs, interrupt: &Interrupt) -> Result<Recorded, CommandError> {
    let Some(forces) = &args.forces else { return Err(CommandError::NoForces { port: args.port.clone() }) };
    let device = Device::connect(PortLink::new(SerialLink::open(&args.port, DEFAULT_BAUD)?))?;
    let hello = *device.hello();
    if !(args.arm || hello.board.is_simulated()) {
        return Err(CommandError::NotArmed { port: args.port.clone() });
    }
    let plan = Plan::new(args, &hello.limits, hello.tick_hz)?;
    // Standard input is read while the board plays, so that its writer does not block.
    let from_stdin = (forces == Path::new("-")).then(|| thread::spawn(|| read_forces(stdin())));
    let mut player = plan.start(device, hello.tick_hz / ROW_HZ)?;
    let board = plan.play(&mut player, interrupt, Duration::from_secs_f64(plan.protocol.duration_s()))?;
    let forces = match from_stdin {
        // A reader that panicked has read nothing.
        Some(reader) => reader.join().unwrap_or_else(|_| Ok(Vec::new()))?,
        None => read(forces)?,
    };
    Ok((board, forces))
}

fn read(path: &Path) -> Result<Vec<ForceRow>, CommandError> {
    if path == Path::new("-") {
        return Ok(read_forces(stdin())?);
    }
    let file = File::open(path).map_err(CommandError::reading(path))?;
    Ok(read_forces(BufReader::new(file))?)
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
        // A square carrier's peak is its rms; its edges need a little more.
        let voltage_max_v_rms = args.voltage.min(0.99 * f64::from(limits.voltage_max_v_peak));
        let protocol = Protocol::new(voltage_max_v_rms, args.seed);
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
                return Err(CommandError::CalibrationInterrupted);
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
            note(format_args!("the board ran out of samples {} times; the drive rested then", status.underruns));
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
