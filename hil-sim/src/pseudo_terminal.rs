//! A serial port for clients in other processes: a pseudo-terminal with a simulated board at its other end.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Write};
use std::os::unix::fs::OpenOptionsExt;

use rustix::fs::OFlags;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, QueueSelector, tcflush, tcgetattr, tcsetattr};

use self::presence::Presence;

/// A pseudo-terminal. No method blocks, so a client that does not read cannot stop the board.
#[derive(Debug)]
pub struct PseudoTerminal {
    board_end: File,
    /// Held open, so that clients may connect and disconnect.
    client_end: File,
    path: String,
    presence: Presence,
    /// Whether bytes have arrived since the last call of [`Self::client_has_gone`].
    heard: bool,
}

impl PseudoTerminal {
    /// Makes a pseudo-terminal in raw mode: bytes pass unchanged.
    pub fn open() -> io::Result<Self> {
        let board_end = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY)?;
        grantpt(&board_end)?;
        unlockpt(&board_end)?;
        let flags = rustix::fs::fcntl_getfl(&board_end)?;
        rustix::fs::fcntl_setfl(&board_end, flags | OFlags::NONBLOCK)?;
        let path = ptsname(&board_end, Vec::new())?.to_string_lossy().into_owned();
        let client_end =
            OpenOptions::new().read(true).write(true).custom_flags(OFlags::NOCTTY.bits() as i32).open(&path)?;
        let mut settings = tcgetattr(&client_end)?;
        settings.make_raw();
        tcsetattr(&client_end, OptionalActions::Now, &settings)?;
        let presence = Presence::watch(&path)?;
        Ok(Self { board_end: File::from(board_end), client_end, path, presence, heard: false })
    }

    /// The path that a client opens.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Reads bytes that a client has written, and returns their number; 0 when there are none.
    pub fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let count = now((&self.board_end).read(bytes))?;
        self.heard |= count > 0;
        Ok(count)
    }

    /// Writes as many bytes as the terminal has room for, and returns their number; 0 when it is full.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if bytes.is_empty() { Ok(0) } else { now((&self.board_end).write(bytes)) }
    }

    /// Returns `true` once after the last client has closed the terminal. Its unread bytes are dropped, and the next
    /// client may open the terminal. Bytes written by the client can still be read, since they include the commands
    /// that end its session.
    pub fn client_has_gone(&mut self) -> io::Result<bool> {
        if !self.presence.has_ended(std::mem::take(&mut self.heard))? {
            return Ok(false);
        }
        tcflush(&self.client_end, QueueSelector::IFlush)?;
        // A killed client leaves the terminal in exclusive mode, which lasts as long as any process has it open.
        rustix::termios::ioctl_tiocnxcl(&self.client_end)?;
        Ok(true)
    }
}

/// Converts the result of a non-blocking call: an operation that would block has transferred zero bytes.
fn now(done: io::Result<usize>) -> io::Result<usize> {
    match done {
        Err(error) if error.kind() == io::ErrorKind::WouldBlock => Ok(0),
        done => done,
    }
}

/// Linux reports when the terminal is opened and closed.
#[cfg(target_os = "linux")]
mod presence {
    use std::io;
    use std::mem::MaybeUninit;
    use std::os::fd::OwnedFd;

    use rustix::fs::inotify::{self, CreateFlags, ReadFlags, WatchFlags};
    use rustix::io::Errno;

    /// Tracks whether a client has the terminal open.
    #[derive(Debug)]
    pub(super) struct Presence {
        events: OwnedFd,
        clients: u32,
    }

    impl Presence {
        pub(super) fn watch(path: &str) -> io::Result<Self> {
            let events = inotify::init(CreateFlags::NONBLOCK | CreateFlags::CLOEXEC)?;
            inotify::add_watch(&events, path, WatchFlags::OPEN | WatchFlags::CLOSE)?;
            Ok(Self { events, clients: 0 })
        }

        /// Returns whether the last client has closed the terminal since the previous call.
        pub(super) fn has_ended(&mut self, _heard: bool) -> io::Result<bool> {
            let clients_before = self.clients;
            let mut opened = false;
            let mut buffer = [MaybeUninit::uninit(); 1024];
            let mut reader = inotify::Reader::new(&self.events, &mut buffer);
            loop {
                match reader.next() {
                    Ok(event) if event.events().contains(ReadFlags::OPEN) => {
                        self.clients += 1;
                        opened = true;
                    }
                    Ok(_) => self.clients = self.clients.saturating_sub(1),
                    Err(Errno::WOULDBLOCK) => break,
                    Err(error) => return Err(error.into()),
                }
            }
            Ok(self.clients == 0 && (clients_before > 0 || opened))
        }
    }
}

/// Other systems do not report when a client closes the terminal, so a silent client counts as gone.
#[cfg(not(target_os = "linux"))]
mod presence {
    use std::io;
    use std::time::{Duration, Instant};

    /// Silence after which a client counts as gone. Clients send several pings in this time.
    const CLIENT_GONE_AFTER: Duration = Duration::from_millis(500);

    /// Tracks when bytes from a client last arrived.
    #[derive(Debug)]
    pub(super) struct Presence {
        heard_at: Instant,
    }

    impl Presence {
        pub(super) fn watch(_: &str) -> io::Result<Self> {
            Ok(Self { heard_at: Instant::now() })
        }

        pub(super) fn has_ended(&mut self, heard: bool) -> io::Result<bool> {
            let has_ended = !heard && self.heard_at.elapsed() > CLIENT_GONE_AFTER;
            if heard || has_ended {
                self.heard_at = Instant::now();
            }
            Ok(has_ended)
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::{Read, Write};
    use std::os::unix::fs::OpenOptionsExt;

    use super::*;

    fn client(terminal: &PseudoTerminal) -> File {
        let flags = (OFlags::NOCTTY | OFlags::NONBLOCK).bits() as i32;
        OpenOptions::new().read(true).write(true).custom_flags(flags).open(terminal.path()).unwrap()
    }

    fn fill(mut write: impl FnMut(&[u8]) -> usize) -> usize {
        let mut len = 0;
        loop {
            let count = write(&[0x55; 1000]);
            if count == 0 {
                return len;
            }
            len += count;
        }
    }

    /// A write that waits for its reader would block here for ever.
    #[test]
    fn a_client_that_does_not_read_does_not_stop_the_board() {
        let mut terminal = PseudoTerminal::open().unwrap();
        let mut client = client(&terminal);
        let written = fill(|bytes| terminal.write(bytes).unwrap());
        let mut bytes = vec![0; written + 1];
        let read = client.read(&mut bytes).unwrap();
        assert!(read > 0 && bytes[..read].iter().all(|byte| *byte == 0x55), "what was written is there");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn bytes_for_a_closed_client_are_dropped() {
        let mut terminal = PseudoTerminal::open().unwrap();
        assert!(!terminal.client_has_gone().unwrap(), "nobody came yet");
        let mut first = client(&terminal);
        first.write_all(b"last words").unwrap();
        fill(|bytes| terminal.write(bytes).unwrap());
        assert!(!terminal.client_has_gone().unwrap());
        drop(first);
        assert!(terminal.client_has_gone().unwrap());
        assert!(!terminal.client_has_gone().unwrap(), "said once");
        let mut bytes = [0; 16];
        assert!(client(&terminal).read(&mut bytes).is_err(), "nothing is there to be read");
        let mut read = 0;
        while read == 0 {
            read = terminal.read(&mut bytes).unwrap();
        }
        assert_eq!(&bytes[..read], b"last words");
    }
}
