//! The serial port to the host: UART 0 at 2 Mbaud, through the UART of a Raspberry Pi Debug Probe, or another one.
//!
//! An interrupt below the tick stores received bytes: the receive FIFO holds 32 bytes, or 0.16 ms, and an iteration of
//! the main loop may take longer. The main loop fills the transmit FIFO itself.
//!
//! | pin | function | |
//! |---|---|---|
//! | GP0 | UART0 TX | to the host |
//! | GP1 | UART0 RX | from the host |

use core::sync::atomic::AtomicU8;

use cortex_m::peripheral::NVIC;
use frixel_board::serial::{RING_LEN, SerialPort, Uart};
use frixel_drivers::ring::InterruptRing;
use rp_pac::{Interrupt, UART0, interrupt};

use crate::clock::CORE_HZ;
use crate::pins::{self, Function};

const BAUD: u32 = 2_000_000;
const TX: usize = 0;
const RX: usize = 1;

/// 64 divisions of the clock for 16 samples of a bit (RP2040, 4.2.7.1, "Baud Rate Calculation").
const DIVIDER: u32 = CORE_HZ * 4 / BAUD;
const _: () = assert!((CORE_HZ * 4).is_multiple_of(BAUD), "the rate is exact");

static RECEIVED: InterruptRing<RING_LEN> = InterruptRing::new();

/// UART 0.
pub struct Uart0(());

/// The serial port.
pub type Serial = SerialPort<Uart0>;

impl Uart0 {
    /// Starts reception: 8 data bits, no parity, 1 stop bit (RP2040, 4.2, "UART").
    pub fn start() -> Serial {
        UART0.uartibrd().write(|w| w.set_baud_divint((DIVIDER / 64) as u16));
        UART0.uartfbrd().write(|w| w.set_baud_divfrac((DIVIDER % 64) as u8));
        // The write that makes the divider effective.
        UART0.uartlcr_h().write(|w| {
            w.set_wlen(0b11);
            w.set_fen(true);
        });
        // With 4 bytes in the FIFO, the least level, or with some and none for the time of 32 bits.
        UART0.uartifls().write(|w| w.set_rxiflsel(0));
        UART0.uartimsc().write(|w| {
            w.set_rxim(true);
            w.set_rtim(true);
        });
        UART0.uartcr().write(|w| {
            w.set_uarten(true);
            w.set_txe(true);
            w.set_rxe(true);
        });
        pins::connect(TX, Function::Uart);
        pins::connect_pulled_up(RX, Function::Uart);
        // SAFETY: the handler shares only atomics. The priority is below the tick's, 0.
        unsafe { NVIC::unmask(Interrupt::UART0_IRQ) };
        SerialPort::new(Self(()))
    }
}

/// Stores what was received. The FIFO's flags of damaged bytes are ignored: they damage frames, which are sent again.
#[interrupt]
fn UART0_IRQ() {
    while !UART0.uartfr().read().rxfe() {
        RECEIVED.push(UART0.uartdr().read().data());
    }
}

impl Uart for Uart0 {
    fn ring(&self) -> &'static [AtomicU8; RING_LEN] {
        &RECEIVED.bytes
    }

    fn remaining(&mut self) -> usize {
        RECEIVED.remaining()
    }

    fn takes_bytes(&self) -> bool {
        !UART0.uartfr().read().txff()
    }

    /// Fills the FIFO.
    fn send(&mut self, bytes: &[u8]) -> usize {
        let taken = bytes.iter().take_while(|byte| {
            let takes = self.takes_bytes();
            if takes {
                UART0.uartdr().write(|w| w.set_data(**byte));
            }
            takes
        });
        taken.count()
    }

    fn has_sent_all(&self) -> bool {
        !UART0.uartfr().read().busy()
    }
}
