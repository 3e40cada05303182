//! Warnings: a program that can be played, but that asks for what the model or the finger's profile does not cover, or
//! that is probably not what its author means.

use frixel_layers::{Blend, Interval};
use serde::Serialize;
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
#[derive(Clone, Debug, PartialEq, Error, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Warning {
    /// The scene asks for more electric friction than the finger has natural friction. The law was compared with
    /// measurements below that, where the exponent of the voltage is near 2.
    #[error(
        "the scene asks for up to {electric_friction_n} N of electric friction, more than the finger's natural friction of \
         {natural_friction_n} N: the model is not confirmed there"
    )]
    ElectricAboveNatural {
        /// Largest electric friction that the scene asks for, N.
        electric_friction_n: f64,
        /// Friction at no voltage, N.
        natural_friction_n: f64,
    },
    /// The scene needs a larger voltage than the finger was measured at.
    #[error(
        "the scene needs up to {voltage_v_rms} V rms, and its finger was measured up to {measured_v_rms} V rms: lower \
         `voltage_max_v_rms`, or measure the finger again"
    )]
    BeyondMeasuredVoltage {
        /// Voltage for the largest friction that the scene asks for, V rms.
        voltage_v_rms: f64,
        /// Largest voltage of the measurement, V rms.
        measured_v_rms: f64,
    },
    /// The finger's load lies outside of the loads of the measurement.
    #[error(
        "the finger's load of {normal_load_n} N lies outside of the {least_n} N to {largest_n} N that it was measured at: \
         change `normal_load_n`, or measure the finger again"
    )]
    BeyondMeasuredLoad {
        /// Load for which the scene is compiled, N.
        normal_load_n: f64,
        /// Least load of the measurement, N.
        least_n: f64,
        /// Largest load of the measurement, N.
        largest_n: f64,
    },
    /// The scene names a larger rms voltage than the peak limit of board or screen lets through.
    #[error(
        "`voltage_max_v_rms = {found}` is more than the {whose} lets through: {max_v_rms:.1} V rms are driven at most, \
         by its limit of {max_v_peak} V peak{why} and a peak of {peak_per_rms:.3} times the rms"
    )]
    RmsOutOfReach {
        /// The rms voltage of the scene and its screen, V.
        found: f64,
        /// Whose limit it is: `board` or `screen`.
        whose: &'static str,
        /// The limit, V peak.
        max_v_peak: f64,
        /// Where the limit is from, if from the carrier; otherwise empty.
        why: &'static str,
        /// Peak voltage over rms voltage of the carrier.
        peak_per_rms: f64,
        /// The rms voltage that remains, V.
        max_v_rms: f64,
    },
    /// The rim of a button leaves no room for its face.
    #[error(
        "{layer}: a rim of {rim_width_mm} mm on both sides leaves no face on a button of {side_mm} mm: make `rim_width_mm` \
         less than {} mm", 0.5 * .side_mm
    )]
    RimWiderThanButton {
        /// The layer.
        layer: String,
        /// Width of the rim, mm.
        rim_width_mm: f64,
        /// The shorter side of the button, mm.
        side_mm: f64,
    },
    /// A picture is stretched along one side.
    #[error(
        "{layer}: the picture is stretched by {percent} % in {direction}: to keep its sides, {}",
        if *.has_own_height {
            "leave the layer's `height_mm` out".to_owned()
        } else {
            format!(
                "make its region {height_mm} mm high, or write `x_mm`, `y_mm` and `width_mm` of the picture in the layer, \
                 beside `region`"
            )
        }
    )]
    PictureStretched {
        /// The layer.
        layer: String,
        /// How much longer its side is than its other side demands, in percent.
        percent: f64,
        /// `width` or `height`.
        direction: &'static str,
        /// Whether the layer itself has a `height_mm`.
        has_own_height: bool,
        /// The height that its width demands, mm.
        height_mm: f64,
    },
    /// A picture is of one grey over what shows through it.
    #[error(
        "{layer}: the picture is of one grey where it is transparent and where it is not, so that nobody feels its shape: \
         write {cure}"
    )]
    PictureHidden {
        /// The layer.
        layer: String,
        /// What to write.
        cure: &'static str,
    },
    /// The line of an edge without a region crosses a scene of layers with regions.
    #[error("{layer} has no `region`, so that its line crosses the whole screen: give it one to end the line there")]
    EdgeAcrossScreen {
        /// The layer.
        layer: String,
    },
    /// The line of an edge does not cross its region.
    #[error(
        "{layer}: its line lies {distance_mm} mm outside of its `region`, so that nobody crosses it: move `x_mm` and `y_mm`, \
         which are a place on the screen, or the region"
    )]
    EdgeOutsideRegion {
        /// The layer.
        layer: String,
        /// From the line to the nearest corner of the rectangle around the region, mm.
        distance_mm: f64,
    },
    /// A layer without a region hides layers below it everywhere.
    #[error(
        "{layer} has no `region`, so that it replaces {hidden} on the whole screen{}: give it a `region`, or a `blend` such \
         as \"add\"", if *.is_live { " while it is on" } else { "" }
    )]
    HidesAllBelow {
        /// The layer.
        layer: String,
        /// Whether the host switches the layer.
        is_live: bool,
        /// The layers that are not felt anywhere.
        hidden: String,
    },
    /// Two layers of one file have the same name.
    #[error(
        "{layer} has the name of layer {lower}, which is the one that `--control` changes by this name: give it \
         another name, or call it {number}"
    )]
    NameTwice {
        /// The upper layer.
        layer: String,
        /// Its number.
        number: String,
        /// The number of the lower layer.
        lower: String,
    },
}

