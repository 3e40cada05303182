//! `frixel check`: prints what is felt of a scene, and what it costs.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use frixel_felt::check::{SceneCheck, feel};
use frixel_felt::judge::{Advice, weber_steps, weber_steps_text};
use frixel_hil_sim::{Board, RigConfig, WorldOptions};
use frixel_layers::Header;
use frixel_play::{TO_THE_END, board_costs, judge};
use frixel_scene::{Program, Scene, compile, compile_draft, printable};

use super::argument;
use super::error::of_simulation;
use super::profiles::{ProfileArgs, TouchArgs};
use super::real_board::{behind, until_measured};
use super::terminal::{print, print_line};

#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    /// The scene, a TOML file (docs/design/scenes.md).
    scene: PathBuf,
    #[command(flatten)]
    profiles: ProfileArgs,
    #[command(flatten)]
    touch: TouchArgs,
    /// Check for a real board: what it refuses, and what is felt within its limits. Default: the simulated board, which
    /// has no touch bound.
    #[arg(long, value_name = "NAME", value_parser = argument::board())]
    board: Option<Board>,
    /// Series resistance in place of that board's, kOhm; voltages go up to its touch bound (`frixel board safety`).
    #[arg(long, value_name = "KOHM", requires = "board", value_parser = argument::positive, allow_negative_numbers = true)]
    series_kohm: Option<f64>,
    /// Also print the bytes and cycles behind *fits*.
    #[arg(long)]
    cost: bool,
    /// Also report the smallest firmware build that plays the scene.
    #[arg(long)]
    image: bool,
    /// Print one JSON object in place of the summary; for a scene with mistakes, it lists them.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &CheckArgs) -> Result<()> {
    let board = args.board.map(|board| behind(board, args.series_kohm)).transpose()?;
    let rig = RigConfig::of(board.unwrap_or(Board::SIMULATOR));
    let world = WorldOptions { touch: args.touch.source()?, ..WorldOptions::default() };
    let (scene, files) = args.profiles.names().load_with_files(&args.scene);
    let compiled = scene.and_then(|scene| {
        compile(&scene, &rig.board.limits, rig.board.tick_hz).map_err(|error| {
            if board.is_some() && !args.json {
                // Printed in addition to the refusal, if a draft compiles.
                let _ = print_draft(&scene, &rig, &world);
            }
            error.into()
        })
    });
    let program = match compiled {
        Err(error) if args.json => {
            print_line(error.to_json())?;
            return Err(error.into());
        }
        compiled => compiled?,
    };
    let judgement = judge(&program, &rig, &world, Advice::Sought, TO_THE_END);
    let judgement = judgement.map_err(of_simulation)?;
    let costs = board_costs(&program, &rig).map_err(of_simulation)?;
    let mut check = SceneCheck::of(&program, &rig.board.limits, &costs, judgement);
    check.notes.extend(files.outside().map(|path| {
        let path = printable(&path.display().to_string()).into_owned();
        format!("{path} is outside the scene's folder: give it along with the scene")
    }));
    let mut check = if args.image { check.with_board(&program, rig.board.kind) } else { check };
    let board_lines = board.map(|board| board_line(&board, &program, verdict(&board, &program))).unwrap_or_default();
    if args.json {
        let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
        check.notes.extend(board_lines.lines().map(words));
        return print_line(check.to_json());
    }
    print(board_lines)?;
    print(check.summary(args.cost))
}

/// The board's answer to a program within its limits.
fn verdict(board: &Board, program: &Program) -> &'static str {
    let allowed_v_peak = board.until_measured_v_peak().unwrap_or(f32::INFINITY);
    if program.header.voltage_max_v_peak > allowed_v_peak {
        "accepts it once limits are stored, and refuses it until then"
    } else {
        "accepts it"
    }
}

/// Prints what is felt of a scene that a board refuses, clamped to the board's limits.
fn print_draft(scene: &Scene, rig: &RigConfig, world: &WorldOptions) -> Result<()> {
    let draft = compile_draft(scene, &rig.board.limits, rig.board.tick_hz)?;
    let judgement = judge(&draft, rig, world, Advice::Omitted, TO_THE_END);
    let felt = feel::text(&feel::lines(&judgement.map_err(of_simulation)?));
    print(board_line(&rig.board, &draft, "refuses it; the results below are clamped to its limits") + &felt)
}

/// The board, its voltage at the scene's carrier, and the friction of the scene's finger at that voltage.
fn board_line(board: &Board, program: &Program, verdict: &str) -> String {
    let Header { voltage_max_v_peak, voltage_max_v_rms, carrier_hz, .. } = program.header;
    let until_measured = until_measured(board)
        .map_or_else(String::new, |said| format!("                   verdicts are for that voltage; {said}\n"));
    format!(
        "  board            {} behind {} kOhm {verdict}\n  voltage          {voltage_max_v_peak:.1} V peak, \
         {voltage_max_v_rms:.1} V rms at {carrier_hz:.0} Hz: up to {:.1} mN above natural, {} Weber steps\n{until_measured}",
        board.kind,
        (1e-3 * board.limits.series_resistance_ohm).round(),
        1e3 * program.reach.electric_friction_max_n,
        weber_steps_text(weber_steps(program.reach.natural_friction_n, program.reach.friction_max_n())),
    )
}
