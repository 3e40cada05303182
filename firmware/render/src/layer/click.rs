//! Short pulses of friction when the finger crosses a line.
#![cfg_attr(not(feature = "edge"), allow(dead_code, reason = "nothing clicks"))]

use frixel_wire::scene::Click as Record;

#[cfg(feature = "edge")]
use super::Around;
use crate::Board;

/// Most edges and buttons of a scene that may click.
pub(crate) const CLICKS_MAX: usize = if cfg!(feature = "edge") { 16 } else { 0 };

/// A layer's click, `height (1 - t / decay)^2`, in the scene's table of clicks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Click {
    height_n: f32,
    decay_ticks: u32,
    per_tick: f32,
}

/// Number of a layer's click in the scene's table, and of its past in the [`Clicks`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ClickNumber(pub(super) u8);

/// What edges and buttons know of the past. It is the ticker's: coefficients stay as they were loaded.
///
/// The past is counted in evaluations: a tick that has something else to do does not look at layers.
#[derive(Clone, Debug)]
pub(crate) struct Clicks {
    /// How often layers were evaluated, modulo 2^32, and how often the finger was lifted.
    evaluation: u32,
    /// The finger was there at the evaluation before this one, and has not been lifted since.
    unbroken: bool,
    touching: bool,
    slots: [Slot; CLICKS_MAX],
}

/// What one layer knows of the past.
#[derive(Clone, Copy, Debug)]
struct Slot {
    /// The last evaluation of this layer, and on which side the finger was.
    seen: u32,
    beyond: bool,
    /// The click's first tick, while it lasts.
    started_at_tick: Option<u32>,
}

impl Clicks {
    pub(crate) const NONE: Self = Self {
        evaluation: 0,
        unbroken: false,
        touching: false,
        slots: [Slot { seen: 0, beyond: false, started_at_tick: None }; CLICKS_MAX],
    };

    /// Another scene plays.
    pub(crate) fn forget(&mut self) {
        *self = Self::NONE;
    }

    /// Layers are about to be evaluated.
    #[inline]
    pub(crate) fn begin(&mut self) {
        self.evaluation = self.evaluation.wrapping_add(1);
        self.unbroken = self.touching;
        self.touching = true;
    }

    /// The finger is not on the screen.
    #[inline]
    pub(crate) fn lift(&mut self) {
        self.touching = false;
    }
}

impl Click {
    pub(super) fn new(record: Record, board: &Board) -> Self {
        let decay_ticks = board.ticks(record.decay_s).max(1);
        Self { height_n: record.height_n, decay_ticks, per_tick: 1.0 / decay_ticks as f32 }
    }
}

#[cfg(feature = "edge")]
impl ClickNumber {
    /// Electric friction of the click when the finger is on one side of a line, or `beyond` it.
    pub(super) fn across(self, beyond: bool, around: &mut Around) -> f32 {
        let Some((click, slot)) = self.find(around) else { return 0.0 };
        let crossed = slot.seen == around.clicks.evaluation.wrapping_sub(1) && slot.beyond != beyond;
        let slot = Slot { beyond, ..slot };
        self.follow(&click, slot, crossed, around)
    }

    /// Electric friction of the click when the finger is inside.
    pub(super) fn inside(self, around: &mut Around) -> f32 {
        let Some((click, slot)) = self.find(around) else { return 0.0 };
        let entered = slot.seen != around.clicks.evaluation.wrapping_sub(1);
        self.follow(&click, slot, entered, around)
    }

    fn find(self, around: &Around) -> Option<(Click, Slot)> {
        let number = usize::from(self.0);
        Some((*around.tables.clicks().get(number)?, *around.clicks.slots.get(number)?))
    }

    fn follow(self, click: &Click, mut slot: Slot, starts: bool, around: &mut Around) -> f32 {
        let (clicks, tick) = (&mut *around.clicks, around.moment.tick);
        slot.seen = clicks.evaluation;
        if !clicks.unbroken {
            // What another touch began is over.
            slot.started_at_tick = None;
        }
        if starts && clicks.unbroken {
            slot.started_at_tick = Some(tick);
        }
        let ticks = slot.started_at_tick.map_or(click.decay_ticks, |start| tick.wrapping_sub(start));
        if ticks >= click.decay_ticks {
            slot.started_at_tick = None;
        }
        if let Some(kept) = clicks.slots.get_mut(usize::from(self.0)) {
            *kept = slot;
        }
        if slot.started_at_tick.is_none() {
            return 0.0;
        }
        let left = 1.0 - ticks as f32 * click.per_tick;
        click.height_n * left * left
    }
}
