//! Panics and faults: they set the output to zero, store the reason, and reset ([`frixel_board::fault`]). The next start
//! reports the reason.

use core::arch::{asm, naked_asm};
use core::panic::PanicInfo;

use cortex_m::interrupt;
use cortex_m::peripheral::SCB;
use cortex_m_rt::exception;
use frixel_board::fault::{Ending, FRAME_LEN, FaultRegisters, LastReset};
use frixel_board::hardware::Processor;
use frixel_drivers::fault_record::{FaultRecord, Text};
use frixel_drivers::stm32g4;
use frixel_wire::fault::Fault;
use stm32_metapac::RCC;

use crate::{flash, output};

/// The last fault, in memory that the start-up code does not clear.
#[unsafe(link_section = ".uninit.RECORD")]
pub static RECORD: FaultRecord = FaultRecord::new();

static ENDING: Ending<Stm32> = Ending::new(Stm32, &RECORD);

struct Stm32;

impl Processor for Stm32 {
    fn disable_interrupts(&self) {
        interrupt::disable();
    }

    fn zero_output_for_good(&self) {
        output::zero_for_good();
    }

    fn reset(&self) -> ! {
        SCB::sys_reset()
    }
}

/// Reads the reset cause and the stored fault, and clears both.
pub fn last_reset(text: &'static mut Text) -> LastReset {
    let flags = RCC.csr().read().0;
    RCC.csr().modify(|w| w.set_rmvf(true));
    let record = outlasting(&RECORD);
    LastReset::take(stm32g4::reset_cause(flags, record.has_outlasted_reset()), record, text)
}

/// Returns a place that the start-up code does not clear. Its initialiser is never written, so the compiler must not
/// conclude from it what the place holds.
pub fn outlasting<T>(place: &'static T) -> &'static T {
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

/// Non-maskable interrupt: an error of the flash, the RAM or the clock.
#[exception]
unsafe fn NonMaskableInt() {
    if !flash::take_unreadable() {
        ENDING.end(Fault::HardFault, 0, &mut |text| {
            text.text("a non-maskable interrupt: flash, RAM or clock failed");
        })
    }
}

/// The stack frame of an exception.
#[repr(C)]
struct Frame {
    registers: [u32; 5],
    link: u32,
    program_counter: u32,
    status: u32,
}

unsafe extern "C" {
    /// Lowest address of the stack, from the linker script.
    static _stack_end: u32;
    /// Top of the stack, from the linker script.
    static _stack_start: u32;
    /// Top of the hard fault's own stack, from the linker script.
    static _fault_stack_start: u32;
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

extern "C" fn on_hard_fault(frame: *const Frame) -> ! {
    let stack = (&raw const _stack_end).addr() as u32..(&raw const _stack_start).addr() as u32;
    ENDING.hard_fault(frame.addr() as u32, stack, || {
        // SAFETY: the processor has stored a frame there, and it lies in the stack. The fault registers are readable.
        let (frame, scb) = unsafe { (&*frame, &*SCB::PTR) };
        FaultRegisters {
            program_counter: frame.program_counter,
            link: frame.link,
            status: Some((scb.cfsr.read(), scb.bfar.read())),
        }
    })
}

const _: () = assert!(size_of::<Frame>() == FRAME_LEN as usize);

/// Panics where a static would be taken twice, which cannot happen.
pub fn never() -> ! {
    panic!("a static was taken twice")
}
