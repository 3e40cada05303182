//! The green light on the board (LD2, PA5): off when disarmed, on when armed or playing, blinking when faulted.

use frixel_wire::fault::State;
use stm32_metapac::GPIOA;

use crate::board::TICK_HZ;
use crate::pins;

const LD2: u32 = 5;
const BLINK_TICKS: u32 = TICK_HZ / 8;

/// Takes the light, off.
pub fn start() {
    pins::output_low(GPIOA, LD2);
}

/// Shows a state.
pub fn show(state: State, now_tick: u32) {
    let on = match state {
        State::Disarmed => false,
        State::Armed | State::Active => true,
        State::Faulted => (now_tick / BLINK_TICKS).is_multiple_of(2),
    };
    pins::set(GPIOA, LD2, on);
}
