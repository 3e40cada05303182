//! Reasons why an element is perceived less certainly than its friction suggests.

use frixel_layers::{Burst, Layer};
use serde::Serialize;

use super::element::Element;
use super::measure::Measured;
use super::texture::SUMMED_S;
use super::thresholds::{BURST_MIN_S, FINGERTIP_M, TOUCH_S, WAY_MAX_M};
use super::{Step, THRESHOLD_UNCERTAINTY, Texture, Verdict};

/// A reason why an element is not certainly perceived, or not as designed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "reason")]
pub enum Reason {
    /// The element is too small.
    TooSmall {
        /// The cause of the reduced change.
        limit: SizeLimit,
        /// The change of the scene, in Weber steps.
        weber_steps: f64,
    },
    /// The friction changes too slowly.
    TooSlow {
        /// The longest way over which a change counts as one, mm.
        way_mm: f64,
        /// The change over the whole way, in Weber steps.
        weber_steps: f64,
    },
    /// The change is too small for a person to notice.
    TooWeak,
    /// Friction is uniform, and there is no border.
    Flat,
    /// A burst is too short.
    TooShort {
        /// Its duration, ms.
        duration_ms: f64,
        /// The shortest perceptible duration, ms.
        least_ms: f64,
    },
    /// A touch may fall between two bursts.
    TooRare {
        /// The pause between two bursts, ms.
        pause_ms: f64,
        /// The duration of a touch, ms.
        touch_ms: f64,
    },
    /// No study covers it.
    NotStudied,
    /// It is perceived as a vibration, and not as stripes in place.
    Buzz,
}

/// The cause of a reduced change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SizeLimit {
    /// A fingertip, which resolves 2 mm.
    Fingertip,
    /// The touch source, whose reports are late, infrequent and sometimes lost.
    TouchSource,
}

impl Reason {
    /// Whether a larger or stronger element would be perceived more certainly.
    pub(super) fn is_size_or_strength(&self) -> bool {
        matches!(self, Self::TooSmall { .. } | Self::TooSlow { .. } | Self::TooWeak)
    }

    /// The most certain verdict that this reason allows.
    fn most(&self) -> Verdict {
        match self {
            Self::TooShort { duration_ms, .. } if *duration_ms < 1e3 * BURST_MIN_S => Verdict::NotFelt,
            Self::TooRare { .. } => Verdict::Maybe,
            _ => Verdict::Felt,
        }
    }
}

/// The verdict and its reasons for an element, from its perception with the actual display (`felt`) and with an ideal
/// one (`faultless`).
pub(super) fn of(element: &Element, felt: &Measured, faultless: &Measured) -> (Verdict, Vec<Reason>) {
    let verdict = felt.verdict();
    let scene = felt.scene;
    let steps = |step: &Step| step.weber_steps.abs();
    let extent = of_extent(element, felt);
    let own = match verdict {
        _ if extent.is_some_and(|most| verdict > most) => {
            let weber_steps = felt.steps().chain([scene.sharp]).map(|step| steps(&step)).fold(0.0, f64::max);
            Some(Reason::TooSmall { limit: SizeLimit::Fingertip, weber_steps })
        }
        Verdict::Felt => is_buzz(felt).then_some(Reason::Buzz),
        // A larger element would be felt. A vibration has no size.
        _ if !felt.is_vibration && faultless.verdict() == Verdict::Felt => {
            let surest = faultless.steps().max_by(Step::cmp_felt).unwrap_or(faultless.contrast);
            Some(Reason::TooSmall { limit: SizeLimit::TouchSource, weber_steps: steps(&surest) })
        }
        _ if !felt.is_vibration && scene.sharp.verdict == Verdict::Felt => {
            Some(Reason::TooSmall { limit: SizeLimit::Fingertip, weber_steps: steps(&scene.sharp) })
        }
        _ if scene.whole.verdict > verdict.max(scene.sharp.verdict)
            && !felt.is_vibration
            && !is_short_ridge(element) =>
        {
            Some(Reason::TooSlow { way_mm: 1e3 * WAY_MAX_M, weber_steps: steps(&scene.whole) })
        }
        Verdict::Unknown => Some(Reason::NotStudied),
        _ if scene.whole.contrast_n == 0.0 && felt.texture.is_none() && !has_border(element, felt) => {
            Some(Reason::Flat)
        }
        _ => Some(Reason::TooWeak),
    };
    let mut reasons: Vec<Reason> = element
        .burst
        .iter()
        .flat_map(|burst| [too_short(burst, felt), too_rare(burst, element.is_triggered)])
        .flatten()
        .collect();
    let is_short = reasons.iter().any(|reason| matches!(reason, Reason::TooShort { .. }));
    reasons.extend(own.filter(|own| !is_short || *own == Reason::Buzz));
    let most = reasons.iter().map(Reason::most).chain(extent).fold(verdict, Verdict::min);
    (most, reasons)
}

