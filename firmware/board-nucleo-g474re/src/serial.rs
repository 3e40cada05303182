//! The serial port to the host, through the virtual port of the on-board ST-Link: USART2 at 2 Mbaud, by DMA in both
//! directions. So no interrupt competes with the tick, and no byte waits for software.
//!
//! | pin | function | |
//! |---|---|---|
//! | PA2 | USART2_TX | to the ST-Link |
//! | PA3 | USART2_RX | from the ST-Link |

use core::sync::atomic::{AtomicU8, Ordering};

use frixel_board::serial::{RING_LEN, SerialPort, Uart};
use stm32_metapac::bdma::vals::{Dir, Pl};
use stm32_metapac::{GPIOA, USART2};

use crate::clock::CORE_HZ;
use crate::{dma, pins};

const BAUD: u32 = 2_000_000;
const TX: u32 = 2;
const RX: u32 = 3;
const USART2_FUNCTION: u8 = 7;

/// Largest number of bytes that DMA sends at a time: 1.3 ms on the line.
const TRANSMIT_LEN: usize = 256;

/// Buffer in the memory for DMA (`memory.x`), read only where DMA has written.
#[unsafe(link_section = ".dma.RECEIVED")]
static RECEIVED: [AtomicU8; RING_LEN] = [const { AtomicU8::new(0) }; RING_LEN];
/// Buffer in the memory for DMA, written before DMA reads it.
#[unsafe(link_section = ".dma.TRANSMITTED")]
static TRANSMITTED: [AtomicU8; TRANSMIT_LEN] = [const { AtomicU8::new(0) }; TRANSMIT_LEN];

/// USART2.
pub struct Usart(());

/// The serial port.
pub type Serial = SerialPort<Usart>;

impl Usart {
    /// Starts reception: 8 data bits, no parity, 1 stop bit (RM0440, "USART").
    pub fn start() -> Serial {
        const { assert!(CORE_HZ.is_multiple_of(BAUD), "the rate is exact") };
        USART2.brr().write(|w| w.set_brr((CORE_HZ / BAUD) as u16));
        USART2.cr3().write(|w| {
            w.set_dmar(true);
            w.set_dmat(true);
            // OVRDIS would bypass the FIFO of 8 bytes (RM0440, "USART_CR3", not read): one byte, 5 us, of room for a
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
        SerialPort::new(Self(()))
    }
}

impl Uart for Usart {
    fn ring(&self) -> &'static [AtomicU8; RING_LEN] {
        &RECEIVED
    }

    fn remaining(&mut self) -> usize {
        // Nothing is received while the flag of an overrun is set (RM0440, "USART receiver": "Overrun error", not
        // read).
        if USART2.isr().read().ore() {
            USART2.icr().write(|w| w.set_ore(true));
        }
        dma::remaining(dma::RECEIVE)
    }

    fn takes_bytes(&self) -> bool {
        dma::remaining(dma::TRANSMIT) == 0
    }

    fn send(&mut self, bytes: &[u8]) -> usize {
        let len = bytes.len().min(TRANSMIT_LEN);
        for (to, from) in TRANSMITTED.iter().zip(bytes) {
            to.store(*from, Ordering::Relaxed);
        }
        dma::begin(dma::TRANSMIT, len as u16);
        len
    }

    fn has_sent_all(&self) -> bool {
        dma::remaining(dma::TRANSMIT) == 0
    }
}
