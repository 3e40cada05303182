//! The figures, one per module.

mod boards;
mod run_time;
mod scene_bytes;
mod stability;
mod stability_soft;
mod tick_layers;

use boards::BoardCostFigure;

use super::counts::Counts;
use super::error::ReportError;
use super::example;
use super::figure::Figure;

/// All figures in the order of the page.
pub(super) fn all(counts: Option<&Counts>) -> Result<Vec<Figure>, ReportError> {
    let measured = run_time::measure()?;
    let instructions = counts.map(|counts| run_time::against_instructions(&measured, counts)).transpose()?.flatten();
    let inversions = BoardCostFigure::new(instructions.as_ref(), counts);
    let layers = counts.map(tick_layers::figure).transpose()?.flatten();
    let ticks = BoardCostFigure::new(layers.as_ref(), counts);
    let figures = [
        instructions,
        Some(run_time::against_time(&measured, inversions)?),
        Some(run_time::against_size(&measured)?),
        layers,
        Some(scene_bytes::figure(&ticks.sentence("a tick"))?),
        Some(stability::in_f64()?),
        Some(stability::in_f32()?),
        Some(stability_soft::figure()?),
    ];
    Ok(figures.into_iter().flatten().collect())
}
