//! Stores the last scene once the board has been disarmed for a while.

use super::{Flash, Found, Slot, Writer, Writing};
use crate::Session;

/// A new scene is written after the board has been disarmed with it for this time, in s. A page bears some 10,000
/// erasures; the delay avoids wear by a host that commits, arms and plays, or that tries one scene after another.
const STORE_AFTER_S: u32 = 2;

/// Keeps the last scene over power-off.
pub struct SceneStore {
    slot: Slot,
    store_after_ticks: u32,
    found: Option<Found>,
    /// CRC-32 of the scene that is stored, or that could not be stored.
    stored_crc32: Option<u32>,
    pending: Option<Pending>,
    failures: u32,
}

/// A scene that is not stored yet.
struct Pending {
    crc32: u32,
    since_tick: u32,
    writer: Option<Writer>,
}

impl SceneStore {
    /// Finds the scene that is stored in `slot`, and commits it in `session`, which then orders the ticker to load it.
    /// This does not arm the board.
    ///
    /// After three starts in a row that ended in a fault ([`Board::reset_fault_starts`]), the stored scene is left alone
    /// and the hello says so ([`notice::STORED_SCENE_SKIPPED`]). It stays stored until another scene takes its place,
    /// and a start that does not follow three faults loads it again.
    ///
    /// [`Board::reset_fault_starts`]: frixel_control::Board::reset_fault_starts
    /// [`notice::STORED_SCENE_SKIPPED`]: frixel_wire::hello::notice::STORED_SCENE_SKIPPED
    pub fn new<F: Flash>(slot: Slot, tick_hz: u32, flash: &F, session: &mut Session) -> Self {
        let found = slot.find(flash);
        if let Some(found) = &found
            && !session.skips_stored_scene()
        {
            session.restore(|offset, bytes| slot.read(flash, found, offset, bytes));
        }
        let stored_crc32 = session.crc32_to_store();
        let store_after_ticks = STORE_AFTER_S * tick_hz;
        Self { slot, store_after_ticks, found, stored_crc32, pending: None, failures: 0 }
    }

    /// Does the next small step without waiting; call it repeatedly. A write under way is abandoned as soon as the
    /// board is armed or has another scene.
    pub fn step<F: Flash>(&mut self, flash: &mut F, session: &Session, now_tick: u32) {
        let Some(scene) = session.scene_to_store().filter(|scene| Some(scene.crc32()) != self.stored_crc32) else {
            self.pending = None;
            // Let an operation that began before arming end: polling it locks the flash again.
            let _ = flash.operation();
            return;
        };
        let begun = Pending { crc32: scene.crc32(), since_tick: now_tick, writer: None };
        let pending = match &mut self.pending {
            Some(pending) if pending.crc32 == scene.crc32() => pending,
            other => other.insert(begun),
        };
        if now_tick.wrapping_sub(pending.since_tick) < self.store_after_ticks {
            let _ = flash.operation();
            return;
        }
        let writing = match &mut pending.writer {
            Some(writer) => writer.step(flash, |offset| scene.word(offset)),
            writer_slot => {
                *writer_slot = Writer::new::<F>(self.slot, self.found.as_ref(), scene.len_to_keep());
                if writer_slot.is_some() { Writing::UnderWay } else { Writing::Failed }
            }
        };
        match writing {
            Writing::UnderWay => {}
            Writing::Done(found) => {
                self.found = Some(found);
                self.stored_crc32 = Some(scene.crc32());
            }
            Writing::Failed => {
                self.failures = self.failures.wrapping_add(1);
                // Do not try again: a page that has failed is likely to fail again.
                self.stored_crc32 = Some(scene.crc32());
            }
        }
    }

    /// CRC-32 of the scene that is stored, or that could not be stored; `None` if nothing is stored.
    pub fn stored_crc32(&self) -> Option<u32> {
        self.stored_crc32
    }

    /// How often the flash failed or a scene did not fit.
    pub fn failures(&self) -> u32 {
        self.failures
    }
}
