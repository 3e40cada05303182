//! The optical touch frame, a Neonode zForce module on I2C 0. The FIFOs of 16 bytes are served whenever the main loop
//! polls; between two polls the peripheral holds SCL low, so that no byte is lost (RP2040, 4.3, "I2C").
//!
//! The module lies along the top edge of the screen, with its corner at the screen's corner.
//!
//! | pin | function | |
//! |---|---|---|
//! | GP16 | I2C0 SDA | |
//! | GP17 | I2C0 SCL | |
//! | GP18 | input, pulled down | data ready |

use core::future::poll_fn;
use core::task::Poll;

use embedded_hal_async::i2c::{self, ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};
use frixel_board::optical_frame::{self, Reports, TickDelay};
use frixel_drivers::i2c_bus_clear::clear_bus;
use frixel_drivers::zforce::{self, MESSAGE_MAX_LEN, ZForce};
use rp_pac::I2C0;
use rp_pac::i2c::vals::Speed;
use rp_pac::resets::regs::Peripherals;

use crate::chip::TICK_HZ;
use crate::clock::{self, CORE_HZ};
use crate::pins::{self, Function, OpenDrainPin, Pin};
use crate::tick;

const SDA: usize = 16;
const SCL: usize = 17;
const DATA_READY: usize = 18;

/// Cycles of the core in a period of SCL, and in its low part: 400 kHz, low for 1.5 us of 2.5.
const PERIOD: u32 = CORE_HZ / 400_000;
const LOW: u32 = PERIOD * 3 / 5;
/// Words of a FIFO.
const FIFO_LEN: usize = 16;
/// Time limit of a transfer: the longest message takes 2.9 ms on the bus, and the module may stretch the clock.
const TRANSFER_TICKS: u32 = TICK_HZ / 1000 * 6;
/// Time limit of the end of a byte, after which the peripheral is idle.
const DISABLE_TICKS: u32 = TICK_HZ / 1000;
/// Age of a place when it is read: two scans at 200 Hz, one that sees the finger and one that is reported. Must be
/// measured at bring-up.
const AGE_TICKS: u32 = TICK_HZ / 100;

/// Takes the bus, and stores one report after the other in `reports`. Never returns.
pub async fn read(reports: &Reports) {
    let frame = ZForce::new(Bus::new(), Pin::input_pulled_down(DATA_READY), delay());
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

/// I2C 0 at 400 kHz.
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
    /// SDA is low before the transfer, and nine clocks have not freed it, or the peripheral waits for the last transfer
    /// to end: a short, a module without supply, or one that holds SCL.
    BusHeld,
    /// A transaction of several transfers, or of none or more than 127 bytes, which the module never needs.
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
        if len == 0 || len > MESSAGE_MAX_LEN {
            return Err(Error::Unsupported);
        }
        if !pins::is_high(SDA) && !clear().await {
            return Err(Error::BusHeld);
        }
        if !disable().await {
            return Err(Error::BusHeld);
        }
        enable(address);
        let from_tick = tick::SHARED.count();
        let mut transfer = Transfer { operation, sent: 0, received: 0 };
        let result = poll_fn(|_| transfer.poll(from_tick)).await;
        disable().await;
        result
    }
}

impl Bus {
    fn new() -> Self {
        clock::restart(Peripherals::set_i2c0);
        pins::connect_pulled_up(SDA, Function::I2c);
        pins::connect_pulled_up(SCL, Function::I2c);
        Self(())
    }
}

/// Clears the bus from a transfer that a reset or a time-out has cut off, and returns whether SDA is free.
async fn clear() -> bool {
    let mut scl = OpenDrainPin::released(SCL);
    let is_free = clear_bus(&mut scl, &mut Pin::reads(SDA), &mut delay()).await;
    pins::connect_pulled_up(SCL, Function::I2c);
    is_free
}

