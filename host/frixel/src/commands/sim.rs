//! `frixel sim`.

use std::path::Path;

use super::error::{of_finger, of_generated_stroke};
use crate::rigs::{Dropped, Server};
use crate::scene_file::ProfileNames;
use anyhow::Result;
use frixel_files::Inputs;
use frixel_hil_sim::{Board, BoardMemory, FingertipConfig, OwnFinger, Person, Rig, RigConfig, WorldOptions};
use frixel_lab::simulate::{BUNDLED_SCREEN_M, REPEAT_PAUSE_S, endless_sweep};

use super::SimArgs;
use super::interrupt::Interrupt;
use super::profiles::screen;
use super::stroke::note_off_screen;
use super::terminal::{note, print_line};

/// Rows per second in felt.csv.
const ROWS_HZ: u32 = 1000;

pub(super) fn run(args: &SimArgs) -> Result<()> {
    let interrupt = Interrupt::watch()?;
    let screen_m = match args.screen.as_deref() {
        Some(name) => {
            let screen = screen(Some(name))?.1;
            [screen.width_mm, screen.height_mm].map(|side_mm| 1e-3 * side_mm)
        }
        None => BUNDLED_SCREEN_M,
    };
    let stroke = match args.stroke.stroke(screen_m, None, args.seed)? {
        Some(stroke) => stroke.looped(REPEAT_PAUSE_S),
        None => endless_sweep(screen_m),
    };
    let stroke = stroke.map_err(of_generated_stroke)?;
    if args.stroke.is_given() {
        // The scene that will play may be made for a larger screen.
        if let Err(error) = note_off_screen(&args.stroke.name(), &stroke, screen_m, stroke.duration_s()) {
            note(format_args!("warning: {error}"));
        }
    }
    let finger = own_finger(args)?;
    let config = RigConfig::default().with(&WorldOptions { finger, ..args.touch.world(args.ideal)? });
    let mut memory = BoardMemory::new();
    let mut rig = Rig::new(&mut memory, &config, stroke, args.seed)?;
    let tick_hz = config.board.tick_hz;
    let profiles = [&args.finger, &args.screen].into_iter().flatten().map(Path::new);
    let inputs = Inputs::new(args.stroke.file().into_iter().chain(profiles).chain(args.touch.file()));
    let server = Server::open(&args.out, &inputs, tick_hz, tick_hz / ROWS_HZ)?;
    print_line(format_args!("port: {}", server.path()))?;
    let path = server.path();
    note(format_args!("a virtual board runs until Ctrl-C; in another terminal: frixel play SCENE --port {path}"));
    let dropped = server.run(&mut rig, &|| interrupt.goes_on())?;
    if dropped.times > 0 {
        let Dropped { seconds, times } = dropped;
        note(format_args!(
            "this machine was too busy {times} times: {seconds:.3} s were dropped in all, in which board and finger stood \
             still (`time-dropped` in events.csv)"
        ));
    }
    note(format_args!("wrote {0}/felt.csv, {0}/forces.csv and {0}/events.csv", args.out.display()));
    Ok(())
}

/// The finger that stays whatever scene plays, if there is one.
fn own_finger(args: &SimArgs) -> Result<Option<OwnFinger>> {
    if let Some(seed) = args.finger_seed {
        let coating_gap_m = screen(args.screen.as_deref())?.1.coating_gap_m();
        return Person::drawn(seed).own_finger(coating_gap_m).map(Some).map_err(of_finger);
    }
    let Some(finger) = &args.finger else { return Ok(None) };
    let names = ProfileNames { finger: Some(finger.clone()), screen: args.screen.clone() };
    let program = names.without_scene(&Board::SIMULATOR.limits, Board::SIMULATOR.tick_hz)?;
    let law = program.header.friction_law().map_err(of_finger)?;
    Ok(Some(OwnFinger { law, fingertip: FingertipConfig::REALISTIC }))
}
