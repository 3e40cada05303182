//! Figs. 4 and 5 of the paper: contact radius and friction over voltage for normal loads of both signs.
use core::f64::consts::PI;
use std::error::Error;

use frixel::report::{Data, Figure};
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel, graded, signed};
use frixel_model::{Contact, ContactModel, ContactState};

use super::{even, example};

/// The paper's relative normal force `f_N = F_N/(k R h0^2)`, Eq. (44), for a coating of permittivity one.
const RELATIVE_LOADS: [f64; 9] = [-20.0, -10.0, -5.0, -1.0, 0.0, 1.0, 5.0, 10.0, 20.0];
/// Normal loads of a finger on a screen, in newtons.
const LOADS_N: [f64; 5] = [0.0, 0.1, 0.2, 0.5, 1.0];

/// The curve of one load, from the lowest voltage at which the contact holds.
struct Curve {
    relative_load: f64,
    normal_load_n: f64,
    /// Voltages with the contact state at each.
    points: Vec<(f64, ContactState<f64>)>,
    /// Whether the first point is the pull-off.
    pulled: bool,
}

fn curve(contact: Contact<f64>, relative_load: f64, voltage_max: f64) -> Result<Curve, Box<dyn Error>> {
    let normal_load_n = relative_load / PI * contact.load_scale_n();
    let pulled = normal_load_n < 0.0;
    let (model, first): (Box<dyn ContactModel<f64>>, f64) = if pulled {
        let pulled = contact.under_pull(-normal_load_n)?;
        // Rounded up, so that a contact exists.
        (Box::new(pulled), pulled.pull_off_voltage_v_rms()? * (1.0 + 1e-12))
    } else {
        (Box::new(contact.under_load(normal_load_n)?), 0.0)
    };
    let mut points = Vec::new();
    // Points are denser where the curve begins, because it is steep there.
    for part in even(0.0, 1.0, 121) {
        let voltage_v_rms = first + (voltage_max - first) * part * part;
        points.push((voltage_v_rms, model.state(voltage_v_rms)?));
    }
    Ok(Curve { relative_load, normal_load_n, points, pulled })
}

fn relative_curves(contact: Contact<f64>) -> Result<Vec<Curve>, Box<dyn Error>> {
    RELATIVE_LOADS.iter().map(|load| curve(contact, *load, 1.8 * contact.voltage_scale_v_rms())).collect()
}

fn load_curves(contact: Contact<f64>) -> Result<Vec<Curve>, Box<dyn Error>> {
    LOADS_N.iter().map(|load| curve(contact, PI * load / contact.load_scale_n(), 200.0)).collect()
}

fn draw(
    panel: &mut Panel,
    curves: &[Curve],
    name: impl Fn(&Curve) -> String,
    at: impl Fn(&(f64, ContactState<f64>)) -> (f64, f64),
) {
    let any_pulled = curves.iter().any(|curve| curve.pulled);
    let largest = curves.iter().map(|curve| curve.relative_load).fold(0.0, f64::max);
    for (index, curve) in curves.iter().enumerate() {
        let colour = if any_pulled { signed(curve.relative_load / largest) } else { graded(index, curves.len()) };
        let points: Vec<_> = curve.points.iter().map(&at).collect();
        let start = points.first().copied().filter(|_| curve.pulled);
        panel.add(&name(curve), Look::line(colour, Line::Solid), points);
        if let Some(start) = start {
            panel.add("", Look::mark(colour, Mark::Ring), vec![start]);
        }
    }
    if any_pulled {
        panel.add("pull-off", Look::mark(PALETTE[6], Mark::Ring), Vec::new());
    }
}

