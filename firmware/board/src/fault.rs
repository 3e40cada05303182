//! The end of a start after a panic or a fault, and its report in the next start.
//!
//! A board has one [`FaultRecord`], in memory not cleared by the start-up code, and one [`Ending`]. Its panic and fault
//! handlers call the methods of the ending, which set the output to zero, store the reason and reset. The next start
//! takes the reason with [`LastReset::take`].

use core::fmt::{Display, Write as _};
use core::ops::Range;
use core::panic::Location;
use core::sync::atomic::{AtomicU32, Ordering};

use frixel_drivers::fault_record::{FaultRecord, Text, Writer};
use frixel_wire::fault::Fault;
use frixel_wire::hello::ResetCause;

use crate::hardware::Processor;

/// Bytes of the exception frame of a Cortex-M, without FPU registers.
pub const FRAME_LEN: u32 = 32;

/// The last reset.
pub struct LastReset {
    /// Its cause.
    pub cause: ResetCause,
    /// The fault that led to it, with its detail.
    pub fault: Option<(Fault, u32)>,
    /// The text stored with the fault.
    pub text: &'static [u8],
}

impl LastReset {
    /// Takes the stored fault from the record and marks the record as used. Call this once in each start. `cause` is
    /// the cause reported by the processor.
    pub fn take(cause: ResetCause, record: &FaultRecord, text: &'static mut Text) -> Self {
        let (fault, text): (_, &[u8]) = match record.take(text) {
            Some((fault, detail, text)) => (Some((fault, detail)), text),
            None if cause == ResetCause::Watchdog => {
                (Some((Fault::Watchdog, 0)), b"the main loop or the tick stood still")
            }
            None => (None, b""),
        };
        record.mark();
        Self { cause, fault, text }
    }

    /// Logs it, in an image with logging.
    #[cfg_attr(not(feature = "defmt"), allow(clippy::unused_self, reason = "nothing is logged"))]
    pub fn log(&self) {
        #[cfg(feature = "defmt")]
        self.log_by_probe();
    }

    #[cfg(feature = "defmt")]
    fn log_by_probe(&self) {
        let (fault, detail) = self.fault.map_or((0, 0), |(fault, detail)| (fault.number(), detail));
        defmt::info!(
            "reset: cause {=u8}, fault {=u8}, {=u32:#x} {=[u8]:a}",
            self.cause.number(),
            fault,
            detail,
            self.text
        );
    }
}

/// The end of a start, from any context.
pub struct Ending<P> {
    processor: P,
    record: &'static FaultRecord,
    /// Faults since the start, at most 1. A number, because with an `AtomicBool` the compiler keeps unused panic
    /// messages, 200 bytes of the smallest image.
    faults: AtomicU32,
}

impl<P: Processor> Ending<P> {
    /// The ending of a board that stores its faults in `record`.
    pub const fn new(processor: P, record: &'static FaultRecord) -> Self {
        Self { processor, record, faults: AtomicU32::new(0) }
    }

    /// Sets the output to zero, stores the fault with the text written by `write_text`, and resets. A second fault
    /// meanwhile resets at once.
    pub fn end(&self, fault: Fault, detail: u32, write_text: &mut dyn FnMut(&mut Writer)) -> ! {
        self.processor.disable_interrupts();
        self.processor.zero_output_for_good();
        // Not a swap, which a Cortex-M0+ lacks: a second fault between load and store would never return here.
        if self.faults.load(Ordering::Relaxed) == 0 {
            self.faults.store(1, Ordering::Relaxed);
            self.record.save(fault, detail, write_text);
        }
        self.processor.reset()
    }

    /// Ends with a panic; the fault's detail is the line. Its message is unused, so the linker drops all messages.
    pub fn panic(&self, location: Option<&Location<'_>>) -> ! {
        let (file, line) = location.map_or(("", 0), |location| (location.file(), location.line()));
        self.end(Fault::Panic, line, &mut |text| {
            text.text("panicked in ").text(file);
        })
    }

    /// Ends with a panic; the fault's detail is the line, and its text the whole message.
    pub fn panic_with_message(&self, location: Option<&Location<'_>>, message: &dyn Display) -> ! {
        self.end(Fault::Panic, location.map_or(0, Location::line), &mut |text| {
            // The writer never fails.
            let _ = write!(text, "{message}");
        })
    }

    /// Ends with an interrupt that has no handler; the fault's detail is its number.
    pub fn unhandled_interrupt(&self, number: i16) -> ! {
        self.end(Fault::HardFault, u32::from(number.unsigned_abs()), &mut |text| {
            text.text("unhandled interrupt");
        })
    }

    /// Ends with a hard fault (including bus faults) whose exception frame is at an address. `stack` is the address
    /// range of the stack; `read` reads the registers, and is called only if the frame lies in the stack.
    ///
    /// The detail is the program counter. For a stack overflow, it is the address outside the stack; for an invalid
    /// stack pointer, its value.
    pub fn hard_fault(&self, frame: u32, stack: Range<u32>, read: impl FnOnce() -> FaultRegisters) -> ! {
        self.processor.zero_output_for_good();
        if frame < stack.start {
            self.end(Fault::StackOverflow, frame, &mut |text| {
                text.text("the stack overflowed");
            })
        }
        if frame.saturating_add(FRAME_LEN) > stack.end {
            self.end(Fault::HardFault, frame, &mut |text| {
                text.text("the stack pointer left the stack");
            })
        }
        let registers = read();
        self.end(Fault::HardFault, registers.program_counter, &mut |text| registers.write(text))
    }
}

/// The processor's information about a hard fault.
pub struct FaultRegisters {
    /// Address of the faulting instruction.
    pub program_counter: u32,
    /// Return address of the faulting function.
    pub link: u32,
    /// `CFSR` and `BFAR`: the kind of fault, and the address of the access; `None` on a processor without them.
    pub status: Option<(u32, u32)>,
}

impl FaultRegisters {
    fn write(&self, text: &mut Writer) {
        text.text("pc ").hex(self.program_counter).text(", lr ").hex(self.link);
        if let Some((cfsr, bfar)) = self.status {
            text.text(", CFSR ").hex(cfsr).text(", BFAR ").hex(bfar);
        }
    }
}
