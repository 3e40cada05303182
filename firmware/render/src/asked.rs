//! The most that a scene can ask for, so that its table goes no further.
//!
//! Interval arithmetic over the records, cell by cell of the scene's grid, in the order and in the `f32` operations of the
//! tick: rounding is monotone, so that no sum or product of the tick leaves the interval of the same operation. Only what
//! rounds within a layer needs room, [`ROUNDING`]. There is no bound from below: a finger that is still, and every ramp,
//! takes friction down to nothing, and has to be smooth there.

use frixel_wire::scene::{Blend, Click, Grid, Layer, Point, RECORDS_MAX, Record, Region};

/// How far a layer may leave the numbers of its record, relative to the larger of them: a cosine may be a millionth above
/// 1, what is summed is rounded a few times.
const ROUNDING: f32 = 4e-6;

/// Least and largest electric friction, N; or plain factors.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Span {
    low: f32,
    high: f32,
}

impl Span {
    const NOTHING: Self = Self { low: 0.0, high: 0.0 };

    fn of(values: impl IntoIterator<Item = f32>) -> Self {
        let none = Self { low: f32::INFINITY, high: f32::NEG_INFINITY };
        values.into_iter().fold(none, |span, value| span.hull(Self { low: value, high: value }))
    }

    fn hull(self, other: Self) -> Self {
        Self { low: lesser(self.low, other.low), high: larger(self.high, other.high) }
    }

    fn plus(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }

    fn times(self, other: Self) -> Self {
        Self::of([self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high])
    }

    fn rounded_outward(self) -> Self {
        let room = ROUNDING * larger(self.low.abs(), self.high.abs());
        Self { low: self.low - room, high: self.high + room }
    }

    fn blended(self, own: Self, blend: Blend) -> Self {
        match blend {
            Blend::Replace => own,
            Blend::Add => self.plus(own),
            Blend::Multiply => self.times(own),
            Blend::Max => Self { low: larger(self.low, own.low), high: larger(self.high, own.high) },
        }
    }
}

/// Not-a-number stays one, unlike with `f32::min`: a bound that is none must not pass for one.
fn lesser(one: f32, other: f32) -> f32 {
    if one < other || one.is_nan() { one } else { other }
}

fn larger(one: f32, other: f32) -> f32 {
    if one > other || one.is_nan() { one } else { other }
}

/// The records of a scene as far as their friction goes.
pub(crate) struct Asked {
    layers: [Own; RECORDS_MAX],
}

/// What a layer gives, its gain included, and how it joins those below.
#[derive(Clone, Copy)]
struct Own {
    span: Span,
    blend: Blend,
    /// On the whole screen, at all times.
    everywhere: bool,
    /// It comes and goes with the host's stream.
    fades: bool,
}

impl Asked {
    pub(crate) const NOTHING: Self = Self { layers: [Own::NOTHING; RECORDS_MAX] };

    /// Adds layer number `number`; `points` are the scene's.
    pub(crate) fn add(&mut self, number: u8, record: &Record, points: &[Point]) {
        let gain = Span::of([record.gain]);
        let fades = matches!(record.layer, Layer::Stream { .. });
        let span = gain.times(of_layer(&record.layer, points).rounded_outward());
        let everywhere = record.region == Region::Screen && !fades;
        if let Some(place) = self.layers.get_mut(usize::from(number)) {
            *place = Own { span, blend: record.blend, everywhere, fades };
        }
    }

    /// The largest electric friction that any place of the grid can ask for, N; not-a-number or infinity when there is no
    /// bound.
    #[inline(never)]
    pub(crate) fn electric_friction_max_n(&self, grid: &Grid) -> f32 {
        let mut last_layers = [0; 2];
        let mut largest_n = 0.0;
        for cell in grid.cells() {
            // Most cells have the layers of the cell before.
            if cell.layers == last_layers {
                continue;
            }
            last_layers = cell.layers;
            let there = (0..).zip(&self.layers).filter(|(number, _)| cell.has(*number));
            let span = there.fold(Span::NOTHING, |below, (_, own)| own.over(below));
            largest_n = larger(largest_n, span.high);
        }
        largest_n
    }
}

impl Own {
    const NOTHING: Self = Self { span: Span::NOTHING, blend: Blend::Replace, everywhere: false, fades: false };

    /// With this layer over what is below: also without it, where it may not be.
    fn over(&self, below: Span) -> Span {
        let blended = below.blended(self.span, self.blend);
        match self {
            Self { everywhere: true, .. } => blended,
            Self { fades: true, .. } => below.hull(blended).rounded_outward(),
            Self { .. } => below.hull(blended),
        }
    }
}

fn of_layer(layer: &Layer, points: &[Point]) -> Span {
    let with_click = |span: Span, click: Click| span.plus(Span::of([0.0, click.height_n]).rounded_outward());
    match *layer {
        Layer::Constant { electric_friction_n } => Span::of([electric_friction_n]),
        Layer::Grating { trough_n, crest_n, .. } => Span::of([trough_n, crest_n]),
        Layer::Bitmap { black_n, white_n, .. } => Span::of([black_n, white_n]),
        Layer::Noise { low_n, high_n, .. }
        | Layer::Vibration { low_n, high_n, .. }
        | Layer::Stream { low_n, high_n } => Span::of([low_n, high_n]),
        Layer::Edge { level_n, ridge_n, click, .. } => {
            with_click(Span::of([level_n, ridge_n]).rounded_outward(), click)
        }
        Layer::Button { rim_n, face_n, click, .. } => with_click(Span::of([rim_n, face_n]).rounded_outward(), click),
        Layer::Speed { first, count } => {
            let own = points.iter().skip(usize::from(first)).take(usize::from(count));
            Span::of(own.map(|point| point.y))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_bound_does_not_pass_for_one() {
        let endless = Span { low: f32::NEG_INFINITY, high: f32::INFINITY };
        assert!(endless.times(Span::NOTHING).high.is_nan());
        assert!(Span::NOTHING.hull(endless.times(Span::NOTHING)).high.is_nan());
        assert!(endless.times(Span::NOTHING).hull(Span::NOTHING).high.is_nan());
        assert!(larger(larger(0.0, f32::NAN), 1.0).is_nan());
    }
}
