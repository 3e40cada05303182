//! The studio on loopback: serves its page, and bridges a WebSocket of the page to a serial port.
//!
//! Only this machine can connect. Every request has to name this server as its host, so that a foreign name that
//! resolves to this machine gets nothing; the bridge also demands the page's origin, and the token that only the page's
//! address has.

mod bridge;
mod http;
mod page;

use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use thiserror::Error;

use http::{Answer, Head};
pub(crate) use page::page;

/// Time between two looks for a connection, or for the end.
const LOOK_PERIOD: Duration = Duration::from_millis(20);
/// Longest time that a client may take to send its request.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(5);
/// Most connections at a time, each of which has a thread. A browser opens six.
const CONNECTIONS_MAX: usize = 64;
/// The port of an address that states none.
const HTTP_PORT: u16 = 80;
/// Path of the bridge.
const BRIDGE_PATH: &str = "/serial";

/// Why the studio cannot be served.
#[derive(Debug, Error)]
pub enum StudioError {
    /// No port of this machine can be listened on.
    #[error("the studio cannot listen on 127.0.0.1: {0}; give another --listen")]
    Listen(#[from] io::Error),
    /// The operating system gives no random numbers.
    #[error("the operating system gives no random numbers for the bridge's token: {0}")]
    Random(getrandom::Error),
    /// There is no page, and no checkout to build it in.
    #[error("no page is given, and this folder is in no checkout of frixel that could build it: give --page FILE.html")]
    NoPage,
    /// The page cannot be read.
    #[error("{path} cannot be read ({source}): give --page the file that `cargo xtask studio` prints")]
    Page {
        /// Path of the page.
        path: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// `cargo xtask studio` failed.
    #[error("the page could not be built: `cargo xtask studio` {reason}")]
    Build {
        /// How it ended.
        reason: String,
    },
}

/// The server of the studio.
pub struct Studio {
    listener: TcpListener,
    site: Arc<Site>,
}

/// What every connection needs.
struct Site {
    page: Vec<u8>,
    /// Address and port, as a browser names them.
    host: String,
    /// Path of the serial port behind the bridge.
    serial_port: Option<String>,
    token: String,
    is_bridge_in_use: AtomicBool,
    is_over: AtomicBool,
}

impl Studio {
    /// Listens on a port of 127.0.0.1, any if it is 0. The page is served at the root; the bridge leads to
    /// `serial_port`, if there is one.
    pub fn open(listen_port: u16, page: Vec<u8>, serial_port: Option<String>) -> Result<Self, StudioError> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, listen_port))?;
        listener.set_nonblocking(true)?;
        let host = host_of(listener.local_addr()?);
        let (is_bridge_in_use, is_over) = Default::default();
        let site = Site { page, host, serial_port, token: token()?, is_bridge_in_use, is_over };
        Ok(Self { listener, site: Arc::new(site) })
    }

    /// The address for a browser. With a serial port, its fragment has the bridge's token; a browser sends no fragment.
    pub fn url(&self) -> String {
        let Site { host, serial_port, token, .. } = &*self.site;
        let fragment = if serial_port.is_some() { format!("#bridge={token}") } else { String::new() };
        format!("http://{host}/{fragment}")
    }

    /// Serves until `interrupted` returns true. A bridge under way ends then, too.
    pub fn run(self, interrupted: &dyn Fn() -> bool) -> Result<(), StudioError> {
        while !interrupted() {
            match self.listener.accept() {
                // Every connection holds the site; one beyond the limit is closed without an answer.
                Ok(_) if Arc::strong_count(&self.site) > CONNECTIONS_MAX => {}
                Ok((stream, _)) => {
                    let site = Arc::clone(&self.site);
                    // A client that misbehaves only ends its own connection.
                    thread::spawn(move || drop(site.serve(stream)));
                }
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => thread::sleep(LOOK_PERIOD),
                Err(error) => return Err(error.into()),
            }
        }
        self.site.is_over.store(true, Ordering::Relaxed);
        Ok(())
    }
}

impl Site {
    fn serve(&self, mut stream: TcpStream) -> io::Result<()> {
        stream.set_nonblocking(false)?;
        stream.set_read_timeout(Some(REQUEST_TIMEOUT))?;
        stream.set_write_timeout(Some(REQUEST_TIMEOUT))?;
        let Some(head) = Head::read(&mut stream)? else {
            return Answer::refusal(400, "this is no request that the studio knows").write(&mut stream);
        };
        match self.checked(&head) {
            Err(refusal) => refusal.write(&mut stream),
            Ok(None) => Answer::page(&self.page).write(&mut stream),
            Ok(Some((key, serial_port))) => self.bridge(stream, &key, serial_port),
        }
    }

    /// `None` for the page; for the bridge, the WebSocket's key and the serial port.
    fn checked(&self, head: &Head) -> Result<Option<(String, &str)>, Answer<'_>> {
        if head.header("host") != Some(self.host.as_str()) {
            return Err(Answer::refusal(403, "this server answers only to its own address"));
        }
        if head.method != "GET" {
            return Err(Answer::refusal(405, "the studio can only be read"));
        }
        let (path, query) = head.target.split_once('?').unwrap_or((&head.target, ""));
        match path {
            "/" => return Ok(None),
            BRIDGE_PATH => {}
            _ => return Err(Answer::refusal(404, "there is nothing but the page at /")),
        }
        let Some(serial_port) = &self.serial_port else {
            return Err(Answer::refusal(404, "no serial port: start `frixel studio --port PATH`"));
        };
        if head.header("origin") != Some(&format!("http://{}", self.host)) {
            return Err(Answer::refusal(403, "only the studio's own page may use the bridge"));
        }
        if !is_equal(query.as_bytes(), format!("token={}", self.token).as_bytes()) {
            return Err(Answer::refusal(403, "the token is wrong: open the address that `frixel studio` prints"));
        }
        let key = head.header("sec-websocket-key").filter(|_| head.header_has("upgrade", "websocket"));
        let key = key.ok_or_else(|| Answer::refusal(400, "the bridge is a WebSocket"))?;
        Ok(Some((key.to_owned(), serial_port)))
    }

    /// Connects the WebSocket to the serial port. One page at a time.
    fn bridge(&self, mut stream: TcpStream, key: &str, serial_port: &str) -> io::Result<()> {
        if self.is_bridge_in_use.swap(true, Ordering::AcqRel) {
            return Answer::refusal(409, "another page uses the board: close it").write(&mut stream);
        }
        // The page learns that the bridge has ended when this is dropped, and may ask for another one at once.
        let connection = stream.try_clone();
        let bridged = bridge::run(stream, key, serial_port, &self.is_over);
        self.is_bridge_in_use.store(false, Ordering::Release);
        connection.and(bridged)
    }
}

/// An address as a browser names it: without the port that HTTP has anyway.
fn host_of(address: SocketAddr) -> String {
    if address.port() == HTTP_PORT { address.ip().to_string() } else { address.to_string() }
}

/// 128 random bits in hexadecimal digits.
fn token() -> Result<String, StudioError> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(StudioError::Random)?;
    Ok(format!("{:032x}", u128::from_be_bytes(bytes)))
}

/// Compares in a time that does not depend on the contents.
fn is_equal(one: &[u8], other: &[u8]) -> bool {
    one.len() == other.len() && one.iter().zip(other).fold(0, |differing, (a, b)| differing | (a ^ b)) == 0
}
