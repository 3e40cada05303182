//! A WebSocket of the page, connected to a serial port: binary messages carry the port's bytes.
//!
//! The bridge sends nothing by itself. A page that is silent leaves the board alone with its host timeout.

use std::io::{self, Write};
use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use frixel_driver::{DEFAULT_BAUD, Link, LinkClosed, SerialLink};
use tungstenite::protocol::{CloseFrame, Role, frame::coding::CloseCode};
use tungstenite::{Error, Message, WebSocket, handshake::derive_accept_key};

use super::http::Answer;

/// Longest wait for bytes of the port before the WebSocket is read again.
const WAIT: Duration = Duration::from_millis(2);

/// Opens the port, answers the handshake with this key, and moves bytes until either end closes, or `is_over`.
pub(super) fn run(mut stream: TcpStream, key: &str, serial_port: &str, is_over: &AtomicBool) -> io::Result<()> {
    let mut port = match SerialLink::open(serial_port, DEFAULT_BAUD) {
        Ok(port) => port,
        Err(error) => return Answer::refusal(503, &error.to_string()).write(&mut stream),
    };
    let accept = derive_accept_key(key.as_bytes());
    write!(
        stream,
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: {accept}\r\n\r\n"
    )?;
    stream.set_nodelay(true)?;
    stream.set_nonblocking(true)?;
    let mut socket = WebSocket::from_raw_socket(stream, Role::Server, None);
    let mut bytes = Vec::new();
    while !is_over.load(Ordering::Relaxed) {
        if let Err(error) = exchange(&mut socket, &mut port, &mut bytes) {
            let reason = match error {
                End::Port(closed) => closed.to_string(),
                End::Socket => return Ok(()),
            };
            // The page is told why; if it has gone, nobody has to be.
            let _ = socket.close(Some(CloseFrame { code: CloseCode::Error, reason: reason.into() }));
            break;
        }
    }
    let _ = socket.flush();
    Ok(())
}

/// Why a bridge ends.
enum End {
    Port(LinkClosed),
    Socket,
}

/// Moves what has arrived at either end.
fn exchange(socket: &mut WebSocket<TcpStream>, port: &mut SerialLink, bytes: &mut Vec<u8>) -> Result<(), End> {
    loop {
        match socket.read() {
            Ok(Message::Binary(message)) => {
                port.write(&message).map_err(End::Port)?;
            }
            Ok(Message::Close(_)) => return Err(End::Socket),
            Ok(_) => {}
            Err(error) if is_pending(&error) => break,
            Err(_) => return Err(End::Socket),
        }
    }
    // Nothing more is taken from the port while the page has not read what was sent: the port then drops what it has no
    // room for, as it does for every program that does not read it.
    if !flushed(socket.flush())? {
        thread::sleep(WAIT);
        return Ok(());
    }
    bytes.clear();
    port.read(bytes, WAIT).map_err(End::Port)?;
    if !bytes.is_empty() {
        flushed(socket.send(Message::binary(bytes.clone())))?;
    }
    Ok(())
}

/// Whether all is sent. What the socket does not take now stays in its buffer.
fn flushed(sent: Result<(), Error>) -> Result<bool, End> {
    match sent {
        Ok(()) => Ok(true),
        Err(error) if is_pending(&error) => Ok(false),
        Err(_) => Err(End::Socket),
    }
}

fn is_pending(error: &Error) -> bool {
    matches!(error, Error::Io(error) if error.kind() == io::ErrorKind::WouldBlock)
}
