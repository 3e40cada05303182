//! The green light on the board, LD2.
//!
//! | pin | function | |
//! |---|---|---|
//! | PA5 | output | LD2, on while high |

use stm32_metapac::GPIOA;

use crate::pins::{self, Pin};

const LD2: u32 = 5;

/// Configures the light's pin and switches the light off.
pub fn start() -> Pin {
    pins::output_low(GPIOA, LD2)
}
