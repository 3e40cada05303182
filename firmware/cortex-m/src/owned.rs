//! Values owned by an interrupt handler.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m::interrupt;

use crate::Boot;

/// Holds a value given by the main program to one interrupt handler.
pub struct Owned<T> {
    is_given: AtomicBool,
    value: UnsafeCell<MaybeUninit<T>>,
}

// SAFETY: the value is written once, before `get` returns it, and from then on only its handler accesses it. So there
// is never more than one reference to it, and it changes context once, which `Send` allows.
unsafe impl<T: Send> Sync for Owned<T> {}

impl<T> Owned<T> {
    /// An empty place.
    #[allow(clippy::new_without_default, reason = "it belongs in a static")]
    pub const fn new() -> Self {
        Self { is_given: AtomicBool::new(false), value: UnsafeCell::new(MaybeUninit::uninit()) }
    }

    /// Gives the value to the handler. Returns `None`, without giving it, if the handler already has one and may be
    /// using it.
    #[must_use = "a handler that has a value keeps it"]
    pub fn give(&self, value: T) -> Option<()> {
        // Without interrupts, so that no other call comes between the test and the end, since an ARMv6-M has no atomic
        // exchange. The second core of a dual-core chip is never started.
        interrupt::free(|_| {
            if self.is_given.load(Ordering::Relaxed) {
                return None;
            }
            // SAFETY: nothing was given, and no other call gets here.
            unsafe { self.put(value) };
            Some(())
        })
    }

    /// Gives the value to the handler.
    ///
    /// # Safety
    /// Only this function gives a value to this place.
    #[inline]
    pub(crate) unsafe fn give_once(&self, _: Boot, value: T) {
        // SAFETY: there is one `Boot`, and it ends here, so this is the first call; and no other function gives.
        unsafe { self.put(value) };
    }

    /// Writes the value, which the handler may take from then on.
    ///
    /// # Safety
    /// Nothing was given, so [`Self::get`] has returned no reference, and no other call of this function is under way.
    unsafe fn put(&self, value: T) {
        // SAFETY: that of this function.
        unsafe { (*self.value.get()).write(value) };
        self.is_given.store(true, Ordering::Release);
    }

    /// Returns the value to the handler; `None` before it was given.
    ///
    /// # Safety
    /// Only the handler that owns the value calls this, once per run, and keeps no reference beyond that run.
    #[allow(clippy::mut_from_ref, reason = "the caller guarantees that the handler is the only owner")]
    pub unsafe fn get(&self) -> Option<&mut T> {
        // SAFETY: it was given, and is not written again. A handler does not interrupt itself, so this is the only
        // reference.
        self.is_given.load(Ordering::Acquire).then(|| unsafe { (*opaque(self.value.get())).assume_init_mut() })
    }
}

/// Returns a pointer whose value is unknown to the compiler. Otherwise it may write the address, as a constant, into
/// every function of the tick, which costs an `ARMv6-M` 500 bytes more than a register.
#[inline]
fn opaque<T>(pointer: *mut T) -> *mut T {
    #[cfg(target_arch = "arm")]
    {
        let opaque;
        // SAFETY: no instruction. It accesses nothing.
        unsafe {
            core::arch::asm!("/* {} */", inout(reg) pointer => opaque, options(nomem, nostack, preserves_flags));
        }
        opaque
    }
    #[cfg(not(target_arch = "arm"))]
    pointer
}
