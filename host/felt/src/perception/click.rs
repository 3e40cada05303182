//! What a person will feel of a layer's click.

use super::slide::{Slide, total_n};
use super::{SAMPLE_HZ, Step};
use frixel_scene::Program;
use frixel_scene::reference::Reference;

/// The friction that is missing to a click, in N, from which it counts as cut off: above the rounding of `f32`.
const CUT_MIN_N: f64 = 1e-6;

/// The step with which a click begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ClickStep {
    /// From the friction where the click begins to that with the click.
    pub(super) step: Step,
    /// Whether the drive cannot give all of it.
    pub(super) is_cut_off: bool,
}

impl ClickStep {
    /// The click of a layer, on the slide that makes the largest step, without the layers above it and the clicks of
    /// those below; `None` for a layer that does not click.
    pub(super) fn of(layer: usize, slides: &[Slide], program: &Program, speed_m_per_s: f64) -> Option<Self> {
        program.records.get(layer)?.layer.click()?;
        let steps = slides.iter().filter_map(|slide| Self::on(&slide.begun_outside(), layer, program, speed_m_per_s));
        steps.max_by(|one, other| one.step.contrast_n.abs().total_cmp(&other.step.contrast_n.abs()))
    }

    /// The largest click of a layer on a slide.
    fn on(slide: &Slide, layer: usize, program: &Program, speed_m_per_s: f64) -> Option<Self> {
        let without = Reference::new(program).with_only(|other| other <= layer);
        let mut with = without.clone().along_stroke().with_clicks_of(layer);
        let frictions = slide
            .contexts(speed_m_per_s, SAMPLE_HZ)
            .map(|context| [without.electric_friction_at_n(&context), with.electric_friction_n(&context)]);
        let size_n = |[without_n, with_n]: &[f64; 2]| (with_n - without_n).abs();
        let largest = frictions.max_by(|one, other| size_n(one).total_cmp(&size_n(other)));
        let electric_n = largest.filter(|largest| size_n(largest) > 0.0)?;
        let [from_n, to_n] = electric_n.map(|electric_n| total_n(program, electric_n));
        let is_cut_off = size_n(&electric_n) - (to_n - from_n).abs() > CUT_MIN_N;
        Some(Self { step: Step::new(from_n, to_n), is_cut_off })
    }
}
