//! Stores the last scene once the board has been disarmed for a while.

use super::{Flash, Found, Slot, Writer, Writing};
use crate::Session;

/// A new scene is written after the board has been disarmed with it for this time, in s. The delay avoids wear by a
/// host that commits, arms and plays.
const STORE_AFTER_S: u32 = 2;

/// An operation of the flash that has not ended after this time has failed, in s. Erasing a page takes tens of
/// milliseconds.
const OPERATION_MAX_S: u32 = 5;

/// Erasures that a page bears: the least that the STM32G474 is specified for (DS12288, "Flash memory endurance and data
/// retention", unread). A page that bears less is found when the copy is read back; the copy before then stays.
const PAGE_ERASURES: u32 = 10_000;
/// Time for which a slot lasts with a host that changes the scene all the time, in s: 5 years of 250 days of 8 hours.
const LIFE_S: u32 = 5 * 250 * 8 * 3600;
/// Shortest time between the beginnings of two writes, in s: 45 minutes. Two thirds of the erasures of two copies are
/// used up in [`LIFE_S`]. The margin is the last third: the first write after a power-on does not wait, and five
/// power-ons on each of those days fit into it.
const WRITE_INTERVAL_S: u32 = LIFE_S / (2 * PAGE_ERASURES / 3 * 2);

/// Keeps the last scene over power-off.
pub struct SceneStore {
    slot: Slot,
    store_after_ticks: u32,
    operation_max_ticks: u32,
    write_interval_ticks: u32,
    /// When the last write began; `None` if that was long enough ago for the next one.
    last_write_tick: Option<u32>,
    found: Option<Found>,
    /// CRC-32 of the scene that is stored, or that could not be stored.
    stored_crc32: Option<u32>,
    pending: Option<Pending>,
}

/// A scene that is not stored yet.
struct Pending {
    crc32: u32,
    /// When the wait began: that before the write, and then that for an operation of the flash.
    since_tick: u32,
    writer: Option<Writer>,
}

impl SceneStore {
    /// Finds the scene that is stored in `slot`, and commits it in `session`, which then orders the ticker to load it.
    /// This does not arm the board.
    ///
    /// After three starts in a row that ended in a fault ([`Board::reset_fault_starts`]), the stored scene is left
    /// alone and the hello says so ([`notice::STORED_SCENE_SKIPPED`]). It stays stored until another scene takes its
    /// place, and a start that does not follow three faults loads it again.
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
        Self {
            slot,
            store_after_ticks: STORE_AFTER_S * tick_hz,
            operation_max_ticks: OPERATION_MAX_S * tick_hz,
            write_interval_ticks: WRITE_INTERVAL_S * tick_hz,
            last_write_tick: (!session.was_started_by_a_person()).then_some(0),
            found,
            stored_crc32,
            pending: None,
        }
    }

    /// Does the next small step without waiting; call it repeatedly, with the ticks since the start.
    ///
    /// Two writes begin at least 45 minutes apart, so that a host that changes the scene all the time does not wear the
    /// flash out. A scene that is committed meanwhile is written after that time, unless another has taken its place;
    /// a power-off before loses it, and the scene stored last is loaded at the next start. The first write after the
    /// power came on, or the reset pin was used, does not wait. After any other reset it does: a board that resets
    /// again and again does not write.
    ///
    /// A write under way pauses while the board is armed, and ends when the board has another scene. If the flash
    /// fails, never ends an operation or has no room for the scene, the hello says so ([`notice::SCENE_NOT_STORED`]).
    ///
    /// [`notice::SCENE_NOT_STORED`]: frixel_wire::hello::notice::SCENE_NOT_STORED
    pub fn step<F: Flash>(&mut self, flash: &mut F, session: &mut Session, now_tick: u32) {
        let waits = |tick: &u32| now_tick.wrapping_sub(*tick) < self.write_interval_ticks;
        self.last_write_tick = self.last_write_tick.filter(waits);
        let Some(scene) = session.scene_to_store().filter(|scene| Some(scene.crc32()) != self.stored_crc32) else {
            self.pending.take_if(|pending| pending.writer.is_none());
            if let Some(pending) = &mut self.pending {
                pending.since_tick = now_tick;
            }
            // Let an operation that began before arming end: polling it locks the flash again.
            let _ = flash.operation();
            return;
        };
        let begun = Pending { crc32: scene.crc32(), since_tick: now_tick, writer: None };
        let pending = match &mut self.pending {
            Some(pending) if pending.crc32 == scene.crc32() => pending,
            other => other.insert(begun),
        };
        let is_early = now_tick.wrapping_sub(pending.since_tick) < self.store_after_ticks;
        if pending.writer.is_none() && (is_early || self.last_write_tick.is_some()) {
            let _ = flash.operation();
            return;
        }
        let writing = match &mut pending.writer {
            Some(writer) => writer.step(flash, |offset| scene.word(offset)),
            writer_slot => {
                *writer_slot = Writer::new::<F>(self.slot, self.found.as_ref(), scene.len_to_keep());
                self.last_write_tick = writer_slot.as_ref().map(|_| now_tick);
                if writer_slot.is_some() { Writing::UnderWay } else { Writing::Failed }
            }
        };
        let crc32 = scene.crc32();
        match writing {
            Writing::UnderWay => {
                pending.since_tick = now_tick;
                return;
            }
            Writing::Busy if now_tick.wrapping_sub(pending.since_tick) < self.operation_max_ticks => return,
            Writing::Done(found) => self.found = Some(found),
            // Do not try again: a page that has failed is likely to fail again.
            Writing::Busy | Writing::Failed => session.could_not_store(crc32),
        }
        self.stored_crc32 = Some(crc32);
        self.pending = None;
    }

    /// CRC-32 of the scene that is stored, or that could not be stored; `None` if nothing is stored.
    pub fn stored_crc32(&self) -> Option<u32> {
        self.stored_crc32
    }
}
