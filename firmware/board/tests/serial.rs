//! The serial port over a UART with a ring, and the terminal of a person on it.

use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::atomic::AtomicU8;

use embedded_io::{ErrorKind, Write, WriteReady};
use frixel_board::serial::{RING_LEN, SerialPort, Uart};
use frixel_board::terminal::Terminal;
use frixel_drivers::ring::InterruptRing;

use crate::support::hardware::{Part, wires};

/// A UART that accepts four bytes at a time, and once reports that it accepts none.
#[derive(Clone)]
struct Wire {
    received: &'static InterruptRing<RING_LEN>,
    sent: Rc<RefCell<Vec<u8>>>,
    is_busy: Rc<Cell<bool>>,
}

impl Wire {
    fn new() -> Self {
        let received = Box::leak(Box::new(InterruptRing::new()));
        Self { received, sent: Rc::default(), is_busy: Rc::default() }
    }

    fn receive(&self, bytes: &[u8]) {
        for byte in bytes {
            self.received.push(*byte);
        }
    }
}

impl Uart for Wire {
    fn ring(&self) -> &'static [AtomicU8; RING_LEN] {
        &self.received.bytes
    }

    fn remaining(&mut self) -> usize {
        self.received.remaining()
    }

    fn takes_bytes(&self) -> bool {
        !self.is_busy.replace(false)
    }

    fn send(&mut self, bytes: &[u8]) -> usize {
        let len = bytes.len().min(4);
        self.sent.borrow_mut().extend(&bytes[..len]);
        self.is_busy.set(true);
        len
    }

    fn has_sent_all(&self) -> bool {
        self.takes_bytes()
    }
}

#[test]
fn a_write_waits_for_the_uart_and_sends_what_it_accepts() {
    let wire = Wire::new();
    let mut port = SerialPort::new(wire.clone());
    assert_eq!((port.write(b""), port.write(b"longer"), port.write(b"er")), (Ok(0), Ok(4), Ok(2)));
    assert!(!port.write_ready().unwrap() && port.write_ready().unwrap());
    assert_eq!((port.flush(), wire.sent.take()), (Ok(()), b"longer".to_vec()));
}

#[test]
fn a_terminal_echoes_a_line_and_discards_earlier_input() {
    let wire = Wire::new();
    let mut terminal = Terminal::new(SerialPort::new(wire.clone()));
    wire.receive(b"too early");
    terminal.forget();
    terminal.say(format_args!("Volts {}?", 3));
    wire.receive(b"10x\x08");
    assert_eq!(terminal.line(), None);
    wire.receive(b"\r");
    assert_eq!(terminal.line().unwrap(), "10");
    assert_eq!(wire.sent.take(), b"Volts 3?\r\n10x\x08 \x08\r\n");
}

#[test]
fn a_terminal_on_a_failing_port_continues() {
    let wires = wires();
    wires.port.set(Err(ErrorKind::Other));
    let mut terminal = Terminal::new(Part(wires));
    terminal.say(format_args!("Volts?"));
    terminal.forget();
    assert_eq!(terminal.line(), None);
}
