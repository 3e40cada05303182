//! The end of a start after a panic or a fault, and its report at the next start.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, Location, catch_unwind, resume_unwind};

use frixel_board::fault::{Ending, FRAME_LEN, FaultRegisters, LastReset};
use frixel_board::hardware::Processor;
use frixel_drivers::fault_record::{FaultRecord, Text};
use frixel_wire::fault::Fault;
use frixel_wire::hello::ResetCause;
use frixel_wire::message::FAULT_TEXT_MAX_LEN;

const STACK: std::ops::Range<u32> = 0x2000_0000..0x2000_4800;

/// Actions of the processor, in order.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    InterruptsOff,
    OutputZero,
    Text,
    Reset,
}

#[derive(Default)]
struct FakeProcessor(RefCell<Vec<Step>>);

/// The payload of the panic that simulates a reset.
struct Reset;

impl FakeProcessor {
    fn step(&self, step: Step) {
        self.0.borrow_mut().push(step);
    }
}

impl Processor for &'static FakeProcessor {
    fn disable_interrupts(&self) {
        self.step(Step::InterruptsOff);
    }

    fn zero_output_for_good(&self) {
        self.step(Step::OutputZero);
    }

    fn reset(&self) -> ! {
        self.step(Step::Reset);
        resume_unwind(Box::new(Reset))
    }
}

/// Runs something that ends in a reset, and returns the steps, the record, and the reset as the next start sees it.
fn ended(end: impl FnOnce(&Ending<&'static FakeProcessor>)) -> (Vec<Step>, LastReset) {
    ended_on(Box::leak(Box::default()), end)
}

/// As [`ended`], on a given processor.
fn ended_on(
    processor: &'static FakeProcessor,
    end: impl FnOnce(&Ending<&'static FakeProcessor>),
) -> (Vec<Step>, LastReset) {
    let record: &'static FaultRecord = Box::leak(Box::new(FaultRecord::new()));
    let ending = Ending::new(processor, record);
    let result = catch_unwind(AssertUnwindSafe(|| end(&ending)));
    assert!(result.is_err_and(|thrown| thrown.is::<Reset>()), "it ends with a reset");
    (processor.0.take(), next_start(record, ResetCause::Software))
}

fn next_start(record: &FaultRecord, cause: ResetCause) -> LastReset {
    let text: &'static mut Text = Box::leak(Box::new([0; FAULT_TEXT_MAX_LEN]));
    LastReset::take(cause, record, text)
}

fn text(last_reset: &LastReset) -> &str {
    std::str::from_utf8(last_reset.text).unwrap()
}

#[test]
fn the_output_is_zero_before_the_fault_is_stored_and_the_reset_comes_last() {
    let processor: &'static FakeProcessor = Box::leak(Box::default());
    let (steps, last_reset) = ended_on(processor, |ending| {
        ending.end(Fault::Watchdog, 7, &mut |text| {
            processor.step(Step::Text);
            text.text("why");
        })
    });
    assert_eq!(steps, [Step::InterruptsOff, Step::OutputZero, Step::Text, Step::Reset]);
    assert_eq!((last_reset.cause, last_reset.fault), (ResetCause::Software, Some((Fault::Watchdog, 7))));
    assert_eq!(text(&last_reset), "why");
}

#[test]
fn a_second_fault_while_the_first_is_stored_resets_at_once() {
    let (steps, last_reset) = ended(|ending| {
        ending.end(Fault::Panic, 1, &mut |text| {
            text.text("half");
            ending.end(Fault::HardFault, 2, &mut |_| panic!("it stores nothing"));
        })
    });
    let ends = [Step::InterruptsOff, Step::OutputZero];
    assert_eq!(steps, [&ends[..], &ends, &[Step::Reset]].concat());
    assert_eq!(last_reset.fault, None, "what was half stored does not count");
}

#[test]
fn the_frame_of_a_hard_fault_is_read_only_inside_the_stack() {
    let outside = || -> FaultRegisters { panic!("there is no frame to read") };
    let overflow = (Fault::StackOverflow, "the stack overflowed");
    let left = (Fault::HardFault, "the stack pointer left the stack");
    for (frame, (fault, why)) in [
        (STACK.start - 4, overflow),
        (0, overflow),
        (STACK.end - FRAME_LEN + 4, left),
        (STACK.end, left),
        (u32::MAX - 3, left),
    ] {
        let (steps, last_reset) = ended(|ending| ending.hard_fault(frame, STACK, outside));
        assert_eq!(steps[0], Step::OutputZero, "first of all");
        assert_eq!((last_reset.fault, text(&last_reset)), (Some((fault, frame)), why), "{frame:#x}");
    }
    for frame in [STACK.start, STACK.end - FRAME_LEN] {
        for (status, more) in [(Some((0x100, 0x6000_0000)), ", CFSR 0x00000100, BFAR 0x60000000"), (None, "")] {
            let read = || FaultRegisters { program_counter: 0x0800_12ef, link: 0x9abc_d321, status };
            let (_, last_reset) = ended(|ending| ending.hard_fault(frame, STACK, read));
            assert_eq!(last_reset.fault, Some((Fault::HardFault, 0x0800_12ef)));
            assert_eq!(text(&last_reset), format!("pc 0x080012ef, lr 0x9abcd321{more}"));
        }
    }
}

#[test]
fn a_panic_and_an_unhandled_interrupt_report_their_place() {
    let here = Location::caller();
    let (_, last_reset) = ended(|ending| ending.panic(Some(here)));
    assert_eq!(last_reset.fault, Some((Fault::Panic, here.line())));
    assert_eq!(text(&last_reset), format!("panicked in {}", here.file()));
    let (_, last_reset) = ended(|ending| ending.panic_with_message(Some(here), &format_args!("{} of {}", 3, 2)));
    assert_eq!((last_reset.fault, text(&last_reset)), (Some((Fault::Panic, here.line())), "3 of 2"));
    let (_, last_reset) = ended(|ending| ending.unhandled_interrupt(-5));
    assert_eq!((last_reset.fault, text(&last_reset)), (Some((Fault::HardFault, 5)), "unhandled interrupt"));
}

/// A watchdog reset stores no fault, so the processor's reset cause is reported. A stored fault takes precedence, since
/// it is closer to the reason.
#[test]
fn a_reset_by_the_watchdog_is_a_fault_unless_another_is_recorded() {
    let record = FaultRecord::new();
    let hung = next_start(&record, ResetCause::Watchdog);
    assert_eq!(hung.fault, Some((Fault::Watchdog, 0)));
    assert!(record.survived_reset(), "each start marks it");
    assert_eq!(text(&hung), "the main loop or the tick stood still");
    record.save(Fault::Panic, 9, &mut |_| ());
    assert_eq!(next_start(&record, ResetCause::Watchdog).fault, Some((Fault::Panic, 9)));
}
