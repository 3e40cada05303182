//! The figures, one per module.

mod boards;
mod run_time;
mod scene;
mod scene_bytes;
mod stability;
mod stability_pulled;
mod stability_soft;
mod tick_layers;

use boards::BoardCostFigure;

use super::Subject;
use super::counts::Counts;
use super::error::ReportError;
use super::figure::Figure;
use super::finger::DrawnFinger;
use super::page::Answer;

/// The answers, and all figures in the order of the page.
pub(super) fn all(subject: &Subject, counts: &Counts) -> Result<(Vec<Answer>, Vec<Figure>), ReportError> {
    let drawn = &DrawnFinger::of(subject.program)?;
    let measured = run_time::measure(drawn)?;
    let instructions = run_time::against_instructions(&measured, drawn, counts)?;
    let inversions = BoardCostFigure::new(instructions.as_ref());
    let layers = tick_layers::figure(counts)?;
    let ticks = BoardCostFigure::new(layers.as_ref());
    let time = run_time::against_time(&measured, drawn, inversions)?;
    let (in_f64, worst_f64) = stability::in_f64()?;
    let (in_f32, worst_f32) = stability::in_f32()?;
    let (pulled, worst_pulled) = stability_pulled::figure()?;
    let (soft, worst_soft) = stability_soft::figure()?;
    let (scene, left_out) = scene::figure(subject, counts)?;
    let answers = vec![
        Answer {
            question: "Error against run time",
            sentences: drawn.instead.iter().cloned().chain(run_time::sentences(&measured, counts)).collect(),
            figure: time.name,
        },
        Answer {
            question: "Stability on stiff and extreme cases",
            sentences: vec![
                format!("In f64, attraction and load over 24 and 14 decades: {worst_f64}."),
                format!("In f32: {worst_f32}."),
                format!(
                    "Under a negative load, in f64: forward {}, and {}, where the problem itself is ill-conditioned; \
                     inverse {}.",
                    worst_pulled.forward, worst_pulled.alike, worst_pulled.inverse
                ),
                format!("Soft finger, in f64: {worst_soft}."),
            ],
            figure: in_f64.name,
        },
        Answer { question: "What is left out", sentences: left_out, figure: scene.name },
    ];
    let figures = [
        instructions,
        Some(time),
        Some(run_time::against_size(&measured, drawn)?),
        Some(in_f64),
        Some(in_f32),
        Some(pulled),
        Some(soft),
        Some(scene),
        layers,
        Some(scene_bytes::figure(drawn, &ticks.sentence("a tick"))?),
    ];
    Ok((answers, figures.into_iter().flatten().collect()))
}