/// The most certain verdict on an element smaller than a fingertip's resolution: below half of it, too small; below all
/// of it, at best near the threshold. A click is perceived anywhere.
fn of_extent(element: &Element, felt: &Measured) -> Option<Verdict> {
    if felt.click.is_some_and(|click| click.step.verdict == Verdict::Felt) {
        return None;
    }
    // Sizes in records are `f32`.
    match element.extent_m() / FINGERTIP_M - 1e-6 {
        part if part <= 0.5 => Some(Verdict::NotFelt),
        part if part < 1.0 - 2e-6 => Some(Verdict::Maybe),
        _ => None,
    }
}

/// Whether it is a ridge so narrow that its slope cannot be too slow.
fn is_short_ridge(element: &Element) -> bool {
    let layer = element.record().map(|record| record.layer);
    matches!(layer, Some(Layer::Edge(edge)) if f64::from(edge.width_m) <= WAY_MAX_M)
}

/// Whether a border can be perceived: a ground of natural friction has none to the bare screen.
fn has_border(element: &Element, felt: &Measured) -> bool {
    let natural_n = element.program.reach.natural_friction_n;
    let is_natural = felt.level.is_some_and(|level| level.scene_n - natural_n < 1e-6);
    felt.border.is_some_and(|border| !is_natural || border.step.verdict > Verdict::NotFelt)
}

/// Whether sufficiently strong stripes are perceived as a vibration only.
fn is_buzz(felt: &Measured) -> bool {
    let is_felt = |step: Step| step.verdict == Verdict::Felt;
    !felt.is_vibration && is_felt(felt.scene.sharp) && !felt.steps().any(is_felt)
}

/// Whether bursts are too short, although their power would suffice if they lasted longer.
fn too_short(burst: &Burst, felt: &Measured) -> Option<Reason> {
    let on_s = f64::from(burst.on_s);
    let faint = felt.texture.filter(|texture| texture.verdict != Verdict::Felt);
    let enough_s = faint.and_then(|Texture { amplitude_n, threshold_n, natural_noise_n, .. }| {
        let enough_n = (THRESHOLD_UNCERTAINTY * threshold_n?).max(natural_noise_n);
        let enough_s = on_s * (enough_n / amplitude_n).powi(2);
        (on_s < SUMMED_S && enough_s <= SUMMED_S).then_some(enough_s)
    });
    let is_short = on_s < BURST_MIN_S || enough_s.is_some();
    let least_ms = 1e3 * enough_s.unwrap_or(0.0).max(BURST_MIN_S);
    is_short.then_some(Reason::TooShort { duration_ms: 1e3 * on_s, least_ms })
}

/// Whether a touch may fall between two bursts. Bursts that are `triggered` start on demand.
fn too_rare(burst: &Burst, triggered: bool) -> Option<Reason> {
    let pause_s = f64::from(burst.period_s) - f64::from(burst.on_s);
    let rare = Reason::TooRare { pause_ms: 1e3 * pause_s, touch_ms: 1e3 * TOUCH_S };
    (pause_s > TOUCH_S && !triggered).then_some(rare)
}
