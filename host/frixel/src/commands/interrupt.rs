//! Ctrl-C, and the signal that asks a process to end.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Becomes true when somebody has requested that the command ends.
#[derive(Clone)]
pub(super) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Watches for it from now on; to be called once.
    pub(super) fn watch() -> Result<Self, ctrlc::Error> {
        let requested = Arc::new(AtomicBool::new(false));
        let handler = Arc::clone(&requested);
        ctrlc::set_handler(move || handler.store(true, Ordering::Relaxed))?;
        Ok(Self(requested))
    }

    /// As [`Self::is_requested`], when something else may have been ended by the same Ctrl-C a moment before.
    pub(super) fn was_requested(&self) -> bool {
        std::thread::sleep(std::time::Duration::from_millis(50));
        self.is_requested()
    }

    pub(super) fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
