//! Ctrl-C, and the polite kill.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Becomes true when a person has asked the command to end.
#[derive(Clone)]
pub(super) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Watches for it from now on; to be called once.
    pub(super) fn watch() -> Result<Self, ctrlc::Error> {
        let asked = Arc::new(AtomicBool::new(false));
        let handler = Arc::clone(&asked);
        ctrlc::set_handler(move || handler.store(true, Ordering::Relaxed))?;
        Ok(Self(asked))
    }

    /// As [`Self::is_asked`], when something else may have been ended by the same Ctrl-C a moment before.
    pub(super) fn was_asked(&self) -> bool {
        std::thread::sleep(std::time::Duration::from_millis(50));
        self.is_asked()
    }

    pub(super) fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
