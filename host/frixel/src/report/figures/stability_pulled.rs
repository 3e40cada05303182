//! Numerical stability of a finger that is pulled off: relative error over attraction and distance from pull-off.

use frixel_model::Contact;

use super::stability::{FINGER, GAP_M};
use super::{Figure, ReportError};
use crate::report::figure::Data;
use crate::report::reference::{PULLED_CELLS_PER_DECADE, PulledRow, pulled};
use frixel_chart::{Axis, Cell, Chart, Field, Look, Mark, PALETTE, Panel};

/// Range of the colours.
const COLOURS: (f64, f64) = (1e-17, 1e-3);
/// Half a unit in the last place of an f64.
const HALF_UNIT: f64 = f64::EPSILON / 2.0;

/// Errors of both directions at one place.
struct Errors {
    q: f64,
    part: f64,
    cell: (i32, i32),
    /// The factor by which rounding of the inputs grows.
    condition: f64,
    forward: f64,
    inverse: f64,
}

fn errors(row: &PulledRow) -> Result<Errors, ReportError> {
    let contact = Contact::new(&FINGER, GAP_M)?;
    let model = contact.under_pull(-row.normal_force_n)?;
    let (forward, inverse) = row.errors(&model)?;
    let q = (row.voltage_v / contact.voltage_scale_v_rms()).powi(2);
    let part = power(2 * row.part_cell + 1, 2 * PULLED_CELLS_PER_DECADE);
    let condition = condition(q, part);
    Ok(Errors { q, part, cell: (row.q_cell, row.part_cell), condition, forward, inverse })
}

/// The sum of the relative changes of friction over those of voltage, load, stiffness, gap and radius.
fn condition(q: f64, part: f64) -> f64 {
    // The square root of Eq. (43) is that of what is missing to the load of pull-off, which the place says without
    // cancellation: the model's own numbers are what is in doubt.
    let fold = q * q + 2.0 * q / (1.0 + q);
    let root = (fold * part).sqrt();
    let y = q + root;
    let of_load = fold * (1.0 - part) / (root * y);
    let of_q = 2.0 * q / y * (1.0 + (q + (1.0 + q).powi(-2)) / root);
    let [voltage, stiffness] = [2.0 * of_q, 1.0 - of_q + of_load];
    let [gap, radius] = [2.0 - 3.0 * of_q + 2.0 * of_load, 1.0 + of_load];
    [voltage, of_load, stiffness, gap, radius].iter().map(|change| change.abs()).sum()
}

fn power(cells: i32, per_decade: i32) -> f64 {
    10_f64.powf(f64::from(cells) / f64::from(per_decade))
}

/// Errors of friction, at the least place and where attraction and stiffness are alike, and the largest of voltage, in
/// words.
pub(super) struct Worst {
    pub(super) forward: String,
    pub(super) alike: String,
    pub(super) inverse: String,
}

fn largest(map: &[Errors], error: fn(&Errors) -> f64) -> Option<&Errors> {
    map.iter().max_by(|one, other| error(one).total_cmp(&error(other)))
}

fn sentence(map: &[Errors], error: fn(&Errors) -> f64) -> String {
    largest(map, error).map_or_else(String::new, |worst| {
        format!("{:.1e} at q = {:.2e}, {:.1e} of the load before pull-off", error(worst), worst.q, worst.part)
    })
}

pub(super) fn figure() -> Result<(Figure, Worst), ReportError> {
    let map: Vec<Errors> = pulled()?.iter().map(errors).collect::<Result<_, _>>()?;
    let panel = |title: &str, error: fn(&Errors) -> f64| {
        let cells = map.iter().map(|errors| {
            let range = |cell: i32| power(cell, PULLED_CELLS_PER_DECADE)..power(cell + 1, PULLED_CELLS_PER_DECADE);
            Cell { x: range(errors.cell.0), y: range(errors.cell.1), value: error(errors) }
        });
        let mut panel = Panel::new(
            title,
            Axis::log("attraction q = σ₀/(g k) = (V/V*)²", 1e-12..1e12),
            Axis::log("missing part of the pull at pull-off", 1e-13..1.0),
        )
        .with_field(Field::cells(cells.collect(), Axis::log("relative error", COLOURS.0..COLOURS.1)));
        if let Some(worst) = largest(&map, error) {
            let name = format!("worst: {}", sentence(&map, error));
            panel.add(&name, Look::mark(PALETTE[1], Mark::Ring), vec![(worst.q, worst.part)]);
        }
        panel
    };
    let mut data =
        Data::new(["q", "part_before_pull_off", "condition", "forward_relative_error", "inverse_relative_error"]);
    for errors in &map {
        let Errors { q, part, condition, forward, inverse, .. } = *errors;
        data.row([q.into(), part.into(), condition.into(), forward.into(), inverse.into()]);
    }
    let alike = map.iter().filter(|one| one.cell.0 == 0).min_by(|one, other| one.part.total_cmp(&other.part));
    let alike = alike.map_or_else(String::new, |one| {
        format!("{:.1e} at q = {:.2}, {:.1e} of the load before pull-off", one.forward, one.q, one.part)
    });
    let worst = Worst { alike, forward: sentence(&map, |one| one.forward), inverse: sentence(&map, |one| one.inverse) };
    let condition = map.iter().map(|one| one.condition).fold(0.0, f64::max);
    // Where the rounding of the answer itself does not count.
    let grown = map.iter().filter(|one| one.condition > 100.0);
    let units = grown.map(|one| one.forward / (one.condition * HALF_UNIT)).fold(0.0, f64::max);
    let figure = Figure {
        name: "stability-pulled",
        title: "Stability under a negative load: error up to pull-off".to_owned(),
        caption: vec![
            format!(
                "Largest relative error of friction from voltage (left) and of voltage from friction (right), Eqs. \
                 (43), (21) with a negative load, computed in f64, in the middle of each cell. Below pull-off there is no \
                 contact: the vertical axis is the part of the load that is missing to it. The reference has 80 digits \
                 (mpmath, model/reference) for the same inputs, which are exact in f64."
            ),
            format!(
                "Near pull-off the problem itself is ill-conditioned: relative changes of voltage, load, stiffness, gap and \
                 radius change friction by up to {condition:.1e} times as much, and without bound beyond the map, so that \
                 half a unit in the last place of each is an error of {:.1e}. The model's error is at most {units:.2} of \
                 what such rounding makes of each answer. The other direction is well-conditioned there.",
                condition * HALF_UNIT
            ),
            format!(
                "Worst points: forward {} (and {}); inverse {}. The finger is that of the maps before. No profile has a negative \
                 load, and no board plays one.",
                worst.forward, worst.alike, worst.inverse
            ),
        ],
        chart: Chart::new(
            vec![
                panel("Forward in f64: friction", |one| one.forward),
                panel("Inverse in f64: voltage", |one| one.inverse),
            ],
            2,
        ),
        csv: data.csv()?,
    };
    Ok((figure, worst))
}
