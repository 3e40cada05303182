//! Panics and faults: they set the output to zero, store the reason, and reset ([`frixel_board::fault`]). The next start
//! reports the reason.

use core::arch::{asm, naked_asm};
use core::panic::PanicInfo;

use cortex_m::interrupt;
use cortex_m_rt::exception;
use frixel_board::fault::{Ending, FRAME_LEN, FaultRegisters, LastReset};
use frixel_board::hardware::Processor;
use frixel_drivers::fault_record::{FaultRecord, Text};
use frixel_drivers::rp2;

use crate::{chip, output, watchdog};

/// The last fault, in memory that the start-up code does not clear.
#[unsafe(link_section = ".uninit.RECORD")]
pub static RECORD: FaultRecord = FaultRecord::new();

static ENDING: Ending<Rp2> = Ending::new(Rp2, &RECORD);

struct Rp2;

impl Processor for Rp2 {
    fn disable_interrupts(&self) {
        interrupt::disable();
    }

    fn zero_output_for_good(&self) {
        output::zero_for_good();
    }

    fn reset(&self) -> ! {
        watchdog::reset()
    }
}

/// Reads the reset cause and the stored fault, and clears the latter.
pub fn last_reset(text: &'static mut Text) -> LastReset {
    let record = outlasting(&RECORD);
    LastReset::take(rp2::reset_cause(chip::reset_flags(), record.has_outlasted_reset()), record, text)
}

/// Returns a place that the start-up code does not clear. Its initialiser is never written, so the compiler must not
/// conclude from it what the place holds.
fn outlasting<T>(place: &'static T) -> &'static T {
    // SAFETY: no instruction. For all that the compiler knows, it writes the place, whose type is made of atomics, of
    // which every content is valid.
    unsafe { asm!("/* {} */", in(reg) place, options(nostack, preserves_flags)) };
    place
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    #[cfg(feature = "panic-message")]
    ENDING.panic_with_message(info.location(), info);
    #[cfg(not(feature = "panic-message"))]
    ENDING.panic(info.location())
}

/// An interrupt without a handler.
#[exception]
unsafe fn DefaultHandler(number: i16) {
    ENDING.unhandled_interrupt(number)
}

/// The stack frame of an exception.
#[repr(C)]
struct Frame {
    registers: [u32; 5],
    link: u32,
    program_counter: u32,
    status: u32,
}

const _: () = assert!(size_of::<Frame>() == FRAME_LEN as usize);

unsafe extern "C" {
    /// Lowest address of the stack, from the linker script.
    static _stack_end: u32;
    /// Top of the stack, from the linker script.
    static _stack_start: u32;
    /// Top of the hard fault's own stack, from the linker script.
    static _fault_stack_start: u32;
}

/// Hard fault. The stack may be exhausted, so the handler first switches to a stack of its own.
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
        "ldr r1, ={handler}",
        "bx r1",
        stack = sym _fault_stack_start,
        handler = sym on_hard_fault,
    )
}

extern "C" fn on_hard_fault(frame: *const Frame) -> ! {
    let stack = (&raw const _stack_end).addr() as u32..(&raw const _stack_start).addr() as u32;
    ENDING.hard_fault(frame.addr() as u32, stack, || {
        // SAFETY: the processor has stored a frame there, and it lies in the stack.
        let (program_counter, link) = unsafe { ((*frame).program_counter, (*frame).link) };
        FaultRegisters { program_counter, link, status: status() }
    })
}

/// `CFSR` and `BFAR`, which the Cortex-M0+ lacks.
#[cfg(feature = "rp2040")]
fn status() -> Option<(u32, u32)> {
    None
}

/// `CFSR` and `BFAR`.
#[cfg(feature = "rp2350")]
fn status() -> Option<(u32, u32)> {
    // SAFETY: the registers are readable.
    let scb = unsafe { &*cortex_m::peripheral::SCB::PTR };
    Some((scb.cfsr.read(), scb.bfar.read()))
}

/// Panics where a static would be taken twice, which cannot happen.
pub fn never() -> ! {
    panic!("a static was taken twice")
}
