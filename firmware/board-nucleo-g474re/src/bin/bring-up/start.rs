//! Starts the firmware's own tick and main loop, with the host on the board.

use board_nucleo_g474re::adc::Adc;
use board_nucleo_g474re::board::Nucleo;
use board_nucleo_g474re::indicator;
use board_nucleo_g474re::tick;
use board_nucleo_g474re::watchdog::Watchdog;
use frixel_board::main_loop::MainLoop;
use frixel_board::start::Parts;
use frixel_control::Board;
use stm32_metapac::interrupt;

use crate::still::Still;

frixel_cortex_m::tick_interrupt!(Nucleo, TIM3);

/// Starts the tick and the watchdog, and returns the main loop, whose turns feed it. Called once.
pub(crate) fn tick(board: Board, still: Still) -> MainLoop<Nucleo> {
    let Still { memory, boot, output, period, inputs: (ready, switch), frames, dac, periods: _ } = still;
    let (light, monitor) = (indicator::start(), Adc::new(&boot));
    let parts = Parts { period, frames, dac, enable: output, ready, monitor, switch, light, serial: None };
    parts.start(memory.make(board), &tick::SHARED, |tick| tick::start(&TICK, boot, tick), Watchdog::start)
}
