//! The figures, one module each.

mod boards;
mod bounds;
mod core_line;
mod loads;
mod run_time;
mod scene_bytes;
mod soft;
mod stability;
mod stability_soft;
mod tick_layers;
mod tick_rate;

use frixel_model::{Contact, Finger, ParameterError, Real};

use boards::Boards;

use super::counts::Counts;
use super::error::ReportError;
use crate::chart::Chart;

/// Effective gap of the example finger, in metres.
const GAP_M: f64 = 1e-5;
/// Load at which the example finger is meant, in newtons.
const LOAD_N: f64 = 0.5;

/// A picture, what it says, and the numbers behind it.
pub(super) struct Figure {
    /// Name of its CSV file, without the end, and of its place in the page.
    pub(super) name: &'static str,
    pub(super) title: String,
    /// What a reader who has nothing but the picture needs to know: paragraphs.
    pub(super) caption: Vec<String>,
    pub(super) chart: Chart,
    /// What the CSV file has.
    pub(super) csv: Vec<u8>,
}

/// All figures in the page's order.
pub(super) fn all(counts: Option<&Counts>) -> Result<Vec<Figure>, ReportError> {
    let measured = run_time::measure()?;
    let instructions = counts.map(|counts| run_time::against_instructions(&measured, counts)).transpose()?.flatten();
    let inversions = Boards::new(instructions.as_ref(), counts);
    let layers = counts.map(tick_layers::figure).transpose()?.flatten();
    let ticks = Boards::new(layers.as_ref(), counts);
    let figures = [
        Some(core_line::figure()?),
        Some(loads::contact_radius()?),
        Some(loads::friction()?),
        Some(bounds::figure()?),
        Some(soft::figure()?),
        instructions,
        Some(run_time::against_time(&measured, inversions)?),
        Some(run_time::against_size(&measured)?),
        Some(tick_rate::figure()?),
        layers,
        Some(scene_bytes::figure(&ticks.sentence("a tick"))?),
        Some(stability::in_f64()?),
        Some(stability::in_f32()?),
        Some(stability_soft::figure()?),
    ];
    Ok(figures.into_iter().flatten().collect())
}

/// The example finger: 250 mN at no voltage and 28 mN more at 150 V rms, under 0.5 N. Chosen to give friction of the
/// size that is measured; a real finger's profile is fitted.
fn example_finger() -> Finger<f64> {
    Finger { radius_m: 8e-3, stiffness_pa_per_m: 1.8e7, friction_coefficient: 0.5 }
}

/// The example finger on its coating, in either precision.
fn example<T: Real>() -> Result<Contact<T>, ParameterError> {
    let Finger { radius_m, stiffness_pa_per_m, friction_coefficient } = example_finger();
    let finger = Finger {
        radius_m: T::from_f64(radius_m),
        stiffness_pa_per_m: T::from_f64(stiffness_pa_per_m),
        friction_coefficient: T::from_f64(friction_coefficient),
    };
    Contact::new(&finger, T::from_f64(GAP_M))
}

/// What every caption about the example finger ends with.
const EXAMPLE: &str = "Example finger: R = 8 mm, k = 18 MPa/m, µ = 0.5, effective gap 10 µm (250 mN of friction \
                       without voltage under 0.5 N, and 28 mN more at 150 V rms).";

/// `count` values from `start` to `end`, evenly.
fn even(start: f64, end: f64, count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |index| start + (end - start) * index as f64 / (count - 1) as f64)
}

/// `count` values from `start` to `end`, evenly in their logarithms.
fn geometric(start: f64, end: f64, count: usize) -> impl Iterator<Item = f64> + Clone {
    even(start.log10(), end.log10(), count).map(|power| 10_f64.powf(power))
}
