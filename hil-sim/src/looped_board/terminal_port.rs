//! A pseudo-terminal at the other end of the board's line, in real time.

use std::io;
use std::thread::sleep;
use std::time::{Duration, Instant};

use frixel_control::Board;

use super::Port;
use crate::PseudoTerminal;

/// Largest lead of the board over real time, and time to wait for a byte.
const AHEAD_MAX: Duration = Duration::from_millis(2);
const WAIT: Duration = Duration::from_millis(1);

/// The terminal, and the board's time.
pub struct TerminalPort {
    terminal: PseudoTerminal,
    begun: Option<Instant>,
    ticks: u64,
}

impl TerminalPort {
    /// A terminal for a client to open at [`Self::path`].
    pub fn open() -> io::Result<Self> {
        Ok(Self { terminal: PseudoTerminal::open()?, begun: None, ticks: 0 })
    }

    /// The path that a client opens.
    pub fn path(&self) -> &str {
        self.terminal.path()
    }
}

impl Port for TerminalPort {
    fn read(&mut self, bytes: &mut [u8]) -> usize {
        self.terminal.read(bytes).unwrap_or(0)
    }

    fn write(&mut self, bytes: &[u8]) -> usize {
        self.terminal.write(bytes).unwrap_or(0)
    }

    fn pace(&mut self, ticks: u32) {
        let begun = *self.begun.get_or_insert_with(Instant::now);
        self.ticks += u64::from(ticks);
        let passed = Duration::from_micros(self.ticks * 1_000_000 / u64::from(Board::NUCLEO_G474RE.tick_hz));
        if let Some(ahead) = passed.checked_sub(begun.elapsed()).filter(|ahead| *ahead > AHEAD_MAX) {
            sleep(ahead);
        }
    }

    fn wait(&mut self) -> bool {
        sleep(WAIT);
        true
    }

    /// Waits until the client has closed the terminal, since its unread bytes would be lost.
    fn end(&mut self) {
        while matches!(self.terminal.client_has_gone(), Ok(false)) {
            // Other systems than Linux detect a gone client by reading nothing.
            self.read(&mut [0; 64]);
            sleep(WAIT);
        }
    }
}
