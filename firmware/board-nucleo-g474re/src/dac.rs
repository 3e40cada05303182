//! The DAC, an AD5761R on SPI2: three bytes by DMA, latched by a timer's edge ([`crate::period`]).
//!
//! | pin | function | |
//! |---|---|---|
//! | PB13 | SPI2_SCK | SCLK |
//! | PB15 | SPI2_MOSI | SDI |
//! | PB14 | SPI2_MISO | SDO, for [`Dac::is_there`] |

use core::sync::atomic::{AtomicU8, Ordering};

use cortex_m::asm;
use frixel_parts::ad5761r::{self, FRAME_LEN, Frame};
use stm32_metapac::bdma::vals::{Dir, Pl};
use stm32_metapac::spi::vals::{Br, Cpha, Cpol, Ds, Frxth, Mstr};
use stm32_metapac::{GPIOB, SPI2};

use crate::clock::CORE_HZ;
use crate::{dma, period, pins, wait_until};

const SCK: u32 = 13;
const MISO: u32 = 14;
const MOSI: u32 = 15;
const SPI2_FUNCTION: u8 = 5;

/// Bytes on their way to the DAC, in the memory for DMA (`memory.x`); they are written before DMA reads them.
#[unsafe(link_section = ".dma.FRAME")]
static FRAME: [AtomicU8; FRAME_LEN] = [const { AtomicU8::new(0) }; FRAME_LEN];

/// The DAC.
pub struct Dac(());

impl Dac {
    /// Sets the DAC up: +-10 V, output at zero. [`period::start`] comes before.
    pub fn new() -> Self {
        // SCLK is high between frames, and the DAC takes bits at falling edges; 170 MHz / 8 is 21.25 MHz of its 50.
        SPI2.cr1().write(|w| {
            w.set_mstr(Mstr::MASTER);
            w.set_cpol(Cpol::IDLE_HIGH);
            w.set_cpha(Cpha::FIRST_EDGE);
            w.set_br(Br::DIV8);
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
        for frame in [ad5761r::RESET, ad5761r::CONFIGURE, ad5761r::output(0)] {
            send_and_wait(frame);
        }
        Self(())
    }

    /// Begins to send a code, which the DAC puts out at the end of the period. `false` when it is too late for that, or
    /// the frame before is still under way; then nothing is sent.
    #[inline]
    #[must_use]
    pub fn send(&mut self, code: i16) -> bool {
        if period::cycles() > period::DEADLINE_CYCLES || dma::remaining(dma::DAC) > 0 {
            return false;
        }
        begin(ad5761r::output(code));
        true
    }

    /// Whether a DAC answers, set up as it should be. Takes several periods.
    pub fn is_there(&mut self) -> bool {
        // It answers more slowly than it listens: up to 40 ns after an edge, beyond half a clock at 21.25 MHz.
        set_clock(Br::DIV32);
        let found = Self::ask();
        set_clock(Br::DIV8);
        found
    }

    fn ask() -> bool {
        send_and_wait(ad5761r::READ_CONTROL);
        while SPI2.sr().read().rxne() {
            let _ = SPI2.dr8().read();
        }
        send_and_wait(ad5761r::NOTHING);
        // The receive buffer holds the last four bytes: these three and none of before.
        ad5761r::is_configured([(); FRAME_LEN].map(|()| SPI2.dr8().read()))
    }
}

/// Changes the clock between two frames (RM0440, "SPI": "Procedure for disabling the SPI").
fn set_clock(divider: Br) {
    wait_until(|| !SPI2.sr().read().bsy(), "SPI2");
    SPI2.cr1().modify(|w| w.set_spe(false));
    SPI2.cr1().modify(|w| w.set_br(divider));
    SPI2.cr1().modify(|w| w.set_spe(true));
}

/// Sends a frame in a period of its own, and waits for the period's end.
fn send_and_wait(frame: Frame) {
    let _ = period::has_begun();
    wait_until(period::has_begun, "a period of TIM3");
    begin(frame);
    wait_until(period::has_begun, "a period of TIM3");
    // What the DAC takes to do it (a reset, the longest, less than 10 us).
    asm::delay(CORE_HZ / 100_000);
}

fn begin(frame: Frame) {
    for (to, from) in FRAME.iter().zip(frame) {
        to.store(from, Ordering::Relaxed);
    }
    period::begin_frame();
    dma::begin(dma::DAC, FRAME_LEN as u16);
}
