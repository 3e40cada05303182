//! Mean felt friction under each carrier, with the table of the board and with one that ignores the carrier.

use std::collections::BTreeMap;

use frixel_chart::{Axis, Line, Look, Mark, PALETTE, Panel};
use frixel_hil_sim::RigConfig;
use frixel_lab::simulate::default_stroke;
use frixel_play::{Simulation, TO_THE_END, simulate};
use frixel_scene::{Program, Scene, compile_draft};

use super::ReportError;
use super::page::{Section, cell, row};

/// Carriers: the slowest, the default and the fastest of each waveform, in Hz.
const CARRIERS: [(&str, f64); 6] =
    [("square", 125.0), ("square", 1e3), ("square", 5e3), ("sine", 125.0), ("sine", 1e3), ("sine", 5e3)];
/// Electric friction as fractions of the reach.
const FRACTIONS: [f64; 5] = [0.02, 0.2, 0.5, 0.8, 0.99];
/// Ticks of a row: whole periods of every carrier in [`CARRIERS`].
const TICKS_PER_ROW: u32 = 320;
/// Duration of a play, s, and the rows at its end that are averaged: the envelope has settled.
const SECONDS: f64 = 0.5;
const ROWS: usize = 30;

/// Mean friction of a constant under a carrier.
struct Constant {
    commanded_n: f64,
    /// Felt over commanded friction, minus 1.
    error: f64,
    /// The same with a table that ignores the ripple of the carrier.
    uncorrected_error: f64,
}

impl Constant {
    fn of(waveform: &str, carrier_hz: f64, fraction: f64) -> Result<Self, ReportError> {
        let rig = RigConfig::default().for_drafts();
        let text = format!(
            "version = 1\ncarrier = {{ shape = \"{waveform}\", frequency_hz = {carrier_hz} }}\n\
             [[layer]]\nname = \"constant\"\nkind = \"constant\"\nfriction_fraction = {fraction}\n"
        );
        let scene = Scene::parse(&text, "constant", &BTreeMap::new())?;
        // A draft: at 150 V rms, the fastest carriers exceed the current limit.
        let program = compile_draft(&scene, &rig.board.limits, rig.board.tick_hz)?;
        let stroke = default_stroke(&program, Some(SECONDS))?;
        let simulation =
            Simulation { seconds: SECONDS, ticks_per_row: TICKS_PER_ROW, ..Simulation::of_stroke(rig, stroke, 1) };
        let rows = simulate(&program, &simulation, None, TO_THE_END)?.recorder.take_rows();
        let (mut commanded_n, mut felt_n) = (0.0, 0.0);
        for row in rows.iter().rev().take(ROWS) {
            let natural_n = row.natural_n.unwrap_or(f64::NAN);
            commanded_n += (row.commanded_n.unwrap_or(f64::NAN) - natural_n) / ROWS as f64;
            felt_n += (row.felt_n.unwrap_or(f64::NAN) - natural_n) / ROWS as f64;
        }
        Ok(Self {
            commanded_n,
            error: felt_n / commanded_n - 1.0,
            uncorrected_error: uncorrected_error(&program, commanded_n)?,
        })
    }
}

fn uncorrected_error(program: &Program, commanded_n: f64) -> Result<f64, ReportError> {
    let voltage_v_rms = program.header.friction_law()?.voltage_v_rms(commanded_n);
    Ok(program.mean_friction()?.electric_friction_n(voltage_v_rms) / commanded_n - 1.0)
}

pub(super) fn section() -> Result<Section, ReportError> {
    let mut panel = Panel::new(
        "",
        Axis::linear("commanded electric friction, mN", 0.0..150.0),
        Axis::linear("mean felt minus commanded, percent", -1.0..12.0),
    );
    let mut table = vec![row("carrier|largest error, percent|without the correction")];
    let mut rows = vec![row("waveform|carrier_hz|commanded_n|relative_error|relative_error_without_correction")];
    for ((waveform, carrier_hz), colour) in CARRIERS.into_iter().zip(PALETTE) {
        let constants = FRACTIONS.map(|fraction| Constant::of(waveform, carrier_hz, fraction));
        let constants: Vec<Constant> = constants.into_iter().collect::<Result<_, _>>()?;
        let points = |error: fn(&Constant) -> f64| {
            constants.iter().map(|one| (1e3 * one.commanded_n, 100.0 * error(one))).collect::<Vec<_>>()
        };
        let name = format!("{waveform}, {carrier_hz} Hz");
        let (corrected, uncorrected) = (points(|one| one.error), points(|one| one.uncorrected_error));
        panel.add("", Look { colour, line: Line::Thin, mark: Mark::Ring }, uncorrected.clone());
        panel.add(&name, Look { colour, line: Line::Solid, mark: Mark::Disc }, corrected.clone());
        let largest = |points: &[(f64, f64)]| points.iter().map(|(_, percent)| percent.abs()).fold(0.0, f64::max);
        table.push(vec![name, format!("{:.3}", largest(&corrected)), format!("{:.1}", largest(&uncorrected))]);
        for Constant { commanded_n, error, uncorrected_error } in &constants {
            let numbers = [carrier_hz, *commanded_n, *error, *uncorrected_error].map(cell);
            rows.push([vec![waveform.to_owned()], numbers.to_vec()].concat());
        }
    }
    let notes = vec![
        "Friction is convex in the squared voltage, and a carrier's squared voltage varies within its period. A table \
         that ignores this makes friction too strong (rings). The board's table is the mean over a period of the scene's \
         carrier with its edges (discs). Constants are played on the simulator in an ideal world, on the example \
         finger; the mean is over whole carrier periods."
            .to_owned(),
        "This holds if friction follows the attraction of each tick. If skin follows the mean square instead, the table \
         without the correction would be right: which of the two is unmeasured. `frixel play --skin mean-square` \
         simulates the other."
            .to_owned(),
    ];
    Ok(Section { name: "carrier", question: "Mean friction under each carrier", panel, table, notes, rows })
}
