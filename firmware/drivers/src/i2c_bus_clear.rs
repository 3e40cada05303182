//! Frees an I2C bus whose data line is held low.
//!
//! A reset in the middle of a transfer leaves the target waiting for clocks, with SDA low if its current bit or
//! acknowledgement is zero. The controller then cannot begin a transfer. According to NXP's UM10204, section 3.1.16,
//! "Bus clear" (not read), the controller sends clock pulses, and the target releases SDA within nine.

use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal_async::delay::DelayNs;

/// Largest number of clock pulses until the target releases SDA.
const PULSES: u32 = 9;
/// Half a period of the clock, in nanoseconds: 100 kHz, the standard mode, which every target supports.
const HALF_PERIOD_NS: u32 = 5_000;

/// Sends up to nine clock pulses until SDA is high, and returns whether it is. `scl` is an open-drain output, and SDA
/// is released. A pin that cannot be read counts as low.
///
/// The target may still be in the middle of a byte: the next transfer must follow, because its START condition resets
/// the target. No pulse is sent once SDA is high: at the ninth, a receiving target would acknowledge, which holds SDA
/// low again.
pub async fn clear_bus(scl: &mut impl OutputPin, sda: &mut impl InputPin, delay: &mut impl DelayNs) -> bool {
    for _ in 0..PULSES {
        if matches!(sda.is_high(), Ok(true)) {
            return true;
        }
        let _ = scl.set_low();
        delay.delay_ns(HALF_PERIOD_NS).await;
        let _ = scl.set_high();
        delay.delay_ns(HALF_PERIOD_NS).await;
    }
    matches!(sda.is_high(), Ok(true))
}
