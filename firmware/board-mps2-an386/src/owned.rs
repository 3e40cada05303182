//! Values that an interrupt handler owns.

use core::cell::UnsafeCell;

/// Holds a value that the main program gives to one interrupt handler before it enables the interrupt.
pub struct Owned<T>(UnsafeCell<Option<T>>);

// SAFETY: the value is given once, before the interrupt is enabled, and from then on only its handler accesses it; so
// there is never more than one reference to it, and it changes context once, which `Send` allows.
unsafe impl<T: Send> Sync for Owned<T> {}

impl<T> Owned<T> {
    /// An empty place.
    pub const fn new() -> Self {
        Self(UnsafeCell::new(None))
    }

    /// Gives the value to the handler.
    ///
    /// # Safety
    /// The handler's interrupt has not been enabled yet.
    pub unsafe fn give(&self, value: T) {
        // SAFETY: the caller guarantees that there is no other reference.
        unsafe { *self.0.get() = Some(value) }
    }

    /// Returns the value to the handler; `None` before it was given.
    ///
    /// # Safety
    /// Only the handler that owns the value calls this, once in each run.
    #[allow(clippy::mut_from_ref, reason = "the handler is the one owner, says the caller")]
    pub unsafe fn get(&self) -> Option<&mut T> {
        // SAFETY: a handler does not interrupt itself, so this is the only reference.
        unsafe { (*self.0.get()).as_mut() }
    }
}
