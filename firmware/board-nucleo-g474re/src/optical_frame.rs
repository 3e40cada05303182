//! The optical touch frame, a Neonode zForce module on I2C3. Transfers use DMA, so that the main loop never waits for
//! them (RM0440, "I2C": "I2C master mode", "DMA requests").
//!
//! The module lies along the top edge of the screen, with its corner at the screen's corner.
//!
//! | pin | function | |
//! |---|---|---|
//! | PC8 | I2C3_SCL | |
//! | PC9 | I2C3_SDA | |
//! | PD2 | input, pulled down | data ready |

use core::future::poll_fn;
use core::sync::atomic::{AtomicU8, Ordering};
use core::task::Poll;

use embedded_hal_async::i2c::{self, ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};
use frixel_board::optical_frame::{self, Reports, TickDelay};
use frixel_drivers::i2c_bus_clear::clear_bus;
use frixel_drivers::zforce::{self, MESSAGE_MAX_LEN, ZForce};
use stm32_metapac::bdma::vals::{Dir as DmaDir, Pl};
use stm32_metapac::i2c::vals::{Autoend, Dir};
use stm32_metapac::rcc::vals::I2csel;
use stm32_metapac::{GPIOC, GPIOD, I2C3, RCC};

use crate::board::TICK_HZ;
use crate::pins::{ForcedPin, Pin};
use crate::{dma, pins, tick};

const SCL: u32 = 8;
const SDA: u32 = 9;
const DATA_READY: u32 = 2;
const I2C3_FUNCTION: u8 = 8;

/// Time limit of a transfer: the longest message takes 2.9 ms on the bus, and the module may stretch the clock.
const TRANSFER_TICKS: u32 = TICK_HZ / 1000 * 6;
/// Age of a place when it is read: two scans at 200 Hz, one that sees the finger and one that is reported. Must be
/// measured at bring-up.
const AGE_TICKS: u32 = TICK_HZ / 100;

/// In the memory for DMA (`memory.x`). Bytes that DMA has not written are written before they are read.
#[unsafe(link_section = ".dma.BYTES")]
static BYTES: [AtomicU8; MESSAGE_MAX_LEN] = [const { AtomicU8::new(0) }; MESSAGE_MAX_LEN];

/// Takes the bus, and stores one report after the other in `reports`. Never returns.
pub async fn read(reports: &Reports) {
    let frame = ZForce::new(Bus::new(), Pin::input_pulled_down(GPIOD, DATA_READY), delay());
    optical_frame::read(frame, AGE_TICKS, reports, log).await;
}

#[cfg(feature = "log")]
fn log(error: zforce::Error<Error>) {
    defmt::warn!("touch frame: {}", error);
}

#[cfg(not(feature = "log"))]
fn log(_: zforce::Error<Error>) {}

fn delay() -> TickDelay<TICK_HZ> {
    TickDelay(&tick::SHARED)
}

/// I2C3 at 400 kHz.
struct Bus(());

/// Why a transfer failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "log", derive(defmt::Format))]
pub enum Error {
    /// The module did not acknowledge.
    NoAcknowledge,
    /// Arbitration was lost to another master, or the bus is shorted.
    ArbitrationLoss,
    /// The transfer took longer than 6 ms.
    Timeout,
    /// SDA is low before the transfer, and nine clocks have not freed it: a short, or a module without supply.
    BusHeld,
    /// A transaction of several transfers, or of more than 127 bytes, which the module never needs.
    Unsupported,
}

impl i2c::Error for Error {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::NoAcknowledge => ErrorKind::NoAcknowledge(NoAcknowledgeSource::Unknown),
            Self::ArbitrationLoss => ErrorKind::ArbitrationLoss,
            Self::Timeout | Self::BusHeld | Self::Unsupported => ErrorKind::Other,
        }
    }
}

impl ErrorType for Bus {
    type Error = Error;
}

