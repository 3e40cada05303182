//! Hard faults, and memory that outlasts a reset.

#[cfg(target_arch = "arm")]
use core::arch::asm;

use frixel_board::fault::{Ending, FRAME_LEN, FaultRegisters};
use frixel_board::hardware::Processor;

/// The frame that the processor stores for an exception, without registers of the FPU.
#[repr(C)]
pub struct ExceptionFrame {
    registers: [u32; 5],
    link: u32,
    program_counter: u32,
    status: u32,
}

const _: () = assert!(size_of::<ExceptionFrame>() == FRAME_LEN as usize);

unsafe extern "C" {
    /// Lowest address of the stack, from the board's linker script.
    static _stack_end: u32;
    /// Top of the stack, from the board's linker script.
    static _stack_start: u32;
}

/// Defines the handler of hard faults, bus faults included, for the [`Ending`] in a static. The stack may be exhausted,
/// so the handler first switches to a stack of its own, whose top is the symbol `_fault_stack_start` of the board's
/// linker script.
#[macro_export]
macro_rules! hard_fault_handler {
    ($ending:path) => {
        /// Handles hard faults.
        ///
        /// # Safety
        /// Called by the processor.
        #[unsafe(naked)]
        #[unsafe(export_name = "HardFault")]
        unsafe extern "C" fn hard_fault() -> ! {
            unsafe extern "C" {
                static _fault_stack_start: u32;
            }
            extern "C" fn end(frame: *const $crate::fault::ExceptionFrame) -> ! {
                // SAFETY: the processor has stored a frame there, or the stack pointer has left the stack.
                unsafe { $crate::fault::end_hard_fault(&$ending, frame) }
            }
            core::arch::naked_asm!(
                "mrs r0, msp",
                "ldr r1, ={stack}",
                "msr msp, r1",
                // A branch of an `ARMv6-M` reaches 2 KiB.
                "ldr r1, ={end}",
                "bx r1",
                stack = sym _fault_stack_start,
                end = sym end,
            )
        }
    };
}

/// Ends with a hard fault. [`hard_fault_handler!`] calls it.
///
/// # Safety
/// If `frame` lies in the stack, the processor has stored a frame there.
pub unsafe fn end_hard_fault<P: Processor>(ending: &Ending<P>, frame: *const ExceptionFrame) -> ! {
    let stack = (&raw const _stack_end).addr() as u32..(&raw const _stack_start).addr() as u32;
    ending.hard_fault(frame.addr() as u32, stack, || {
        // SAFETY: it is called only if the frame lies in the stack.
        let frame = unsafe { &*frame };
        FaultRegisters { program_counter: frame.program_counter, link: frame.link, status: status() }
    })
}

/// `CFSR` and `BFAR`, which an `ARMv6-M` does not have.
#[cfg_attr(not(armv6m), allow(clippy::unnecessary_wraps, reason = "on an ARMv6-M there are none"))]
fn status() -> Option<(u32, u32)> {
    #[cfg(not(armv6m))]
    {
        // SAFETY: the registers are readable, and reading them changes nothing.
        let scb = unsafe { &*cortex_m::peripheral::SCB::PTR };
        Some((scb.cfsr.read(), scb.bfar.read()))
    }
    #[cfg(armv6m)]
    None
}

/// Returns a place that the start-up code does not clear, such as a static in the section `.uninit`. Its initialiser is
/// never written, so the compiler must not conclude from it what the place holds. Put atomics of integers there only,
/// of which every content is valid.
pub fn outlasting<T: Sync>(place: &'static T) -> &'static T {
    #[cfg(target_arch = "arm")]
    // SAFETY: no instruction. For all that the compiler knows, it writes the place.
    unsafe {
        asm!("/* {} */", in(reg) place, options(nostack, preserves_flags));
    }
    place
}
