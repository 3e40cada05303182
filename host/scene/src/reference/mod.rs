//! The reference: the friction defined by a program, evaluated in `f64` and independently of the firmware.

mod shape;
mod stroke;

use std::sync::Arc;

use frixel_layers::{Blend, Interval, Record};

pub(crate) use shape::{Shape, edges};
pub use stroke::{Context, StrokeReference, direction_of};

use crate::Program;
use crate::kinds::{self, Field};

/// Evaluates the friction defined by a program at a place on the screen.
///
/// It uses the numbers of the compiled program: frictions rounded to `f32`, and resampled pictures. The result is not
/// clamped to the reachable range.
#[derive(Clone, Debug)]
pub struct Reference {
    natural_friction_n: f64,
    pieces: Vec<ReferenceLayer>,
}

/// A record prepared for evaluation.
#[derive(Clone, Debug)]
pub(crate) struct ReferenceLayer {
    pub(crate) shape: Shape,
    pub(crate) blend: Blend,
    pub(crate) gain: f64,
    /// A layer that is off has no effect.
    pub(crate) is_on: bool,
    /// [`Context::begun_s`] of the layer.
    begun_s: f64,
    pub(crate) field: Arc<dyn Field>,
    /// Bounds of the layer's friction before its gain, from `frixel-layers`.
    pub(crate) bounds: Interval<f64>,
    /// Whether the layer fades with the host's stream.
    pub(crate) is_streamed: bool,
}

impl Reference {
    /// Prepares a program for evaluation, with all layers on.
    pub fn new(program: &Program) -> Self {
        let pieces = program.records.iter().map(|record| ReferenceLayer::new(record, program)).collect();
        let natural_friction_n =
            f64::from(program.header.friction_coefficient) * f64::from(program.header.normal_load_n);
        Self { natural_friction_n, pieces }
    }

    /// The reference at the start of a play: layers with `start = "off"` are off.
    pub fn at_start(program: &Program) -> Self {
        Self::new(program).with_only(|layer| program.start.get(layer).is_none_or(|setting| setting.on))
    }

    /// Friction at no voltage, `mu F_N`, in newtons.
    pub fn natural_friction_n(&self) -> f64 {
        self.natural_friction_n
    }

    /// Electric friction at a place, in metres from the screen's top left corner, in newtons. It may be out of reach.
    /// It is NaN where a record refers to a bitmap that the program lacks.
    ///
    /// Time and speed are 0, and there are no clicks and no stream; [`StrokeReference`] includes these.
    pub fn electric_friction_n(&self, x_m: f64, y_m: f64) -> f64 {
        self.at(&Context { x_m, y_m, ..Context::default() }, |_| 0.0)
    }

    /// As [`Self::electric_friction_n`], at a time, a speed and a sample of the stream. There are no clicks.
    pub fn electric_friction_at_n(&self, context: &Context) -> f64 {
        self.at(context, |_| 0.0)
    }

    /// The same reference with every vibration held at its largest friction.
    #[must_use]
    pub fn with_vibrations_held(mut self) -> Self {
        for piece in &mut self.pieces {
            if let Some(largest_n) = piece.field.largest_over_time_n() {
                (piece.field, piece.bounds) = (kinds::constant_field(largest_n), Interval::of([largest_n]));
            }
        }
        self
    }

    /// The same reference with only the layers on whose index from the bottom satisfies `is_on`.
    #[must_use]
    pub fn with_only(mut self, is_on: impl Fn(usize) -> bool) -> Self {
        for (layer, piece) in self.pieces.iter_mut().enumerate() {
            piece.is_on = is_on(layer);
        }
        self
    }

    /// The reference along a stroke, with clicks where the finger crosses an edge or enters a button.
    pub fn along_stroke(self) -> StrokeReference {
        StrokeReference::new(self)
    }

