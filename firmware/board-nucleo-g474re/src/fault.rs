//! What ends the firmware, and what is known of it after the reset: output to zero first, then the reason kept, then the
//! reset.

use core::arch::naked_asm;
#[cfg(feature = "panic-message")]
use core::panic::Location;
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use cortex_m::interrupt;
use cortex_m::peripheral::SCB;
use cortex_m_rt::exception;
use frixel_drivers::fault_record::{FaultRecord, Text, Writer};
use frixel_drivers::reset;
use frixel_wire::fault::Fault;
use frixel_wire::hello::ResetCause;
use stm32_metapac::RCC;

use crate::{flash, output};

/// Outside of what the start-up code clears.
#[unsafe(link_section = ".uninit.RECORD")]
static RECORD: FaultRecord = FaultRecord::new();

/// Is [`MARK`] as long as RAM has had power.
#[unsafe(link_section = ".uninit.MARKED")]
static MARKED: AtomicU32 = AtomicU32::new(0);
const MARK: u32 = 0x6672_786c;

/// Why the processor started.
pub struct LastReset {
    /// Its cause.
    pub cause: ResetCause,
    /// The fault that led to it, with a number that belongs to the fault.
    pub fault: Option<(Fault, u32)>,
    /// What was said of the fault.
    pub text: &'static [u8],
}

impl LastReset {
    /// Reads the reset cause and the stored fault, and clears both.
    pub fn take(text: &'static mut Text) -> Self {
        let flags = RCC.csr().read().0;
        RCC.csr().modify(|w| w.set_rmvf(true));
        let cause = reset::cause(flags, MARKED.swap(MARK, Ordering::Relaxed) == MARK);
        let (fault, text): (_, &[u8]) = match RECORD.take(text) {
            Some((fault, detail, text)) => (Some((fault, detail)), text),
            None if cause == ResetCause::Watchdog => {
                (Some((Fault::Watchdog, 0)), b"the main loop or the tick stood still")
            }
            None => (None, b""),
        };
        Self { cause, fault, text }
    }
}

/// Puts the output to zero, keeps the reason and resets.
fn end(fault: Fault, detail: u32, say: &mut dyn FnMut(&mut Writer)) -> ! {
    static ENDING: AtomicBool = AtomicBool::new(false);
    interrupt::disable();
    output::zero_for_good();
    // A fault in what follows resets without more ado.
    if !ENDING.swap(true, Ordering::Relaxed) {
        RECORD.save(fault, detail, say);
    }
    SCB::sys_reset()
}

/// A panic; the number that goes with it is the line.
#[cfg(feature = "panic-message")]
#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    use core::fmt::Write;
    end(Fault::Panic, info.location().map_or(0, Location::line), &mut |text| {
        // The writer never fails.
        let _ = write!(text, "{info}");
    })
}

/// A panic; the number that goes with it is the line. The message is not used, so the linker drops it.
#[cfg(not(feature = "panic-message"))]
#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    let (file, line) = info.location().map_or(("", 0), |place| (place.file(), place.line()));
    end(Fault::Panic, line, &mut |text| {
        text.text("panicked in ").text(file);
    })
}

/// An interrupt that nobody handles.
#[exception]
unsafe fn DefaultHandler(number: i16) {
    end(Fault::HardFault, u32::from(number.unsigned_abs()), &mut |text| {
        text.text("an interrupt came that nobody handles");
    })
}

/// Flash that cannot be read, or RAM, or the clock.
#[exception]
unsafe fn NonMaskableInt() {
    if !flash::take_unreadable() {
        end(Fault::HardFault, 0, &mut |text| {
            text.text("a non-maskable interrupt: the image's flash or RAM cannot be read, or the clock failed");
        })
    }
}

/// What an exception puts on the stack.
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

/// The number that goes with a hard fault is the program counter; with a stack overflow, the address that was out; with a
/// stack pointer that was lost, where it was.
extern "C" fn on_hard_fault(frame: *const Frame) -> ! {
    output::zero_for_good();
    let address = frame.addr();
    if address < (&raw const _stack_end).addr() {
        end(Fault::StackOverflow, address as u32, &mut |text| {
            text.text("the stack overflowed");
        })
    }
    if address + size_of::<Frame>() > (&raw const _stack_start).addr() {
        end(Fault::HardFault, address as u32, &mut |text| {
            text.text("the stack pointer was outside the stack");
        })
    }
    // SAFETY: the processor has put a frame there, and it lies in the stack. The registers of the fault can be read.
    let (program_counter, link, status, fault_address) = unsafe {
        let scb = &*SCB::PTR;
        ((*frame).program_counter, (*frame).link, scb.cfsr.read(), scb.bfar.read())
    };
    end(Fault::HardFault, program_counter, &mut |text| {
        text.text("pc ").hex(program_counter).text(", lr ").hex(link);
        text.text(", CFSR ").hex(status).text(", BFAR ").hex(fault_address);
    })
}

/// For what cannot happen.
pub fn never() -> ! {
    panic!("a static was taken twice")
}
