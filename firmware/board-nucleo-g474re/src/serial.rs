//! The serial port to the host, through the virtual port of the on-board ST-Link: USART2 at 2 Mbaud, by DMA in both
//! directions. So no interrupt competes with the tick, and no byte waits for software.
//!
//! | pin | function | |
//! |---|---|---|
//! | PA2 | USART2_TX | to the ST-Link |
//! | PA3 | USART2_RX | from the ST-Link |

use core::convert::Infallible;
use core::sync::atomic::{AtomicU8, Ordering};

use embedded_io::{ErrorType, Read, ReadReady, Write, WriteReady};
use frixel_drivers::ring::RingReader;
use stm32_metapac::bdma::vals::{Dir, Pl};
use stm32_metapac::{GPIOA, USART2};

use crate::board::RECEIVE_WINDOW;
use crate::clock::CORE_HZ;
use crate::{dma, pins};

const BAUD: u32 = 2_000_000;
const TX: u32 = 2;
const RX: u32 = 3;
const USART2_FUNCTION: u8 = 7;

/// Length of the ring: the host's credit, and room for a hello and some noise, which need no credit.
const RING_LEN: usize = RECEIVE_WINDOW + 512;
/// Largest number of bytes that DMA sends at a time: 1.3 ms on the line.
const TRANSMIT_LEN: usize = 256;

/// In the memory for DMA (`memory.x`). It is read only where DMA has written.
#[unsafe(link_section = ".dma.RECEIVED")]
static RECEIVED: [AtomicU8; RING_LEN] = [const { AtomicU8::new(0) }; RING_LEN];
/// In the memory for DMA. It is written before DMA reads it.
#[unsafe(link_section = ".dma.TRANSMITTED")]
static TRANSMITTED: [AtomicU8; TRANSMIT_LEN] = [const { AtomicU8::new(0) }; TRANSMIT_LEN];

/// The serial port.
pub struct Serial {
    reader: RingReader<RING_LEN>,
}

impl Serial {
    /// Starts reception: 8 data bits, no parity, 1 stop bit (RM0440, "USART").
    pub fn new() -> Self {
        const { assert!(CORE_HZ.is_multiple_of(BAUD), "the rate is exact") };
        USART2.brr().write(|w| w.set_brr((CORE_HZ / BAUD) as u16));
        USART2.cr3().write(|w| {
            w.set_dmar(true);
            w.set_dmat(true);
            // OVRDIS would bypass the FIFO of 8 bytes (RM0440, "USART_CR3", unread): one byte, 5 us, of room for a
            // DMA that waits for the bus, instead of 40 us.
        });
        let receive = dma::Transfer {
            request: dma::Request::Usart2Rx,
            direction: Dir::FROM_PERIPHERAL,
            priority: Pl::HIGH,
            circular: true,
            register: USART2.rdr().as_ptr().cast(),
        };
        let transmit = dma::Transfer {
            request: dma::Request::Usart2Tx,
            direction: Dir::FROM_MEMORY,
            priority: Pl::LOW,
            circular: false,
            register: USART2.tdr().as_ptr().cast(),
        };
        dma::set_up(dma::RECEIVE, &receive, &RECEIVED);
        dma::set_up(dma::TRANSMIT, &transmit, &TRANSMITTED);
        dma::begin(dma::RECEIVE, RING_LEN as u16);
        pins::alternate(GPIOA, TX, USART2_FUNCTION);
        pins::alternate(GPIOA, RX, USART2_FUNCTION);
        // The FIFO can only be enabled while the USART is disabled.
        USART2.cr1().write(|w| w.set_fifoen(true));
        USART2.cr1().modify(|w| w.set_ue(true));
        USART2.cr1().modify(|w| {
            w.set_te(true);
            w.set_re(true);
        });
        Self { reader: RingReader::new() }
    }
}

impl ErrorType for Serial {
    type Error = Infallible;
}

impl ReadReady for Serial {
    fn read_ready(&mut self) -> Result<bool, Infallible> {
        // Nothing is received while the flag of an overrun is set (RM0440, "USART receiver": "Overrun error", unread).
        // The bytes that are lost until then damage frames, which the host sends again.
        if USART2.isr().read().ore() {
            USART2.icr().write(|w| w.set_ore(true));
        }
        Ok(!self.reader.is_empty(dma::remaining(dma::RECEIVE)))
    }
}

impl Read for Serial {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Infallible> {
        if bytes.is_empty() {
            return Ok(0);
        }
        loop {
            let piece = self.reader.take(dma::remaining(dma::RECEIVE), bytes.len());
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
        Ok(dma::remaining(dma::TRANSMIT) == 0)
    }
}

impl Write for Serial {
    /// Starts to send, once the previous bytes have been sent.
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        if bytes.is_empty() {
            return Ok(0);
        }
        self.flush()?;
        let len = bytes.len().min(TRANSMIT_LEN);
        for (to, from) in TRANSMITTED.iter().zip(bytes) {
            to.store(*from, Ordering::Relaxed);
        }
        dma::begin(dma::TRANSMIT, len as u16);
        Ok(len)
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        while dma::remaining(dma::TRANSMIT) > 0 {}
        Ok(())
    }
}
