//! The interface of a kind of layer.

use frixel_wire::message::{ConfigRefusal, Refusal};
use frixel_wire::scene::SceneError;

use crate::click::Click;
use crate::context::Context;
use crate::cost::Cost;
use crate::interval::Interval;
use crate::measured;
use crate::parameters::Parameters;
use crate::point::Point;
use crate::prepare::Preparation;
use crate::region::{ActiveRegion, Region};

/// A kind of layer: its cost, its bounds, and the computation of its coefficients. The type of the kind's parameters
/// implements it.
pub(crate) trait Kind: Parameters + Copy {
    /// The coefficients that the tick evaluates.
    type Coefficients: Evaluate;
    /// Core cycles added by the kind to every tick of a scene with at least one such layer, at any position of the
    /// finger. They count once for all layers of the kind.
    const COST_ELSEWHERE: Cost = Cost::ZERO;
    /// Whether the layer plays the host's stream, and fades with it.
    const STREAMED: bool = false;

    /// Checks the kind's requirements on its region, and on the number of points in the scene.
    fn check_structure(&self, region: &Region, point_count: u8, record: u8) -> Result<(), SceneError> {
        let _ = (region, point_count, record);
        Ok(())
    }

    /// Checks relations between parameters, and the points that the layer refers to. The range of each parameter has
    /// already been checked.
    fn check_relations(&self, points: &[Point], layer: u8) -> Result<(), ConfigRefusal> {
        let _ = (points, layer);
        Ok(())
    }

    /// Largest number of core cycles of an evaluation.
    fn cost(&self) -> Cost;

    /// Bounds of the layer's friction before its gain, in N, or as a factor.
    fn bounds(&self, points: &[Point]) -> Interval<f32>;

    /// CRC-32 of the layer's bitmap; `None` without a bitmap.
    fn bitmap_crc32(&self) -> Option<u32> {
        None
    }

    /// The layer's click, if it has one.
    fn click(&self) -> Option<Click> {
        None
    }

    /// Bytes of the layer in the scene's tables.
    fn table_bytes(&self) -> usize {
        0
    }

    /// Computes the coefficients of layer `layer`. Its parameters have been checked.
    fn prepare(&self, layer: u8, preparation: &mut Preparation) -> Result<Self::Coefficients, Refusal>;
}

/// Cost of the layer in the benchmark `tick_NAME_alone`. 0 until it is measured, which the tests of the samples detect.
pub(crate) const fn measured_cost(name: &str) -> Cost {
    let mut number = 0;
    while number < measured::LAYERS.len() {
        let (measured, cost) = measured::LAYERS[number];
        if is_same(measured.as_bytes(), name.as_bytes()) {
            return cost;
        }
        number += 1;
    }
    Cost::ZERO
}

/// `==` of slices, for constants.
const fn is_same(one: &[u8], other: &[u8]) -> bool {
    let mut at = 0;
    while at < one.len() && at < other.len() && one[at] == other[at] {
        at += 1;
    }
    at == one.len() && at == other.len()
}

/// Coefficients of a layer, evaluated by the tick.
pub(crate) trait Evaluate: Copy {
    /// Whether to inline the evaluation, because a call would cost more than the evaluation.
    const IN_LINE: bool = false;

    /// Electric friction, in N, before the gain; or a factor. The finger is inside `region`.
    fn electric_friction_n(&self, region: &ActiveRegion, context: &mut Context) -> f32;

    /// Called when the host switches the layer on; `tick` is its first tick.
    #[inline]
    fn begin(&mut self, tick: u32) {
        let _ = tick;
    }
}

/// Evaluates one kind without inlining; otherwise a loop over layers would first load the constants of all kinds. The
/// function is generic, so that it is compiled with the crate that calls it.
#[inline(never)]
fn call<C: Evaluate>(coefficients: &C, region: &ActiveRegion, context: &mut Context) -> f32 {
    coefficients.electric_friction_n(region, context)
}

/// Evaluates one kind, inlined or not.
#[inline]
pub(crate) fn evaluate<C: Evaluate>(coefficients: &C, region: &ActiveRegion, context: &mut Context) -> f32 {
    if C::IN_LINE { coefficients.electric_friction_n(region, context) } else { call(coefficients, region, context) }
}
