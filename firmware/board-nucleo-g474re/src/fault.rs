//! Panics and faults: they set the output to zero, store the reason, and reset. The next start reports the reason.

use core::arch::{asm, naked_asm};
#[cfg(feature = "panic-message")]
use core::panic::Location;
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use cortex_m::interrupt;
use cortex_m::peripheral::SCB;
use cortex_m_rt::exception;
use frixel_drivers::fault_record::{FaultRecord, Text, Writer};
use frixel_drivers::stm32g4;
use frixel_wire::fault::Fault;
use frixel_wire::hello::ResetCause;
use stm32_metapac::RCC;

use crate::{flash, output};

/// The last fault, in memory that the start-up code does not clear.
#[unsafe(link_section = ".uninit.RECORD")]
pub static RECORD: FaultRecord = FaultRecord::new();

/// Holds [`MARK`] as long as RAM has had power.
#[unsafe(link_section = ".uninit.MARKED")]
static MARKED: AtomicU32 = AtomicU32::new(0);
const MARK: u32 = 0x6672_786c;

/// The last reset.
pub struct LastReset {
    /// Its cause.
    pub cause: ResetCause,
    /// The fault that led to it, with its detail.
    pub fault: Option<(Fault, u32)>,
    /// The text stored with the fault.
    pub text: &'static [u8],
    /// Number of starts in a row before this one that ended in a fault.
    pub fault_starts: u8,
}

impl LastReset {
    /// Reads the reset cause and the stored fault, and clears both.
    pub fn take(text: &'static mut Text) -> Self {
        let flags = RCC.csr().read().0;
        RCC.csr().modify(|w| w.set_rmvf(true));
        let cause = stm32g4::reset_cause(flags, outlasting(&MARKED).swap(MARK, Ordering::Relaxed) == MARK);
        let (fault, text): (_, &[u8]) = match outlasting(&RECORD).take(text) {
            Some((fault, detail, text)) => (Some((fault, detail)), text),
            None if cause == ResetCause::Watchdog => {
                (Some((Fault::Watchdog, 0)), b"the main loop or the tick stood still")
            }
            None => (None, b""),
        };
        Self { cause, fault, text, fault_starts: RECORD.count_start(fault.is_some()) }
    }
}

/// Returns a place that the start-up code does not clear. Its initialiser is never written, so the compiler must not
/// conclude from it what the place holds.
fn outlasting<T>(place: &'static T) -> &'static T {
    // SAFETY: no instruction. For all that the compiler knows, it writes the place, whose type is made of atomics, of
    // which every content is valid.
    unsafe { asm!("/* {} */", in(reg) place, options(nostack, preserves_flags)) };
    place
}

/// Sets the output to zero, stores the reason and resets.
fn end(fault: Fault, detail: u32, write_text: &mut dyn FnMut(&mut Writer)) -> ! {
    static ENDING: AtomicBool = AtomicBool::new(false);
    interrupt::disable();
    output::zero_for_good();
    // A second fault during the following code resets at once.
    if !ENDING.swap(true, Ordering::Relaxed) {
        RECORD.save(fault, detail, write_text);
    }
    SCB::sys_reset()
}

/// A panic; the fault's detail is the line number.
#[cfg(feature = "panic-message")]
#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    use core::fmt::Write;
    end(Fault::Panic, info.location().map_or(0, Location::line), &mut |text| {
        // The writer never fails.
        let _ = write!(text, "{info}");
    })
}

/// A panic; the fault's detail is the line number. The message is not used, so the linker drops it.
#[cfg(not(feature = "panic-message"))]
#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    let (file, line) = info.location().map_or(("", 0), |place| (place.file(), place.line()));
    end(Fault::Panic, line, &mut |text| {
        text.text("panicked in ").text(file);
    })
}

/// An interrupt without a handler.
#[exception]
unsafe fn DefaultHandler(number: i16) {
    end(Fault::HardFault, u32::from(number.unsigned_abs()), &mut |text| {
        text.text("unhandled interrupt");
    })
}

/// Non-maskable interrupt: an error of the flash, the RAM or the clock.
#[exception]
unsafe fn NonMaskableInt() {
    if !flash::take_unreadable() {
        end(Fault::HardFault, 0, &mut |text| {
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

/// The detail of a hard fault is the program counter; of a stack overflow, the address outside the stack; of an
/// invalid stack pointer, its value.
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
            text.text("the stack pointer left the stack");
        })
    }
    // SAFETY: the processor has stored a frame there, and it lies in the stack. The fault registers are readable.
    let (program_counter, link, status, fault_address) = unsafe {
        let scb = &*SCB::PTR;
        ((*frame).program_counter, (*frame).link, scb.cfsr.read(), scb.bfar.read())
    };
    end(Fault::HardFault, program_counter, &mut |text| {
        text.text("pc ").hex(program_counter).text(", lr ").hex(link);
        text.text(", CFSR ").hex(status).text(", BFAR ").hex(fault_address);
    })
}

/// Panics where a static would be taken twice, which cannot happen.
pub fn never() -> ! {
    panic!("a static was taken twice")
}
