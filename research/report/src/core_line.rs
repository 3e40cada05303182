//! Fig. 3 of the paper: contact radius and friction over voltage without a load, on one core line.
use std::error::Error;

use frixel::report::{Data, Figure};
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel};
use frixel_model::{Contact, ContactModel, Finger};

use super::{even, example, geometric};

/// A finger to plot on the core line, with its name in the legend.
struct Example {
    name: &'static str,
    finger: Finger<f64>,
    gap_m: f64,
    look: Look,
}

fn examples() -> [Example; 3] {
    let soft = Finger { radius_m: 1e-2, stiffness_pa_per_m: 3e6, friction_coefficient: 0.8 };
    let hard = Finger { radius_m: 5e-3, stiffness_pa_per_m: 2e9, friction_coefficient: 0.3 };
    [
        Example {
            name: "R 8 mm, k 1.8e7 Pa/m, gap 10 µm, µ 0.5",
            finger: example::FINGER,
            gap_m: example::GAP_M,
            look: Look::mark(PALETTE[1], Mark::Ring),
        },
        Example {
            name: "R 10 mm, k 3e6 Pa/m, gap 30 µm, µ 0.8",
            finger: soft,
            gap_m: 3e-5,
            look: Look::mark(PALETTE[2], Mark::Cross),
        },
        Example {
            name: "R 5 mm, k 2e9 Pa/m, gap 0.3 µm, µ 0.3",
            finger: hard,
            gap_m: 3e-7,
            look: Look::mark(PALETTE[3], Mark::Triangle),
        },
    ]
}

/// State of a finger, in SI units and scaled.
struct Point {
    voltage_v_rms: f64,
    contact_radius_m: f64,
    friction_n: f64,
    scaled_voltage: f64,
    scaled_radius: f64,
    scaled_friction: f64,
}

fn points(example: &Example, voltages: impl Iterator<Item = f64>, scaled: bool) -> Result<Vec<Point>, Box<dyn Error>> {
    let contact = Contact::new(&example.finger, example.gap_m)?;
    let upper = contact.under_load(0.0)?;
    let voltage_unit = if scaled { contact.voltage_scale_v_rms() } else { 1.0 };
    let mut points = Vec::new();
    for voltage in voltages {
        let voltage_v_rms = voltage * voltage_unit;
        let state = upper.state(voltage_v_rms)?;
        points.push(Point {
            voltage_v_rms,
            contact_radius_m: state.contact_radius_m,
            friction_n: state.friction_n,
            scaled_voltage: voltage_v_rms / contact.voltage_scale_v_rms(),
            scaled_radius: contact.area(state.contact_radius_m).sqrt(),
            scaled_friction: state.friction_n / contact.friction_scale_n(),
        });
    }
    Ok(points)
}

const LINE: Look = Look::line(PALETTE[0], Line::Solid);
const LIMIT: Look = Look::line(PALETTE[6], Line::Dashed);

/// The core lines with their asymptotes, and the fingers as points on them.
fn scaled_panels(curve: &[Point], data: &mut Data<7>) -> Result<[Panel; 2], Box<dyn Error>> {
    let voltage = || Axis::log("voltage V / V*", 1e-2..1e2);
    let radius_axis = Axis::log("contact radius a / √(2 R g)", 0.1..200.0);
    let mut radius = Panel::new("Core line: contact radius", voltage(), radius_axis);
    let mut friction = Panel::new("Core line: friction", voltage(), Axis::log("friction F_T / F*", 1e-4..1e9));
    let of_radius = |point: &Point| (point.scaled_voltage, point.scaled_radius);
    let of_friction = |point: &Point| (point.scaled_voltage, point.scaled_friction);
    radius.add("Eq. (36)", LINE, curve.iter().map(of_radius).collect());
    friction.add("Eqs. (36), (34)", LINE, curve.iter().map(of_friction).collect());
    let power = |factor: f64, exponent: f64| [1e-2, 1e2].map(|v: f64| (v, factor * v.powf(exponent))).to_vec();
    radius.add("V → 0 (a ∝ √V); V → ∞ (a ∝ V)", LIMIT, power(2_f64.powf(0.25), 0.5));
    radius.add("", LIMIT, power(2_f64.sqrt(), 1.0));
    friction.add("V → 0 (F ∝ σ₀); V → ∞ (F ∝ σ₀²)", LIMIT, power(2.0, 2.0));
    friction.add("", LIMIT, power(4.0, 4.0));
    let examples = examples();
    for (index, example) in examples.iter().enumerate() {
        // Each finger has different voltages, so that no mark hides another.
        let voltages = geometric(1.3e-2, 80.0, 24).skip(index).step_by(examples.len());
        let points = points(example, voltages, true)?;
        radius.add(example.name, example.look, points.iter().map(of_radius).collect());
        friction.add(example.name, example.look, points.iter().map(of_friction).collect());
        for point in points {
            put(data, example.name, &point);
        }
    }
    Ok([radius, friction])
}

/// The example finger in SI units.
fn example_panels(curve: &[Point]) -> [Panel; 2] {
    let volts = || Axis::linear("voltage, V rms", 0.0..200.0);
    let millimetres = Axis::linear("contact radius, mm", 0.0..2.0);
    let mut radius = Panel::new("Example finger: contact radius", volts(), millimetres);
    let mut friction = Panel::new("Example finger: friction", volts(), Axis::linear("friction, mN", 0.0..10.0));
    radius.add("Eq. (36)", LINE, curve.iter().map(|p| (p.voltage_v_rms, 1e3 * p.contact_radius_m)).collect());
    friction.add("Eqs. (36), (34)", LINE, curve.iter().map(|p| (p.voltage_v_rms, 1e3 * p.friction_n)).collect());
    [radius, friction]
}

pub(super) fn figure() -> Result<Figure, Box<dyn Error>> {
    let mut data = Data::new([
        "finger",
        "voltage_v_rms",
        "contact_radius_m",
        "friction_n",
        "voltage_over_scale",
        "radius_over_scale",
        "friction_over_scale",
    ]);
    let [example, ..] = examples();
    let scaled = points(&example, geometric(1e-2, 1e2, 161), true)?;
    // Points are denser where the curve of the contact radius begins, because it is steep there.
    let in_volts = points(&example, even(0.0, 1.0, 101).map(|part| 200.0 * part * part), false)?;
    let mut panels: Vec<Panel> = scaled_panels(&scaled, &mut data)?.into();
    panels.extend(example_panels(&in_volts));
    for point in scaled.iter().chain(&in_volts) {
        put(&mut data, "core line", point);
    }
    Ok(Figure {
        name: "fig3-core-line",
        title: "Fig. 3 of the paper: contact radius and friction without a load".to_owned(),
        caption: vec![
            "Without a normal load, contact radius and friction of every finger fall on one line each when voltage is \
             scaled by V* = √(2 k g³/ε₀), radius by √(2 R g) and friction by F* = µ π k R g² (g: effective gap). Three \
             very different fingers, computed in their own units, stand on the lines. At small voltages friction grows \
             with σ₀ ∝ V², at large ones with σ₀² ∝ V⁴, the lower bound of Eq. (42): dashed."
                .to_owned(),
            example::CAPTION.to_owned(),
        ],
        chart: Chart::new(panels, 2),
        csv: data.csv()?,
    })
}

fn put(data: &mut Data<7>, name: &str, point: &Point) {
    data.row([
        name.into(),
        point.voltage_v_rms.into(),
        point.contact_radius_m.into(),
        point.friction_n.into(),
        point.scaled_voltage.into(),
        point.scaled_radius.into(),
        point.scaled_friction.into(),
    ]);
}
