//! The model's error in stiff and extreme cases, against reference solutions with 80 digits.

use std::collections::BTreeMap;

use frixel_chart::{Axis, Cell, Field, Look, Mark, PALETTE, Panel};
use frixel_model::{Contact, ContactModel, Finger, Real, SoftFinger};
use serde::Deserialize;

use super::ReportError;
use super::page::{Section, cell, digits, row};

/// Rows of `model/reference/generate.py`.
const REFERENCE: &str = include_str!("stability.csv");
/// Parameters of all fingers of the reference, exact in f32.
const RADIUS_M: f64 = 1.0 / 128.0;
const GAP_M: f64 = 1.0 / 131_072.0;
const MU: f64 = 0.5;
const MODULUS_PA: f64 = 131_072.0;
const SHAPE_CONSTANT: f64 = 4.5;
/// Distance to pull-off, as a part of its load, below which a finger counts as near pull-off.
const NEAR: f64 = 0.01;
/// Decades of attraction and load that are drawn; a cell is one decade of attraction and two of load.
const Q_DECADES: (i32, i32) = (-12, 12);
const N_DECADES: (i32, i32) = (-6, 8);
/// Where points without a load are drawn.
const NO_LOAD: (f64, f64) = (1e-8, 1e-7);
const COLOURS: (f64, f64) = (1e-17, 4e-15);

/// The case of a row of the reference.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
enum Case {
    /// A finger on springs.
    Springs,
    /// A finger of soft material.
    Soft,
    /// A finger on springs under a negative load.
    Pulled,
}

#[derive(Clone, Debug, Deserialize)]
struct Row {
    finger: Case,
    stiffness_pa_per_m: Option<f64>,
    stress_exponent: Option<f64>,
    voltage_v: f64,
    normal_force_n: f64,
    friction_n: f64,
    friction_n_rest: f64,
    given_friction_n: f64,
    answer_voltage_v: f64,
    answer_voltage_v_rest: f64,
    /// Factor by which relative changes of the inputs grow in friction; for pulled fingers only.
    condition: Option<f64>,
}

/// Errors of friction from voltage, and of voltage from friction.
type Errors = [f64; 2];

/// A row with the model's errors.
struct Point {
    row: Row,
    /// Attraction and load, without units.
    q: f64,
    n: f64,
    /// Distance to pull-off, as a part of its load; for pulled fingers only.
    part: Option<f64>,
    double: Errors,
    /// `None` where the inputs are not exact in f32.
    single: Option<Errors>,
}

impl Row {
    /// The row with its exact f32 inputs, which the file states with nine digits.
    fn rounded(self) -> Self {
        let single = |number: f64| f64::from(number as f32);
        let (stiffness_pa_per_m, stress_exponent) =
            (self.stiffness_pa_per_m.map(single), self.stress_exponent.map(single));
        let row = Self { stiffness_pa_per_m, stress_exponent, voltage_v: single(self.voltage_v), ..self };
        if row.finger == Case::Pulled {
            return row;
        }
        let (normal_force_n, given_friction_n) = (single(row.normal_force_n), single(row.given_friction_n));
        Self { normal_force_n, given_friction_n, ..row }
    }

    fn contact<T: Real>(&self) -> Result<Contact<T>, ReportError> {
        let stiffness_pa_per_m = T::from_f64(self.stiffness_pa_per_m.unwrap_or(f64::NAN));
        let finger =
            Finger { radius_m: T::from_f64(RADIUS_M), stiffness_pa_per_m, friction_coefficient: T::from_f64(MU) };
        Ok(Contact::new(&finger, T::from_f64(GAP_M))?)
    }

    fn errors<T: Real>(&self) -> Result<Errors, ReportError> {
        let load_n = T::from_f64(self.normal_force_n);
        match self.finger {
            Case::Springs => Ok(self.errors_of(&self.contact::<T>()?.under_load(load_n)?)),
            Case::Soft => {
                let finger = SoftFinger {
                    radius_m: T::from_f64(RADIUS_M),
                    modulus_pa: T::from_f64(MODULUS_PA),
                    stress_exponent: T::from_f64(self.stress_exponent.unwrap_or(f64::NAN)),
                    shape_constant: T::from_f64(SHAPE_CONSTANT),
                    friction_coefficient: T::from_f64(MU),
                };
                Ok(self.errors_of(&finger.on_gap(T::from_f64(GAP_M))?.under_load(load_n)?))
            }
            Case::Pulled => {
                // Total friction, since a pulled finger has no natural friction.
                let model = self.contact::<T>()?.under_pull(-load_n)?;
                let friction_n = model.state(T::from_f64(self.voltage_v)).map(|state| state.friction_n.into());
                let voltage_v = model.voltage_for_friction(T::from_f64(self.given_friction_n)).map(Into::into);
                Ok(self.compared(friction_n.ok(), voltage_v.ok()))
            }
        }
    }

