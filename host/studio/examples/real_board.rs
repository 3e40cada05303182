//! A virtual board behind a pseudo-terminal that says it is a NUCLEO-G474RE with an electrode, for the browser tests.
//!
//! `real_board [BAUD]`, with the rate of its serial line in bits a second. It prints `port: PATH`, and then a line of
//! JSON whenever something of this changes: the board's state, its fault, whether it fell silent, whether it drives.
//! A line `fault` on standard input makes the amplifier report a fault for a moment. It ends with its standard input.

use std::error::Error;
use std::io::{self, BufRead};
use std::sync::mpsc::{self, TryRecvError};
use std::thread;
use std::time::{Duration, Instant};

use frixel_control::Board;
use frixel_hil_sim::{BoardMemory, PseudoTerminal, Rig, RigConfig, RigTick, Status, Stroke, WorldFault};
use frixel_wire::fault::Flags;
use frixel_wire::hello::{BoardKind, BoardLimits};
use serde_json::{Value, json};

/// Most virtual time between two exchanges with the terminal, ticks: 5 ms.
const BATCH_TICKS: u64 = 200;
/// A lag behind the clock that is not caught up, ticks: 50 ms.
const LAG_MAX_TICKS: u64 = 2_000;
/// The board's clock is so much slower than the machine's. A page or a worker that a busy machine holds up for less
/// than this many host timeouts is then no silence.
const SLOWNESS: f64 = 4.0;
/// Duration of a fault of the amplifier, ticks: 5 ms.
const FAULT_TICKS: u64 = 200;
/// Layers that the board takes: fewer than the simulator, so that it refuses a scene that the simulator plays.
const LAYERS_MAX: u8 = 3;
/// A voltage above this one is a drive, V.
const DRIVE_V: f32 = 1.0;

fn main() -> Result<(), Box<dyn Error>> {
    let default = RigConfig::default();
    let baud = std::env::args().nth(1).map_or(Ok(default.baud), |baud| baud.parse())?;
    let limits = BoardLimits { records_max: LAYERS_MAX, ..default.board.limits };
    let board = Board { kind: BoardKind::NucleoG474re, limits, ..default.board };
    let mut memory = BoardMemory::new();
    let stroke = Stroke::sweep(0.12, 0.11, 3.0)?.looped(0.2)?;
    let mut rig = Rig::new(&mut memory, &RigConfig { board, baud, ..default }, stroke, 1)?;
    let mut terminal = PseudoTerminal::open()?;
    println!("port: {}", terminal.path());
    rig.world_mut().start_stroke();

    let commands = commands();
    let (mut epoch, mut unwritten, mut reported) = (Instant::now(), Vec::new(), Value::Null);
    loop {
        match commands.try_recv() {
            Ok(command) if command == "fault" => {
                let now = rig.tick();
                rig.world_mut().schedule_fault(now..now + FAULT_TICKS, WorldFault::AmplifierNotReady)?;
            }
            Ok(command) => return Err(format!("unknown command `{command}`: write `fault`").into()),
            Err(TryRecvError::Disconnected) => return Ok(()),
            Err(TryRecvError::Empty) => {}
        }
        exchange(&mut terminal, &mut rig, &mut unwritten)?;
        let tick_hz = f64::from(rig.tick_hz());
        let mut behind = ((epoch.elapsed().as_secs_f64() * tick_hz / SLOWNESS) as u64).saturating_sub(rig.tick());
        if behind > LAG_MAX_TICKS {
            epoch += Duration::from_secs_f64(behind as f64 * SLOWNESS / tick_hz);
            behind = 0;
        }
        for _ in 0..behind.min(BATCH_TICKS) {
            let record = rig.step();
            let now = report(&record);
            if now != reported {
                println!("{}", json!({ "ms": record.tick * 1_000 / u64::from(rig.tick_hz()), "board": now }));
                reported = now;
            }
        }
        thread::sleep(Duration::from_millis(1));
    }
}

/// The lines of the standard input.
fn commands() -> mpsc::Receiver<String> {
    let (sender, commands) = mpsc::channel();
    thread::spawn(move || io::stdin().lock().lines().map_while(Result::ok).try_for_each(|line| sender.send(line)));
    commands
}

fn exchange(terminal: &mut PseudoTerminal, rig: &mut Rig, unwritten: &mut Vec<u8>) -> io::Result<()> {
    if terminal.client_has_gone()? {
        unwritten.clear();
    }
    let mut bytes = [0; 4096];
    let count = terminal.read(&mut bytes)?;
    rig.send(bytes.get(..count).unwrap_or_default());
    rig.receive(unwritten);
    let written = terminal.write(unwritten)?;
    unwritten.drain(..written);
    rig.set_host_away(!unwritten.is_empty());
    Ok(())
}

fn report(RigTick { status, .. }: &RigTick<Status>) -> Value {
    json!({
        "state": format!("{:?}", status.telemetry.state).to_lowercase(),
        "fault": status.fault.map(|(fault, _)| fault.to_string()),
        "isSilent": status.telemetry.flags.contains(Flags::HOST_SILENT),
        "isDriving": status.telemetry.voltage_v_rms > DRIVE_V,
    })
}
