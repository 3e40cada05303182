//! Ctrl-C, and the signal that requests a process to end.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Becomes true when Ctrl-C or a signal requests the command to end.
#[derive(Clone, Default)]
pub(super) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Installs the handler; may be called only once.
    pub(super) fn watch() -> Result<Self, ctrlc::Error> {
        let requested = Arc::new(AtomicBool::new(false));
        let handler = Arc::clone(&requested);
        ctrlc::set_handler(move || handler.store(true, Ordering::Relaxed))?;
        Ok(Self(requested))
    }

    /// Like [`Self::is_requested`], for use after a failure that the same Ctrl-C may have caused a moment ago.
    pub(super) fn was_requested(&self) -> bool {
        std::thread::sleep(std::time::Duration::from_millis(50));
        self.is_requested()
    }

    pub(super) fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