/// The rows of all curves, each with one quantity in its unit and scaled.
fn data(
    families: [&[Curve]; 2],
    quantity: [&'static str; 2],
    contact: &Contact<f64>,
    values: impl Fn(&ContactState<f64>) -> [f64; 2],
) -> Result<Vec<u8>, Box<dyn Error>> {
    let [in_unit, scaled] = quantity;
    let mut data = Data::new([
        "panel",
        "relative_normal_force",
        "normal_force_n",
        "voltage_v_rms",
        "voltage_over_scale",
        in_unit,
        scaled,
    ]);
    let [relative, on_screen] = families;
    let named = relative.iter().map(|curve| ("relative", curve)).chain(on_screen.iter().map(|curve| ("screen", curve)));
    for (panel, curve) in named {
        for (voltage_v_rms, state) in &curve.points {
            let [in_unit, scaled] = values(state);
            data.row([
                panel.into(),
                curve.relative_load.into(),
                curve.normal_load_n.into(),
                (*voltage_v_rms).into(),
                (voltage_v_rms / contact.voltage_scale_v_rms()).into(),
                in_unit.into(),
                scaled.into(),
            ]);
        }
    }
    Ok(data.csv()?)
}

fn relative_name(curve: &Curve) -> String {
    format!("f_N = {}", curve.relative_load).replace('-', "−")
}

fn load_name(curve: &Curve) -> String {
    format!("F_N = {:.1} N", curve.normal_load_n)
}

pub(super) fn contact_radius() -> Result<Figure, Box<dyn Error>> {
    let contact = example::contact::<f64>()?;
    let (relative, loaded) = (relative_curves(contact)?, load_curves(contact)?);
    let mut left = Panel::new(
        "Relative loads of Eq. (44)",
        Axis::linear("voltage V / V*", 0.0..1.8),
        Axis::linear("contact radius a / √(2 R g)", 0.0..2.8),
    );
    draw(&mut left, &relative, relative_name, |(voltage_v_rms, state)| {
        (voltage_v_rms / contact.voltage_scale_v_rms(), contact.area(state.contact_radius_m).sqrt())
    });
    let mut right = Panel::new(
        "Example finger on a screen",
        Axis::linear("voltage, V rms", 0.0..200.0),
        Axis::linear("contact radius, mm", 0.0..6.0),
    );
    draw(&mut right, &loaded, load_name, |(voltage_v_rms, state)| (*voltage_v_rms, 1e3 * state.contact_radius_m));
    Ok(Figure {
        name: "fig4-contact-radius-under-load",
        title: "Fig. 4 of the paper: contact radius under normal loads of both signs".to_owned(),
        caption: vec![
            "Contact radius over voltage, Eq. (43), for the relative normal force f_N = F_N/(k R h₀²) of Eq. (44) \
             (permittivity 1). A finger that is pulled (f_N < 0) sticks only above a voltage, and comes off with a \
             contact that is not small: rings. A pressing finger has its contact already without voltage."
                .to_owned(),
            "Real loads are far beyond the paper's range: 0.5 N is f_N = 35,000 for the example finger, and voltage \
             hardly changes its contact radius."
                .to_owned(),
            example::CAPTION.to_owned(),
        ],
        csv: data([&relative, &loaded], ["contact_radius_m", "radius_over_scale"], &contact, |state| {
            [state.contact_radius_m, contact.area(state.contact_radius_m).sqrt()]
        })?,
        chart: Chart::new(vec![left, right], 2),
    })
}

pub(super) fn friction() -> Result<Figure, Box<dyn Error>> {
    let contact = example::contact::<f64>()?;
    let (relative, loaded) = (relative_curves(contact)?, load_curves(contact)?);
    let mut left = Panel::new(
        "Relative loads of Eq. (44)",
        Axis::linear("voltage V / V*", 0.0..1.8),
        Axis::linear("friction F_T / F*", 0.0..60.0),
    );
    draw(&mut left, &relative, relative_name, |(voltage_v_rms, state)| {
        (voltage_v_rms / contact.voltage_scale_v_rms(), state.friction_n / contact.friction_scale_n())
    });
    let mut right = Panel::new(
        "Example finger on a screen: what voltage adds",
        Axis::linear("voltage, V rms", 0.0..200.0),
        Axis::linear("electric friction F_T − µ F_N, mN", 0.0..80.0),
    );
    draw(&mut right, &loaded, load_name, |(voltage_v_rms, state)| (*voltage_v_rms, 1e3 * state.electric_friction_n));
    Ok(Figure {
        name: "fig5-friction-under-load",
        title: "Fig. 5 of the paper: friction under normal loads of both signs".to_owned(),
        caption: vec![
            "Friction over voltage, Eqs. (43), (21), for the loads of Fig. 4. Left: in total, scaled by F* = µ π k R \
             g²; a pulled finger has friction only above its pull-off (rings). Right: the part that voltage adds to \
             the friction µ F_N of an example finger that presses; a larger contact is attracted more."
                .to_owned(),
            example::CAPTION.to_owned(),
        ],
        csv: data([&relative, &loaded], ["electric_friction_n", "friction_over_scale"], &contact, |state| {
            [state.electric_friction_n, state.friction_n / contact.friction_scale_n()]
        })?,
        chart: Chart::new(vec![left, right], 2),
    })
}
