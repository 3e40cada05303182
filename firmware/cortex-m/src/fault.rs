//! Panics, faults, and memory that survives a reset.

#[cfg(target_arch = "arm")]
use core::arch::asm;
use core::panic::PanicInfo;

use cortex_m::interrupt;
use cortex_m::peripheral::SCB;
use frixel_board::fault::{Ending, FRAME_LEN, FaultRegisters};
use frixel_board::hardware::Processor;
use frixel_wire::fault::Fault;
use frixel_wire::hello::ResetCause;

/// Re-exports for [`fault_handlers!`](crate::fault_handlers).
#[doc(hidden)]
pub mod parts {
    pub use frixel_board::fault::{Ending, LastReset};
    pub use frixel_drivers::fault_record::{FaultRecord, Text};
}

/// The start and the end of a chip's run.
pub trait Chip: Sync {
    /// Returns the cause of the last reset, and clears it. `ram_survived` states whether RAM has kept its content.
    fn reset_cause(ram_survived: bool) -> ResetCause;

    /// Sets the output to zero until the reset ([`Processor::zero_output_for_good`]).
    fn zero_output_for_good();

    /// Resets the chip.
    fn reset() -> ! {
        SCB::sys_reset()
    }
}

/// A chip as required by [`Ending`].
pub struct CortexM<C>(pub C);

impl<C: Chip> Processor for CortexM<C> {
    fn disable_interrupts(&self) {
        interrupt::disable();
    }

    fn zero_output_for_good(&self) {
        C::zero_output_for_good();
    }

    fn reset(&self) -> ! {
        C::reset()
    }
}

/// Defines the handlers of panics, hard faults and interrupts without a handler for the [`Chip`] `$chip`, a unit
/// struct. They set the output to zero, store the reason, and reset ([`frixel_board::fault`]). Also defines
/// `last_reset`, with which the next start takes the reason. The board's linker script places `.uninit` where the
/// start-up code clears nothing.
///
/// `nmi: $is_harmless` adds a handler of non-maskable interrupts, which are a fault unless that function returns
/// `true`.
#[macro_export]
macro_rules! fault_handlers {
    ($chip:ident, nmi: $is_harmless:path) => {
        $crate::fault_handlers!($chip);

        /// Non-maskable interrupt: an error of the flash, the RAM or the clock.
        #[::cortex_m_rt::exception]
        unsafe fn NonMaskableInt() {
            if !$is_harmless() {
                $crate::fault::end_nmi(&ENDING)
            }
        }
    };
    ($chip:ident) => {
        /// The last fault, in memory that the start-up code does not clear.
        #[unsafe(link_section = ".uninit.RECORD")]
        static RECORD: $crate::fault::parts::FaultRecord = $crate::fault::parts::FaultRecord::new();

        static ENDING: $crate::fault::parts::Ending<$crate::fault::CortexM<$chip>> =
            $crate::fault::parts::Ending::new($crate::fault::CortexM($chip), &RECORD);

        /// Takes the cause of the last reset and the stored fault, and clears both. Call this once in each start.
        pub fn last_reset(text: &'static mut $crate::fault::parts::Text) -> $crate::fault::parts::LastReset {
            let record = $crate::retained(&RECORD);
            let cause = <$chip as $crate::fault::Chip>::reset_cause(record.survived_reset());
            $crate::fault::parts::LastReset::take(cause, record, text)
        }

        #[panic_handler]
        fn panic(info: &::core::panic::PanicInfo) -> ! {
            $crate::fault::end_panic(&ENDING, info)
        }

        /// An interrupt without a handler.
        #[::cortex_m_rt::exception]
        unsafe fn DefaultHandler(number: i16) {
            ENDING.unhandled_interrupt(number)
        }

        $crate::hard_fault_handler!(ENDING);
    };
}

/// Ends with a panic. With the feature `panic-message`, its whole message is stored.
pub fn end_panic<P: Processor>(ending: &Ending<P>, info: &PanicInfo) -> ! {
    if cfg!(feature = "panic-message") {
        ending.panic_with_message(info.location(), info)
    }
    ending.panic(info.location())
}

/// Ends with a non-maskable interrupt.
pub fn end_nmi<P: Processor>(ending: &Ending<P>) -> ! {
    ending.end(Fault::HardFault, 0, &mut |text| {
        text.text("NMI: flash, RAM or clock failed");
    })
}

/// The exception frame of the processor, without FPU registers.
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

/// Defines the handler of hard faults (including bus faults), for the [`Ending`] in a static. The stack may be
/// exhausted, so the handler first switches to its own stack, whose top is the symbol `_fault_stack_start` of the
/// board's linker script.
#[doc(hidden)]
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

/// `CFSR` and `BFAR`, which an `ARMv6-M` lacks.
#[cfg_attr(not(armv6m), allow(clippy::unnecessary_wraps, reason = "on an ARMv6-M there are none"))]
fn status() -> Option<(u32, u32)> {
    #[cfg(not(armv6m))]
    {
        // SAFETY: the registers are readable, and reading them changes nothing.
        let scb = unsafe { &*SCB::PTR };
        Some((scb.cfsr.read(), scb.bfar.read()))
    }
    #[cfg(armv6m)]
    None
}

/// Returns a place that the start-up code does not clear, such as a static in the section `.uninit`. Its initialiser is
/// never written, so the compiler must not assume the initial content. Use it only for atomic integers, for which every
/// content is valid.
pub fn retained<T: Sync>(place: &'static T) -> &'static T {
    #[cfg(target_arch = "arm")]
    // SAFETY: no instruction. no instruction, but the compiler must assume that it writes the place.
    unsafe {
        asm!("/* {} */", in(reg) place, options(nostack, preserves_flags));
    }
    place
}
