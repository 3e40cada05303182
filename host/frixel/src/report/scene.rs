//! The board's resources: the part that a scene uses, and the part that it leaves out.

use frixel_chart::{Axis, Line, Look, Mark, PALETTE, Panel};
use frixel_felt::check::{BoardCosts, BoardImage, SceneCheck};
use frixel_felt::judge::Judgement;
use frixel_hil_sim::RigConfig;
use frixel_layers::cost::{LayerCosts, cycles};
use frixel_layers::layer_set;
use frixel_scene::Program;
use frixel_wire::hello::BoardKind;

use super::Subject;
use super::counts::Counts;
use super::page::{Section, row};

/// A resource of the board: its name, its unit, the amount that the scene uses, and the whole.
type Part = (&'static str, &'static str, f64, f64);

pub(super) fn section(subject: &Subject, counts: &Counts) -> Section {
    let Subject { name, program, .. } = subject;
    let (parts, notes) = match program {
        Ok(program) => {
            let (check, image) = (check(program), BoardImage::of(program, BoardKind::NucleoG474re));
            let image_bytes = image_bytes(&image, counts);
            (parts(program, &check, image_bytes, counts), notes(name, program, &check, (&image, image_bytes), counts))
        }
        Err(error) => (Vec::new(), vec![format!("{name} cannot be compiled: {error}")]),
    };
    let mut table = vec![row("of the board|this scene|left out|of")];
    let mut rows = vec![row("what|unit|needed|whole")];
    for (what, unit, needed, whole) in &parts {
        let amount = |number: f64| format!("{number:.0} {unit}");
        table.push(vec![(*what).to_owned(), amount(*needed), amount((whole - needed).max(0.0)), amount(*whole)]);
        rows.push(vec![(*what).to_owned(), (*unit).to_owned(), needed.to_string(), whole.to_string()]);
    }
    let mut panel = Panel::new(
        "",
        Axis::linear("needed, percent of the whole", 0.0..100.0),
        Axis::linear("", 0.0..parts.len().max(1) as f64).with_labels(0.0),
    );
    for ((what, _, needed, whole), line) in parts.iter().zip(0_u8..) {
        let (y, percent) = (parts.len() as f64 - 0.7 - f64::from(line), 100.0 * (needed / whole.max(1e-9)).min(1.0));
        let look = Look { colour: PALETTE[2], line: Line::Solid, mark: Mark::Square };
        panel.add("", look, vec![(0.0, y), (percent, y)]);
        panel.notes.push((2.0, y + 0.35, format!("{what}: {percent:.0} %")));
    }
    Section { name: "scene", question: "What the scene leaves out", panel, table, notes, rows }
}

/// The result of `frixel check` for the program, without verdicts.
fn check(program: &Program) -> SceneCheck {
    let rig = RigConfig::default();
    SceneCheck::of(program, &rig.board.limits, &BoardCosts::of(program, &rig, 0), Judgement::default())
}

fn parts(program: &Program, check: &SceneCheck, image_bytes: Option<f64>, counts: &Counts) -> Vec<Part> {
    let SceneCheck { tick, ram, reach, targets, .. } = check;
    let electric_n = (targets.most_n.min(reach.total_max_n) - reach.natural_n).max(0.0);
    let mut parts: Vec<Part> = vec![
        ("tick, if all layers were under the finger", "cycles", tick.cycles.into(), every_layer(program).into()),
        ("tick, of what a board accepts", "cycles", tick.cycles.into(), tick.cycles_limit.into()),
        ("inverse table", "bytes", ram.table_bytes as f64, ram.table_whole_bytes as f64),
        ("pictures", "bytes", ram.bitmap_pool_bytes as f64, ram.bitmap_pool_limit_bytes.into()),
        ("electric friction", "mN", 1e3 * electric_n, 1e3 * reach.electric_max_n),
    ];
    let image = image_bytes.zip(counts.get("g474.flash_full"));
    parts.extend(image.map(|(needed, whole)| ("image, flash", "bytes", needed, whole)));
    parts
}

/// Estimated cycles of a tick that evaluates every layer, as without the grid.
fn every_layer(program: &Program) -> u32 {
    let core = RigConfig::default().board.limits.core;
    let mut costs = LayerCosts::new(&program.header, core);
    for (number, record) in (0..).zip(&program.records) {
        costs.add(number, record, &program.points, core);
    }
    cycles(core, costs.of_tick(layer_set(0..program.records.len())))
}

/// Bytes of flash of a NUCLEO's image: the image without any feature, plus what each feature alone adds.
fn image_bytes(image: &BoardImage, counts: &Counts) -> Option<f64> {
    let bytes = |build: &str| counts.get(&format!("g474.flash_{build}"));
    let none = bytes("none")?;
    let names = image.features.iter();
    let added = names.map(|name| Some(bytes(&format!("{}_only", name.replace('-', "_")))? - none));
    Some(none + added.sum::<Option<f64>>()?)
}

fn notes(
    name: &str,
    program: &Program,
    SceneCheck { left_out, finger, reach, targets, .. }: &SceneCheck,
    (image, image_bytes): (&BoardImage, Option<f64>),
    counts: &Counts,
) -> Vec<String> {
    let omitted = if left_out.is_empty() { "nothing of its file is left out".to_owned() } else { left_out.join("; ") };
    let mut notes = vec![format!("Layers of {name} that are played: {}; {omitted}.", program.records.len())];
    let refused: Vec<String> = program.refusals().map(ToString::to_string).collect();
    if !refused.is_empty() {
        notes.push(format!("This is a draft, clamped: a board refuses it. {}", refused.join("; ")));
    }
    notes.push(format!(
        "Reach of {}, {}: {:.4} to {:.4} mN at {:.0} V rms; the scene asks for {:.1} to {:.1} mN.",
        finger.title,
        finger.origin,
        1e3 * reach.natural_n,
        1e3 * reach.total_max_n,
        reach.voltage_max_v_rms,
        1e3 * targets.least_n,
        1e3 * targets.most_n
    ));
    notes.push(
        "The first line is what the grid saves: a tick evaluates the layers near the finger only. Cycles are estimated \
         from instructions by class for a Cortex-M4F. Rows of the table that the scene cannot ask for are not computed."
            .to_owned(),
    );
    let bytes = if let Some(bytes) = image_bytes {
        format!("about {bytes:.0} bytes, the sum of what each feature adds to an image without any")
    } else {
        let shown = |build| counts.get(build).map_or("unknown".to_owned(), |bytes| bytes.to_string());
        let [least, most] = ["g474.flash_grating_only", "g474.flash_full"].map(shown);
        format!("from {least} bytes with one kind of layer to {most} with everything")
    };
    notes.push(format!("The smallest image that plays it has the features {}: {bytes}.", image.features.join(", ")));
    notes
}
