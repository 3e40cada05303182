//! Warnings: the program can be played, but exceeds the validity of the model or the finger's profile, or probably
//! differs from its author's intention.

use frixel_layers::{Blend, Interval};
use thiserror::Error;

use super::cover::{PLACES_MAX, widened};
use super::digits::digits;
use super::file::Scene;
use super::finger::Evidence;
use super::kinds::Kind;
use super::layer::Layer;
use super::program::Program;
use super::reach::{ROUNDING, Reach};
use super::reference::Reference;
use super::titles::{LayerTitle, listed};

/// A reason to doubt a program. Its text is one sentence for the scene's designer.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum Warning {
    /// The electric friction exceeds the finger's natural friction. The law was compared with measurements only below
    /// that, where the exponent of the voltage is near 2.
    #[error(
        "the scene asks for up to {electric_friction_n} N of electric friction, more than the finger's natural friction of \
         {natural_friction_n} N: the model is not confirmed there"
    )]
    ElectricAboveNatural { electric_friction_n: f64, natural_friction_n: f64 },
    /// The scene needs a larger voltage than the measurement of the finger covers.
    #[error(
        "the scene needs up to {voltage_v_rms} V rms, and its finger was measured up to {measured_v_rms} V rms: lower \
         `voltage_max_v_rms`, or measure the finger again"
    )]
    BeyondMeasuredVoltage { voltage_v_rms: f64, measured_v_rms: f64 },
    /// The finger's load is outside the measured range.
    #[error(
        "the finger's load of {normal_load_n} N is outside its measured range, {least_n} N to {largest_n} N: \
         change `normal_load_n`, or measure the finger again"
    )]
    BeyondMeasuredLoad { normal_load_n: f64, least_n: f64, largest_n: f64 },
    /// The rms voltage exceeds what the peak limit of the board or screen allows.
    #[error(
        "`voltage_max_v_rms = {found}` exceeds what the {whose} allows: at most {max_v_rms:.1} V rms are driven, \
         given its limit of {max_v_peak} V peak{why} and a crest factor of {peak_per_rms:.3}"
    )]
    RmsOutOfReach {
        found: f64,
        whose: &'static str,
        max_v_peak: f64,
        why: &'static str,
        peak_per_rms: f64,
        max_v_rms: f64,
    },
    /// The rim of a button leaves no room for its face.
    #[error(
        "{layer}: a rim of {rim_width_mm} mm on both sides leaves no face on a button of {side_mm} mm: make `rim_width_mm` \
         less than {} mm", 0.5 * .side_mm
    )]
    RimWiderThanButton { layer: String, rim_width_mm: f64, side_mm: f64 },
    /// A picture is stretched along one side.
    #[error(
        "{layer}: the picture is stretched by {percent} % in {direction}: to keep its proportions, {}",
        if *.has_own_height {
            "leave the layer's `height_mm` out".to_owned()
        } else {
            format!(
                "make its region {height_mm} mm high, or write `x_mm`, `y_mm` and `width_mm` of the picture in the layer, \
                 beside `region`"
            )
        }
    )]
    PictureStretched { layer: String, percent: f64, direction: &'static str, has_own_height: bool, height_mm: f64 },
    /// Transparent and opaque parts of a picture have the same grey.
    #[error(
        "{layer}: its transparent and opaque parts have the same grey, so its shape cannot be felt: \
         write {cure}"
    )]
    PictureHidden { layer: String, cure: &'static str },
    /// The line of an edge without a region crosses a scene of layers with regions.
    #[error("{layer} has no `region`, so its line crosses the whole screen: add one to end the line there")]
    EdgeAcrossScreen { layer: String },
    /// The line of an edge does not cross its region.
    #[error(
        "{layer}: its line lies {distance_mm} mm outside its `region` and is never crossed: move `x_mm` and `y_mm`, \
         which are screen coordinates, or the region"
    )]
    EdgeOutsideRegion { layer: String, distance_mm: f64 },
    /// The region of an edge clips its ridge.
    #[error(
        "{layer}: its region leaves {room_mm} mm for a ridge of `width_mm = {width_mm}`, and clips its edges: make the \
         region at least as wide as the ridge"
    )]
    RidgeCutOff { layer: String, width_mm: f64, room_mm: f64 },
    /// A layer without a region hides layers below it everywhere.
    #[error(
        "{layer} has no `region`, so it replaces {hidden} on the whole screen{}: give it a `region`, or a `blend` such \
         as \"add\"", if *.is_live { " while it is on" } else { "" }
    )]
    HidesAllBelow { layer: String, is_live: bool, hidden: String },
    /// Two layers of one file have the same name.
    #[error(
        "{layer} has the same name as layer {lower}, which is the one that `--control` changes: rename it, \
         or refer to it as {number}"
    )]
    NameTwice { layer: String, number: String, lower: String },
}

