//! Stores that a reset interrupts: the copy before must be whole at the next start.

use frixel_session::store::{Flash, Found, Operation, WORD_LEN, Writer, Writing};
use frixel_wire::frame::Crc32;

use super::{LoopedBoard, Stop};

/// Bytes of what is stored.
const LEN: u32 = 16 * 1024;
/// Operations of the flash after which the board resets, as long as the last of them is under way.
pub(super) const RESETS: [u32; 3] = [5, LEN / 16, LEN / 8 + 10];
/// What [`RESETS`] must leave whole, as the report names it.
pub(super) const NAMES: [&str; RESETS.len()] =
    ["store_whole_after_reset_in_erasure", "store_whole_after_reset_in_content", "store_whole_after_reset_at_the_end"];

/// The contents that are stored one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Content {
    /// Stored before the resets.
    Before,
    /// Its store is interrupted.
    Interrupted,
}

impl Content {
    fn word(self, offset: u32) -> [u8; WORD_LEN] {
        let low = offset.wrapping_mul(0x9e37_79b9);
        let high = if self == Self::Before { !low } else { low };
        (u64::from(high) << 32 | u64::from(low)).to_le_bytes()
    }

    fn crc32(self) -> u32 {
        let mut digest = Crc32::new();
        for offset in (0..LEN).step_by(WORD_LEN) {
            digest.update(&self.word(offset));
        }
        digest.finish()
    }

    /// Whether this is what is stored.
    pub(super) fn is_stored<B: LoopedBoard>(self, board: &mut B) -> bool {
        let found: Option<Found> = board.flash().and_then(|flash| B::SLOT.find(flash));
        found.is_some_and(|found| found.len == LEN && found.crc32 == self.crc32())
    }

    /// Stores it, calling `meanwhile` between two looks at the flash, until `operations` have begun; all of it for
    /// `None`.
    pub(super) fn store<B: LoopedBoard>(
        self,
        board: &mut B,
        operations: Option<u32>,
        mut meanwhile: impl FnMut(&mut B) -> Result<(), Stop>,
    ) -> Result<(), Stop> {
        let flash = board.flash().ok_or(Stop::NoFlash)?;
        let found = B::SLOT.find(flash);
        let mut writer = Writer::new::<B::Flash>(B::SLOT, found.as_ref(), LEN).ok_or(Stop::NoFlash)?;
        let mut begun = 0;
        while operations.is_none_or(|operations| begun < operations) {
            meanwhile(board)?;
            let flash = board.flash().ok_or(Stop::NoFlash)?;
            match writer.step(flash, |offset| self.word(offset)) {
                Writing::Busy => {}
                Writing::UnderWay => begun += 1,
                Writing::Done(_) => return Ok(()),
                Writing::Failed => return Err(Stop::FlashFailed),
            }
        }
        Ok(())
    }
}

/// Erases both copies' beginnings, so that nothing is stored.
pub(super) fn forget<B: LoopedBoard>(
    board: &mut B,
    mut meanwhile: impl FnMut(&mut B) -> Result<(), Stop>,
) -> Result<(), Stop> {
    for page in [B::SLOT.first_page, B::SLOT.first_page + B::SLOT.pages] {
        board.flash().ok_or(Stop::NoFlash)?.begin_erase(page);
        loop {
            meanwhile(board)?;
            match board.flash().ok_or(Stop::NoFlash)?.operation() {
                Operation::Busy => {}
                Operation::Done => break,
                Operation::Failed => return Err(Stop::FlashFailed),
            }
        }
    }
    Ok(())
}
