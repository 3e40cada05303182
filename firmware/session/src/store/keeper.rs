//! When the last scene is written: while the board is disarmed, and has settled.

use super::{Flash, Found, Slot, Writer, Writing};
use crate::Session;

/// Time for which the board has been disarmed with a scene that is not kept yet before it is written. A page bears some
/// 10,000 erasures; a host that commits, arms and plays is not done in this time, and one that tries scene after scene
/// wears nothing.
const SETTLED_AFTER_S: u32 = 2;

/// Keeps the last scene over power-off.
pub struct SceneKeeper {
    slot: Slot,
    settled_after_ticks: u32,
    found: Option<Found>,
    /// CRC-32 of the scene that is kept, or that could not be.
    settled_crc32: Option<u32>,
    pending: Option<Pending>,
    failures: u32,
}

/// A scene that is not kept yet.
struct Pending {
    crc32: u32,
    since_tick: u32,
    writer: Option<Writer>,
}

impl SceneKeeper {
    /// Looks for the scene that is kept in `slot`, and commits it in `session`, whose ticker then gets an order to load
    /// it. It is not armed by that.
    pub fn new<F: Flash>(slot: Slot, tick_hz: u32, flash: &F, session: &mut Session) -> Self {
        let found = slot.find(flash);
        if let Some(found) = &found {
            session.restore(|offset, bytes| slot.read(flash, found, offset, bytes));
        }
        let settled_crc32 = session.kept_crc32();
        let settled_after_ticks = SETTLED_AFTER_S * tick_hz;
        Self { slot, settled_after_ticks, found, settled_crc32, pending: None, failures: 0 }
    }

    /// Does the next small thing that there is to do, without waiting: to be called again and again. What is under way
    /// is given up as soon as the board is armed or the scene is another one.
    pub fn step<F: Flash>(&mut self, flash: &mut F, session: &Session, now_tick: u32) {
        let Some(kept) = session.kept().filter(|kept| Some(kept.crc32()) != self.settled_crc32) else {
            self.pending = None;
            // What was begun before the board was armed ends, and leaves the flash as it was found.
            let _ = flash.operation();
            return;
        };
        let begun = Pending { crc32: kept.crc32(), since_tick: now_tick, writer: None };
        let pending = match &mut self.pending {
            Some(pending) if pending.crc32 == kept.crc32() => pending,
            other => other.insert(begun),
        };
        if now_tick.wrapping_sub(pending.since_tick) < self.settled_after_ticks {
            let _ = flash.operation();
            return;
        }
        let writing = match &mut pending.writer {
            Some(writer) => writer.step(flash, |offset| kept.word(offset)),
            none => {
                *none = Writer::new::<F>(self.slot, self.found.as_ref(), kept.len_to_keep());
                if none.is_some() { Writing::UnderWay } else { Writing::Failed }
            }
        };
        match writing {
            Writing::UnderWay => {}
            Writing::Done(found) => {
                self.found = Some(found);
                self.settled_crc32 = Some(kept.crc32());
            }
            Writing::Failed => {
                self.failures = self.failures.wrapping_add(1);
                // It is not tried again: a page that has failed would only fail once more.
                self.settled_crc32 = Some(kept.crc32());
            }
        }
    }

    /// CRC-32 of the scene in the newest good copy's place, or that could not be written; `None` when nothing is kept.
    pub fn settled_crc32(&self) -> Option<u32> {
        self.settled_crc32
    }

    /// Times that the flash has failed, or a scene did not fit.
    pub fn failures(&self) -> u32 {
        self.failures
    }
}