    fn errors_of<T: Real>(&self, model: &impl ContactModel<T>) -> Errors {
        let friction_n = model.state(T::from_f64(self.voltage_v)).map(|state| state.electric_friction_n.into());
        let voltage_v = model.voltage_for_electric_friction(T::from_f64(self.given_friction_n)).map(Into::into);
        self.compared(friction_n.ok(), voltage_v.ok())
    }

    fn compared(&self, friction_n: Option<f64>, voltage_v: Option<f64>) -> Errors {
        [
            relative_error(friction_n, self.friction_n, self.friction_n_rest),
            relative_error(voltage_v, self.answer_voltage_v, self.answer_voltage_v_rest),
        ]
    }

    fn point(self) -> Result<Point, ReportError> {
        let row = self.rounded();
        let (mut q, mut n, mut part) = (f64::NAN, f64::NAN, None);
        if row.finger != Case::Soft {
            let contact = row.contact::<f64>()?;
            q = (row.voltage_v / contact.voltage_scale_v_rms()).powi(2);
            n = row.normal_force_n / contact.load_scale_n();
            part = (row.finger == Case::Pulled).then(|| 1.0 + n / (q * q + 2.0 * q / (1.0 + q)));
        }
        let single = (row.finger != Case::Pulled).then(|| row.errors::<f32>()).transpose()?;
        Ok(Point { q, n, part, double: row.errors::<f64>()?, single, row })
    }
}

/// Relative error against a reference, given as its nearest f64 and the rest; infinite without a finite answer.
fn relative_error(found: Option<f64>, nearest: f64, rest: f64) -> f64 {
    let found = found.unwrap_or(f64::NAN);
    // `found - nearest` is exact when both are close.
    if found.is_finite() { (((found - nearest) - rest) / nearest).abs() } else { f64::INFINITY }
}

impl Point {
    fn worst(&self) -> f64 {
        self.double[0].max(self.double[1])
    }

    /// Its place, for display.
    fn place(&self) -> String {
        let Row { voltage_v, normal_force_n, stiffness_pa_per_m, stress_exponent, .. } = &self.row;
        match (self.part, stiffness_pa_per_m, stress_exponent) {
            (Some(part), ..) => format!("q = {:.1e}, {part:.1e} of the load before pull-off", self.q),
            (_, Some(k), _) => format!("q = {:.1e}, n = {:.1e} ({k:.1e} Pa/m)", self.q, self.n),
            (.., exponent) => {
                format!("{voltage_v:.0e} V, {normal_force_n} N, stress exponent {:.2}", exponent.unwrap_or(f64::NAN))
            }
        }
    }
}

