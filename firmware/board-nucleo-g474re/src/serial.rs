//! The host, through the virtual port of the on-board ST-Link: USART2 at 2 Mbaud, by DMA both ways, so that no interrupt
//! stands beside the tick and no byte waits for software.
//!
//! | pin | function | |
//! |---|---|---|
//! | PA2 | USART2_TX | to the ST-Link |
//! | PA3 | USART2_RX | from the ST-Link |

use core::sync::atomic::{AtomicU8, Ordering};

use frixel_parts::ring::RingReader;
use stm32_metapac::bdma::vals::{Dir, Pl};
use stm32_metapac::{GPIOA, USART2};

use crate::board::RECEIVE_WINDOW;
use crate::clock::CORE_HZ;
use crate::{dma, pins};

const BAUD: u32 = 2_000_000;
const TX: u32 = 2;
const RX: u32 = 3;
const USART2_FUNCTION: u8 = 7;

/// Bytes of the ring: those that the host may have under way, and those of a hello and some noise without credit.
const RING_LEN: usize = RECEIVE_WINDOW + 512;
/// Most bytes that are sent at a time: 2.6 ms of the line.
pub const TRANSMIT_LEN: usize = 512;

/// In the memory for DMA (`memory.x`); it is read where DMA has written.
#[unsafe(link_section = ".dma.RECEIVED")]
static RECEIVED: [AtomicU8; RING_LEN] = [const { AtomicU8::new(0) }; RING_LEN];
/// In the memory for DMA; it is written before DMA reads it.
#[unsafe(link_section = ".dma.TRANSMITTED")]
static TRANSMITTED: [AtomicU8; TRANSMIT_LEN] = [const { AtomicU8::new(0) }; TRANSMIT_LEN];

/// The serial port.
pub struct Serial {
    reader: RingReader<RING_LEN>,
}

impl Serial {
    /// Starts to receive: 8 data bits, no parity, 1 stop bit (RM0440, "USART").
    pub fn new() -> Self {
        const { assert!(CORE_HZ.is_multiple_of(BAUD), "the rate is exact") };
        USART2.brr().write(|w| w.set_brr((CORE_HZ / BAUD) as u16));
        USART2.cr3().write(|w| {
            w.set_dmar(true);
            w.set_dmat(true);
            // A byte too many is a bad frame and no more; reception goes on.
            w.set_ovrdis(true);
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
        // The FIFO can only be switched on before the rest is.
        USART2.cr1().write(|w| w.set_fifoen(true));
        USART2.cr1().modify(|w| w.set_ue(true));
        USART2.cr1().modify(|w| {
            w.set_te(true);
            w.set_re(true);
        });
        Self { reader: RingReader::new() }
    }

    /// Takes bytes that have come, and gives them piece by piece to `receive`.
    pub fn receive(&mut self, mut receive: impl FnMut(&[u8])) {
        loop {
            let piece = self.reader.take(dma::remaining(dma::RECEIVE));
            if piece.is_empty() {
                return;
            }
            let mut bytes = [0; 256];
            for places in RECEIVED.get(piece).unwrap_or_default().chunks(bytes.len()) {
                for (to, from) in bytes.iter_mut().zip(places) {
                    *to = from.load(Ordering::Relaxed);
                }
                receive(bytes.get(..places.len()).unwrap_or_default());
            }
        }
    }

    /// Sends the bytes that `transmit` writes, and returns how many there are, when those before have gone.
    pub fn transmit(&mut self, transmit: impl FnOnce(&mut [u8]) -> usize) {
        if dma::remaining(dma::TRANSMIT) > 0 {
            return;
        }
        let mut bytes = [0; TRANSMIT_LEN];
        let len = transmit(&mut bytes).min(TRANSMIT_LEN);
        if len == 0 {
            return;
        }
        for (to, from) in TRANSMITTED.iter().zip(bytes.get(..len).unwrap_or_default()) {
            to.store(*from, Ordering::Relaxed);
        }
        dma::begin(dma::TRANSMIT, len as u16);
    }
}