impl I2c for Bus {
    async fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), Error> {
        let [operation] = operations else { return Err(Error::Unsupported) };
        let len = match operation {
            Operation::Read(bytes) => bytes.len(),
            Operation::Write(bytes) => bytes.len(),
        };
        if len > MESSAGE_MAX_LEN {
            return Err(Error::Unsupported);
        }
        if !pins::is_high(GPIOC, SDA) && !clear().await {
            return Err(Error::BusHeld);
        }
        match operation {
            Operation::Write(bytes) => begin_write(address, bytes),
            Operation::Read(_) => begin_read(address, len),
        }
        let from_tick = tick::count();
        let result = poll_fn(|_| poll_transfer(from_tick)).await;
        if result.is_err() {
            release();
        }
        if let Operation::Read(bytes) = operation {
            for (to, from) in bytes.iter_mut().zip(&BYTES) {
                *to = from.load(Ordering::Relaxed);
            }
        }
        result
    }
}

impl Bus {
    fn new() -> Self {
        RCC.ccipr().modify(|w| w.set_i2c3sel(I2csel::HSI));
        pins::alternate_open_drain(GPIOC, SDA, I2C3_FUNCTION);
        connect();
        Self(())
    }
}

/// Clears the bus from a transfer that a reset or a time-out has cut off, and returns whether SDA is free.
async fn clear() -> bool {
    // Releases both lines.
    I2C3.cr1().write(|w| w.set_pe(false));
    let mut scl = ForcedPin::new(GPIOC, SCL);
    let is_free = clear_bus(&mut scl, &mut Pin::reads(GPIOC, SDA), &mut delay()).await;
    connect();
    is_free
}

/// Connects SCL to the peripheral, and enables it.
fn connect() {
    pins::alternate_open_drain(GPIOC, SCL, I2C3_FUNCTION);
    enable();
}

fn poll_transfer(from_tick: u32) -> Poll<Result<(), Error>> {
    let status = I2C3.isr().read();
    if status.berr() {
        // Errata ES0430, 2.15.2: a spurious bus error in master mode; the transfer continues.
        I2C3.icr().write(|w| w.set_berrcf(true));
    }
    if status.nackf() {
        Poll::Ready(Err(Error::NoAcknowledge))
    } else if status.arlo() {
        Poll::Ready(Err(Error::ArbitrationLoss))
    } else if status.stopf() {
        I2C3.icr().write(|w| w.set_stopcf(true));
        Poll::Ready(Ok(()))
    } else if tick::count().wrapping_sub(from_tick) > TRANSFER_TICKS {
        Poll::Ready(Err(Error::Timeout))
    } else {
        Poll::Pending
    }
}

/// Releases the bus and clears all flags: the peripheral is off for three clocks (RM0440, "Software reset" of I2C).
fn release() {
    I2C3.cr1().write(|w| w.set_pe(false));
    for _ in 0..3 {
        let _ = I2C3.cr1().read();
    }
    enable();
}

/// 400 kHz from 16 MHz (RM0440, "I2C": "`I2C_TIMINGR` register configuration examples").
fn enable() {
    I2C3.timingr().write(|w| {
        w.set_presc(1);
        w.set_scll(9);
        w.set_sclh(3);
        w.set_sdadel(2);
        w.set_scldel(3);
    });
    I2C3.cr1().write(|w| {
        w.set_txdmaen(true);
        w.set_rxdmaen(true);
        w.set_pe(true);
    });
}

fn begin_write(address: u8, bytes: &[u8]) {
    for (to, from) in BYTES.iter().zip(bytes) {
        to.store(*from, Ordering::Relaxed);
    }
    let register = I2C3.txdr().as_ptr().cast();
    begin(address, Dir::WRITE, dma::Request::I2c3Tx, DmaDir::FROM_MEMORY, register, bytes.len());
}

fn begin_read(address: u8, len: usize) {
    let register = I2C3.rxdr().as_ptr().cast();
    begin(address, Dir::READ, dma::Request::I2c3Rx, DmaDir::FROM_PERIPHERAL, register, len);
}

fn begin(address: u8, dir: Dir, request: dma::Request, direction: DmaDir, register: *mut (), len: usize) {
    let transfer = dma::Transfer { request, direction, priority: Pl::LOW, circular: false, register };
    dma::set_up(dma::OPTICAL_FRAME, &transfer, &BYTES);
    dma::begin(dma::OPTICAL_FRAME, len as u16);
    I2C3.cr2().write(|w| {
        w.set_sadd(u16::from(address) << 1);
        w.set_dir(dir);
        w.set_nbytes(len as u8);
        w.set_autoend(Autoend::AUTOMATIC);
        w.set_start(true);
    });
}