/// A row of the table: its name, and whether a point belongs to it.
type Group = (&'static str, fn(&Point) -> bool);

const GROUPS: [Group; 7] = [
    ("no load", |point| point.row.finger == Case::Springs && is_load(point, 0.0)),
    ("0.5 N", |point| point.row.finger == Case::Springs && is_load(point, 0.5)),
    ("2 N", |point| point.row.finger == Case::Springs && is_load(point, 2.0)),
    ("any load, n to 10⁸", |point| point.row.finger == Case::Springs),
    ("soft material; 0, 0.5, 2 N", |point| point.row.finger == Case::Soft),
    ("negative load", |point| point.part.is_some_and(|part| part >= NEAR)),
    ("within 1 % of pull-off", |point| point.part.is_some_and(|part| part < NEAR)),
];

fn is_load(point: &Point, load_n: f64) -> bool {
    point.row.normal_force_n.total_cmp(&load_n).is_eq()
}

pub(super) fn section() -> Result<Section, ReportError> {
    let mut points = Vec::new();
    for row in csv::Reader::from_reader(REFERENCE.as_bytes()).deserialize() {
        points.push(Row::point(row?)?);
    }
    let mut table = vec![row("load|f64: friction|f64: voltage|f32: friction|f32: voltage")];
    let mut worst = Vec::new();
    for (name, is_in) in GROUPS {
        let group = || points.iter().filter(|point| is_in(point));
        let most = |error: &dyn Fn(&Point) -> Option<f64>| group().filter_map(error).reduce(f64::max).map(digits);
        let double = [0, 1].map(|direction| most(&|point| Some(point.double[direction])));
        let single = [0, 1].map(|direction| most(&|point| Some(point.single?[direction])));
        let cells = [double, single].into_iter().flatten().map(Option::unwrap_or_default);
        table.push([name.to_owned()].into_iter().chain(cells).collect());
        let place = group().max_by(|one, other| one.worst().total_cmp(&other.worst()));
        worst.extend(place.map(|point| format!("{name}: {} at {}", digits(point.worst()), point.place())));
    }
    let condition = points.iter().filter_map(|point| point.row.condition).fold(0.0, f64::max);
    let notes = vec![
        "q = σ₀/(g k) = (V/V*)² is the attraction at the contact over the finger's springs, and n = F_N/(π k R g²) the \
         load, both without units: the model is one curve in them. Every cell has several points, on fingers of 1.3·10⁵, 1.7·10⁷ \
         and 8.8·10¹² Pa/m; loads of 0, 0.5 and 2 N are swept from 1 µV to 10 kV on each."
            .to_owned(),
        "The errors are relative, of electric friction and of voltage, Eqs. (43), (21), (29); under a negative load, of \
         total friction. The reference is the paper's dimensional equations in 80 digits (model/reference/generate.py). \
         The model's bounds are 4e-15 in f64 and 1e-6 in f32, for soft material 4e-14 and 1e-5."
            .to_owned(),
        format!(
            "Near pull-off the problem itself is ill-conditioned: relative changes of the inputs change friction by up \
             to {condition:.1e} times as much. Voltage from friction is not. No profile has a negative load, and no board \
             plays one."
        ),
        format!("Worst points in f64: {}.", worst.join("; ")),
    ];
    let (name, question) = ("stability", "Stability on stiff and extreme cases");
    Ok(Section { name, question, panel: panel(&points), table, notes, rows: rows(&points) })
}

/// The largest error in each cell of attraction and load.
fn panel(points: &[Point]) -> Panel {
    let mut cells: BTreeMap<(i32, Option<i32>), f64> = BTreeMap::new();
    let springs = || points.iter().filter(|point| point.row.finger == Case::Springs);
    for point in springs() {
        let q_decade = point.q.log10().floor() as i32;
        let n_decade = (point.n > 0.0).then(|| 2 * (point.n.log10() / 2.0).floor() as i32);
        let is_drawn = |decade: i32, (from, to): (i32, i32)| (from..to).contains(&decade);
        if is_drawn(q_decade, Q_DECADES) && n_decade.is_none_or(|decade| is_drawn(decade, N_DECADES)) {
            let worst = cells.entry((q_decade, n_decade)).or_default();
            *worst = worst.max(point.worst());
        }
    }
    let power = |decade: i32| 10_f64.powi(decade);
    let cells = cells.into_iter().map(|((q, n), value)| {
        let y = n.map_or(NO_LOAD.0..NO_LOAD.1, |n| power(n)..power(n + 2));
        Cell { x: power(q)..power(q + 1), y, value }
    });
    let colours = Axis::log("relative error, f64", COLOURS.0..COLOURS.1);
    let mut panel = Panel::new(
        "",
        Axis::log("attraction q = σ₀/(g k) = (V/V*)²", power(Q_DECADES.0)..power(Q_DECADES.1)),
        Axis::log("load n = F_N/(π k R g²)", NO_LOAD.0..power(N_DECADES.1)),
    )
    .with_field(Field::cells(cells.collect(), colours));
    panel.notes.push((1.5e-12, 2.6e-7, "↓ no load, n = 0".to_owned()));
    if let Some(point) = springs().max_by(|one, other| one.worst().total_cmp(&other.worst())) {
        let n = if point.n > 0.0 { point.n } else { (NO_LOAD.0 * NO_LOAD.1).sqrt() };
        let name = format!("worst: {} at {}", digits(point.worst()), point.place());
        panel.add(&name, Look::mark(PALETTE[1], Mark::Ring), vec![(point.q, n)]);
    }
    panel
}

fn rows(points: &[Point]) -> Vec<Vec<String>> {
    let mut rows = vec![row(
        "finger|stiffness_pa_per_m|stress_exponent|voltage_v_rms|normal_force_n|q|n|part_before_pull_off|condition|\
         friction_error_f64|voltage_error_f64|friction_error_f32|voltage_error_f32",
    )];
    for Point { row, q, n, part, double, single } in points {
        let number = |number: Option<f64>| number.unwrap_or(f64::NAN);
        let [friction, voltage] = single.unwrap_or([f64::NAN; 2]);
        let inputs = [number(row.stiffness_pa_per_m), number(row.stress_exponent), row.voltage_v, row.normal_force_n];
        let places = [*q, *n, number(*part), number(row.condition), double[0], double[1], friction, voltage];
        let numbers = inputs.into_iter().chain(places).map(cell);
        rows.push([format!("{:?}", row.finger).to_lowercase()].into_iter().chain(numbers).collect());
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::relative_error;

    #[test]
    fn errors_are_resolved_below_the_last_bit() {
        assert!((relative_error(Some(1.0), 1.0, 1e-17) - 1e-17).abs() < 1e-30);
        assert!((relative_error(Some(1.0 + f64::EPSILON), 1.0, 1e-17) - (f64::EPSILON - 1e-17)).abs() < 1e-30);
        assert!(relative_error(None, 1.0, 0.0).is_infinite());
    }
}
