//! The green light on the board, LD2.
//!
//! | pin | function | |
//! |---|---|---|
//! | PA5 | output | LD2, on while high |

use frixel_drivers::state_light::StateLight;
use stm32_metapac::GPIOA;

use crate::board::TICK_HZ;
use crate::pins::Pin;

const LD2: u32 = 5;

/// Configures the light's pin and switches the light off.
pub fn start() -> StateLight<Pin> {
    StateLight::new(Pin::output_low(GPIOA, LD2), TICK_HZ)
}
