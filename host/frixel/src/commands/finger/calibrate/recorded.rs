//! Board and sensor data of a calibration, on the simulator or on a board at a port.

use std::path::Path;
use std::time::Duration;

use anyhow::{Result, bail};
use frixel_driver::{Device, PollingLink};
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, WorldOptions};
use frixel_lab::calibration::{BoardRow, ForceRow, ForceSensor, read_forces, simulated_finger, simulation_seed};
use frixel_play::RigStream;
use frixel_wire::hello::Hello;

use super::plan::{Plan, ROW_HZ, row_ticks};
use super::{CUT_OFF, CalibrateArgs, forces};
use crate::commands::error::{of_finger, of_generated_stroke, reading};
use crate::commands::interrupt::Interrupt;
use crate::commands::port;
use crate::commands::profiles::screen;
use crate::commands::waiting;
use frixel_files::{FileWriter, OutputFile};

/// Time after the run for which late forces on standard input are awaited: the sensor may buffer them.
const FORCES_LATE: Duration = Duration::from_millis(500);

pub(super) type Recorded = (Vec<BoardRow>, Vec<ForceRow>);

/// Calibrates a simulated person: what the board reported, and what the sensor under the screen measured.
pub(super) fn on_simulator(args: &CalibrateArgs, recording: &OutputFile, interrupt: &Interrupt) -> Result<Recorded> {
    let coating_gap_m = screen(None)?.1.coating_gap_m();
    let finger = simulated_finger(args.finger_seed, coating_gap_m).map_err(of_finger)?;
    let config = RigConfig::default().with(&WorldOptions { finger: Some(finger), ..WorldOptions::default() });
    let plan = Plan::new(args, &config.board.limits, config.board.tick_hz)?;
    plan.say(recording)?;
    let stroke = plan.protocol.stroke().map_err(of_generated_stroke)?;
    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &config, stroke, simulation_seed(args.seed, args.finger_seed))?;
    let mut sensor = ForceSensor::new(ROW_HZ, config.board.tick_hz);
    let line = RigStream::new(Box::new(rig)).observed(|tick| sensor.measure(tick.tick, &tick.felt));
    let mut player = plan.start(Device::connect(PollingLink::new(line))?, 0)?;
    // A simulated recording is written when it is complete.
    let board = plan.play(&mut player, interrupt, Duration::MAX, &mut std::io::sink())?;
    drop(player);
    let forces = match &args.forces {
        Some(path) => forces::read(path)?,
        None => sensor.take_rows(),
    };
    Ok((board, forces))
}

pub(super) fn on_port(
    args: &CalibrateArgs,
    recording: &OutputFile,
    interrupt: &Interrupt,
    mut partial: Option<FileWriter>,
) -> Result<(Recorded, Hello)> {
    let port = &args.port;
    let Some(forces) = &args.forces else {
        bail!("a board at {port} measures no forces: give those of a sensor with --forces FILE.csv, or --forces -")
    };
    if args.finger_seed.is_some() {
        bail!(
            "--finger-seed draws the finger of --port sim only; the finger on {port} is its own: leave --finger-seed \
             out"
        );
    }
    let device = port::connect_to_play(&args.port, &["sim"], args.arm)?;
    let hello = *device.hello();
    let plan = Plan::new(args, &hello.limits, hello.tick_hz)?;
    plan.say(recording)?;
    let from_stdin = if forces == Path::new("-") {
        // A recording that goes to a stream has no partial file, and needs no copy.
        let copy = if partial.is_some() { Some(forces::copy(args)?.begin_recording(CUT_OFF)?) } else { None };
        Some(forces::StandardInput::read(copy))
    } else {
        None
    };
    let mut player = plan.start(waiting::watch(device, interrupt), row_ticks(hello.tick_hz))?;
    let duration = Duration::from_secs_f64(plan.protocol.duration_s());
    let board = match &mut partial {
        Some(partial) => plan.play(&mut player, interrupt, duration, partial)?,
        None => plan.play(&mut player, interrupt, duration, &mut std::io::sink())?,
    };
    drop(partial);
    let forces = match from_stdin {
        Some(input) => {
            let bytes = input.after(FORCES_LATE).map_err(reading(forces))?;
            forces::understood(forces, read_forces(bytes.as_slice())?)
        }
        None => forces::read(forces)?,
    };
    Ok(((board, forces), hello))
}
