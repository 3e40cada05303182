//! Straight slides over a layer, and the friction along them.

use std::f64::consts::TAU;

use super::SAMPLE_HZ;
use frixel_scene::Program;
use frixel_scene::reference::{Context, Reference, direction_of};

/// Rows and columns over the bounding rectangle of a layer.
const ROWS: usize = 5;
/// Places of a row at which the layers are determined.
const PLACES: usize = 400;
/// Samples of a signal at most.
const SAMPLES_MAX: usize = 16_384;

/// A straight way over the part of a layer that no other layer replaces, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slide {
    from_m: (f64, f64),
    to_m: (f64, f64),
    /// From one place at which the layers are determined to the next.
    place_step_m: (f64, f64),
}

impl Slide {
    /// Rows and columns over a layer, each where it is visible for the longest.
    pub(super) fn over(layer: usize, reference: &Reference, screen_m: (f64, f64)) -> Vec<Self> {
        let Some([from_x_m, from_y_m, to_x_m, to_y_m]) = bounds_m(layer, reference, screen_m) else {
            return Vec::new();
        };
        let slides = (0..ROWS).flat_map(|number| {
            let part = (number as f64 + 0.5) / ROWS as f64;
            let (x_m, y_m) = (from_x_m + part * (to_x_m - from_x_m), from_y_m + part * (to_y_m - from_y_m));
            [((from_x_m, y_m), (to_x_m, y_m)), ((x_m, from_y_m), (x_m, to_y_m))]
                .map(|(from_m, to_m)| Self::new(from_m, to_m))
        });
        slides.filter_map(|slide| slide.longest_visible(layer, reference)).collect()
    }

    /// The way along an axis through the middle of a layer, where the layer is visible for the longest.
    pub(super) fn along(axis_turns: f64, layer: usize, reference: &Reference, screen_m: (f64, f64)) -> Option<Self> {
        let [left_m, top_m, right_m, bottom_m] = bounds_m(layer, reference, screen_m)?;
        let (middle_x_m, middle_y_m) = (0.5 * (left_m + right_m), 0.5 * (top_m + bottom_m));
        let (axis_y, axis_x) = libm::sincos(TAU * axis_turns);
        // An axis along one side never meets the ends of the other: infinite.
        let half_m = (0.5 * (right_m - left_m) / axis_x.abs()).min(0.5 * (bottom_m - top_m) / axis_y.abs());
        let at = |part: f64| (middle_x_m + part * half_m * axis_x, middle_y_m + part * half_m * axis_y);
        Self::new(at(-1.0), at(1.0)).longest_visible(layer, reference)
    }

    /// The same way back.
    pub(super) fn back(&self) -> Self {
        let (x_step_m, y_step_m) = self.place_step_m;
        Self { from_m: self.to_m, to_m: self.from_m, place_step_m: (-x_step_m, -y_step_m) }
    }

    fn new(from_m: (f64, f64), to_m: (f64, f64)) -> Self {
        let place_step_m = ((to_m.0 - from_m.0) / PLACES as f64, (to_m.1 - from_m.1) / PLACES as f64);
        Self { from_m, to_m, place_step_m }
    }

    /// Whether it runs along x.
    pub(super) fn is_row(&self) -> bool {
        self.place_step_m.1 == 0.0
    }

    pub(super) fn length_m(&self) -> f64 {
        libm::hypot(self.to_m.0 - self.from_m.0, self.to_m.1 - self.from_m.1)
    }

    /// The place after a part of the way, from 0 to 1.
    fn at(&self, part: f64) -> (f64, f64) {
        let ((from_x_m, from_y_m), (to_x_m, to_y_m)) = (self.from_m, self.to_m);
        (from_x_m + part * (to_x_m - from_x_m), from_y_m + part * (to_y_m - from_y_m))
    }

