//! The largest target friction of a scene, from the bounds of its layers.
//!
//! Used by the host's compiler, not by a board. [`electric_friction_max_n`] works cell by cell on the scene's grid, in
//! the order and with the `f32` operations of the tick. Rounding is monotone, so no sum or product of the tick leaves
//! the interval of the same operation. Only rounding within a layer needs a margin, [`ROUNDING`]. A lower
//! bound would be useless: ramps take the friction down to zero, so the board's table has to reach down there.

use crate::grid::Grid;
use crate::header::{Header, upper_half_rounded_up};
use crate::interval::{Interval, larger};
use crate::point::Point;
use crate::record::Record;
use crate::region::Region;

/// Largest excess of a layer over the numbers in its record, relative to the larger of them: a cosine may be a
/// millionth above 1, and a sum is rounded a few times.
const ROUNDING: f32 = 4e-6;

const NOTHING: Interval<f32> = Interval { low: 0.0, high: 0.0 };

/// The largest electric friction of a scene at any place, time and speed, N, rounded up to the precision of the header
/// ([`Header::electric_friction_max_n`]); `None` if it has no finite bound. Only valid if the host does not change
/// layers during the play.
pub fn electric_friction_max_n(header: &Header, records: &[Record], points: &[Point]) -> Option<f32> {
    let mut grid = Grid::EMPTY;
    grid.reset(header.screen_width_m, header.screen_height_m);
    for (number, record) in (0..).zip(records) {
        grid.add(number, &record.region, points);
    }
    let of_cell = |layers: &dyn Fn(u8) -> bool| {
        let there = (0..).zip(records).filter(|(number, _)| layers(*number));
        there.fold(NOTHING, |below, (_, record)| over(record, points, below)).high
    };
    let max_n = grid.cells().map(|cell| of_cell(&|number| cell.has(number))).fold(0.0, larger);
    let stored_n = f32::from_bits(u32::from(upper_half_rounded_up(max_n)) << u16::BITS);
    Some(stored_n).filter(|max_n| max_n.is_finite())
}

/// The interval after blending a layer over the interval below it, including the case that the layer does not act
/// there.
fn over(record: &Record, points: &[Point], below: Interval<f32>) -> Interval<f32> {
    let own = Interval::of([record.gain]).times(rounded_outward(record.layer.bounds(points)));
    let is_streamed = record.layer.is_streamed();
    let blended = record.blend.of_intervals(below, own, record.region == Region::Screen && !is_streamed);
    if is_streamed { rounded_outward(blended) } else { blended }
}

/// The interval with the margin for rounding on both sides.
fn rounded_outward(interval: Interval<f32>) -> Interval<f32> {
    let margin = ROUNDING * larger(interval.low.abs(), interval.high.abs());
    Interval { low: interval.low - margin, high: interval.high + margin }
}
