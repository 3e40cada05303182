//! Serial port: UART0 of the CMSDK (Arm DDI0479, section 4.3), one byte deep, interrupt-driven in both directions.

use core::convert::Infallible;

use cortex_m::interrupt::InterruptNumber;
use cortex_m::peripheral::NVIC;
use embedded_io::{ErrorType, Read, ReadReady, Write, WriteReady};
use frixel_cortex_m::Owned;
use frixel_exchange::{BOARD, layout};
use heapless::spsc::{Consumer, Producer, Queue};

use crate::shared;

/// Room for the host's credit, and for hello requests and noise, which need no credit.
const RECEIVE_LEN: usize = BOARD.limits.receive_window_bytes as usize + 512;
const TRANSMIT_LEN: usize = 256;

const BASE: usize = 0x4000_4000;
const DATA: usize = BASE;
const STATE: usize = BASE + 0x4;
const CTRL: usize = BASE + 0x8;
const INTCLEAR: usize = BASE + 0xc;
const BAUDDIV: usize = BASE + 0x10;

const STATE_TX_FULL: u32 = 1;
const STATE_RX_FULL: u32 = 1 << 1;
const CTRL_TX_ENABLE: u32 = 1;
const CTRL_RX_ENABLE: u32 = 1 << 1;
const CTRL_TX_INTERRUPT: u32 = 1 << 2;
const CTRL_RX_INTERRUPT: u32 = 1 << 3;
const INT_TX: u32 = 1;
const INT_RX: u32 = 1 << 1;

/// Divider of the 25 MHz clock for about 2 Mbaud: the smallest divider that the UART accepts.
const DIVIDER: u32 = 16;

/// Priority below the tick.
const PRIORITY: u8 = 0xc0;

static RECEIVER: Owned<Producer<'static, u8>> = Owned::new();
static TRANSMITTER: Owned<Consumer<'static, u8>> = Owned::new();

/// Interrupts of UART0, by number.
#[derive(Clone, Copy)]
#[repr(u16)]
enum Interrupt {
    Receive = 0,
    Transmit = 1,
}

// SAFETY: these are the numbers of two interrupts, and they never change.
unsafe impl InterruptNumber for Interrupt {
    fn number(self) -> u16 {
        self as u16
    }
}

/// Interrupt vectors after those of the processor itself.
#[unsafe(link_section = ".vector_table.interrupts")]
#[unsafe(no_mangle)]
static __INTERRUPTS: [extern "C" fn(); 2] = [receive, transmit];

/// The main program's ends of both directions.
pub struct Uart {
    received: Consumer<'static, u8>,
    to_transmit: Producer<'static, u8>,
}

/// Queues between the main program and the interrupts.
pub struct Queues {
    receive: Queue<u8, RECEIVE_LEN>,
    transmit: Queue<u8, TRANSMIT_LEN>,
}

impl Queues {
    /// Empty queues.
    pub const fn new() -> Self {
        Self { receive: Queue::new(), transmit: Queue::new() }
    }
}

impl Uart {
    /// Enables the port; `None` if it is already enabled.
    ///
    /// Start `SysTick` first: on an idle emulator without a timer, the first byte takes a second.
    pub fn start(queues: &'static mut Queues, nvic: &mut NVIC) -> Option<Self> {
        let (receiver, received) = queues.receive.split();
        let (to_transmit, transmitter) = queues.transmit.split();
        RECEIVER.give(receiver)?;
        TRANSMITTER.give(transmitter)?;
        write(BAUDDIV, DIVIDER);
        write(CTRL, CTRL_TX_ENABLE | CTRL_RX_ENABLE | CTRL_TX_INTERRUPT | CTRL_RX_INTERRUPT);
        for interrupt in [Interrupt::Receive, Interrupt::Transmit] {
            // SAFETY: no critical section relies on these priorities or on these interrupts being disabled.
            unsafe {
                nvic.set_priority(interrupt, PRIORITY);
                NVIC::unmask(interrupt);
            }
        }
        Some(Self { received, to_transmit })
    }
}

impl ErrorType for Uart {
    type Error = Infallible;
}

impl ReadReady for Uart {
    fn read_ready(&mut self) -> Result<bool, Infallible> {
        Ok(self.received.ready())
    }
}

impl Read for Uart {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Infallible> {
        let mut count = 0;
        while count == 0 && !bytes.is_empty() {
            for (place, byte) in bytes.iter_mut().zip(core::iter::from_fn(|| self.received.dequeue())) {
                *place = byte;
                count += 1;
            }
        }
        Ok(count)
    }
}

impl WriteReady for Uart {
    fn write_ready(&mut self) -> Result<bool, Infallible> {
        Ok(self.to_transmit.ready())
    }
}

impl Write for Uart {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        let mut count = 0;
        while count == 0 && !bytes.is_empty() {
            count = bytes.iter().take_while(|byte| self.to_transmit.enqueue(**byte).is_ok()).count();
        }
        // The interrupt occurs by itself only after a byte was sent; this sends the first one.
        NVIC::pend(Interrupt::Transmit);
        Ok(count)
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        while !self.to_transmit.is_empty() {}
        Ok(())
    }
}

/// Handles a received byte.
#[unsafe(export_name = "UART0_RX")]
extern "C" fn receive() {
    write(INTCLEAR, INT_RX);
    // SAFETY: this is the handler that owns the value.
    let Some(receiver) = (unsafe { RECEIVER.get() }) else { return };
    while read(STATE) & STATE_RX_FULL != 0 {
        // A host that respects its credit never fills the queue. Bytes beyond it are lost, and the frame's CRC fails.
        let _ = receiver.enqueue(read(DATA) as u8);
        shared::set(layout::RECEIVED_BYTES, shared::get(layout::RECEIVED_BYTES).wrapping_add(1));
    }
}

/// Sends bytes from the queue while the UART has room. Runs after each sent byte, and when software pends it.
#[unsafe(export_name = "UART0_TX")]
extern "C" fn transmit() {
    write(INTCLEAR, INT_TX);
    // SAFETY: this is the handler that owns the value.
    let Some(transmitter) = (unsafe { TRANSMITTER.get() }) else { return };
    while read(STATE) & STATE_TX_FULL == 0 {
        let Some(byte) = transmitter.dequeue() else { break };
        write(DATA, u32::from(byte));
    }
}

fn read(register: usize) -> u32 {
    // SAFETY: a register of UART0, which only this module accesses.
    unsafe { (register as *const u32).read_volatile() }
}

fn write(register: usize, value: u32) {
    // SAFETY: a register of UART0, which only this module accesses.
    unsafe { (register as *mut u32).write_volatile(value) }
}
