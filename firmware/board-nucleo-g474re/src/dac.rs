//! The DAC, an AD5761R on SPI2. Two halves take turns on the bus
//! ([`BusHandover`](frixel_drivers::bus_handover::BusHandover)):
//!
//! - [`Frames`], in the tick: one output frame a period by DMA, latched by a timer's edge ([`crate::period`]);
//! - [`DacBus`], in the main loop: an `SpiDevice` for the driver that configures the DAC and reads it back.
//!
//! | pin | function | |
//! |---|---|---|
//! | PB13 | SPI2_SCK | SCLK |
//! | PB15 | SPI2_MOSI | SDI |
//! | PB14 | SPI2_MISO | SDO, to read back |

use core::sync::atomic::{AtomicU8, Ordering};

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{self, ErrorKind, ErrorType, Operation, SpiDevice};
use frixel_board::hardware::{DacFrames, Late};
use frixel_drivers::ad5761r::{self, Ad5761r, FRAME_LEN};
use frixel_wire::dac_code::DacCode;
use stm32_metapac::bdma::vals::{Dir, Pl};
use stm32_metapac::spi::vals::{Br, Cpha, Cpol, Ds, Frxth, Mstr};
use stm32_metapac::{GPIOB, SPI2};

use crate::clock::CycleDelay;
use crate::{ROUNDS_MAX, dma, period, pins};

const SCK: u32 = 13;
const MISO: u32 = 14;
const MOSI: u32 = 15;
const SPI2_FUNCTION: u8 = 5;
/// Clock of the tick's frames: 170 MHz / 8 = 21.25 MHz; the DAC allows 50.
const FRAME_CLOCK: Br = Br::DIV8;
/// Clock of the driver, 5.3 MHz. SDO follows an edge by up to 40 ns, more than half a period at 21.25 MHz.
const DRIVER_CLOCK: Br = Br::DIV32;

/// Bytes for the DAC, in the memory for DMA (`memory.x`). They are written before DMA reads them.
#[unsafe(link_section = ".dma.FRAME")]
static FRAME: [AtomicU8; FRAME_LEN] = [const { AtomicU8::new(0) }; FRAME_LEN];

/// The driver of this board's DAC.
pub type Dac = Ad5761r<DacBus, CycleDelay>;
/// Errors of the DAC's driver.
pub type DacError = ad5761r::Error<SpiError>;

/// Starts SPI2 and returns its two halves. Call [`period::start`] first. The DAC is not configured yet.
pub fn start() -> (Frames, Dac) {
    // SCLK is high between frames, and the DAC samples at falling edges: mode 2.
    SPI2.cr1().write(|w| {
        w.set_mstr(Mstr::MASTER);
        w.set_cpol(Cpol::IDLE_HIGH);
        w.set_cpha(Cpha::FIRST_EDGE);
        w.set_br(FRAME_CLOCK);
        w.set_ssm(true);
        w.set_ssi(true);
    });
    SPI2.cr2().write(|w| {
        w.set_ds(Ds::BITS8);
        w.set_frxth(Frxth::QUARTER);
        w.set_txdmaen(true);
    });
    SPI2.cr1().modify(|w| w.set_spe(true));
    for pin in [SCK, MISO, MOSI] {
        pins::alternate(GPIOB, pin, SPI2_FUNCTION);
    }
    let transfer = dma::Transfer {
        request: dma::Request::Spi2Tx,
        direction: Dir::FROM_MEMORY,
        priority: Pl::VERY_HIGH,
        circular: false,
        register: SPI2.dr8().as_ptr().cast(),
    };
    dma::set_up(dma::DAC, &transfer, &FRAME);
    (Frames(()), Ad5761r::new(DacBus(()), CycleDelay))
}

/// The tick's half of the DAC.
pub struct Frames(());

impl DacFrames for Frames {
    #[inline]
    fn send(&mut self, code: DacCode) -> Result<(), Late> {
        if period::cycles() > period::DEADLINE_CYCLES || dma::remaining(dma::DAC) > 0 {
            return Err(Late);
        }
        for (to, from) in FRAME.iter().zip(ad5761r::output(code)) {
            to.store(from, Ordering::Relaxed);
        }
        period::begin_frame();
        dma::begin(dma::DAC, FRAME_LEN as u16);
        Ok(())
    }
}

/// The main loop's half of the DAC. It polls, while the tick sends nothing.
pub struct DacBus(());

/// Why a transfer failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "log", derive(defmt::Format))]
pub enum SpiError {
    /// SPI2 did not become idle, or did not receive a byte.
    Timeout,
}

impl spi::Error for SpiError {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

impl ErrorType for DacBus {
    type Error = SpiError;
}

impl SpiDevice for DacBus {
    /// SYNC is low for the whole transaction. The tick may interrupt it at any point; the bus then pauses.
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), SpiError> {
        configure(DRIVER_CLOCK, false)?;
        // Discard the bytes that were received during the tick's frames, and the overrun that they caused.
        while SPI2.sr().read().rxne() {
            let _ = SPI2.dr8().read();
        }
        period::hold_sync_low();
        let result = operations.iter_mut().try_for_each(run);
        period::end_frame();
        configure(FRAME_CLOCK, true)?;
        result
    }
}

fn run(operation: &mut Operation<'_, u8>) -> Result<(), SpiError> {
    match operation {
        Operation::Read(bytes) => {
            for byte in bytes.iter_mut() {
                *byte = exchange(0)?;
            }
        }
        Operation::Write(bytes) => {
            for byte in *bytes {
                exchange(*byte)?;
            }
        }
        Operation::Transfer(read, write) => {
            for index in 0..read.len().max(write.len()) {
                let received = exchange(write.get(index).copied().unwrap_or_default())?;
                if let Some(byte) = read.get_mut(index) {
                    *byte = received;
                }
            }
        }
        Operation::TransferInPlace(bytes) => {
            for byte in bytes.iter_mut() {
                *byte = exchange(*byte)?;
            }
        }
        Operation::DelayNs(ns) => CycleDelay.delay_ns(*ns),
    }
    Ok(())
}

/// Sends a byte, and returns the byte received meanwhile.
fn exchange(byte: u8) -> Result<u8, SpiError> {
    SPI2.dr8().write_value(byte);
    wait_until(|| SPI2.sr().read().rxne())?;
    Ok(SPI2.dr8().read())
}

/// Changes clock and DMA between two frames (RM0440, "SPI": "Procedure for disabling the SPI").
fn configure(clock: Br, dma: bool) -> Result<(), SpiError> {
    wait_until(|| !SPI2.sr().read().bsy())?;
    SPI2.cr1().modify(|w| w.set_spe(false));
    SPI2.cr1().modify(|w| w.set_br(clock));
    SPI2.cr2().modify(|w| w.set_txdmaen(dma));
    SPI2.cr1().modify(|w| w.set_spe(true));
    Ok(())
}

fn wait_until(ready: impl Fn() -> bool) -> Result<(), SpiError> {
    if (0..ROUNDS_MAX).any(|_| ready()) { Ok(()) } else { Err(SpiError::Timeout) }
}
