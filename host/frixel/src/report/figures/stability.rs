//! Maps of numerical stability: relative error over the plane of attraction and load.

use frixel_model::{Contact, Finger, Real};

use super::{Figure, ReportError};
use crate::report::figure::Data;
use crate::report::reference::{CELLS_PER_DECADE, PlaneRow, Q_DECADES, plane};
use frixel_chart::{Axis, Cell, Chart, Field, Look, Mark, PALETTE, Panel};

/// The parameters are powers of two, and so exact in f32: the error is the model's rounding, not that of its
/// parameters.
pub(super) const FINGER: Finger<f64> =
    Finger { radius_m: 1.0 / 128.0, stiffness_pa_per_m: 16_777_216.0, friction_coefficient: 0.5 };
pub(super) const GAP_M: f64 = 1.0 / 131_072.0;

/// Position of the strip for no load, and the least load of the plane.
const NO_LOAD: (f64, f64) = (1e-8, 1e-7);

/// The largest error so far, and where it occurred.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    error: f64,
    q: f64,
    n: f64,
}

impl Worst {
    fn take(&mut self, error: f64, q: f64, n: f64) {
        if error > self.error {
            *self = Self { error, q, n };
        }
    }

    fn sentence(&self) -> String {
        let Self { error, q, n } = self;
        format!("{error:.1e} at q = {q:.2e}, n = {n:.2e}")
    }
}

/// Errors of both directions in one cell.
struct Errors {
    x: (f64, f64),
    y: (f64, f64),
    n: f64,
    forward: f64,
    inverse: f64,
}

impl Errors {
    fn of_cell(row: &PlaneRow) -> Self {
        let cell = |cell: i32| (power(cell), power(cell + 1));
        Self { x: cell(row.q_cell), y: row.n_cell.map_or(NO_LOAD, cell), n: 0.0, forward: 0.0, inverse: 0.0 }
    }
}

struct Map {
    cells: Vec<Errors>,
    forward: Worst,
    inverse: Worst,
}

fn power(cells: i32) -> f64 {
    10_f64.powf(f64::from(cells) / f64::from(CELLS_PER_DECADE))
}

fn map<T: Real>() -> Result<Map, ReportError> {
    let finger = Finger {
        radius_m: T::from_f64(FINGER.radius_m),
        stiffness_pa_per_m: T::from_f64(FINGER.stiffness_pa_per_m),
        friction_coefficient: T::from_f64(FINGER.friction_coefficient),
    };
    let contact = Contact::new(&finger, T::from_f64(GAP_M))?;
    let mut map = Map { cells: Vec::new(), forward: Worst::default(), inverse: Worst::default() };
    for row in plane()? {
        let answers = row.answers();
        let model = contact.under_load(T::from_f64(answers.normal_load_n))?;
        let (forward, inverse) = answers.errors(&model)?;
        let q = (answers.voltage_v_rms / contact.voltage_scale_v_rms().into()).powi(2);
        let n = answers.normal_load_n / contact.load_scale_n().into();
        map.forward.take(forward, q, n);
        map.inverse.take(inverse, q, n);
        map.cells.push(Errors { n, forward, inverse, ..Errors::of_cell(&row) });
    }
    Ok(map)
}

/// The constants that differ between the two precisions.
struct Precision {
    name: &'static str,
    title: &'static str,
    goal: f64,
    colours: (f64, f64),
    half_unit: &'static str,
}

/// A map, and its worst points in words.
pub(super) type Mapped = (Figure, String);

pub(super) fn in_f64() -> Result<Mapped, ReportError> {
    let precision =
        Precision { name: "stability-f64", title: "f64", goal: 4e-15, colours: (1e-17, 4e-15), half_unit: "1.1e-16" };
    figure(&precision, &map::<f64>()?)
}

pub(super) fn in_f32() -> Result<Mapped, ReportError> {
    let precision =
        Precision { name: "stability-f32", title: "f32", goal: 1e-6, colours: (1e-9, 1e-6), half_unit: "6.0e-8" };
    figure(&precision, &map::<f32>()?)
}

fn figure(precision: &Precision, map: &Map) -> Result<Mapped, ReportError> {
    let panel = |title: &str, error: fn(&Errors) -> f64, worst: &Worst| {
        let (low, high) = (f64::from(Q_DECADES.0), f64::from(Q_DECADES.1));
        let cells =
            map.cells.iter().map(|cell| Cell { x: cell.x.0..cell.x.1, y: cell.y.0..cell.y.1, value: error(cell) });
        let colours = Axis::log("relative error", precision.colours.0..precision.colours.1);
        let mut panel = Panel::new(
            title,
            Axis::log("attraction q = σ₀/(g k) = (V/V*)²", 10_f64.powf(low)..10_f64.powf(high)),
            Axis::log("load n = F_N/(π k R g²)", NO_LOAD.0..1e8),
        )
        .with_field(Field::cells(cells.collect(), colours));
        panel.notes.push((1.5e-12, 2.6e-7, "↓ no load, n = 0".to_owned()));
        // Draw points without a load in the middle of their strip.
        let n = if worst.n > 0.0 { worst.n } else { (NO_LOAD.0 * NO_LOAD.1).sqrt() };
        panel.add(&format!("worst: {}", worst.sentence()), Look::mark(PALETTE[1], Mark::Ring), vec![(worst.q, n)]);
        panel
    };
    let mut data = Data::new(["q_from", "q_to", "n_from", "n_to", "forward_relative_error", "inverse_relative_error"]);
    for cell in &map.cells {
        let (low, high) = if cell.n > 0.0 { cell.y } else { (0.0, 0.0) };
        let (left, right) = cell.x;
        data.row([left.into(), right.into(), low.into(), high.into(), cell.forward.into(), cell.inverse.into()]);
    }
    let title = precision.title;
    let worst = format!("forward {}; inverse {}", map.forward.sentence(), map.inverse.sentence());
    let figure = Figure {
        name: precision.name,
        title: format!("Stability in {title}: error over the plane of attraction and load"),
        caption: vec![
            format!(
                "Largest relative error of electric friction from voltage (left) and of voltage from electric friction \
                 (right), Eqs. (43), (21), computed in {title}, in the middle of each cell. The reference is what the \
                 paper's dimensional equations give in 80 digits (mpmath, model/reference) for the same inputs, which \
                 are exact in f32. Half a unit in the last place is {}; the goal is {:e}, the upper end of the \
                 colours.",
                precision.half_unit, precision.goal
            ),
            format!(
                "Worst points: {worst}. The finger's parameters are powers of two (R = 1/128 m, k = 2²⁴ Pa/m, gap 2⁻¹⁷ \
                 m, µ = 1/2), and so exact."
            ),
        ],
        chart: Chart::new(
            vec![
                panel(&format!("Forward in {title}: electric friction"), |cell| cell.forward, &map.forward),
                panel(&format!("Inverse in {title}: voltage"), |cell| cell.inverse, &map.inverse),
            ],
            2,
        ),
        csv: data.csv()?,
    };
    Ok((figure, worst))
}
