//! The serial port over a UART with a ring, and the terminal of a person on it.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::atomic::AtomicU8;

use embedded_io::{ErrorKind, ErrorType, Read, ReadReady, Write, WriteReady};
use frixel_board::serial::{RING_LEN, SerialPort, Uart};
use frixel_board::terminal::Terminal;
use frixel_drivers::ring::InterruptRing;

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
fn bytes_are_read_over_the_end_of_the_ring() {
    let wire = Wire::new();
    let mut port = SerialPort::new(wire.clone());
    let (mut sent, mut found) = (Vec::<u8>::new(), Vec::<u8>::new());
    while sent.len() < 3 * RING_LEN {
        let piece: Vec<u8> = (0..777_u32).map(|at| (sent.len() as u32 + at) as u8).collect();
        wire.receive(&piece);
        sent.extend(piece);
        while port.read_ready().unwrap() {
            let mut bytes = [0; 256];
            let len = port.read(&mut bytes).unwrap();
            found.extend(&bytes[..len]);
        }
    }
    assert_eq!(found, sent);
}

#[test]
fn a_write_waits_until_the_uart_takes_a_byte_and_begins_with_what_it_takes() {
    let wire = Wire::new();
    let mut port = SerialPort::new(wire.clone());
    assert_eq!((port.write(b""), port.write(b"longer"), port.write(b"er")), (Ok(0), Ok(4), Ok(2)));
    assert!(!port.write_ready().unwrap() && port.write_ready().unwrap());
    assert_eq!((port.flush(), wire.sent.take()), (Ok(()), b"longer".to_vec()));
}

#[test]
fn a_terminal_echoes_a_line_and_forgets_what_came_before_it_was_asked() {
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

/// A port that fails.
struct Broken;

impl ErrorType for Broken {
    type Error = ErrorKind;
}

impl ReadReady for Broken {
    fn read_ready(&mut self) -> Result<bool, ErrorKind> {
        Err(ErrorKind::Other)
    }
}

impl Read for Broken {
    fn read(&mut self, _: &mut [u8]) -> Result<usize, ErrorKind> {
        Err(ErrorKind::Other)
    }
}

impl WriteReady for Broken {
    fn write_ready(&mut self) -> Result<bool, ErrorKind> {
        Err(ErrorKind::Other)
    }
}

impl Write for Broken {
    fn write(&mut self, _: &[u8]) -> Result<usize, ErrorKind> {
        Err(ErrorKind::Other)
    }

    fn flush(&mut self) -> Result<(), ErrorKind> {
        Err(ErrorKind::Other)
    }
}

#[test]
fn a_terminal_on_a_port_that_fails_goes_on() {
    let mut terminal = Terminal::new(Broken);
    terminal.say(format_args!("Volts?"));
    terminal.forget();
    assert_eq!(terminal.line(), None);
}