/// Stretch factor above which a warning is issued.
const STRETCH_MAX: f64 = 1.05;

impl Warning {
    /// Returns a warning if the rims of a button leave no face.
    pub(super) fn of_rim(layer: &str, rim_width_mm: f64, side_mm: f64) -> Option<Self> {
        (2.0 * rim_width_mm >= side_mm).then(|| Self::RimWiderThanButton {
            layer: layer.to_owned(),
            rim_width_mm,
            side_mm,
        })
    }

    /// Returns a warning if a picture is stretched. `height_factor` is its height over the height that preserves the
    /// proportions, `height_mm` the latter.
    pub(super) fn of_stretch(layer: &str, height_factor: f64, height_mm: f64, has_own_height: bool) -> Option<Self> {
        let (factor, direction) =
            if height_factor > 1.0 { (height_factor, "height") } else { (1.0 / height_factor, "width") };
        let percent = (100.0 * (factor - 1.0)).round();
        (factor > STRETCH_MAX).then(|| Self::PictureStretched {
            layer: layer.to_owned(),
            percent,
            direction,
            has_own_height,
            height_mm: digits(height_mm, f64::round),
        })
    }

    /// Returns a warning if the line of an edge lies far outside its region, or inside it without room for the ridge.
    /// `distances_mm` are those of the region's sides from the line, along the edge's direction.
    pub(super) fn of_ridge(layer: &str, width_mm: f64, distances_mm: Interval<f64>) -> Option<Self> {
        let Interval { low, high } = distances_mm;
        // Ignore rounding errors.
        let distance_mm = digits((low.max(-high) - 1e-6).max(0.0), f64::round);
        let room_mm = digits(2.0 * high.min(-low), f64::round);
        let layer = || layer.to_owned();
        if distance_mm > 0.0 {
            Some(Self::EdgeOutsideRegion { layer: layer(), distance_mm })
        } else {
            (1e-6..width_mm - 1e-6).contains(&room_mm).then(|| Self::RidgeCutOff { layer: layer(), width_mm, room_mm })
        }
    }

    /// Whether a real board refuses the program because it extrapolates a measurement.
    pub(super) fn is_refused_by_boards(&self) -> bool {
        matches!(self, Self::BeyondMeasuredVoltage { .. } | Self::BeyondMeasuredLoad { .. })
    }
}

/// Returns the warnings of layers that probably differ from their author's intention.
pub(super) fn of_layers(layers: &[Layer]) -> Vec<(&Layer, Warning)> {
    let edges = layers.iter().enumerate().filter_map(|(number, layer)| {
        let has_no_end = matches!(layer.kind, Kind::Edge(_)) && layer.region.is_none() && !layer.is_copy;
        let has_regions_below = layers.iter().take(number).any(|below| below.region.is_some());
        (has_no_end && has_regions_below).then(|| (layer, Warning::EdgeAcrossScreen { layer: layer.title.to_string() }))
    });
    edges.chain(hiding(layers)).chain(same_names(layers)).collect()
}

