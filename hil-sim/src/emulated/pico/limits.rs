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
