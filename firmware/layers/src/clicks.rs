//! Coefficients of a scene's clicks, and their state between ticks.
#![cfg_attr(not(feature = "edge"), allow(dead_code, reason = "only edges and buttons click"))]

/// Largest number of edges and buttons with a click in a scene.
pub const CLICKS_MAX: usize = if cfg!(feature = "edge") { 16 } else { 0 };

/// A layer's click in the scene's tables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ClickCoefficients {
    pub(crate) height_n: f32,
    pub(crate) decay_ticks: u32,
    pub(crate) per_tick: f32,
}

/// Index of a layer's click in the scene's tables, and of its state in the [`Clicks`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ClickNumber(pub(crate) u8);

/// State of all clicks: where the finger was at the previous evaluation, and the clicks in progress.
///
/// The state counts evaluations of the scene instead of ticks, so that a tick without an evaluation does not hide a
/// crossing.
#[derive(Clone, Debug)]
pub struct Clicks {
    /// Evaluations of the scene, modulo 2^32.
    pub(crate) evaluation: u32,
    /// Whether the finger was on the screen at the previous evaluation, and has not been lifted since.
    pub(crate) unbroken: bool,
    touching: bool,
    pub(crate) slots: [Slot; CLICKS_MAX],
}

/// The state of one click.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slot {
    /// The last evaluation of this layer, and the side of its line on which the finger was.
    pub(crate) evaluation: u32,
    pub(crate) beyond: bool,
    /// The click's first tick, while it lasts.
    pub(crate) started_at_tick: Option<u32>,
}

impl Clicks {
    /// Initial state: no click in progress, and no finger.
    pub const NONE: Self = Self {
        evaluation: 0,
        unbroken: false,
        touching: false,
        slots: [Slot { evaluation: 0, beyond: false, started_at_tick: None }; CLICKS_MAX],
    };

    /// Resets the state for another scene.
    pub fn reset(&mut self) {
        *self = Self::NONE;
    }

    /// Counts an evaluation of the scene. Must be called before the evaluation.
    #[inline]
    pub(crate) fn begin(&mut self) {
        self.evaluation = self.evaluation.wrapping_add(1);
        self.unbroken = self.touching;
        self.touching = true;
    }

    /// Records that the finger is not on the screen.
    #[inline]
    pub fn lift(&mut self) {
        self.touching = false;
    }
}
