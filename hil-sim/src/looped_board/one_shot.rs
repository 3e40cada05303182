//! The one-shot of the enable and the captures of its edges, in virtual time.

use frixel_board::self_test::Fall;

use super::defect::Defect;

/// Cycles per microsecond. Reading the time takes one.
pub(super) const CYCLES_PER_US: u32 = 2;
/// Time from the last kick until the enable falls, us, and the same for a one-shot that is too long.
pub(super) const ONE_SHOT_US: u32 = 900;
const LONG_US: u32 = 1_200;
/// Time from a kick to the rise of the enable, and from disabling it to its fall, us.
const EDGE_US: u32 = 1;
/// Time from the rise of the enable until an amplifier reports that it is ready, us.
const TURN_ON_US: u32 = 300;

/// The timer.
#[derive(Debug, Default)]
pub(super) struct OneShot {
    now: u32,
    rises_at: Option<u32>,
    falls_at: Option<u32>,
    /// Time since which the enable has been high.
    high_since: Option<u32>,
    forbidden_cycles: u32,
    /// Number of ended pulses.
    pulses: u32,
    rose: Option<u32>,
    fell: Option<Fall>,
}

impl OneShot {
    /// Advances by one cycle, in which the enable must be low if it `is_forbidden`, and returns the time.
    pub(super) fn pass(&mut self, is_forbidden: bool) -> u32 {
        self.now += 1;
        self.forbidden_cycles += u32::from(is_forbidden && self.high_since.is_some());
        if self.rises_at == Some(self.now) {
            self.high_since = self.high_since.or(Some(self.now));
            self.rose = self.rose.or(Some(self.now));
        }
        if self.falls_at == Some(self.now) {
            self.high_since = None;
            self.falls_at = None;
            self.pulses += 1;
            self.fell = Some(Fall { at: self.now, had_fallen_before: self.fell.is_some() });
        }
        self.now
    }

    pub(super) fn kick(&mut self, wrong: Defect) {
        if wrong == Defect::EnableDead {
            return;
        }
        if self.high_since.is_none() {
            self.rises_at = Some(self.now + EDGE_US * CYCLES_PER_US);
        }
        let life_us = if wrong == Defect::OneShotLong { LONG_US } else { ONE_SHOT_US };
        let falls_at = Some(self.now + life_us * CYCLES_PER_US);
        self.falls_at = match wrong {
            Defect::EnableStaysHigh => None,
            Defect::NotRetriggered => self.falls_at.or(falls_at),
            _ => falls_at,
        };
    }

    pub(super) fn disable(&mut self, wrong: Defect) {
        if self.falls_at.is_some() && wrong != Defect::NotCut {
            self.falls_at = Some(self.now + EDGE_US * CYCLES_PER_US);
        }
    }

    pub(super) fn forget_edges(&mut self) -> u32 {
        (self.rose, self.fell) = (None, None);
        self.now
    }

    pub(super) fn rose(&mut self) -> Option<u32> {
        self.rose.take()
    }

    pub(super) fn fell(&mut self) -> Option<Fall> {
        self.fell.take()
    }

    /// Time for which the enable was high although it was forbidden, us.
    pub(super) fn forbidden_enable_us(&self) -> u32 {
        self.forbidden_cycles / CYCLES_PER_US
    }

    /// Whether the enable is high in a pulse after the first one.
    pub(super) fn is_high_again(&self) -> bool {
        self.high_since.is_some() && self.pulses > 0
    }

    /// Whether an amplifier on this enable has turned on.
    pub(super) fn amplifier_has_turned_on(&self) -> bool {
        self.high_since.is_some_and(|since| self.now - since > TURN_ON_US * CYCLES_PER_US)
    }
}
