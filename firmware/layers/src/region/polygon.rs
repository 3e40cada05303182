//! Tests whether a place is inside a polygon.

use crate::context::Context;
use crate::point::points_of;

/// The even-odd rule: whether a ray towards larger x crosses the edges an odd number of times.
///
/// The position of an edge is computed from its upper to its lower end, regardless of their order, so that two polygons
/// with a common edge agree on it to the bit.
#[inline]
pub(super) fn contains(first: u8, count: u8, context: &Context) -> bool {
    let vertices = points_of(context.tables.points(), first, count);
    let [x_m, y_m] = context.inputs.place_m;
    let Some(mut before) = vertices.last() else { return false };
    let mut inside = false;
    for vertex in vertices {
        let down = vertex.y > y_m;
        if down != (before.y > y_m) {
            let (upper, lower) = if down { (before, vertex) } else { (vertex, before) };
            if (x_m - upper.x) * (lower.y - upper.y) < (y_m - upper.y) * (lower.x - upper.x) {
                inside = !inside;
            }
        }
        before = vertex;
    }
    inside
}
