//! The check of the DAC before the board arms.

use frixel_wire::fault::Fault;

use crate::dac::Dac;
use crate::{limited_polls, tick};

/// Configures the DAC and reads it back while the tick sends no frames, and returns when the tick sends them again.
/// The order to arm follows. If the DAC does not hold its configuration, this raises fault `Dac`, which the order does
/// not clear.
///
/// It takes some 0.2 ms: five frames and the hand-over. Meanwhile the output is zero and the amplifier disabled.
pub fn prepare(dac: &mut Dac) {
    let prepared = tick::DAC_BUS.while_frames_rest(limited_polls("the tick"), || dac.prepare());
    if let Err(error) = prepared {
        #[cfg(feature = "log")]
        defmt::error!("not armed: {}", error);
        tick::raise(Fault::Dac, error.detail());
    }
}
