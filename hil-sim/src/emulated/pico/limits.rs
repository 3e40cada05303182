//! The limits in the flash of a board that was brought up, as an image for bring-up would have stored them.

use frixel_session::store::{Ceilings, Flash, Operation, Slot, WORD_LEN, Writer, Writing, write_limits};
use frixel_wire::hello::BoardLimits;

/// Offset of the stores in the flash, and the slot of the limits in them (`firmware/board-pico`).
pub(super) const OFFSET: u32 = 1 << 20;
const SLOT: Slot = Slot { first_page: 0, pages: 1 };

/// The pages of both copies, erased at first.
struct Pages(Vec<u8>);

impl Flash for Pages {
    const PAGE_LEN: u32 = 4096;

    fn read(&self, offset: u32, bytes: &mut [u8]) -> bool {
        let start = offset as usize;
        self.0.get(start..start + bytes.len()).is_some_and(|found| {
            bytes.copy_from_slice(found);
            true
        })
    }

    fn begin_erase(&mut self, page: u32) {
        let start = (page * Self::PAGE_LEN) as usize;
        self.0[start..start + Self::PAGE_LEN as usize].fill(0xff);
    }

    fn begin_write(&mut self, offset: u32, word: [u8; WORD_LEN]) {
        self.0[offset as usize..][..WORD_LEN].copy_from_slice(&word);
    }

    fn operation(&mut self) -> Operation {
        Operation::Done
    }
}

/// The bytes of the slot, from [`OFFSET`] on, a byte a word. Limits that no board stores leave it erased.
pub(super) fn stored(limits: &BoardLimits) -> Vec<u32> {
    let mut flash = Pages(vec![0xff; 2 * SLOT.pages as usize * Pages::PAGE_LEN as usize]);
    if let Ok(bytes) = write_limits(limits, Ceilings::InForce)
        && let Some(mut writer) = Writer::new::<Pages>(SLOT, None, bytes.len() as u32)
    {
        let word = |place: u32| {
            let mut word = [0; WORD_LEN];
            let rest = &bytes[place as usize..];
            let len = rest.len().min(WORD_LEN);
            word[..len].copy_from_slice(&rest[..len]);
            word
        };
        while matches!(writer.step(&mut flash, word), Writing::UnderWay) {}
    }
    flash.0.into_iter().map(u32::from).collect()
}
