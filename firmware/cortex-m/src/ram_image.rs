//! Images that run from RAM, with their vector table.

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::asm;
use cortex_m::peripheral::SCB;

/// Lets an image run from RAM. Defines `move_vectors`, and the function that first copies code and constants from
/// `__sicode` to the range from `__scode` to `__ecode`; these are symbols of the board's linker script. `$vectors` is
/// the number of exceptions (including the initial stack pointer) and interrupts. The linker script aligns the section
/// `.vectors`, where the table is while the image runs, as required by the processor.
#[macro_export]
macro_rules! runs_from_ram {
    ($vectors:expr) => {
        /// The vector table while the image runs.
        #[unsafe(link_section = ".vectors")]
        static IN_RAM: [::core::sync::atomic::AtomicU32; $vectors] =
            [const { ::core::sync::atomic::AtomicU32::new(0) }; $vectors];

        /// Moves the vector table to RAM, so that interrupts are taken while the flash cannot be read.
        pub fn move_vectors(scb: &mut ::cortex_m::peripheral::SCB) {
            unsafe extern "C" {
                static __vector_table: [u32; $vectors];
            }
            // SAFETY: the linker script places it, and nothing writes it.
            let vectors = unsafe { &__vector_table };
            // SAFETY: the table will be complete, and is aligned by the linker script.
            unsafe { $crate::ram_image::move_vectors(scb, vectors, &IN_RAM) }
        }

        /// Copies code and constants to RAM. `Reset` of `cortex-m-rt` calls this first; it lies in the flash beside it.
        ///
        /// # Safety
        /// Called once, before anything is run from RAM.
        #[unsafe(naked)]
        #[unsafe(export_name = "__pre_init")]
        #[unsafe(link_section = ".Reset")]
        unsafe extern "C" fn copy_code() {
            ::core::arch::naked_asm!(
                "ldr r0, =__scode",
                "ldr r1, =__ecode",
                "ldr r2, =__sicode",
                "2:",
                "cmp r0, r1",
                "beq 3f",
                "ldm r2!, {{r3}}",
                "stm r0!, {{r3}}",
                "b 2b",
                "3:",
                "bx lr",
            )
        }
    };
}

/// Copies the vector table, and switches the processor to the copy.
///
/// # Safety
/// `from` has all vectors of the processor, and `to` is aligned as required for a vector table.
pub unsafe fn move_vectors<const N: usize>(scb: &mut SCB, from: &[u32; N], to: &'static [AtomicU32; N]) {
    for (to, from) in to.iter().zip(from) {
        to.store(*from, Ordering::Relaxed);
    }
    asm::dsb();
    // SAFETY: the table is complete and aligned, as the caller guarantees.
    unsafe { scb.vtor.write(to.as_ptr().addr() as u32) };
    asm::dsb();
    asm::isb();
}
