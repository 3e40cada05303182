//! Verdicts of the judge: values.

use frixel_scene::LayerTitle;
use serde::Serialize;

use super::{AlikeLayers, BorderStep, BurstTimes, Element, Level, Over, Reason, Step, Texture, Verdict};

/// What a person will feel of a program.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Judgement {
    /// The layers that are visible somewhere, from bottom to top.
    pub layers: Vec<LayerVerdict>,
    /// Layers that a person cannot tell apart by their strength.
    pub alike: Vec<AlikeLayers>,
    /// What only a sliding finger feels, and other notes, a sentence each.
    pub notes: Vec<String>,
}

/// What a person will feel of a layer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayerVerdict {
    /// The layer's number and title.
    pub layer: LayerTitle,
    /// Whether a person feels the layer: the surest of contrast, texture, border and click, at the best of the speeds.
    pub verdict: Verdict,
    /// The best of the speeds, mm/s; absent where friction depends on the speed, in one play of any speed, or where
    /// nothing was played.
    pub speed_mm_per_s: Option<f64>,
    /// Why it is not surely felt, or felt otherwise than it is written.
    pub reasons: Vec<Reason>,
    /// What would be felt instead; absent where nothing was sought.
    pub advice: Option<String>,
    /// What the contrast is a change with.
    pub over: Over,
    /// The felt contrast within the layer, on ways of at most 50 mm: from the 5th to the 95th percentile, or from the
    /// least to the largest friction of an edge, or if [`Self::is_narrow`]. Over speed, from the friction at 20 mm/s to
    /// that at 100 mm/s; over the direction, between a slide and the slide back; of a stream, from its lowest to its
    /// highest sample.
    pub contrast: Step,
    /// Whether the friction is the same almost everywhere in the layer, but for a narrow place that makes the contrast.
    pub is_narrow: bool,
    /// The most noticeable texture; absent where there is none.
    pub texture: Option<Texture>,
    /// The border of the layer that is felt most surely, as a step onto it; absent for a layer without any.
    pub border: Option<BorderStep>,
    /// The bursts of a vibration, during which contrast and texture hold; absent if they hold all the time.
    pub burst: Option<BurstTimes>,
    /// The step with which the layer's click begins.
    pub click: Option<Step>,
    /// Whether the drive cannot give all of the click.
    pub is_click_cut_off: bool,
    /// Mean friction inside of the layer where no other one is above; absent for narrow layers.
    #[serde(skip)]
    pub level: Option<Level>,
    /// Whether the scene has the same friction throughout the layer.
    #[serde(skip)]
    pub is_flat: bool,
    /// What layers are compared by.
    #[serde(skip)]
    pub(super) scene: SceneFeel,
}

/// What a display without fault gives of a layer, to the finger that the scene is meant for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SceneFeel {
    /// Index of the layer from the bottom.
    pub(super) layer: usize,
    pub(super) contrast: Step,
    /// At 50 mm/s.
    pub(super) texture: Option<Texture>,
    /// The layers that act where the layer does, a bit each.
    pub(super) visible: u64,
}

impl LayerVerdict {
    /// A layer of which nothing but a contrast is known.
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
            is_click_cut_off: false,
            level: None,
            is_flat: false,
            scene: SceneFeel { layer: element.layer, contrast, texture: None, visible: 1 << element.layer },
        }
    }

    /// The same of a copy of the layer.
    pub(super) fn of_copy(&self, copy: &Element) -> Self {
        let visible = self.scene.visible & !(1 << self.scene.layer) | 1 << copy.layer;
        let scene = SceneFeel { layer: copy.layer, visible, ..self.scene };
        let border = self.border.clone().map(|border| BorderStep { to: Some(copy.title.clone()), ..border });
        Self { layer: copy.title.clone(), border, scene, ..self.clone() }
    }
}
