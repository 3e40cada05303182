//! Panics and faults: output to zero first, then the fault stored for the next start, then the reset.

use core::arch::naked_asm;
use core::panic::PanicInfo;

use cortex_m::interrupt;
use cortex_m::peripheral::SCB;
use cortex_m_rt::exception;
use frixel_drivers::fault_record::{FaultRecord, Text, Writer};
use frixel_wire::fault::Fault;

use crate::shared;

/// Outside of what the start-up code clears.
#[unsafe(link_section = ".uninit.RECORD")]
static RECORD: FaultRecord = FaultRecord::new();

/// The fault that led to the reset with its detail, if it was one, and its text in `text`. It is returned once.
pub fn take(text: &'static mut Text) -> Option<(Fault, u32, &'static [u8])> {
    RECORD.take(text)
}

/// Puts the output to zero, stores the fault and resets.
fn end(fault: Fault, detail: u32, say: &mut dyn FnMut(&mut Writer)) -> ! {
    interrupt::disable();
    shared::output_off();
    RECORD.save(fault, detail, say);
    SCB::sys_reset()
}

/// A panic; the number that goes with it is the line.
#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    let (file, line) = info.location().map_or(("", 0), |place| (place.file(), place.line()));
    end(Fault::Panic, line, &mut |text| {
        text.text("panicked in ").text(file);
    })
}

/// An exception that nobody handles.
#[exception]
unsafe fn DefaultHandler(number: i16) {
    end(Fault::HardFault, u32::from(number.unsigned_abs()), &mut |text| {
        text.text("an interrupt came that nobody handles");
    });
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
        end(Fault::StackOverflow, frame as u32, &mut |text| {
            text.text("the stack overflowed");
        });
    }
    // SAFETY: the processor has put a frame there, and it lies in the stack.
    let program_counter = unsafe { (&raw const (*frame).program_counter).read() };
    end(Fault::HardFault, program_counter, &mut |text| {
        text.text("pc ").hex(program_counter);
    })
}

/// For what cannot happen.
pub fn never() -> ! {
    panic!("a static was taken twice")
}
