//! Values that an interrupt handler owns.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicBool, Ordering};

/// Holds a value that the main program gives to one interrupt handler before it enables the interrupt.
pub struct Owned<T> {
    given: AtomicBool,
    value: UnsafeCell<MaybeUninit<T>>,
}

// SAFETY: the value is given once, before the interrupt is enabled, and from then on only its handler accesses it; so
// there is never more than one reference to it, and it changes context once, which `Send` allows.
unsafe impl<T: Send> Sync for Owned<T> {}

impl<T> Owned<T> {
    /// An empty place.
    #[allow(clippy::new_without_default, reason = "it belongs in a static")]
    pub const fn new() -> Self {
        Self { given: AtomicBool::new(false), value: UnsafeCell::new(MaybeUninit::uninit()) }
    }

    /// Gives the value to the handler.
    ///
    /// # Safety
    /// The handler's interrupt has not been enabled yet.
    pub unsafe fn give(&self, value: T) {
        // SAFETY: the caller guarantees that there is no other reference.
        unsafe { (*self.value.get()).write(value) };
        self.given.store(true, Ordering::Release);
    }

    /// Returns the value to the handler; `None` before it was given.
    ///
    /// # Safety
    /// Only the handler that owns the value calls this, once in each run.
    #[allow(clippy::mut_from_ref, reason = "the handler is the one owner, says the caller")]
    pub unsafe fn get(&self) -> Option<&mut T> {
        // SAFETY: it was given, and a handler does not interrupt itself, so this is the only reference.
        self.given.load(Ordering::Acquire).then(|| unsafe { (*self.value.get()).assume_init_mut() })
    }
}
