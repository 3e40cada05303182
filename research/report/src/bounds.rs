//! Upper and lower bound of the model, and a finger of finite size.
use std::error::Error;

use frixel::report::{Data, Figure};
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel, graded};
use frixel_model::ContactModel;

use super::{example, geometric};

/// Outer radii of the attraction, in metres.
const OUTER_RADII_M: [f64; 3] = [1e-3, 0.5e-3, 0.2e-3];
const LOADS_N: [f64; 5] = [0.0, 1e-4, 1e-2, 0.1, 0.5];

pub(super) fn figure() -> Result<Figure, Box<dyn Error>> {
    let contact = example::contact::<f64>()?;
    let voltages = geometric(1.0, 1e3, 121);
    let mut data = Data::new(["bound", "normal_force_n", "outer_radius_m", "voltage_v_rms", "electric_friction_n"]);
    let mut left =
        Panel::new("No load: the bounds", Axis::log("voltage, V rms", 1.0..1e3), Axis::log("friction, mN", 1e-8..1e4));
    let mut curve = |name: &str, load_n: f64, outer_m: Option<f64>, model: &dyn ContactModel<f64>| {
        let points: Vec<_> = voltages
            .clone()
            // A contact that would exceed the outer radius has no solution.
            .filter_map(|voltage| Some((voltage, model.state(voltage).ok()?.electric_friction_n)))
            .collect();
        for (voltage, friction) in &points {
            data.row([name.into(), load_n.into(), outer_m.into(), (*voltage).into(), (*friction).into()]);
        }
        points.into_iter().map(|(voltage, friction_n)| (voltage, 1e3 * friction_n)).collect::<Vec<_>>()
    };
    let upper = curve("upper", 0.0, None, &contact.under_load(0.0)?);
    left.add("upper bound, Eqs. (34), (36)", Look::line(PALETTE[0], Line::Solid), upper);
    for (index, radius_m) in (0..).zip(OUTER_RADII_M) {
        let points = curve("finite", 0.0, Some(radius_m), &contact.within(radius_m, 0.0)?);
        let name = format!("finger ends at b = {} mm, Eq. (19)", 1e3 * radius_m);
        let colour = PALETTE[[4, 2, 5][index]];
        let end = points.last().copied();
        left.add(&name, Look::line(colour, Line::Solid), points);
        left.add("", Look::mark(colour, Mark::Ring), end.into_iter().collect());
    }
    left.add("the contact would pass b", Look::mark(PALETTE[6], Mark::Ring), Vec::new());
    let lower = curve("lower", 0.0, None, &contact.lower_bound(0.0)?);
    left.add("lower bound, Eq. (42)", Look::line(PALETTE[1], Line::Solid), lower);

    let mut right = Panel::new(
        "What the bounds leave open",
        Axis::log("voltage, V rms", 1.0..1e3),
        Axis::linear("electric friction: lower / upper bound", 0.0..1.05),
    );
    for (index, load_n) in LOADS_N.into_iter().enumerate() {
        let upper = curve("upper", load_n, None, &contact.under_load(load_n)?);
        let lower = curve("lower", load_n, None, &contact.lower_bound(load_n)?);
        let ratio = upper.iter().zip(&lower).map(|(upper, lower)| (upper.0, lower.1 / upper.1)).collect();
        right.add(&format!("F_N = {load_n} N"), Look::line(graded(index, LOADS_N.len()), Line::Solid), ratio);
    }
    Ok(Figure {
        name: "upper-and-lower-bound",
        title: "Upper against lower bound".to_owned(),
        caption: vec![
            "The upper bound counts the attraction around the contact to any distance, the lower bound not at all. \
             Left: without a load they part at small voltages, where the upper bound grows with V² and the lower one \
             with V⁴, and meet far above V* = 64 V. A finger that ends at an outer radius b lies between them; its \
             curve stops where the contact would pass b: rings."
                .to_owned(),
            "Right: under a load the contact is large, what surrounds it hardly matters, and the bounds nearly \
             coincide: at 0.5 N they are 1 % apart at any voltage that a screen has."
                .to_owned(),
            example::CAPTION.to_owned(),
        ],
        chart: Chart::new(vec![left, right], 2),
        csv: data.csv()?,
    })
}
