//! The serial port to the host: UART 0 at 2 Mbaud, through the UART of a Raspberry Pi Debug Probe, or another one.
//!
//! An interrupt below the tick stores the bytes that come: the receive FIFO holds 32 of them, 0.16 ms, and the main
//! loop may take longer for a turn. The main loop fills the transmit FIFO itself.
//!
//! | pin | function | |
//! |---|---|---|
//! | GP0 | UART0 TX | to the host |
//! | GP1 | UART0 RX | from the host |

use core::convert::Infallible;
use core::sync::atomic::{AtomicU8, AtomicUsize, Ordering};

use cortex_m::peripheral::NVIC;
use embedded_io::{ErrorType, Read, ReadReady, Write, WriteReady};
use frixel_drivers::ring::RingReader;
use rp_pac::{Interrupt, UART0, interrupt};

use crate::board::RECEIVE_WINDOW;
use crate::clock::CORE_HZ;
use crate::pins::{self, Function};

const BAUD: u32 = 2_000_000;
const TX: usize = 0;
const RX: usize = 1;

/// 64 divisions of the clock for 16 samples of a bit (RP2040, 4.2.7.1, "Baud Rate Calculation").
const DIVIDER: u32 = CORE_HZ * 4 / BAUD;
const _: () = assert!((CORE_HZ * 4).is_multiple_of(BAUD), "the rate is exact");

/// Length of the ring: the host's credit, and room for a hello and some noise, which need no credit.
const RING_LEN: usize = RECEIVE_WINDOW + 512;

static RECEIVED: [AtomicU8; RING_LEN] = [const { AtomicU8::new(0) }; RING_LEN];
/// Bytes until the interrupt begins the ring anew, as DMA would count them. Only the interrupt writes it.
static REMAINING: AtomicUsize = AtomicUsize::new(RING_LEN);

/// The serial port.
pub struct Serial {
    reader: RingReader<RING_LEN>,
}

impl Serial {
    /// Starts reception: 8 data bits, no parity, 1 stop bit (RP2040, 4.2, "UART").
    pub fn new() -> Self {
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
        // SAFETY: what the handler shares are atomics. The priority is below the tick's, 0.
        unsafe { NVIC::unmask(Interrupt::UART0_IRQ) };
        Self { reader: RingReader::new() }
    }
}

/// Stores what was received. The FIFO's flags of damaged bytes are ignored: they damage frames, which are sent again.
#[interrupt]
fn UART0_IRQ() {
    while !UART0.uartfr().read().rxfe() {
        let byte = UART0.uartdr().read().data();
        let remaining = REMAINING.load(Ordering::Relaxed);
        if let Some(place) = RECEIVED.get(RING_LEN - remaining) {
            place.store(byte, Ordering::Relaxed);
        }
        REMAINING.store(if remaining > 1 { remaining - 1 } else { RING_LEN }, Ordering::Release);
    }
}

impl ErrorType for Serial {
    type Error = Infallible;
}

impl ReadReady for Serial {
    fn read_ready(&mut self) -> Result<bool, Infallible> {
        Ok(!self.reader.is_empty(REMAINING.load(Ordering::Acquire)))
    }
}

impl Read for Serial {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Infallible> {
        if bytes.is_empty() {
            return Ok(0);
        }
        loop {
            let piece = self.reader.take(REMAINING.load(Ordering::Acquire), bytes.len());
            let places = RECEIVED.get(piece).unwrap_or_default();
            if places.is_empty() {
                continue;
            }
            for (to, from) in bytes.iter_mut().zip(places) {
                *to = from.load(Ordering::Relaxed);
            }
            return Ok(places.len());
        }
    }
}

impl WriteReady for Serial {
    fn write_ready(&mut self) -> Result<bool, Infallible> {
        Ok(!UART0.uartfr().read().txff())
    }
}

impl Write for Serial {
    /// Fills the FIFO, once it has room.
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        let mut written = 0;
        for byte in bytes {
            while UART0.uartfr().read().txff() {
                if written > 0 {
                    return Ok(written);
                }
            }
            UART0.uartdr().write(|w| w.set_data(*byte));
            written += 1;
        }
        Ok(written)
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        while UART0.uartfr().read().busy() {}
        Ok(())
    }
}
