//! Stability of the soft finger: relative error over its exponent.

use frixel_model::{ContactModel, Real, SoftFinger, contact_exponent};

use super::{Figure, ReportError, even, geometric};
use crate::report::chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel};
use crate::report::data::Data;
use crate::report::exact::{Soft, relative_error};

/// Powers of two, and so exact in f32.
const RADIUS_M: f64 = 1.0 / 128.0;
const MODULUS_PA: f64 = 131_072.0;
const SHAPE_CONSTANT: f64 = 4.5;
const FRICTION_COEFFICIENT: f64 = 0.5;
const GAP_M: f64 = 1.0 / 131_072.0;
const LOADS_N: [f64; 2] = [0.0, 0.5];
/// Voltages at each exponent, in V rms.
const VOLTAGES: (f64, f64, usize) = (1e-6, 1e4, 21);
/// Stress exponents.
const STRESS_EXPONENTS: (f64, f64, usize) = (0.02, 1.0, 33);

/// Where an error was largest.
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

/// The worst errors at one exponent and load.
struct Point {
    gamma: f64,
    load_n: f64,
    forward: Worst,
    inverse: Worst,
}

fn points<T: Real>() -> Result<Vec<Point>, ReportError> {
    let (low, high, count) = STRESS_EXPONENTS;
    let mut points = Vec::new();
    for load_n in LOADS_N {
        for stress_exponent in even(low, high, count) {
            // Exact in f32, and so in f64.
            let stress_exponent = f64::from(stress_exponent as f32);
            points.push(point::<T>(stress_exponent, load_n)?);
        }
    }
    Ok(points)
}

fn point<T: Real>(stress_exponent: f64, load_n: f64) -> Result<Point, ReportError> {
    let wide = SoftFinger {
        radius_m: RADIUS_M,
        modulus_pa: MODULUS_PA,
        stress_exponent,
        shape_constant: SHAPE_CONSTANT,
        friction_coefficient: FRICTION_COEFFICIENT,
    };
    let finger = SoftFinger {
        radius_m: T::from_f64(wide.radius_m),
        modulus_pa: T::from_f64(wide.modulus_pa),
        stress_exponent: T::from_f64(wide.stress_exponent),
        shape_constant: T::from_f64(wide.shape_constant),
        friction_coefficient: T::from_f64(wide.friction_coefficient),
    };
    let model = finger.on_gap(T::from_f64(GAP_M))?.under_load(T::from_f64(load_n))?;
    let exact = Soft::new(&wide, GAP_M);
    let gamma = contact_exponent(stress_exponent)?;
    let mut point = Point { gamma, load_n, forward: Worst::default(), inverse: Worst::default() };
    let (low, high, count) = VOLTAGES;
    for voltage in geometric(low, high, count) {
        let voltage = T::from_f64(voltage);
        let found: f64 = model.state(voltage)?.electric_friction_n.into();
        let right = exact.electric_friction_n(voltage.into(), load_n, found);
        let error = right.as_ref().map_or(f64::INFINITY, |right| relative_error(found, right));
        point.forward = worse(point.forward, error, voltage.into(), stress_exponent);
        let friction = T::from_f64(right.map_or(found, |right| right.to_f64().value()));
        let right = exact.voltage_v_rms(friction.into(), load_n);
        let error = relative_error(model.voltage_for_electric_friction(friction)?.into(), &right);
        point.inverse = worse(point.inverse, error, voltage.into(), stress_exponent);
    }
    Ok(point)
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

pub(super) fn figure() -> Result<Figure, ReportError> {
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
    Ok(Figure {
        name: "stability-soft",
        title: "Stability of the soft finger: error over its exponent".to_owned(),
        caption: vec![
            "Largest relative error over voltages from 1 µV to 10 kV of electric friction from voltage, Eqs. (29), (43), and of \
             voltage from electric friction, against the same equations in 256 bits (dashu-float). Dashed: the goals, 4e-14 and 1e-5."
                .to_owned(),
            format!("Worst points in f64: {}. In f32: {}.", worst(&double), worst(&single)),
            "Soft finger: R = 1/128 m, E = 2¹⁷ Pa, B = 4.5, µ = 1/2, gap 2⁻¹⁷ m, all exact in f32; stress exponents from 0.02 to 1."
                .to_owned(),
        ],
        chart: Chart {
            panels: vec![
                panel("f64", 1e-16..1e-12, 4e-14, &double),
                panel("f32", 1e-8..1e-4, 1e-5, &single),
            ],
            columns: 2,
            shared_legend: false,
        },
        csv: data.csv()?,
    })
}
