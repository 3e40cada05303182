//! The limits in the flash of a board, as stored by bring-up.

use frixel_session::store::{COPY_LEN, CeilingPolicy, first_copy, write_limits};
use frixel_wire::hello::BoardLimits;

use crate::emulated::EmulatorError;

/// The flash bytes of the limits, one byte per word.
pub(super) fn stored(limits: &BoardLimits) -> Result<[u32; COPY_LEN], EmulatorError> {
    let bytes = write_limits(limits, CeilingPolicy::InForce)
        .map_err(|error| EmulatorError::LimitsNotStored { reason: error.to_string() })?;
    Ok(first_copy(&bytes).map(u32::from))
}

#[cfg(test)]
mod tests {
    use frixel_control::Board;

    use super::*;

    #[test]
    fn limits_that_no_board_stores_are_an_error_that_says_what_to_do() {
        assert!(stored(&Board::PICO.limits).is_ok());
        let above = BoardLimits { voltage_max_v_peak: 201.0, full_scale_v_peak: 300.0, ..Board::PICO.limits };
        let said = stored(&above).unwrap_err().to_string();
        assert!(said.contains("201 V peak, its ceiling 200 V: lower it"), "{said}");
    }
}
