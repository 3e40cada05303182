//! Stability maps: relative error over the plane of attraction and load.

use frixel_model::{Contact, ContactModel, Finger, Real};

use super::{Figure, ReportError};
use crate::report::chart::{Axis, Cell, Chart, Field, Look, Mark, PALETTE, Panel};
use crate::report::data::Data;
use crate::report::exact::{Springs, relative_error};

/// Powers of two, and so exact in f32: what is measured is the model's rounding, and not that of its parameters.
const FINGER: Finger<f64> =
    Finger { radius_m: 1.0 / 128.0, stiffness_pa_per_m: 16_777_216.0, friction_coefficient: 0.5 };
const GAP_M: f64 = 1.0 / 131_072.0;

/// Decades of `q` and of `n`, and cells to a decade.
const Q_DECADES: (i32, i32) = (-12, 12);
const N_DECADES: (i32, i32) = (-6, 8);
const CELLS_PER_DECADE: i32 = 3;
/// Places in a cell at which the error is taken, as parts of its sides. The largest counts.
const PLACES: [(f64, f64); 4] = [(0.12, 0.58), (0.37, 0.08), (0.62, 0.83), (0.87, 0.33)];
/// Where the strip without a load stands, and the least load of the plane.
const NO_LOAD: (f64, f64) = (1e-8, 1e-7);

/// Where an error was largest.
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

/// Errors of both directions over one cell.
struct Errors {
    x: (f64, f64),
    y: (f64, f64),
    n: f64,
    forward: f64,
    inverse: f64,
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
    let exact = Springs::new(&FINGER, GAP_M);
    let rows = N_DECADES.0 * CELLS_PER_DECADE..N_DECADES.1 * CELLS_PER_DECADE;
    let mut map = Map { cells: Vec::new(), forward: Worst::default(), inverse: Worst::default() };
    for row in rows.map(Some).chain([None]) {
        for column in Q_DECADES.0 * CELLS_PER_DECADE..Q_DECADES.1 * CELLS_PER_DECADE {
            let (left, right) = (power(column), power(column + 1));
            let (low, high) = row.map_or(NO_LOAD, |row| (power(row), power(row + 1)));
            let mut cell = Errors { x: (left, right), y: (low, high), n: 0.0, forward: 0.0, inverse: 0.0 };
            for (across, up) in PLACES {
                let q = left * (right / left).powf(across);
                let n = if row.is_some() { low * (high / low).powf(up) } else { 0.0 };
                let (forward, inverse) = errors(&contact, &exact, q, n)?;
                cell.n = n;
                cell.forward = cell.forward.max(forward);
                cell.inverse = cell.inverse.max(inverse);
                map.forward.take(forward, q, n);
                map.inverse.take(inverse, q, n);
            }
            map.cells.push(cell);
        }
    }
    Ok(map)
}

/// Errors of electric friction and of voltage at a place of the plane, for inputs rounded to the precision.
fn errors<T: Real>(contact: &Contact<T>, exact: &Springs, q: f64, n: f64) -> Result<(f64, f64), ReportError> {
    let voltage = T::from_f64(contact.voltage_scale_v_rms().into() * q.sqrt());
    let load = T::from_f64(contact.load_scale_n().into() * n);
    let model = contact.under_load(load)?;
    let right = exact.electric_friction_n(voltage.into(), load.into());
    let forward = relative_error(model.state(voltage)?.electric_friction_n.into(), &right);
    let friction = T::from_f64(right.to_f64().value());
    let right = exact.voltage_v_rms(friction.into(), load.into());
    let inverse = relative_error(model.voltage_for_electric_friction(friction)?.into(), &right);
    Ok((forward, inverse))
}

/// What differs between the two precisions.
struct Precision {
    name: &'static str,
    title: &'static str,
    goal: f64,
    colours: (f64, f64),
    half_unit: &'static str,
}

pub(super) fn in_f64() -> Result<Figure, ReportError> {
    let precision =
        Precision { name: "stability-f64", title: "f64", goal: 4e-15, colours: (1e-17, 4e-15), half_unit: "1.1e-16" };
    figure(&precision, &map::<f64>()?)
}

pub(super) fn in_f32() -> Result<Figure, ReportError> {
    let precision =
        Precision { name: "stability-f32", title: "f32", goal: 1e-6, colours: (1e-9, 1e-6), half_unit: "6.0e-8" };
    figure(&precision, &map::<f32>()?)
}

fn figure(precision: &Precision, map: &Map) -> Result<Figure, ReportError> {
    let panel = |title: &str, error: fn(&Errors) -> f64, worst: &Worst| {
        let (low, high) = (f64::from(Q_DECADES.0), f64::from(Q_DECADES.1));
        let mut panel = Panel::new(
            title,
            Axis::log("attraction q = σ₀/(g k) = (V/V*)²", 10_f64.powf(low)..10_f64.powf(high)),
            Axis::log("load n = F_N/(π k R g²)", NO_LOAD.0..1e8),
        );
        panel.field = Some(Field {
            cells: map
                .cells
                .iter()
                .map(|cell| Cell { x: cell.x.0..cell.x.1, y: cell.y.0..cell.y.1, value: error(cell) })
                .collect(),
            colours: Axis::log("relative error", precision.colours.0..precision.colours.1),
        });
        panel.notes.push((1.5e-12, 2.6e-7, "↓ no load, n = 0".to_owned()));
        // Without a load, in the middle of the strip.
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
    Ok(Figure {
        name: precision.name,
        title: format!("Stability in {title}: error over the plane of attraction and load"),
        caption: vec![
            format!(
                "Largest relative error of electric friction from voltage (left) and of voltage from electric friction (right), \
                 Eqs. (43), (21), computed in {title}; the largest of four places in each cell. Right is what the paper's \
                 dimensional equations give in 256 bits (dashu-float) for the same inputs. Half a unit in the last place is {}; the \
                 goal is {:e}, the upper end of the colours.",
                precision.half_unit, precision.goal
            ),
            format!(
                "Worst points: forward {}; inverse {}. The finger's parameters are powers of two (R = 1/128 m, k = 2²⁴ Pa/m, gap \
                 2⁻¹⁷ m, µ = 1/2), and so exact.",
                map.forward.sentence(),
                map.inverse.sentence()
            ),
        ],
        chart: Chart {
            panels: vec![
                panel(&format!("Forward in {title}: electric friction"), |cell| cell.forward, &map.forward),
                panel(&format!("Inverse in {title}: voltage"), |cell| cell.inverse, &map.inverse),
            ],
            columns: 2,
            shared_legend: false,
        },
        csv: data.csv()?,
    })
}
