//! What is checked before the board arms.

use frixel_wire::fault::Fault;

use crate::dac::Dac;
use crate::{limited_polls, tick};

/// Configures the DAC and reads it back while the tick's frames rest, and returns when they run again. An order to arm
/// comes after this. A DAC that does not hold its configuration raises fault `Dac`, which the order does not lift.
///
/// It takes some 0.2 ms, five frames and the hand-over. The output is zero and the amplifier off meanwhile.
pub fn prepare(dac: &mut Dac) {
    let prepared = tick::DAC_BUS.while_frames_rest(limited_polls("the tick"), || dac.prepare());
    if let Err(error) = prepared {
        #[cfg(feature = "log")]
        defmt::error!("not armed: {}", error);
        tick::raise(Fault::Dac, error.detail());
    }
}
