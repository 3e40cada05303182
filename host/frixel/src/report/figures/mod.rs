//! The figures, one per module.

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
mod touch_estimators;

use frixel_model::{Contact, Finger, ParameterError, Real};

use boards::BoardCostFigure;

use super::counts::Counts;
use super::error::ReportError;
use crate::chart::Chart;

/// Effective gap of the finger of the charts, in metres.
const GAP_M: f64 = 1e-5;
/// Normal load on the example finger, in newtons.
const LOAD_N: f64 = 0.5;

/// A picture with its caption and the numbers behind it.
pub(super) struct Figure {
    /// Name of the figure, used for its CSV file (without the extension) and its anchor in the page.
    pub(super) name: &'static str,
    pub(super) title: String,
    /// Paragraphs that explain the picture without any other text.
    pub(super) caption: Vec<String>,
    pub(super) chart: Chart,
    /// Content of the CSV file.
    pub(super) csv: Vec<u8>,
}

/// All figures in the order of the page.
pub(super) fn all(counts: Option<&Counts>) -> Result<Vec<Figure>, ReportError> {
    let measured = run_time::measure()?;
    let instructions = counts.map(|counts| run_time::against_instructions(&measured, counts)).transpose()?.flatten();
    let inversions = BoardCostFigure::new(instructions.as_ref(), counts);
    let layers = counts.map(tick_layers::figure).transpose()?.flatten();
    let ticks = BoardCostFigure::new(layers.as_ref(), counts);
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
        Some(touch_estimators::figure()?),
        layers,
        Some(scene_bytes::figure(&ticks.sentence("a tick"))?),
        Some(stability::in_f64()?),
        Some(stability::in_f32()?),
        Some(stability_soft::figure()?),
    ];
    Ok(figures.into_iter().flatten().collect())
}

/// The finger of the charts: that of `scenes/fingers/example.toml`, on an effective gap of 10 um in place of 5 um. 250
/// mN at zero voltage and 28 mN more at 150 V rms, under 0.5 N.
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

/// Last sentence of every caption about the example finger.
const EXAMPLE: &str = "Example finger, assumed: R = 8 mm, k = 18 MPa/m, µ = 0.5, on an effective gap of 10 µm in place of \
                       the 5 µm of its profile (250 mN of friction \
                       without voltage under 0.5 N, and 28 mN more at 150 V rms).";

/// `count` evenly spaced values from `start` to `end`.
fn even(start: f64, end: f64, count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |index| start + (end - start) * index as f64 / (count - 1) as f64)
}

/// `count` values from `start` to `end`, evenly spaced in their logarithms.
fn geometric(start: f64, end: f64, count: usize) -> impl Iterator<Item = f64> + Clone {
    even(start.log10(), end.log10(), count).map(|power| 10_f64.powf(power))
}