/// A picture that is stretched by more than this is warned of.
const STRETCH_MAX: f64 = 1.05;

impl Warning {
    /// The warning of a button whose two rims meet, if they do.
    pub(super) fn of_rim(layer: &str, rim_width_mm: f64, side_mm: f64) -> Option<Self> {
        (2.0 * rim_width_mm >= side_mm).then(|| Self::RimWiderThanButton {
            layer: layer.to_owned(),
            rim_width_mm,
            side_mm,
        })
    }

    /// The warning of a picture that is higher for its width by this factor than its pixels are, if that is much.
    /// `height_mm` is the height that its width demands.
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

    /// The warning of an edge whose line lies so far outside of its region, if it does.
    pub(super) fn of_line(layer: &str, distance_mm: f64) -> Option<Self> {
        let distance_mm = digits(distance_mm, f64::round);
        (distance_mm > 0.0).then(|| Self::EdgeOutsideRegion { layer: layer.to_owned(), distance_mm })
    }

    /// Whether a board with an electrode refuses the program: it extrapolates from a measurement.
    pub fn is_refused_by_boards(&self) -> bool {
        matches!(self, Self::BeyondMeasuredVoltage { .. } | Self::BeyondMeasuredLoad { .. })
    }
}

/// The warnings of layers that their author probably means otherwise.
pub(super) fn of_layers(layers: &[Layer]) -> Vec<(&Layer, Warning)> {
    let edges = layers.iter().enumerate().filter_map(|(number, layer)| {
        let has_no_end = matches!(layer.kind, Kind::Edge(_)) && layer.region.is_none() && !layer.is_copy;
        let has_regions_below = layers.iter().take(number).any(|below| below.region.is_some());
        (has_no_end && has_regions_below).then(|| (layer, Warning::EdgeAcrossScreen { layer: layer.title.to_string() }))
    });
    edges.chain(hiding(layers)).chain(same_names(layers)).collect()
}

/// The warnings of the topmost layer that hides all layers below it for good, and of the topmost one above it that
/// hides them while it is on. Whole screens that the host switches are meant to hide one another.
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

/// The warnings of layers that have the name of a lower one. Of the copies of a layer, the first one is warned of.
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
    // The law is one: the reach was computed from it.
    if let Ok(law) = program.header.friction_law() {
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

/// The largest electric friction that the scene asks for anywhere and the drive reaches, if it is above a limit. A host
/// that changes layers can ask for all that the drive reaches.
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
