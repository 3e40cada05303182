//! The DAC, an AD5761R on SPI2. Two halves take turns on the bus
//! ([`BusHandover`](frixel_drivers::bus_handover::BusHandover)):
//!
//! - [`Frames`], in the tick: one output frame a period by DMA, latched by a timer's edge ([`crate::period`]);
//! - [`DacBus`], in the main loop: for the driver that configures the DAC and reads it back.
//!
//! | pin | function | |
//! |---|---|---|
//! | PB13 | SPI2_SCK | SCLK |
//! | PB15 | SPI2_MOSI | SDI |
//! | PB14 | SPI2_MISO | SDO, to read back |

use core::sync::atomic::{AtomicU8, Ordering};

use frixel_board::hardware::{DacFrames, Late};
use frixel_cortex_m::Boot;
use frixel_drivers::ad5761r::{self, Ad5761r, BusError, FRAME_LEN, FrameBus, FrameDevice};
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
pub type Dac = Ad5761r<FrameDevice<DacBus>, CycleDelay>;

/// Starts SPI2 and returns its two halves. Call [`period::start`] first. The DAC is not configured yet.
pub fn start(_: &Boot) -> (Frames, Dac) {
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
    (Frames(()), Ad5761r::new(FrameDevice(DacBus(())), CycleDelay {}))
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

impl FrameBus for DacBus {
    /// The tick may interrupt it at any point; the bus then pauses.
    fn exchange(&mut self, bytes: &mut [u8]) -> Result<(), BusError> {
        configure(DRIVER_CLOCK, false)?;
        // Discard the bytes that were received during the tick's frames, and the overrun that they caused.
        while SPI2.sr().read().rxne() {
            let _ = SPI2.dr8().read();
        }
        period::hold_sync_low();
        let result = bytes.iter_mut().try_for_each(exchange);
        period::end_frame();
        configure(FRAME_CLOCK, true)?;
        result
    }
}

/// Sends a byte, and replaces it by the byte received meanwhile.
fn exchange(byte: &mut u8) -> Result<(), BusError> {
    SPI2.dr8().write_value(*byte);
    wait_until(|| SPI2.sr().read().rxne())?;
    *byte = SPI2.dr8().read();
    Ok(())
}

/// Changes clock and DMA between two frames (RM0440, "SPI": "Procedure for disabling the SPI").
fn configure(clock: Br, dma: bool) -> Result<(), BusError> {
    wait_until(|| !SPI2.sr().read().bsy())?;
    SPI2.cr1().modify(|w| w.set_spe(false));
    SPI2.cr1().modify(|w| w.set_br(clock));
    SPI2.cr2().modify(|w| w.set_txdmaen(dma));
    SPI2.cr1().modify(|w| w.set_spe(true));
    Ok(())
}

fn wait_until(ready: impl Fn() -> bool) -> Result<(), BusError> {
    if (0..ROUNDS_MAX).any(|_| ready()) { Ok(()) } else { Err(BusError::Timeout) }
}
