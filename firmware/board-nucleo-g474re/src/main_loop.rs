//! The main loop of [`frixel_board::main_loop`], with the optical frame if the image has it.
//!
//! The compiler takes it into the program, where [`tick_interrupt`](crate::tick_interrupt) declares the tick, so that
//! both share the code of their queues. Otherwise it inlines a part of that into the tick, with a panic for a queue of
//! length zero, which no queue has (`cargo xtask bench` looks for panics of the tick).

#[cfg(feature = "optical-frame")]
use core::pin::pin;

use frixel_board::main_loop::MainLoop;
#[cfg(feature = "optical-frame")]
use frixel_board::optical_frame::{OpticalFrame, Reports};

use crate::board::Nucleo;
#[cfg(feature = "optical-frame")]
use crate::optical_frame;

/// Runs the main loop for ever.
#[inline]
pub fn run(mut main_loop: MainLoop<Nucleo>) -> ! {
    #[cfg(feature = "optical-frame")]
    let reports = Reports::new(None);
    #[cfg(feature = "optical-frame")]
    let reading = pin!(optical_frame::read(&reports));
    #[cfg(feature = "optical-frame")]
    let mut touch_source = OpticalFrame::new(reading, &reports);
    loop {
        #[cfg(feature = "optical-frame")]
        let touch = touch_source.next_touch();
        #[cfg(not(feature = "optical-frame"))]
        let touch = None;
        main_loop.turn(touch);
    }
}
