//! The serial link over a pseudo-terminal, in real time. Nothing here is measured by the clock.

use std::io::{Read, Write};
use std::time::Duration;

use frixel_driver::{DEFAULT_BAUD, KeepAlive, Link, PortError, SerialLink};
use serialport::{SerialPort, TTYPort};

const LONG: Duration = Duration::from_mins(2);

/// The far end of a line, the near one, held open so that hosts may come and go, and the path of the near one.
fn line() -> (TTYPort, TTYPort, String) {
    let (mut far, near) = TTYPort::pair().unwrap();
    far.set_timeout(LONG).unwrap();
    let path = near.name().unwrap();
    (far, near, path)
}

fn open(path: &str) -> Result<SerialLink, PortError> {
    SerialLink::open(path, DEFAULT_BAUD)
}

/// The next bytes at an end of a line.
fn heard(end: &mut TTYPort, len: usize) -> Vec<u8> {
    let mut bytes = vec![0; len];
    end.read_exact(&mut bytes).unwrap();
    bytes
}

#[test]
fn bytes_go_both_ways_and_the_last_ones_are_those_of_the_shutdown() {
    let (mut far, _near, path) = line();
    for _ in 0..3 {
        let mut link = open(&path).unwrap();
        link.set_shutdown_frames(vec![5, 0]);
        link.write(&[1, 0]).unwrap();
        assert_eq!(heard(&mut far, 2), [1, 0]);
        far.write_all(&[7]).unwrap();
        let mut received = Vec::new();
        link.read(&mut received, LONG).unwrap();
        assert_eq!(received, [7]);
        drop(link);
        assert_eq!(heard(&mut far, 2), [5, 0]);
    }
}

/// `host/python/tests` checks that they end when the application hangs.
#[test]
fn pings_go_out_while_nobody_calls() {
    let (mut far, _near, path) = line();
    let mut link = open(&path).unwrap();
    link.keep_alive(Duration::from_millis(5));
    let mut pings = KeepAlive::default();
    let both = [pings.next_ping(Duration::ZERO), pings.next_ping(Duration::ZERO)].concat();
    assert_eq!(heard(&mut far, both.len()), both);
}

#[test]
fn an_answer_that_an_earlier_host_did_not_read_is_thrown_away() {
    let (mut far, _near, path) = line();
    let mut earlier = TTYPort::open(&serialport::new(&path, DEFAULT_BAUD).timeout(LONG)).unwrap();
    far.write_all(&[1; 5]).unwrap();
    heard(&mut earlier, 1);
    drop(earlier);
    let mut link = open(&path).unwrap();
    far.write_all(&[42]).unwrap();
    let mut received = Vec::new();
    link.read(&mut received, LONG).unwrap();
    assert_eq!(received, [42]);
}

#[test]
fn a_pulled_cable_ends_a_long_wait_and_every_later_call() {
    let (far, near, path) = line();
    let mut link = open(&path).unwrap();
    let waiting = std::thread::spawn(move || (link.read(&mut Vec::new(), LONG), link));
    drop((far, near));
    let (outcome, mut link) = waiting.join().unwrap();
    assert!(outcome.is_err() && link.write(&[1]).is_err());
}

#[test]
fn a_port_in_use_is_refused() {
    let (_far, _near, path) = line();
    let _first = open(&path).unwrap();
    assert_eq!(open(&path).err(), Some(PortError::Busy { port: path }));
}

/// A client that opens the port while the previous one is still closing it waits for that.
#[test]
fn a_port_that_is_let_go_soon_opens() {
    let (_far, _near, path) = line();
    let first = open(&path).unwrap();
    std::thread::spawn(move || drop(first));
    open(&path).unwrap();
}

/// The operating system stops accepting bytes long before this point. Neither a write nor a drop may wait for it.
#[test]
fn an_end_that_does_not_read_blocks_nobody() {
    let (_far, _near, path) = line();
    let mut link = open(&path).unwrap();
    for count in 1..=2000 {
        assert_eq!(link.write(&[1; 192]).unwrap(), 192 * count);
    }
}
