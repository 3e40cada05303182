//! The optical touch frame as a touch source of the main loop: a future reads one report after the other, and each turn
//! of the main loop polls it.

use core::cell::Cell;
use core::pin::Pin;

use embedded_hal::digital::InputPin;
use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;
use frixel_drivers::polling::{poll_once, yield_now};
use frixel_drivers::zforce::{self, ZForce};
use frixel_session::Touch;

use crate::tick::TickShared;

/// The last report that the frame has read, until it is taken.
pub type Reports = Cell<Option<Touch>>;

/// The frame as a touch source: a future that reads reports, and the cell in which it stores them.
pub struct OpticalFrame<'a> {
    reading: Pin<&'a mut dyn Future<Output = ()>>,
    reports: &'a Reports,
}

impl<'a> OpticalFrame<'a> {
    /// A source from a future of [`read`] and the cell that was passed to it.
    pub fn new(reading: Pin<&'a mut dyn Future<Output = ()>>, reports: &'a Reports) -> Self {
        Self { reading, reports }
    }

    /// Continues to read without waiting, and returns a report when one is complete. To be called repeatedly.
    pub fn next_touch(&mut self) -> Option<Touch> {
        let _ = poll_once(self.reading.as_mut());
        self.reports.take()
    }
}

/// Stores one report after the other in `reports`, each as old as `age_ticks` when it is read, and passes errors to
/// `on_error`. Never returns.
pub async fn read<B: I2c, R: InputPin, D: DelayNs>(
    mut frame: ZForce<B, R, D>,
    age_ticks: u32,
    reports: &Reports,
    on_error: impl Fn(zforce::Error<B::Error>),
) {
    loop {
        match frame.next_touch().await {
            Ok(zforce::Touch::Down { x_m, y_m }) => reports.set(Some(Touch::Down { x_m, y_m, age_ticks })),
            Ok(zforce::Touch::Up) => reports.set(Some(Touch::Up)),
            Err(error) => on_error(error),
        }
        // Waits until the report is taken before it reads the next.
        while reports.get().is_some() {
            yield_now().await;
        }
    }
}

/// A delay that counts ticks: as long as asked for, and up to two ticks longer.
pub struct TickDelay<const TICK_HZ: u32>(pub &'static TickShared);

impl<const TICK_HZ: u32> DelayNs for TickDelay<TICK_HZ> {
    async fn delay_ns(&mut self, ns: u32) {
        let (from_tick, ticks) = (self.0.count(), ns.div_ceil(1_000_000_000 / TICK_HZ));
        while self.0.count().wrapping_sub(from_tick) <= ticks {
            yield_now().await;
        }
    }
}
