//! The limits in the flash of a board that was brought up, as an image for bring-up would have stored them.

use frixel_drivers::rp2::LIMITS_PAGES;
use frixel_session::store::{Ceilings, Slot, WORD_LEN, Writer, Writing, write_limits};
use frixel_wire::hello::BoardLimits;

use crate::emulated::EmulatorError;
use crate::simulated_flash::SimulatedFlash;

/// The slot of the limits, and the pages of its two copies, in sectors of the flash chip.
const SLOT: Slot = Slot { first_page: 0, pages: LIMITS_PAGES };
type Pages = SimulatedFlash<{ 2 * LIMITS_PAGES as usize }, 4096>;

/// The bytes of the stores that hold the limits, a byte a word.
pub(super) fn stored(limits: &BoardLimits) -> Result<Vec<u32>, EmulatorError> {
    let not_stored = |reason: String| EmulatorError::LimitsNotStored { reason };
    let bytes = write_limits(limits, Ceilings::InForce).map_err(|error| not_stored(error.to_string()))?;
    let too_long = || not_stored(format!("they take {} bytes, which {SLOT:?} does not hold: enlarge it", bytes.len()));
    let mut writer = Writer::new::<Pages>(SLOT, None, bytes.len() as u32).ok_or_else(too_long)?;
    let word = |place: u32| {
        let mut word = [0; WORD_LEN];
        word.iter_mut().zip(bytes.iter().skip(place as usize)).for_each(|(to, from)| *to = *from);
        word
    };
    let mut flash = Pages::new();
    loop {
        match writer.step(&mut flash, word) {
            Writing::Busy | Writing::UnderWay => {}
            Writing::Done(_) => return Ok(flash.bytes().iter().copied().map(u32::from).collect()),
            Writing::Failed => return Err(not_stored(format!("{SLOT:?} does not hold what was written: check it"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use frixel_control::Board;

    use super::*;

    #[test]
    fn limits_that_no_board_stores_are_an_error_that_says_what_to_do() {
        assert!(stored(&Board::PICO.limits).is_ok());
        let above = BoardLimits { voltage_max_v_peak: 201.0, full_scale_v_peak: 300.0, ..Board::PICO.limits };
        let said = stored(&above).map(|words| words.len()).unwrap_err().to_string();
        assert!(said.contains("201 V peak, its ceiling 200 V: lower it"), "{said}");
    }
}