/// Returns the warning of the topmost layer that hides all layers below it permanently, and of the topmost one above it
/// that hides them while it is on. Switchable layers of full-screen size are expected to hide one another.
fn hiding(layers: &[Layer]) -> impl Iterator<Item = (&Layer, Warning)> {
    let hides = |layer: &Layer| {
        let is_everywhere = layer.region.is_none() && layer.kind.fills_screen();
        layer.blend == Blend::Replace && is_everywhere && !matches!(layer.kind, Kind::Stream(_))
    };
    let topmost = |is_live: bool| layers.iter().rposition(|layer| layer.live == is_live && hides(layer));
    let (for_good, while_on) = (topmost(false), topmost(true));
    let has_regions = |number: usize| layers.iter().take(number).any(|below| below.region.is_some());
    let is_above = |number: usize| for_good.is_none_or(|for_good| number > for_good);
    let while_on = while_on.filter(|number| is_above(*number) && has_regions(*number));
    for_good.into_iter().chain(while_on).filter(|number| *number > 0).filter_map(|number| {
        let layer = layers.get(number)?;
        let hidden: Vec<&LayerTitle> = layers.iter().take(number).map(|below| &below.title).collect();
        let (is_live, hidden) = (layer.live, listed(&hidden));
        Some((layer, Warning::HidesAllBelow { layer: layer.title.to_string(), is_live, hidden }))
    })
}

/// Returns the warnings of layers that share the name of a lower layer. Of copies, only the first is included.
fn same_names(layers: &[Layer]) -> impl Iterator<Item = (&Layer, Warning)> {
    let twin = |number: usize, layer: &Layer| {
        let below = layers.iter().take(number).filter(|other| other.name.is_some() && other.name == layer.name);
        below.map(Layer::number).next()
    };
    let twins = layers.iter().enumerate().filter_map(move |(number, layer)| Some((layer, twin(number, layer)?)));
    let mut warned = Vec::new();
    twins.filter_map(move |(layer, lower)| {
        let is_first = !warned.contains(&layer.number().table);
        warned.push(layer.number().table);
        let (number, lower) = (layer.number().to_string(), lower.to_string());
        is_first.then(|| (layer, Warning::NameTwice { layer: layer.title.to_string(), number, lower }))
    })
}

/// The warnings of a program.
pub(super) fn of(scene: &Scene, program: &Program) -> Vec<Warning> {
    let reach = &program.reach;
    let mut warnings = Vec::new();
    if let Some(largest_n) = demand_above(program, reach.natural_friction_n) {
        warnings.push(Warning::ElectricAboveNatural {
            electric_friction_n: digits(largest_n, f64::round),
            natural_friction_n: digits(reach.natural_friction_n, f64::round),
        });
    }
    let finger = scene.finger();
    let Evidence::Measured { voltage_max_v_rms, normal_load_range_n: [least_n, largest_n], .. } = finger.evidence
    else {
        return warnings;
    };
    // The law is valid: the reach was computed from it.
    if let Ok(law) = program.mean_friction() {
        let measured_n = (1.0 + ROUNDING) * law.electric_friction_n(voltage_max_v_rms);
        if let Some(needed_n) = demand_above(program, measured_n) {
            let voltage_v_rms = digits(law.voltage_v_rms(needed_n), f64::round);
            warnings.push(Warning::BeyondMeasuredVoltage { voltage_v_rms, measured_v_rms: voltage_max_v_rms });
        }
    }
    let normal_load_n = finger.normal_load_n;
    if !(least_n..=largest_n).contains(&normal_load_n) {
        warnings.push(Warning::BeyondMeasuredLoad { normal_load_n, least_n, largest_n });
    }
    warnings
}

/// The largest electric friction that the scene asks for and the drive reaches, if it exceeds `limit_n`. A host that
/// changes layers can ask for the full reach.
fn demand_above(program: &Program, limit_n: f64) -> Option<f64> {
    let Program { header, reach: Reach { electric_friction_max_n, .. }, .. } = program;
    let largest_n = if header.layers_fixed {
        let below = Interval { low: f64::NEG_INFINITY, high: limit_n };
        widened(below, header, Reference::new(program).pieces(), PLACES_MAX).high
    } else {
        *electric_friction_max_n
    };
    Some(largest_n.min(*electric_friction_max_n)).filter(|largest_n| *largest_n > limit_n)
}