/// Disables the peripheral, which clears its FIFOs, and clears its flags: those of a transfer that was given up must
/// not end the next one. Returns whether it is idle; until then, it takes no configuration (RP2040, 4.3.10,
/// "Disabling").
async fn disable() -> bool {
    I2C0.ic_enable().write(|w| w.set_enable(false));
    let from_tick = tick::SHARED.count();
    let is_idle = poll_fn(|_| {
        let is_idle = !I2C0.ic_enable_status().read().ic_en();
        let is_late = tick::SHARED.count().wrapping_sub(from_tick) > DISABLE_TICKS;
        if is_idle || is_late { Poll::Ready(is_idle) } else { Poll::Pending }
    })
    .await;
    // Reading it clears them.
    let _ = I2C0.ic_clr_intr().read();
    is_idle
}

/// Configures the peripheral, which is disabled, as controller for this target, and enables it.
fn enable(address: u8) {
    I2C0.ic_con().write(|w| {
        w.set_master_mode(true);
        w.set_speed(Speed::FAST);
        w.set_ic_restart_en(true);
        w.set_ic_slave_disable(true);
    });
    I2C0.ic_tar().write(|w| w.set_ic_tar(u16::from(address)));
    I2C0.ic_fs_scl_hcnt().write(|w| w.set_ic_fs_scl_hcnt((PERIOD - LOW) as u16));
    I2C0.ic_fs_scl_lcnt().write(|w| w.set_ic_fs_scl_lcnt(LOW as u16));
    // Spikes of up to 50 ns are filtered; SDA changes 300 ns after SCL has fallen.
    I2C0.ic_fs_spklen().write(|w| w.set_ic_fs_spklen((CORE_HZ / 20_000_000) as u8));
    I2C0.ic_sda_hold().modify(|w| w.set_ic_sda_tx_hold((CORE_HZ / 10_000_000 * 3 + 1) as u16));
    I2C0.ic_enable().write(|w| w.set_enable(true));
}

/// A transfer that is under way.
struct Transfer<'a, 'b> {
    operation: &'a mut Operation<'b>,
    /// Bytes whose commands are in the FIFO or were carried out.
    sent: usize,
    /// Bytes that were read.
    received: usize,
}

impl Transfer<'_, '_> {
    fn poll(&mut self, from_tick: u32) -> Poll<Result<(), Error>> {
        self.receive();
        self.send();
        let status = I2C0.ic_raw_intr_stat().read();
        if status.tx_abrt() {
            // Only a lost arbitration and a missing acknowledgement are possible.
            let lost = I2C0.ic_tx_abrt_source().read().arb_lost();
            return Poll::Ready(Err(if lost { Error::ArbitrationLoss } else { Error::NoAcknowledge }));
        }
        // The last byte may have come between the two.
        self.receive();
        if status.stop_det() && self.is_complete() {
            Poll::Ready(Ok(()))
        } else if tick::SHARED.count().wrapping_sub(from_tick) > TRANSFER_TICKS {
            Poll::Ready(Err(Error::Timeout))
        } else {
            Poll::Pending
        }
    }

    fn is_complete(&self) -> bool {
        match &*self.operation {
            Operation::Read(bytes) => self.received == bytes.len(),
            Operation::Write(bytes) => self.sent == bytes.len(),
        }
    }

    /// Fills the transmit FIFO: with the bytes to write, or with commands to read, of which no more may be under way
    /// than the receive FIFO holds.
    fn send(&mut self) {
        let (bytes, is_read): (&[u8], bool) = match &*self.operation {
            Operation::Read(bytes) => (bytes, true),
            Operation::Write(bytes) => (bytes, false),
        };
        while let Some(byte) = bytes.get(self.sent)
            && I2C0.ic_status().read().tfnf()
            && !(is_read && self.sent - self.received >= FIFO_LEN)
        {
            self.sent += 1;
            I2C0.ic_data_cmd().write(|w| {
                w.set_cmd(is_read);
                w.set_dat(if is_read { 0 } else { *byte });
                w.set_stop(self.sent == bytes.len());
            });
        }
    }

    /// Empties the receive FIFO.
    fn receive(&mut self) {
        let Operation::Read(bytes) = self.operation else { return };
        while let Some(byte) = bytes.get_mut(self.received)
            && I2C0.ic_status().read().rfne()
        {
            *byte = I2C0.ic_data_cmd().read().dat();
            self.received += 1;
        }
    }
}