    /// Electric friction in a context. `click_n` returns the friction added by a layer's click.
    fn at(&self, context: &Context, click_n: impl Fn(usize) -> f64) -> f64 {
        let above = self.stack_at(context.x_m, context.y_m, |_, piece| piece.is_on).filter(|(_, piece)| piece.is_on);
        above.fold(0.0, |below_n, (number, piece)| {
            let own_n =
                piece.gain * (piece.field.at(&Context { begun_s: piece.begun_s, ..*context }) + click_n(number));
            let blended_n = match piece.blend {
                Blend::Replace => own_n,
                Blend::Add => below_n + own_n,
                Blend::Multiply => below_n * own_n,
                Blend::Max => own_n.max(below_n),
            };
            if piece.is_streamed { below_n + context.stream_weight * (blended_n - below_n) } else { blended_n }
        })
    }

    /// Indices from the bottom of the layers with an effect at a place in metres, from the topmost down: on, covering
    /// the place, and not replaced by a layer above.
    pub fn visible_at(&self, x_m: f64, y_m: f64) -> impl Iterator<Item = usize> {
        let visible = self.stack_at(x_m, y_m, |_, piece| piece.is_on).rev().filter(|(_, piece)| piece.is_on);
        visible.map(|(number, _)| number)
    }

    /// Indices from the bottom of the layers that cover a place in metres, from the topmost down, ending with the first
    /// one that replaces the layers below and is not in `off`.
    pub(crate) fn covering_at(&self, x_m: f64, y_m: f64, off: &[usize]) -> impl Iterator<Item = usize> {
        self.stack_at(x_m, y_m, |layer, _| !off.contains(&layer)).rev().map(|(layer, _)| layer)
    }

    /// The layers that cover a place, with their indices, from bottom to top, starting with the last one that is on and
    /// replaces the layers below.
    fn stack_at(
        &self,
        x_m: f64,
        y_m: f64,
        is_on: impl Fn(usize, &ReferenceLayer) -> bool,
    ) -> impl DoubleEndedIterator<Item = (usize, &ReferenceLayer)> {
        let covers = move |piece: &ReferenceLayer| piece.shape.covers(x_m, y_m);
        let pieces = || self.pieces.iter().enumerate();
        let hides =
            |(layer, piece): (usize, &ReferenceLayer)| piece.hides_below() && is_on(layer, piece) && covers(piece);
        pieces().skip(pieces().rposition(hides).unwrap_or(0)).filter(move |(_, piece)| covers(piece))
    }

    /// Left, top, right and bottom of a layer's bounding rectangle, in metres, infinite for a layer that covers the
    /// screen; `None` for an index above the topmost layer.
    pub fn bounds_m(&self, layer: usize) -> Option<[f64; 4]> {
        self.pieces.get(layer).map(|piece| piece.shape.bounds_m())
    }

    /// Number of layers.
    pub fn layer_count(&self) -> usize {
        self.pieces.len()
    }

    /// Whether friction changes under a finger at rest because a layer vibrates or follows a stream.
    pub fn changes_by_itself(&self) -> bool {
        self.pieces.iter().any(|piece| piece.is_streamed || piece.field.largest_over_time_n().is_some())
    }

    /// The layers from bottom to top.
    pub(crate) fn pieces(&self) -> &[ReferenceLayer] {
        &self.pieces
    }
}

impl ReferenceLayer {
    /// Whether the layer hides the layers below it.
    pub(crate) fn hides_below(&self) -> bool {
        self.blend == Blend::Replace && !self.is_streamed
    }

    fn new(record: &Record, program: &Program) -> Self {
        let shape = Shape::new(record.region, &program.points);
        let field = kinds::field(&record.layer, record.region, program);
        let Interval { low, high } = record.layer.bounds(&program.points);
        Self {
            shape,
            blend: record.blend,
            gain: f64::from(record.gain),
            is_on: true,
            begun_s: 0.0,
            field,
            bounds: Interval { low: f64::from(low), high: f64::from(high) },
            is_streamed: record.layer.is_streamed(),
        }
    }
}
