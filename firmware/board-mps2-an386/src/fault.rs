//! What ends the firmware, and what is known of it after the reset: output to zero first, then the reason kept, then
//! the reset.

use core::arch::naked_asm;
use core::mem::MaybeUninit;
use core::panic::PanicInfo;

use cortex_m::interrupt;
use cortex_m::peripheral::SCB;
use cortex_m_rt::exception;
use frixel_wire::fault::Fault;

use crate::shared;

/// Says that a reason was kept, and was not there by chance.
const KEPT: u32 = 0x6b65_7074;

/// A reason for a reset.
#[derive(Clone, Copy)]
#[repr(C)]
struct Reason {
    kept: u32,
    number: u32,
    detail: u32,
    check: u32,
}

/// Outside of what the start-up code clears.
#[unsafe(link_section = ".uninit.REASON")]
static mut REASON: MaybeUninit<Reason> = MaybeUninit::uninit();

/// The fault that led to the reset, with a number that belongs to it, if it was one. It is told once.
pub fn take() -> Option<(Fault, u32)> {
    // SAFETY: any four words are a `Reason`; only this function and `end` touch it, and `end` never returns here.
    let reason = unsafe {
        let reason = (&raw const REASON).cast::<Reason>().read_volatile();
        (&raw mut REASON).cast::<u32>().write_volatile(0);
        reason
    };
    if reason.kept != KEPT || reason.check != check(reason.number, reason.detail) {
        return None;
    }
    Fault::try_from(reason.number as u8).ok().map(|fault| (fault, reason.detail))
}

const fn check(number: u32, detail: u32) -> u32 {
    !(number.rotate_left(16) ^ detail)
}

/// Puts the output to zero, keeps the reason and resets.
fn end(fault: Fault, detail: u32) -> ! {
    interrupt::disable();
    shared::output_off();
    let number = u32::from(fault.number());
    let reason = Reason { kept: KEPT, number, detail, check: check(number, detail) };
    // SAFETY: interrupts are off, and nothing comes back from here.
    unsafe { (&raw mut REASON).cast::<Reason>().write_volatile(reason) };
    SCB::sys_reset()
}

/// A panic; the number that goes with it is the line.
#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    end(Fault::Panic, info.location().map_or(0, core::panic::Location::line))
}

/// An exception that nobody handles.
#[exception]
unsafe fn DefaultHandler(number: i16) {
    end(Fault::HardFault, u32::from(number.unsigned_abs()));
}

/// What an exception puts on the stack.
#[repr(C)]
struct Frame {
    registers: [u32; 6],
    program_counter: u32,
    status: u32,
}

unsafe extern "C" {
    /// Lowest address of the stack, from the linker script.
    static _stack_end: u32;
}

/// Hard fault, bus fault included. The stack may be used up: this goes to one of its own before anything else.
///
/// # Safety
/// Called by the processor.
#[unsafe(naked)]
#[unsafe(export_name = "HardFault")]
unsafe extern "C" fn hard_fault() -> ! {
    naked_asm!(
        "mrs r0, msp",
        "ldr r1, ={stack}",
        "msr msp, r1",
        "b {handler}",
        stack = sym _fault_stack_start,
        handler = sym on_hard_fault,
    )
}

unsafe extern "C" {
    /// Top of the hard fault's own stack, from the linker script.
    static _fault_stack_start: u32;
}

/// The number that goes with a hard fault is the program counter; with a stack overflow, the address that was out.
extern "C" fn on_hard_fault(frame: *const Frame) -> ! {
    let bottom = (&raw const _stack_end) as usize;
    if (frame as usize) < bottom {
        end(Fault::StackOverflow, frame as u32);
    }
    // SAFETY: the processor has put a frame there, and it lies in the stack.
    let program_counter = unsafe { (&raw const (*frame).program_counter).read() };
    end(Fault::HardFault, program_counter)
}

/// For what cannot happen.
pub fn never() -> ! {
    end(Fault::Panic, 0)
}
