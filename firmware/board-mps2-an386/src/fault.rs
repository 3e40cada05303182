//! Panics and faults: they set the output to zero, store the fault for the next start, and reset.

use core::arch::naked_asm;
use core::panic::PanicInfo;

use cortex_m::interrupt;
use cortex_m::peripheral::SCB;
use cortex_m_rt::exception;
use frixel_drivers::fault_record::{FaultRecord, Text, Writer};
use frixel_wire::fault::Fault;

use crate::shared;

/// In memory that the start-up code does not clear.
#[unsafe(link_section = ".uninit.RECORD")]
static RECORD: FaultRecord = FaultRecord::new();

/// Removes and returns the fault that led to the reset, with its detail and its text; the text is stored in `text`.
/// `None` without a fault.
pub fn take(text: &'static mut Text) -> Option<(Fault, u32, &'static [u8])> {
    RECORD.take(text)
}

/// Sets the output to zero, stores the fault and resets.
fn end(fault: Fault, detail: u32, write_text: &mut dyn FnMut(&mut Writer)) -> ! {
    interrupt::disable();
    shared::output_off();
    RECORD.save(fault, detail, write_text);
    SCB::sys_reset()
}

/// A panic; the fault's detail is the line number.
#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    let (file, line) = info.location().map_or(("", 0), |place| (place.file(), place.line()));
    end(Fault::Panic, line, &mut |text| {
        text.text("panicked in ").text(file);
    })
}

/// An exception without a handler.
#[exception]
unsafe fn DefaultHandler(number: i16) {
    end(Fault::HardFault, u32::from(number.unsigned_abs()), &mut |text| {
        text.text("unhandled interrupt");
    });
}

/// The stack frame of an exception.
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

/// Hard fault, bus fault included. The stack may be exhausted, so the handler first switches to a stack of its own.
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

/// The detail of a hard fault is the program counter; of a stack overflow, the address outside the stack.
extern "C" fn on_hard_fault(frame: *const Frame) -> ! {
    let bottom = (&raw const _stack_end) as usize;
    if (frame as usize) < bottom {
        end(Fault::StackOverflow, frame as u32, &mut |text| {
            text.text("the stack overflowed");
        });
    }
    // SAFETY: the processor has stored a frame there, and it lies in the stack.
    let program_counter = unsafe { (&raw const (*frame).program_counter).read() };
    end(Fault::HardFault, program_counter, &mut |text| {
        text.text("pc ").hex(program_counter);
    })
}

/// Panics where a static would be taken twice, which cannot happen.
pub fn never() -> ! {
    panic!("a static was taken twice")
}