    /// The longest stretch on which the layer is visible, from the first place there to the last one, or to
    /// the end of the row; `None` for less than two places.
    fn longest_visible(&self, layer: usize, reference: &Reference) -> Option<Self> {
        let part = |number: usize| number as f64 / PLACES as f64;
        let (mut longest, mut run) = (0..0, 0..0);
        for number in 0..PLACES {
            let (x_m, y_m) = self.at(part(number) + 0.5 / PLACES as f64);
            if visible_layers(reference, x_m, y_m) >> layer & 1 == 1 {
                run.end = number + 1;
                if run.len() > longest.len() {
                    longest = run.clone();
                }
            } else {
                run = number + 1..number + 1;
            }
        }
        // Where the row ends, the layer does, too; elsewhere it ends somewhere between two places.
        let half = 0.5 / PLACES as f64;
        let first = if longest.start == 0 { 0.0 } else { part(longest.start) + half };
        let last = if longest.end == PLACES { 1.0 } else { part(longest.end) - half };
        (longest.len() > 1).then(|| Self { from_m: self.at(first), to_m: self.at(last), ..*self })
    }

    /// The layers that have an effect somewhere on the way, a bit each.
    pub(super) fn visible_layers(&self, reference: &Reference) -> u64 {
        let places = (0..PLACES).map(|number| self.at((number as f64 + 0.5) / PLACES as f64));
        places.fold(0, |visible, (x_m, y_m)| visible | visible_layers(reference, x_m, y_m))
    }

    /// The same way, begun two places earlier: outside of a layer that begins where the way does.
    pub(super) fn begun_outside(&self) -> Self {
        let ((x_m, y_m), (x_step_m, y_step_m)) = (self.from_m, self.place_step_m);
        Self { from_m: (x_m - 2.0 * x_step_m, y_m - 2.0 * y_step_m), ..*self }
    }

    /// The same way, begun earlier and ended later by a length in metres.
    pub(super) fn begun_and_ended_outside(&self, length_m: f64) -> Self {
        let part = length_m / self.length_m();
        Self { from_m: self.at(-part), to_m: self.at(1.0 + part), ..*self }
    }

    /// Total friction along the way at a constant speed, in newtons, clamped to what the drive can give.
    pub(super) fn friction_n(
        &self,
        reference: &Reference,
        program: &Program,
        speed_m_per_s: f64,
        sample_hz: f64,
    ) -> Vec<f64> {
        let contexts = self.contexts(speed_m_per_s, sample_hz);
        contexts.map(|context| total_n(program, reference.electric_friction_at_n(&context))).collect()
    }

    /// Samples a second of a finger that slides along all of the way, for its contrast: on a long way fewer than for its
    /// textures.
    pub(super) fn contrast_sample_hz(&self, speed_m_per_s: f64) -> f64 {
        SAMPLE_HZ.min(SAMPLES_MAX as f64 * speed_m_per_s / self.length_m())
    }

    /// A finger that slides along the way at a constant speed.
    pub(super) fn contexts(&self, speed_m_per_s: f64, sample_hz: f64) -> impl Iterator<Item = Context> {
        let step_m = speed_m_per_s / sample_hz;
        let direction = direction_of([self.to_m.0 - self.from_m.0, self.to_m.1 - self.from_m.1]);
        let count = ((self.length_m() / step_m) as usize).min(SAMPLES_MAX);
        (0..count).map(move |number| {
            let (x_m, y_m) = self.at((number as f64 + 0.5) * step_m / self.length_m());
            Context { x_m, y_m, t_s: number as f64 / sample_hz, speed_m_per_s, direction, ..Context::default() }
        })
    }
}

/// Left, top, right and bottom of the part of a layer that lies on the screen, m.
fn bounds_m(layer: usize, reference: &Reference, screen_m: (f64, f64)) -> Option<[f64; 4]> {
    let [left_m, top_m, right_m, bottom_m] = reference.bounds_m(layer)?;
    Some([left_m.max(0.0), top_m.max(0.0), right_m.min(screen_m.0), bottom_m.min(screen_m.1)])
}

/// Total friction, in newtons, with the electric friction clamped to what the drive can give.
pub(crate) fn total_n(program: &Program, electric_n: f64) -> f64 {
    program.reach.natural_friction_n + electric_n.clamp(0.0, program.reach.electric_friction_max_n)
}

/// The layers that have an effect at a place, a bit each.
pub(crate) fn visible_layers(reference: &Reference, x_m: f64, y_m: f64) -> u64 {
    reference.visible_at(x_m, y_m).fold(0, |visible, layer| visible | 1 << layer)
}
