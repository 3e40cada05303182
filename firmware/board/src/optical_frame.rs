//! The optical touch frame, a Neonode zForce module on I2C, as the main loop's touch source: a future reads one report
//! after the other, and each turn of the main loop polls it.
//!
//! The module is mounted along the top edge of the screen, with its corner at the screen's corner.

use core::cell::Cell;
use core::future::poll_fn;
use core::pin::{Pin, pin};
use core::task::Poll;

use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::{self, ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};
use frixel_drivers::i2c_bus_clear::clear_bus;
use frixel_drivers::polling::{poll_once, yield_now};
use frixel_drivers::zforce::{self, MESSAGE_MAX_LEN, ZForce};
use frixel_session::Touch;

use crate::hardware::Hardware;
use crate::main_loop::MainLoop;
use crate::tick::TickShared;

/// Time limit of a transfer, ms: the longest message takes 2.9 ms on the bus, and the module may stretch the clock.
const TRANSFER_MS: u32 = 6;
/// Time limit for ending a byte, after which the peripheral has stopped, ms.
const STOP_MS: u32 = 1;
/// Age of a place when it is read, ms: two scans at 200 Hz, one that detects the finger and one that is reported. Must
/// be measured at bring-up.
const AGE_MS: u32 = 10;

/// Runs the main loop forever with the frame on `port`, whose data-ready line is `data_ready`.
pub fn run<H: Hardware, P: I2cPort>(main_loop: MainLoop<H>, port: P, data_ready: impl InputPin) -> ! {
    let time = TickTime { shared: main_loop.shared, tick_hz: H::TICK_HZ };
    let reports = Reports::new(None);
    let frame = ZForce::new(FrameBus::new(port, time), data_ready, time);
    let reading = pin!(read(frame, time.ticks(AGE_MS), &reports, log));
    let mut source = OpticalFrame::new(reading, &reports);
    main_loop.run(|| source.next_touch())
}

#[cfg(feature = "defmt")]
fn log(error: zforce::Error<BusError>) {
    defmt::warn!("touch frame: {}", error);
}

#[cfg(not(feature = "defmt"))]
fn log(_: zforce::Error<BusError>) {}

/// The last report read from the frame, until it is taken.
pub type Reports = Cell<Option<Touch>>;

/// The frame as a touch source: a future that reads reports, and the cell in which it stores them.
pub struct OpticalFrame<'a> {
    reading: Pin<&'a mut dyn Future<Output = ()>>,
    reports: &'a Reports,
}

impl<'a> OpticalFrame<'a> {
    /// A source from a future of [`read`] and the cell passed to it.
    pub fn new(reading: Pin<&'a mut dyn Future<Output = ()>>, reports: &'a Reports) -> Self {
        Self { reading, reports }
    }

    /// Continues to read without waiting, and returns a report when one is complete. Call this repeatedly.
    pub fn next_touch(&mut self) -> Option<Touch> {
        let _ = poll_once(self.reading.as_mut());
        self.reports.take()
    }
}

/// Stores one report after the other in `reports`, each with the age `age_ticks` when read, and passes errors to
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
        // Wait until the report is taken before reading the next.
        while reports.get().is_some() {
            yield_now().await;
        }
    }
}

/// Time in ticks. As a delay, it lasts up to two ticks longer than requested.
#[derive(Clone, Copy)]
pub struct TickTime {
    /// The counter of ticks.
    pub shared: &'static TickShared,
    /// Ticks a second.
    pub tick_hz: u32,
}

impl TickTime {
    fn ticks(self, ms: u32) -> u32 {
        self.tick_hz / 1000 * ms
    }

    /// Polls until there is a result; `None` after more than `ms`.
    async fn within<T>(self, ms: u32, mut poll: impl FnMut() -> Poll<T>) -> Option<T> {
        let from_tick = self.shared.count();
        poll_fn(|_| match poll() {
            Poll::Ready(result) => Poll::Ready(Some(result)),
            Poll::Pending if self.shared.count().wrapping_sub(from_tick) > self.ticks(ms) => Poll::Ready(None),
            Poll::Pending => Poll::Pending,
        })
        .await
    }
}

impl DelayNs for TickTime {
    async fn delay_ns(&mut self, ns: u32) {
        let (from_tick, ticks) = (self.shared.count(), ns.div_ceil(1_000_000_000 / self.tick_hz));
        while self.shared.count().wrapping_sub(from_tick) <= ticks {
            yield_now().await;
        }
    }
}

