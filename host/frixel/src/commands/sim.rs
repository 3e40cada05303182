//! `frixel sim`.

use frixel::rigs::Server;
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke};

use super::SimArgs;
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::terminal::{note, print_line};

/// Size of the screen that the generated stroke covers: that of the bundled scenes.
const SCREEN_WIDTH_M: f64 = 0.12;
const SCREEN_HEIGHT_M: f64 = 0.11;
/// Duration of the generated stroke, s.
const STROKE_S: f64 = 3.0;
/// Time for which the finger is lifted before it repeats its stroke.
const PAUSE_S: f64 = 0.2;
/// Rows per second in felt.csv.
const ROWS_HZ: u32 = 1000;

pub(super) fn run(args: &SimArgs) -> Result<(), CommandError> {
    let interrupt = Interrupt::watch()?;
    let stroke = match args.stroke.stroke([SCREEN_WIDTH_M, SCREEN_HEIGHT_M], None, args.seed)? {
        Some(stroke) => stroke,
        None => Stroke::natural(SCREEN_WIDTH_M, SCREEN_HEIGHT_M, STROKE_S).map_err(CommandError::NaturalStroke)?,
    };
    let stroke = stroke.looped(PAUSE_S).map_err(CommandError::NaturalStroke)?;
    let config = RigConfig::default();
    let mut memory = BoardMemory::new();
    let mut rig = Rig::new(&mut memory, &config, stroke, args.seed)?;
    let tick_hz = config.board.tick_hz;
    let server = Server::open(&args.out, tick_hz, tick_hz / ROWS_HZ)?;
    print_line(format_args!("port: {}", server.path()))?;
    let path = server.path();
    note(format_args!("a virtual board is there until Ctrl-C; in another terminal: frixel play SCENE --port {path}"));
    server.run(&mut rig, &|| interrupt.is_requested())?;
    note(format_args!("wrote {0}/felt.csv, {0}/forces.csv and {0}/events.csv", args.out.display()));
    Ok(())
}
