//! What the board has for a scene, and what the scene needs of it.

use frixel_felt::check::SceneCheck;
use frixel_felt::judge::Judgement;
use frixel_hil_sim::RigConfig;

use super::{Figure, ReportError, Subject};
use crate::report::counts::Counts;
use crate::report::figure::{Data, Value};
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel};
use frixel_lab::simulation::board_costs;

/// Points of the curve of friction over voltage.
const POINTS: u32 = 200;
/// The images of the smallest and of the largest set of kinds, in the counts.
const FLASH: [&str; 2] = ["g474.flash_grating_only", "g474.flash_full"];

/// What a scene needs of something that the board has for every scene.
struct Part {
    what: &'static str,
    unit: &'static str,
    needed: f64,
    whole: f64,
}

impl Part {
    fn percent(&self) -> f64 {
        if self.whole > 0.0 { 100.0 * self.needed / self.whole } else { 0.0 }
    }
}

fn parts(check: &SceneCheck) -> [Part; 4] {
    let part =
        |what, unit, needed: usize, whole: usize| Part { what, unit, needed: needed as f64, whole: whole as f64 };
    let (ram, tick) = (&check.ram, &check.tick);
    [
        part("rows of the inverse table", "bytes", ram.table_bytes, ram.table_whole_bytes),
        part("longest tick, estimated", "cycles", tick.cycles as usize, tick.cycles_limit as usize),
        part("pictures", "bytes", ram.bitmap_pool_bytes, ram.bitmap_pool_limit_bytes as usize),
        Part {
            what: "electric friction",
            unit: "mN",
            needed: 1e3 * (check.asked.most_n.min(check.reach.total_max_n) - check.reach.natural_n).max(0.0),
            whole: 1e3 * check.reach.electric_max_n,
        },
    ]
}

/// What flash an image with only the scene's kinds needs, as far as it was measured.
fn flash(check: &SceneCheck, counts: &Counts) -> String {
    let image = check.board.as_ref().map_or_else(String::new, |image| image.features.join(", "));
    match FLASH.map(|name| counts.get(name)) {
        [Some(least), Some(most)] => format!(
            "Flash: an image with one kind of layer has {least} bytes, one with everything {most} ({}); this scene needs \
             the features {image}.",
            counts.origin()
        ),
        _ => format!("Flash: not counted; this scene needs the features {image}."),
    }
}

/// The figure, and what is left out in sentences.
pub(super) fn figure(subject: &Subject, counts: &Counts) -> Result<(Figure, Vec<String>), ReportError> {
    let Subject { name, program } = *subject;
    let rig = RigConfig::default();
    let costs = board_costs(program, &rig)?;
    let check =
        SceneCheck::of(program, &rig.board.limits, &costs, Judgement::default()).with_board(program, rig.board.kind);
    let parts = parts(&check);
    let mut data = Data::new(["what", "unit", "needed", "whole"]);
    data.row(["layers that are played".into(), String::new().as_str().into(), check.layers.into(), Value::from("")]);
    for Part { what, unit, needed, whole } in &parts {
        data.row([(*what).into(), (*unit).into(), (*needed).into(), (*whole).into()]);
    }
    for sentence in &check.left_out {
        data.row(["left out".into(), "".into(), sentence.as_str().into(), "".into()]);
    }
    let (reach, tick) = (&check.reach, &check.tick);
    let cut = match check.left_out.as_slice() {
        [] => "nothing of its file is left out".to_owned(),
        left_out => left_out.join("; "),
    };
    let sentences = vec![
        format!("Layers of {name} that are played: {}; {cut}.", check.layers),
        format!(
            "Table: {} of {} bytes are computed. Longest tick: estimated {} of {} cycles, worst at {:.1} mm, {:.1} mm.",
            check.ram.table_bytes, check.ram.table_whole_bytes, tick.cycles, tick.cycles_limit, tick.x_mm, tick.y_mm
        ),
        format!(
            "Reach of {}, {}: {:.1} to {:.1} mN at {:.0} V rms; the scene asks for {:.1} to {:.1} mN.",
            check.finger.title,
            check.finger.origin,
            1e3 * reach.natural_n,
            1e3 * reach.total_max_n,
            reach.voltage_max_v_rms,
            1e3 * check.asked.least_n,
            1e3 * check.asked.most_n
        ),
        flash(&check, counts),
    ];
    let figure = Figure {
        name: "scene",
        title: format!("What {name} needs of the board, and what is left out"),
        caption: [
            "Left: friction over the voltage for the scene's finger, and the least and the largest friction that the \
             scene asks for. Right: what it needs, in percent of what the board has for every scene; the rest is not \
             computed, sent or evaluated. Cycles are estimated from instructions by class for a Cortex-M4F, the limit is \
             that of the board's hello."
                .to_owned(),
        ]
        .into_iter()
        .chain(sentences.clone())
        .collect(),
        chart: Chart::new(vec![friction(subject, &check)?, shares(&parts)], 2),
        csv: data.csv()?,
    };
    Ok((figure, sentences))
}

/// Friction over voltage, with what the scene asks for.
fn friction(subject: &Subject, check: &SceneCheck) -> Result<Panel, ReportError> {
    let law = subject.program.header.friction_law()?;
    let volts = check.reach.voltage_max_v_rms;
    let curve = (0..=POINTS).map(|point| {
        let voltage_v_rms = volts * f64::from(point) / f64::from(POINTS);
        (voltage_v_rms, 1e3 * (law.natural_friction_n() + law.electric_friction_n(voltage_v_rms)))
    });
    let most_mn = 1.08e3 * check.reach.total_max_n;
    let mut panel =
        Panel::new("Reach", Axis::linear("voltage, V rms", 0.0..volts), Axis::linear("friction, mN", 0.0..most_mn));
    panel.add("friction of the finger", Look::line(PALETTE[0], Line::Solid), curve.collect());
    for (name, friction_n) in [("least that is asked for", check.asked.least_n), ("most", check.asked.most_n)] {
        let friction_mn = (1e3 * friction_n).min(most_mn);
        panel.add(name, Look::line(PALETTE[1], Line::Dashed), vec![(0.0, friction_mn), (volts, friction_mn)]);
    }
    Ok(panel)
}

/// A bar for each part.
fn shares(parts: &[Part]) -> Panel {
    let mut panel = Panel::new(
        "Needed of what there is",
        Axis::linear("percent", 0.0..100.0),
        Axis::linear("", 0.0..parts.len() as f64).with_labels(0.0),
    );
    for (part, row) in parts.iter().zip(0_u8..) {
        let y = parts.len() as f64 - 0.6 - f64::from(row);
        let bar = vec![(0.0, y), (part.percent().min(100.0), y)];
        panel.add("", Look { colour: PALETTE[2], line: Line::Solid, mark: Mark::Square }, bar);
        let Part { what, unit, needed, whole } = part;
        panel.notes.push((2.0, y + 0.25, format!("{what}: {needed:.0} of {whole:.0} {unit}")));
    }
    panel
}