/// An I2C peripheral that is the only controller on its bus, at 400 kHz. None of its methods waits.
pub trait I2cPort {
    /// SCL, as a pin that software pulls low or releases.
    type Clock: OutputPin;
    /// SDA, as a pin that software reads.
    type Data: InputPin;

    /// The level of SDA.
    fn data(&self) -> Self::Data;

    /// Takes SCL from the peripheral, which releases both lines.
    fn take_clock(&mut self) -> Self::Clock;

    /// Gives SCL back to the peripheral.
    fn give_clock(&mut self);

    /// Requests a stop from a peripheral that must be disabled between transfers. Called before and after each
    /// transfer.
    fn stop(&mut self) {}

    /// Whether the peripheral has stopped.
    fn has_stopped(&mut self) -> bool {
        true
    }

    /// Begins to transfer the bytes of an operation, 1 to [`MESSAGE_MAX_LEN`]. Flags of an earlier transfer must not
    /// end this one.
    fn begin(&mut self, address: u8, operation: &Operation<'_>);

    /// Continues the transfer, and returns its result once it has ended, with all read bytes in the operation.
    fn poll(&mut self, operation: &mut Operation<'_>) -> Poll<Result<(), BusError>>;

    /// Aborts a failed or overlong transfer, and releases the bus.
    fn give_up(&mut self) {}
}

/// Why a transfer failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum BusError {
    /// The module did not acknowledge.
    NoAcknowledge,
    /// Arbitration was lost to another master, or the bus is shorted.
    ArbitrationLoss,
    /// The transfer took longer than 6 ms.
    Timeout,
    /// SDA is low before the transfer, and nine clocks have not freed it, or the peripheral waits for the last transfer
    /// to end: a short, an unpowered module, or one that holds SCL.
    BusHeld,
    /// A transaction of several transfers, or of none or more than 127 bytes, which the module never needs.
    Unsupported,
}

impl i2c::Error for BusError {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::NoAcknowledge => ErrorKind::NoAcknowledge(NoAcknowledgeSource::Unknown),
            Self::ArbitrationLoss => ErrorKind::ArbitrationLoss,
            Self::Timeout | Self::BusHeld | Self::Unsupported => ErrorKind::Other,
        }
    }
}

/// The bus of the frame, over a board's peripheral. A transaction is one transfer within a time limit. An interrupted
/// transfer is cleared from the bus before the next.
pub struct FrameBus<P> {
    port: P,
    time: TickTime,
}

impl<P: I2cPort> FrameBus<P> {
    /// The bus of a peripheral that is ready.
    pub fn new(port: P, time: TickTime) -> Self {
        Self { port, time }
    }

    /// Clears a transfer interrupted by a reset or a timeout from the bus, and returns whether SDA is free.
    async fn clear(&mut self) -> bool {
        let mut clock = self.port.take_clock();
        let is_free = clear_bus(&mut clock, &mut self.port.data(), &mut self.time).await;
        self.port.give_clock();
        is_free
    }

    /// Stops the peripheral, and returns whether it has stopped.
    async fn stop(&mut self) -> bool {
        self.port.stop();
        let stopped = || if self.port.has_stopped() { Poll::Ready(()) } else { Poll::Pending };
        self.time.within(STOP_MS, stopped).await.is_some()
    }
}

impl<P> ErrorType for FrameBus<P> {
    type Error = BusError;
}

impl<P: I2cPort> I2c for FrameBus<P> {
    async fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), BusError> {
        let [operation] = operations else { return Err(BusError::Unsupported) };
        let len = match operation {
            Operation::Read(bytes) => bytes.len(),
            Operation::Write(bytes) => bytes.len(),
        };
        if len == 0 || len > MESSAGE_MAX_LEN {
            return Err(BusError::Unsupported);
        }
        if !matches!(self.port.data().is_high(), Ok(true)) && !self.clear().await {
            return Err(BusError::BusHeld);
        }
        if !self.stop().await {
            return Err(BusError::BusHeld);
        }
        self.port.begin(address, operation);
        let result = self.time.within(TRANSFER_MS, || self.port.poll(operation)).await;
        let result = result.unwrap_or(Err(BusError::Timeout));
        if result.is_err() {
            self.port.give_up();
        }
        self.stop().await;
        result
    }
}
