//! The reference along a stroke, in which clicks depend on earlier places of the finger.

use super::Reference;

/// State at which the reference is evaluated: place and velocity of the finger, time, and stream sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Context {
    /// Place from the screen's left edge, m.
    pub x_m: f64,
    /// Place from the screen's top edge, m.
    pub y_m: f64,
    /// Time of the tick since the board's power-on, s.
    pub t_s: f64,
    /// Time at which the host switched the evaluated layer on, since the board's power-on, s; 0 if it has not.
    pub begun_s: f64,
    /// Sliding speed, m/s.
    pub speed_m_per_s: f64,
    /// Unit vector of the sliding direction along x and y; zeros for a finger without a direction, for which friction
    /// is the mean over all directions.
    pub direction: [f64; 2],
    /// The stream's sample, from 0 to 1.
    pub stream: f64,
    /// Weight of the stream's layers, from 0 (no stream) to 1.
    pub stream_weight: f64,
}

/// Direction of a step along x and y, as in [`Context`]; zeros for a step of length 0.
pub fn direction_of([x_m, y_m]: [f64; 2]) -> [f64; 2] {
    let length_m = libm::hypot(x_m, y_m);
    if length_m > 0.0 { [x_m / length_m, y_m / length_m] } else { [0.0; 2] }
}

/// The reference along a stroke, evaluated at successive times.
///
/// A click begins in the first context beyond an edge or inside a button. With one context per tick, the board detects
/// the crossing in the same tick.
#[derive(Clone, Debug)]
pub struct StrokeReference {
    reference: Reference,
    clicking: Vec<ClickingLayer>,
    touching: bool,
}

/// The click state of a layer.
#[derive(Clone, Debug)]
struct ClickingLayer {
    layer: usize,
    /// The finger's side of an edge, or whether it was inside a button, in the previous context; `None` if unknown.
    side: Option<bool>,
    clicked_at_s: Option<f64>,
}

impl StrokeReference {
    pub(super) fn new(reference: Reference) -> Self {
        let clicks = |layer: &usize| reference.pieces.get(*layer).is_some_and(|piece| piece.field.click().is_some());
        let layers = (0..reference.pieces.len()).filter(clicks);
        let clicking = layers.map(|layer| ClickingLayer { layer, side: None, clicked_at_s: None }).collect();
        Self { reference, clicking, touching: false }
    }

    /// The same reference with the clicks of one layer only.
    #[must_use]
    pub fn with_clicks_of(mut self, layer: usize) -> Self {
        self.clicking.retain(|clicking| clicking.layer == layer);
        self
    }

    /// Friction at no voltage, `mu F_N`, in newtons.
    pub fn natural_friction_n(&self) -> f64 {
        self.reference.natural_friction_n
    }

    /// Electric friction in the stroke's next context, in newtons, as in [`Reference::electric_friction_n`].
    pub fn electric_friction_n(&mut self, context: &Context) -> f64 {
        for layer in &mut self.clicking {
            layer.follow(&self.reference, context, self.touching);
        }
        self.touching = true;
        let click_n = |number: usize| {
            let layer = self.clicking.iter().find(|layer| layer.layer == number);
            layer.and_then(|layer| layer.click_n(&self.reference, context.t_s)).unwrap_or(0.0)
        };
        self.reference.at(context, click_n)
    }

    /// Switches a layer on or off, and sets its gain. `layer` is its index from the bottom, `t_s` the time since the
    /// board's power-on.
    pub fn set_layer(&mut self, layer: usize, on: bool, gain: f64, t_s: f64) {
        if let Some(piece) = self.reference.pieces.get_mut(layer) {
            if on && !piece.is_on {
                piece.begun_s = t_s;
            }
            (piece.is_on, piece.gain) = (on, gain);
        }
    }

    /// Records that the finger leaves the screen.
    pub fn lift(&mut self) {
        self.touching = false;
        for layer in &mut self.clicking {
            layer.side = None;
        }
    }
}

impl ClickingLayer {
    /// Records the finger's place, and begins a click if it has crossed an edge, or entered a button while touching.
    fn follow(&mut self, reference: &Reference, context: &Context, touching: bool) {
        let Some(piece) = reference.pieces.get(self.layer) else { return };
        let (x_m, y_m) = (context.x_m, context.y_m);
        let side = piece.shape.covers(x_m, y_m).then(|| piece.field.is_beyond(x_m, y_m));
        let clicks = match (self.side, side) {
            (Some(before), Some(now)) => before != now,
            (None, Some(_)) => touching && piece.field.clicks_on_entry(),
            (_, None) => false,
        };
        if clicks {
            self.clicked_at_s = Some(context.t_s);
        }
        self.side = side;
    }

    /// Friction that the last click still adds, N; `None` when it is over.
    fn click_n(&self, reference: &Reference, t_s: f64) -> Option<f64> {
        let click = reference.pieces.get(self.layer)?.field.click()?;
        let left = 1.0 - (t_s - self.clicked_at_s?) / f64::from(click.decay_s);
        (left > 0.0).then(|| f64::from(click.height_n) * left * left)
    }
}
