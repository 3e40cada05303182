//! The checks of the DAC before the board arms and before it plays.

use frixel_control::Order;
use frixel_wire::fault::Fault;

use crate::dac::Dac;
use crate::{limited_polls, tick};

/// Checks the DAC before an order reaches the ticker: configures it and reads it back before [`Order::Arm`], and reads
/// it back before [`Order::Play`], so that a DAC whose supply dipped while the board was armed is not driven. If the
/// DAC does not hold its configuration, this raises fault `Dac`, which the order does not clear.
///
/// The tick sends no frames meanwhile. It takes some 0.2 ms, up to five frames and the hand-over, in which the output
/// is zero and the amplifier disabled; if a stop is still under way, it begins once the output is zero.
pub fn check_before(order: &Order, dac: &mut Dac) {
    let configures = match order {
        Order::Arm => true,
        Order::Play => false,
        _ => return,
    };
    let work = || if configures { dac.prepare() } else { dac.check() };
    if let Err(error) = tick::DAC_BUS.while_frames_rest(limited_polls("the tick"), work) {
        #[cfg(feature = "log")]
        defmt::error!("the DAC is not ready: {}", error);
        tick::raise(Fault::Dac, error.detail());
    }
}
