//! Numerical stability of the soft-finger model: relative error over its exponent.

use frixel_model::{Real, SoftFinger, contact_exponent};

use super::{Figure, ReportError};
use crate::report::figure::Data;
use crate::report::reference::{SoftRow, soft};
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel};

/// The parameters are exact in f32.
const RADIUS_M: f64 = 1.0 / 128.0;
const MODULUS_PA: f64 = 131_072.0;
const SHAPE_CONSTANT: f64 = 4.5;
const FRICTION_COEFFICIENT: f64 = 0.5;
const GAP_M: f64 = 1.0 / 131_072.0;
const LOADS_N: [f64; 2] = [0.0, 0.5];
/// The largest error so far, and where it occurred.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    error: f64,
    voltage: f64,
    stress_exponent: f64,
}

impl Worst {
    fn of(points: &[Point], part: fn(&Point) -> Self) -> Self {
        points.iter().map(part).fold(Self::default(), |worst, one| if one.error > worst.error { one } else { worst })
    }

    fn gamma(&self) -> f64 {
        self.stress_exponent / (2.0 * self.stress_exponent + 1.0)
    }

    fn sentence(&self) -> String {
        let (Self { error, voltage, stress_exponent }, gamma) = (self, self.gamma());
        format!("{error:.1e} at γ = {gamma:.3} (stress exponent {stress_exponent:.3}), {voltage:.1e} V")
    }
}

/// The largest errors at one exponent and load.
struct Point {
    gamma: f64,
    load_n: f64,
    forward: Worst,
    inverse: Worst,
}

fn points<T: Real>() -> Result<Vec<Point>, ReportError> {
    let rows = soft()?;
    let alike = |one: &SoftRow, other: &SoftRow| {
        let [one, other] =
            [one, other].map(|row| (row.stress_exponent.to_bits(), row.answers().normal_load_n.to_bits()));
        one == other
    };
    rows.chunk_by(alike).map(point::<T>).collect()
}

/// The largest errors over rows that differ only in their voltage.
fn point<T: Real>(rows: &[SoftRow]) -> Result<Point, ReportError> {
    let (mut forward, mut inverse) = (Worst::default(), Worst::default());
    let stress_exponent = rows.first().map_or(f64::NAN, |row| row.stress_exponent);
    let load_n = rows.first().map_or(f64::NAN, |row| row.answers().normal_load_n);
    let finger = SoftFinger {
        radius_m: T::from_f64(RADIUS_M),
        modulus_pa: T::from_f64(MODULUS_PA),
        stress_exponent: T::from_f64(stress_exponent),
        shape_constant: T::from_f64(SHAPE_CONSTANT),
        friction_coefficient: T::from_f64(FRICTION_COEFFICIENT),
    };
    let model = finger.on_gap(T::from_f64(GAP_M))?.under_load(T::from_f64(load_n))?;
    for row in rows {
        let answers = row.answers();
        let (forward_error, inverse_error) = answers.errors(&model)?;
        forward = worse(forward, forward_error, answers.voltage_v_rms, stress_exponent);
        inverse = worse(inverse, inverse_error, answers.voltage_v_rms, stress_exponent);
    }
    Ok(Point { gamma: contact_exponent(stress_exponent)?, load_n, forward, inverse })
}

fn worse(worst: Worst, error: f64, voltage: f64, stress_exponent: f64) -> Worst {
    if error > worst.error { Worst { error, voltage, stress_exponent } } else { worst }
}

fn panel(title: &str, range: std::ops::Range<f64>, goal: f64, points: &[Point]) -> Panel {
    let mut panel = Panel::new(
        title,
        Axis::linear("γ = s/(2 s + 1), s the stress exponent", 0.0..0.35),
        Axis::log("largest relative error, 1 µV to 10 kV", range),
    );
    for (load_n, forward, inverse) in [(LOADS_N[0], PALETTE[0], PALETTE[1]), (LOADS_N[1], PALETTE[5], PALETTE[4])] {
        let name = if load_n > 0.0 { format!("under {load_n} N") } else { "no load".to_owned() };
        let curve = |part: fn(&Point) -> f64| {
            points.iter().filter(|point| point.load_n.total_cmp(&load_n).is_eq()).map(|p| (p.gamma, part(p))).collect()
        };
        let solid = |colour| Look::line(colour, Line::Solid);
        panel.add(&format!("friction, {name}"), solid(forward), curve(|point| point.forward.error));
        panel.add(&format!("voltage, {name}"), solid(inverse), curve(|point| point.inverse.error));
    }
    let (forward, inverse) = (Worst::of(points, |point| point.forward), Worst::of(points, |point| point.inverse));
    let (name, worst) = if forward.error > inverse.error { ("friction", forward) } else { ("voltage", inverse) };
    let place = (worst.gamma(), worst.error);
    panel.add(&format!("worst: {name} {}", worst.sentence()), Look::mark(PALETTE[6], Mark::Ring), vec![place]);
    panel.add("goal", Look::line(PALETTE[6], Line::Dashed), vec![(0.0, goal), (0.35, goal)]);
    panel
}

/// The figure, and its worst points in f64 in words.
pub(super) fn figure() -> Result<(Figure, String), ReportError> {
    let (double, single) = (points::<f64>()?, points::<f32>()?);
    let mut data = Data::new([
        "precision",
        "gamma",
        "normal_force_n",
        "forward_relative_error",
        "forward_worst_voltage_v_rms",
        "inverse_relative_error",
        "inverse_worst_voltage_v_rms",
    ]);
    for (precision, points) in [("f64", &double), ("f32", &single)] {
        for point in points {
            data.row([
                precision.into(),
                point.gamma.into(),
                point.load_n.into(),
                point.forward.error.into(),
                point.forward.voltage.into(),
                point.inverse.error.into(),
                point.inverse.voltage.into(),
            ]);
        }
    }
    let worst = |points: &[Point]| {
        let (forward, inverse) = (Worst::of(points, |point| point.forward), Worst::of(points, |point| point.inverse));
        format!("friction {}; voltage {}", forward.sentence(), inverse.sentence())
    };
    let figure = Figure {
        name: "stability-soft",
        title: "Stability of the soft finger: error over its exponent".to_owned(),
        caption: vec![
            "Largest relative error over eleven voltages from 1 µV to 10 kV of electric friction from voltage, Eqs. \
             (29), (43), and of voltage from electric friction, against the same equations in 80 digits (mpmath, \
             model/reference). Dashed: the goals, 4e-14 and 1e-5."
                .to_owned(),
            format!("Worst points in f64: {}. In f32: {}.", worst(&double), worst(&single)),
            "Soft finger: R = 1/128 m, E = 2¹⁷ Pa, B = 4.5, µ = 1/2, gap 2⁻¹⁷ m, all exact in f32; stress exponents from 0.02 to 1."
                .to_owned(),
        ],
        chart: Chart::new(
            vec![panel("f64", 1e-16..1e-12, 4e-14, &double), panel("f32", 1e-8..1e-4, 1e-5, &single)],
            2,
        ),
        csv: data.csv()?,
    };
    Ok((figure, worst(&double)))
}
