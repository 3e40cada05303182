//! Verdicts of the judge: values.

use frixel_scene::LayerTitle;
use serde::Serialize;

use super::{AlikeLayers, BorderStep, BurstTimes, Element, Level, Over, Reason, Step, Texture, Verdict};

/// Predicted perception of a program.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Judgement {
    /// The visible layers, from bottom to top.
    pub layers: Vec<LayerVerdict>,
    /// Layers that a person cannot distinguish by their strength.
    pub alike: Vec<AlikeLayers>,
    /// Notes, one sentence each.
    pub notes: Vec<String>,
}

/// Predicted perception of a layer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayerVerdict {
    /// The layer's number and title.
    pub layer: LayerTitle,
    /// Whether a person perceives the layer: the most certain of contrast, texture, border and click, at the best
    /// speed.
    pub verdict: Verdict,
    /// The best speed, mm/s; absent if friction depends on the speed, in a single play of any speed, or if nothing was
    /// played.
    pub speed_mm_per_s: Option<f64>,
    /// Reasons why it is not certainly perceived, or not as designed.
    pub reasons: Vec<Reason>,
    /// A change that would make it perceptible; absent without such advice.
    pub advice: Option<String>,
    /// The variable over which the contrast is measured.
    pub over: Over,
    /// The felt contrast within the layer, over ways of at most 50 mm: from the 5th to the 95th percentile, or from the
    /// smallest to the largest friction for an edge or if [`Self::is_narrow`]. Over speed, from the friction at 20 mm/s
    /// to the friction at 100 mm/s; over direction, between both directions; for a stream, from its lowest to its
    /// highest sample.
    pub contrast: Step,
    /// Whether friction is uniform in the layer except for a narrow place that makes the contrast.
    pub is_narrow: bool,
    /// The most noticeable texture, if the layer has one.
    pub texture: Option<Texture>,
    /// The most certainly perceived border, as a step onto the layer; absent for a layer without a border.
    pub border: Option<BorderStep>,
    /// The bursts of a vibration, during which contrast and texture hold; absent if they hold at all times.
    pub burst: Option<BurstTimes>,
    /// The initial step of the layer's click.
    pub click: Option<Step>,
    /// Whether the drive clamps the click.
    pub is_click_clamped: bool,
    /// Mean friction inside the layer where no other layer is above; absent for narrow layers.
    #[serde(skip)]
    pub level: Option<Level>,
    /// Whether the scene's friction is uniform in the layer.
    #[serde(skip)]
    pub is_flat: bool,
    /// Key for comparing layers.
    #[serde(skip)]
    pub(super) scene: SceneFeel,
}

/// Perception of a layer with an ideal display, for the finger that the scene is designed for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SceneFeel {
    /// Index of the layer from the bottom.
    pub(super) layer: usize,
    pub(super) contrast: Step,
    /// At 50 mm/s.
    pub(super) texture: Option<Texture>,
    /// Bit set of the layers that overlap it.
    pub(super) visible: u64,
}

impl LayerVerdict {
    /// A verdict from a contrast alone.
    pub(super) fn new(element: &Element, contrast: Step, over: Over) -> Self {
        Self {
            layer: element.title.clone(),
            verdict: contrast.verdict,
            speed_mm_per_s: None,
            reasons: Vec::new(),
            advice: None,
            over,
            contrast,
            is_narrow: false,
            texture: None,
            border: None,
            burst: element.burst.map(|burst| BurstTimes {
                on_ms: 1e3 * f64::from(burst.on_s),
                period_ms: 1e3 * f64::from(burst.period_s),
            }),
            click: None,
            is_click_clamped: false,
            level: None,
            is_flat: false,
            scene: SceneFeel { layer: element.layer, contrast, texture: None, visible: 1 << element.layer },
        }
    }

    /// The step that stands for the layer: its contrast or its border, whichever is felt with more certainty.
    pub fn main_step(&self) -> Step {
        let border = self.border.as_ref().map(|border| border.step);
        border.into_iter().chain([self.contrast]).max_by(Step::cmp_felt).unwrap_or(self.contrast)
    }

    /// The same verdict for a copy of the layer.
    pub(super) fn of_copy(&self, copy: &Element) -> Self {
        let visible = self.scene.visible & !(1 << self.scene.layer) | 1 << copy.layer;
        let scene = SceneFeel { layer: copy.layer, visible, ..self.scene };
        let border = self.border.clone().map(|border| BorderStep { to: Some(copy.title.clone()), ..border });
        Self { layer: copy.title.clone(), border, scene, ..self.clone() }
    }
}
