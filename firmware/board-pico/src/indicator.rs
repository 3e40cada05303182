//! The light on the board.
//!
//! | pin | function | |
//! |---|---|---|
//! | GP25 | output | the light, on while high |

use crate::pins::{self, Pin};

const LIGHT: usize = 25;

/// Configures the light's pin and switches the light off.
pub fn start() -> Pin {
    pins::output_low(LIGHT)
}
