//! Ctrl-C, and the signal that requests a process to end.

use std::ops::ControlFlow;
use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use frixel_play::break_if;

/// Exit code after a second signal: 128 + SIGINT, as shells report a process that Ctrl-C ended.
const EXIT_CODE: i32 = 130;

/// Becomes true when Ctrl-C or a signal requests the command to end.
#[derive(Clone, Default)]
pub(super) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Installs the handler; may be called only once.
    ///
    /// A second Ctrl-C or signal ends the process at once, whatever it is blocked in: a board whose host has gone sets
    /// its output to zero by itself.
    pub(super) fn watch() -> Result<Self, ctrlc::Error> {
        let requested = Arc::new(AtomicBool::new(false));
        let handler = Arc::clone(&requested);
        ctrlc::set_handler(move || {
            if handler.swap(true, Ordering::Relaxed) {
                process::exit(EXIT_CODE);
            }
        })?;
        Ok(Self(requested))
    }

    /// Like [`Self::is_requested`], for use after a failure: waits 50 ms for the signal, since a Ctrl-C may have caused
    /// the failure by ending a child process first.
    pub(super) fn was_requested(&self) -> bool {
        std::thread::sleep(std::time::Duration::from_millis(50));
        self.is_requested()
    }

    pub(super) fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Breaks when the command should end, for use as [`GoesOn`](frixel_play::GoesOn).
    pub(super) fn goes_on(&self) -> ControlFlow<()> {
        break_if(self.is_requested())
    }
}
