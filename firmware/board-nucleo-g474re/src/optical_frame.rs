//! I2C3 for the optical touch frame of [`frixel_board::optical_frame`]. Transfers use DMA, so that the main loop never
//! waits for them (RM0440, "I2C": "I2C master mode", "DMA requests").
//!
//! | pin | function | |
//! |---|---|---|
//! | PC8 | I2C3_SCL | |
//! | PC9 | I2C3_SDA | |
//! | PD2 | input, pulled down | data ready |

use core::sync::atomic::{AtomicU8, Ordering};
use core::task::Poll;

use embedded_hal_async::i2c::Operation;
use frixel_board::main_loop::MainLoop;
use frixel_board::optical_frame::{self, BusError, I2cPort};
use frixel_drivers::pin::DirectPin;
use frixel_drivers::zforce::MESSAGE_MAX_LEN;
use stm32_metapac::bdma::vals::{Dir as DmaDir, Pl};
use stm32_metapac::i2c::vals::{Autoend, Dir};
use stm32_metapac::rcc::vals::I2csel;
use stm32_metapac::{GPIOC, GPIOD, I2C3, RCC};

use crate::board::Nucleo;
use crate::dma;
use crate::pins::{self, Forced, Pin};

const SCL: u32 = 8;
const SDA: u32 = 9;
const DATA_READY: u32 = 2;
const I2C3_FUNCTION: u8 = 8;

/// Buffer in the memory for DMA (`memory.x`). Bytes that DMA has not written are written before they are read.
#[unsafe(link_section = ".dma.BYTES")]
static BYTES: [AtomicU8; MESSAGE_MAX_LEN] = [const { AtomicU8::new(0) }; MESSAGE_MAX_LEN];

/// Takes the bus, and runs the main loop forever with the frame as its touch source.
pub fn run(main_loop: MainLoop<Nucleo>) -> ! {
    RCC.ccipr().modify(|w| w.set_i2c3sel(I2csel::HSI));
    pins::alternate_open_drain(GPIOC, SDA, I2C3_FUNCTION);
    let mut port = Port(());
    port.give_clock();
    optical_frame::run(main_loop, port, pins::input_pulled_down(GPIOD, DATA_READY))
}

/// I2C3 at 400 kHz.
struct Port(());

impl I2cPort for Port {
    type Clock = DirectPin<Forced>;
    type Data = Pin;

    fn data(&self) -> Pin {
        pins::reads(GPIOC, SDA)
    }

    fn take_clock(&mut self) -> DirectPin<Forced> {
        // Releases both lines.
        I2C3.cr1().write(|w| w.set_pe(false));
        pins::forced(GPIOC, SCL)
    }

    fn give_clock(&mut self) {
        pins::alternate_open_drain(GPIOC, SCL, I2C3_FUNCTION);
        enable();
    }

    fn begin(&mut self, address: u8, operation: &Operation<'_>) {
        match operation {
            Operation::Write(bytes) => {
                for (to, from) in BYTES.iter().zip(*bytes) {
                    to.store(*from, Ordering::Relaxed);
                }
                let register = I2C3.txdr().as_ptr().cast();
                begin(address, Dir::WRITE, dma::Request::I2c3Tx, DmaDir::FROM_MEMORY, register, bytes.len());
            }
            Operation::Read(bytes) => {
                let register = I2C3.rxdr().as_ptr().cast();
                begin(address, Dir::READ, dma::Request::I2c3Rx, DmaDir::FROM_PERIPHERAL, register, bytes.len());
            }
        }
    }

    fn poll(&mut self, operation: &mut Operation<'_>) -> Poll<Result<(), BusError>> {
        let status = I2C3.isr().read();
        if status.berr() {
            // Errata ES0430, 2.15.2: a spurious bus error in master mode; the transfer continues.
            I2C3.icr().write(|w| w.set_berrcf(true));
        }
        if status.nackf() {
            Poll::Ready(Err(BusError::NoAcknowledge))
        } else if status.arlo() {
            Poll::Ready(Err(BusError::ArbitrationLoss))
        } else if status.stopf() {
            I2C3.icr().write(|w| w.set_stopcf(true));
            if let Operation::Read(bytes) = operation {
                for (to, from) in bytes.iter_mut().zip(&BYTES) {
                    *to = from.load(Ordering::Relaxed);
                }
            }
            Poll::Ready(Ok(()))
        } else {
            Poll::Pending
        }
    }

    /// Releases the bus and clears all flags: the peripheral is off for three clocks (RM0440, "Software reset" of I2C).
    fn give_up(&mut self) {
        I2C3.cr1().write(|w| w.set_pe(false));
        for _ in 0..3 {
            let _ = I2C3.cr1().read();
        }
        enable();
    }
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
