//! The light on the board.
//!
//! | pin | function | |
//! |---|---|---|
//! | GP25 | output | the light, on while high |

use frixel_drivers::state_light::StateLight;

use crate::chip::TICK_HZ;
use crate::pins::Pin;

const LIGHT: usize = 25;

/// Configures the light's pin and switches the light off.
pub fn start() -> StateLight<Pin> {
    StateLight::new(Pin::output_low(LIGHT), TICK_HZ)
}
