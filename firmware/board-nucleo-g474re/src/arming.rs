//! The checks of the DAC before the board arms and before it plays.

use frixel_control::Order;
use frixel_wire::fault::Fault;

use crate::dac::{Dac, DacError};
use crate::{limited_polls, tick};

/// Checks the DAC before an order reaches the ticker: configures it and reads it back before [`Order::Arm`], and reads
/// it back before [`Order::Play`], so that a DAC whose supply dipped while the board was armed is not driven. If the DAC
/// does not hold its configuration, this raises fault `Dac`, which the order does not clear.
pub fn check_before(order: &Order, dac: &mut Dac) {
    match order {
        Order::Arm => between_frames(dac, Dac::prepare),
        Order::Play => between_frames(dac, Dac::check),
        _ => {}
    }
}

/// Does work on the DAC while the tick sends no frames, and returns when the tick sends them again.
///
/// It takes some 0.2 ms: up to five frames and the hand-over. Meanwhile the output is zero and the amplifier disabled. If
/// a stop is still under way, it waits until the output is zero.
#[inline(never)]
fn between_frames(dac: &mut Dac, work: fn(&mut Dac) -> Result<(), DacError>) {
    if let Err(error) = tick::DAC_BUS.while_frames_rest(limited_polls("the tick"), || work(dac)) {
        #[cfg(feature = "log")]
        defmt::error!("the DAC is not ready: {}", error);
        tick::raise(Fault::Dac, error.detail());
    }
}
