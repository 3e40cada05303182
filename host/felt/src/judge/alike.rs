//! Layers of one kind with indistinguishable strength.

use frixel_layers::Layer;
use frixel_scene::{LayerTitle, Program};
use serde::Serialize;

use super::{Element, LayerVerdict, Texture, VOLTAGE_DIFFERENCE_DB, Verdict, weber_steps};

/// An element and its verdict.
type Judged = (Element, LayerVerdict);

/// Largest difference in frequency, in octaves, at which textures are compared by voltage. Assumed.
const ALIKE_OCTAVES: f64 = 1.0 / 3.0;
/// Difference below which frictions are indistinguishable, in Weber steps.
const ALIKE_WEBER_STEPS: f64 = 1.0;

/// Relative difference in width above which rims of buttons are distinguished by width. Assumed.
const ALIKE_WIDTHS: f64 = 0.25;

/// Two layers of one kind with an imperceptible difference. One of the two differences is known.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AlikeLayers {
    /// The layers; of copies, the first ones.
    pub layers: [LayerTitle; 2],
    /// Number of other copies of each.
    pub copies: [usize; 2],
    /// Voltage difference at the 95th percentile of the friction, dB, for textures of similar frequency.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub difference_db: Option<f64>,
    /// Difference of the least or the largest frictions, whichever is larger, in Weber steps, for plates, buttons and
    /// ridges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub difference_weber_steps: Option<f64>,
}

/// Pairs of indistinguishable layers of one kind, each for all copies of both. Excluded are layers with equal
/// parameters, which are meant to feel the same; layers that act at the same place; imperceptible layers; and layers
/// that depend on the direction, which differ by it at any strength.
pub(super) fn of(judged: &[Judged], program: &Program) -> Vec<AlikeLayers> {
    let mut groups: Vec<(&Judged, usize)> = Vec::new();
    for layer in judged.iter().filter(|(_, found)| found.verdict > Verdict::Unknown) {
        match groups.iter_mut().find(|((first, _), _)| first.has_parameters_of(&layer.0)) {
            Some((_, copies)) => *copies += 1,
            None => groups.push((layer, 0)),
        }
    }
    let pairs = groups
        .iter()
        .enumerate()
        .flat_map(|(number, one)| groups.iter().skip(number + 1).map(move |other| (one, other)));
    let alike = |((one, one_copies), (other, other_copies)): (&(&Judged, usize), &(&Judged, usize))| {
        let is_comparable = !acts_on(one, other) && !acts_on(other, one) && are_of_one_form(one, other);
        let alike = is_comparable.then(|| alike(&one.1, &other.1, program)).flatten()?;
        Some(AlikeLayers { copies: [*one_copies, *other_copies], ..alike })
    };
    pairs.filter_map(alike).collect()
}

/// Whether two layers are of one kind, with rims of similar width in case of buttons.
fn are_of_one_form((one, _): &Judged, (other, _): &Judged) -> bool {
    let layer = |element: &Element| element.record().map(|record| record.layer);
    match (layer(one), layer(other)) {
        (Some(Layer::Button(one)), Some(Layer::Button(other))) => {
            let (narrow_m, wide_m) = (one.rim_width_m.min(other.rim_width_m), one.rim_width_m.max(other.rim_width_m));
            f64::from(wide_m - narrow_m) <= ALIKE_WIDTHS * f64::from(wide_m)
        }
        (Some(Layer::Direction(_)), Some(_)) => false,
        (Some(one), Some(other)) => one.number() == other.number(),
        _ => false,
    }
}

/// Whether a layer overlaps another one.
fn acts_on((one, _): &Judged, (_, other): &Judged) -> bool {
    other.scene.visible >> one.layer & 1 == 1
}

/// The layers and their difference, if it is imperceptible.
fn alike(one: &LayerVerdict, other: &LayerVerdict, program: &Program) -> Option<AlikeLayers> {
    let layers = [one, other].map(|found| found.layer.clone());
    match (felt_texture(one), felt_texture(other)) {
        (Some(one_texture), Some(other_texture)) => {
            let octaves = libm::log2(one_texture.frequency_hz / other_texture.frequency_hz).abs();
            let ratio = voltage_v_rms(one, program)? / voltage_v_rms(other, program)?;
            let difference_db = 20.0 * libm::log10(ratio).abs();
            let is_alike = octaves < ALIKE_OCTAVES && difference_db < VOLTAGE_DIFFERENCE_DB;
            let difference_db = Some(difference_db);
            is_alike.then_some(AlikeLayers { layers, copies: [0, 0], difference_db, difference_weber_steps: None })
        }
        (None, None) => {
            let (one, other) = (&one.scene.contrast, &other.scene.contrast);
            let least = weber_steps(one.from_n, other.from_n).abs();
            let steps = weber_steps(one.to_n, other.to_n).abs().max(least);
            let difference_weber_steps = Some(steps);
            let alike = AlikeLayers { layers, copies: [0, 0], difference_db: None, difference_weber_steps };
            (steps < ALIKE_WEBER_STEPS).then_some(alike)
        }
        _ => None,
    }
}

/// The texture at the usual speed, if it may be perceptible.
fn felt_texture(found: &LayerVerdict) -> Option<&Texture> {
    found.scene.texture.as_ref().filter(|texture| texture.verdict != Verdict::NotFelt)
}

/// The voltage at the 95th percentile of the friction; `None` at natural friction.
fn voltage_v_rms(found: &LayerVerdict, program: &Program) -> Option<f64> {
    let electric_n = found.scene.contrast.to_n - program.reach.natural_friction_n;
    let law = program.mean_friction().ok().filter(|_| electric_n > 0.0)?;
    Some(law.voltage_v_rms(electric_n))
}
